//! Which replicates of a picture are wanted.

use std::fmt;
use std::ops::Range;
use std::str::FromStr;

/// Whole replicates, and the first parts of some others.
///
/// Its text form, such as `0..12,12:3,13:1`, repeats a picture that time has ended: replicates 0 to 11
/// whole, the first three parts of replicate 12 and the first one of replicate 13.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Selection {
    /// Numbers of whole replicates; the end of the last range is open where it is `u64::MAX`.
    pub whole: Vec<Range<u64>>,
    /// Numbers and parts of the others.
    pub tails: Vec<(u64, u32)>,
}

impl Selection {
    /// The first `count` replicates.
    pub fn first(count: u64) -> Self {
        Self { whole: std::iter::once(0..count).collect(), tails: Vec::new() }
    }

    /// The selection with its open end, if it has one, at `count`.
    #[must_use]
    pub fn closed(mut self, count: u64) -> Self {
        for range in &mut self.whole {
            if range.end == u64::MAX {
                range.end = count.max(range.start);
            }
        }
        self
    }

    /// The numbers of the whole replicates, in order.
    pub fn numbers(&self) -> impl Iterator<Item = u64> + Send + '_ {
        self.whole.iter().flat_map(Clone::clone)
    }

    /// How many whole replicates there are.
    pub fn count(&self) -> u64 {
        self.whole.iter().map(|range| range.end.saturating_sub(range.start)).sum()
    }

    /// Of these numbers, which rise.
    pub fn of(numbers: impl Iterator<Item = u64>) -> Self {
        let mut whole: Vec<Range<u64>> = Vec::new();
        for number in numbers {
            match whole.last_mut() {
                Some(last) if last.end == number => last.end += 1,
                _ => whole.push(number..number + 1),
            }
        }
        Self { whole, tails: Vec::new() }
    }
}

impl fmt::Display for Selection {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let ranges = self.whole.iter().filter(|range| !range.is_empty()).map(|range| {
            let end = if range.end == u64::MAX { String::new() } else { range.end.to_string() };
            format!("{}..{end}", range.start)
        });
        let tails = self.tails.iter().map(|(number, parts)| format!("{number}:{parts}"));
        let all: Vec<String> = ranges.chain(tails).collect();
        f.write_str(&all.join(","))
    }
}

impl FromStr for Selection {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        const FORM: &str = "give ranges such as 0..8 or 8.., parts of replicates such as 12:3, or \
            several separated by commas";
        let number = |text: &str| text.trim().parse::<u64>().map_err(|_error| FORM.to_owned());
        let mut selection = Self::default();
        for item in text.split(',') {
            if let Some((replicate, parts)) = item.split_once(':') {
                let parts = u32::try_from(number(parts)?).map_err(|_error| FORM.to_owned())?;
                selection.tails.push((number(replicate)?, parts));
                continue;
            }
            let (start, end) = item.split_once("..").ok_or(FORM)?;
            let end = if end.trim().is_empty() { u64::MAX } else { number(end)? };
            selection.whole.push(number(start)?..end);
        }
        selection.whole.sort_by_key(|range| range.start);
        if selection.whole.iter().any(|range| range.start >= range.end) {
            return Err(
                "a range must end after its beginning: 4..8 holds the numbers 4 to 7".to_owned()
            );
        }
        let twice = selection.whole.windows(2).any(|pair| pair[0].end > pair[1].start);
        let inside = |number: u64| selection.whole.iter().any(|range| range.contains(&number));
        if twice || selection.tails.iter().any(|(number, _)| inside(*number)) {
            return Err("no replicate may appear twice".to_owned());
        }
        Ok(selection)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn selections_have_a_text_form() {
        for text in ["0..12", "3..5,8..", "0..12,12:3,13:1", "0:1"] {
            let selection: Selection = text.parse().expect(text);
            assert_eq!(selection.to_string(), text);
        }
        for text in ["", "3", "5..3", "4..4", "0..3,2..5", "0..5,3:1", "a..b", "0..2,2:x"] {
            assert!(text.parse::<Selection>().is_err(), "`{text}` is no selection");
        }
        let open: Selection = "2..3,5..".parse().expect("a selection");
        let closed = open.closed(8);
        assert_eq!(closed.numbers().collect::<Vec<_>>(), [2, 5, 6, 7]);
        assert_eq!((closed.count(), Selection::of(closed.numbers())), (4, closed));
    }
}
