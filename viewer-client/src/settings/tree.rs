//! Where the conditions of the whole filter were written.

use common::{Filter, SelectorKind};

use crate::settings::FilterSettings;

/// Where a condition of the whole filter was written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    /// A spherical selector, by its number.
    Sphere(usize),
    /// The text; which of its conditions.
    Text(usize),
    /// A kept filter, by its number.
    Kept(usize),
}

impl FilterSettings {
    /// Where the condition of this number, as the daemon counts them, was written.
    pub fn source(&self, condition: usize) -> Option<Source> {
        let mut left = condition;
        for kind in SelectorKind::ALL {
            let of_kind = self.selectors.iter().enumerate().filter(|(_, s)| s.kind == kind);
            for (number, _) in of_kind {
                match left.checked_sub(1) {
                    Some(fewer) => left = fewer,
                    None => return Some(Source::Sphere(number)),
                }
            }
        }
        let count = |text: &str| Filter::parse(text).map_or(0, |filter| filter.leaves().len());
        let own = count(&self.text);
        if left < own {
            return Some(Source::Text(left));
        }
        left -= own;
        for (number, kept) in self.kept.iter().enumerate().filter(|(_, kept)| kept.on) {
            let conditions = count(&kept.text);
            if left < conditions {
                return Some(Source::Kept(number));
            }
            left -= conditions;
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::command::{FilterCommand, Sphere, Switch};

    #[test]
    fn the_source_of_every_condition_is_known() {
        let mut settings = FilterSettings::default();
        let sphere = |kind| Sphere { kind, place: [0.0, 0.0, 0.0, 1.0] };
        for kind in [SelectorKind::Any, SelectorKind::Start] {
            settings.apply(&FilterCommand::Add(sphere(kind)));
        }
        settings.apply(&FilterCommand::Set("edges == 2 or dwell > 3".to_owned()));
        settings.apply(&FilterCommand::Keep("mine".to_owned()));
        settings.apply(&FilterCommand::Set("chain == 1".to_owned()));
        settings.apply(&FilterCommand::Use("mine".to_owned(), Switch::On));
        let whole = Filter::parse(&settings.wanted()).expect("our own");
        let sources: Vec<_> = (0..whole.leaves().len()).map(|i| settings.source(i)).collect();
        use Source::{Kept, Sphere as Ball, Text};
        let kept = [Kept(0); 4].map(Some);
        let expected = [[Some(Ball(1)), Some(Ball(0)), Some(Text(0))].as_slice(), &kept].concat();
        assert_eq!(sources, expected, "starts come before others: {whole}");
        assert_eq!(settings.source(7), None, "there are no more");
    }
}
