//! Changes to a filter's tree that panels and explanations ask for.

use common::{Filter, Leaf, SelectorKind};

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

/// The conditions of a filter from the left to the right, as a compiled one counts them.
pub fn leaves(filter: &Filter) -> Vec<&Leaf> {
    match filter {
        Filter::Constant(_) => Vec::new(),
        Filter::Not(part) => leaves(part),
        Filter::And(parts) | Filter::Or(parts) => parts.iter().flat_map(leaves).collect(),
        Filter::Leaf(leaf) => vec![leaf],
    }
}

/// The filter with its condition of this number changed.
pub fn with_leaf(filter: Filter, number: usize, change: &impl Fn(Leaf) -> Leaf) -> Filter {
    edit(filter, &mut number.clone(), &|leaf| Some(change(leaf))).unwrap_or_default()
}

/// The filter without its condition of this number.
pub fn without_leaf(filter: Filter, number: usize) -> Filter {
    edit(filter, &mut number.clone(), &|_| None).unwrap_or_default()
}

/// `None` where nothing is left.
fn edit(
    filter: Filter,
    left: &mut usize,
    change: &impl Fn(Leaf) -> Option<Leaf>,
) -> Option<Filter> {
    let mut each = |parts: Vec<Filter>| -> Vec<Filter> {
        parts.into_iter().filter_map(|part| edit(part, left, change)).collect()
    };
    match filter {
        Filter::Constant(_) => Some(filter),
        Filter::Not(part) => edit(*part, left, change).map(negated),
        Filter::And(parts) => joined(each(parts), Filter::And),
        Filter::Or(parts) => joined(each(parts), Filter::Or),
        Filter::Leaf(leaf) => {
            let here = *left == 0;
            // Later conditions must not be counted as this one.
            *left = left.checked_sub(1).unwrap_or(usize::MAX);
            if here { change(leaf).map(Filter::Leaf) } else { Some(Filter::Leaf(leaf)) }
        }
    }
}

/// Several parts as one; `None` without any.
pub fn joined(mut parts: Vec<Filter>, join: impl Fn(Vec<Filter>) -> Filter) -> Option<Filter> {
    if parts.len() > 1 { Some(join(parts)) } else { parts.pop() }
}

/// The opposite.
pub fn negated(part: Filter) -> Filter {
    match part {
        Filter::Not(inner) => *inner,
        other => Filter::Not(Box::new(other)),
    }
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
        let count = |text: &str| Filter::parse(text).map_or(0, |filter| leaves(&filter).len());
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

    fn filter(text: &str) -> Filter {
        Filter::parse(text).expect(text)
    }

    #[test]
    fn conditions_are_changed_and_dropped_by_number() {
        let text = "not edges == 2 and (dwell > 3 or chain == 1) and lpe \"CDL\"";
        let without = |number| without_leaf(filter(text), number).to_string();
        assert_eq!(without(0), "(dwell > 3 or chain == 1) and lpe \"CDL\"", "with its `not`");
        assert_eq!(without(1), "not edges == 2 and chain == 1 and lpe \"CDL\"", "one of two");
        assert_eq!(without(3), "not edges == 2 and (dwell > 3 or chain == 1)", "the last");
        assert_eq!(without(4), text, "there is no such condition");
        assert_eq!(without_leaf(filter("edges == 2"), 0), Filter::default(), "nothing is left");
        let other = leaves(&filter("step < 9"))[0].clone();
        let changed = with_leaf(filter(text), 2, &|_| other.clone());
        assert_eq!(changed, filter(&text.replace("chain == 1", "step < 9")), "in its place");
    }

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
        let whole = filter(&settings.wanted());
        let sources: Vec<_> = (0..leaves(&whole).len()).map(|i| settings.source(i)).collect();
        use Source::{Kept, Sphere as Ball, Text};
        let kept = [Kept(0); 4].map(Some);
        let expected = [[Some(Ball(1)), Some(Ball(0)), Some(Text(0))].as_slice(), &kept].concat();
        assert_eq!(sources, expected, "starts come before others: {whole}");
        assert_eq!(settings.source(7), None, "there are no more");
    }
}
