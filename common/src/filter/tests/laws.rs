//! What holds for every registered condition, whatever it is.

use std::mem::discriminant;

use proptest::prelude::*;

use super::super::complete::offers;
use super::super::condition::Leaves as _;
use super::super::condition::attribute::{Attribute, Comparison};
use super::super::condition::strategy::Among;
use super::super::condition::vertex::{On, VertexClass};
use super::super::offers::{Offer, Offers, Rank};
use super::random::filter;
use super::*;

proptest! {
    #[test]
    fn what_is_printed_reads_back(filter in filter()) {
        let text = filter.to_string();
        prop_assume!(text.len() <= MAX_FILTER_BYTES);
        match Filter::parse(&text) {
            Ok(read) => prop_assert_eq!(read, filter, "{}", text),
            Err(error) => prop_assert!(false, "{}", error.pointed(&text)),
        }
    }

    /// Bits of valid texts, cut out, repeated and mixed: an answer, never a panic, and a complaint
    /// that points into the text.
    #[test]
    fn any_text_of_a_filter_is_answered(
        filter in filter(),
        cuts in prop::collection::vec((any::<prop::sample::Index>(), any::<prop::sample::Index>()), 1..6),
        noise in "[ -~]{0,12}|\\PC{0,4}",
    ) {
        let mut text = filter.to_string();
        for (i, (from, to)) in cuts.iter().enumerate() {
            let (a, b) = (from.index(text.len() + 1), to.index(text.len() + 1));
            let (a, b) = (text.floor_char_boundary(a.min(b)), text.floor_char_boundary(a.max(b)));
            match i % 3 {
                0 => text.replace_range(a..b, &noise),
                1 => {
                    let copy = text[a..b].to_owned();
                    text.insert_str(a, &copy);
                }
                _ => text.truncate(b),
            }
        }
        text.truncate(text.floor_char_boundary(2 * MAX_FILTER_BYTES));
        let found = Filter::parse(&text).and_then(|filter| filter.compile(&scene()));
        if let Err(error) = found {
            prop_assert!(error.span.start <= text.len(), "{error:?} on {text:?}");
            prop_assert!(!error.pointed(&text).is_empty());
        }
        for cursor in [text.len(), text.len() / 2] {
            let Completion { range, .. } = complete(&text, cursor, &scene());
            prop_assert!(text.get(range.clone()).is_some(), "{range:?} at {cursor} of {text:?}");
        }
    }

    /// Wherever a filter is cut off, whatever is offered then can be written on to a filter.
    #[test]
    fn what_is_offered_leads_to_a_filter(
        filter in filter(),
        place in any::<prop::sample::Index>(),
        first in any::<prop::sample::Index>(),
    ) {
        let text = filter.to_string();
        prop_assume!(text.len() <= MAX_FILTER_BYTES / 2);
        let cut = &text[..text.floor_char_boundary(place.index(text.len() + 1))];
        let completion = complete(cut, cut.len(), &scene());
        // Some of them: all would take long.
        for number in (0..completion.choices.len().min(4)).map(|i| i + first.index(60)) {
            let number = number % completion.choices.len();
            let (taken, cursor) = completion.taken(cut, number).expect("a choice");
            prop_assert_eq!(cursor, taken.len(), "at the end");
            prop_assert!(can_be_finished(&taken), "`{}` after `{}`", taken, cut);
        }
    }

    /// Whoever writes a filter is offered each of its words.
    #[test]
    fn every_word_is_offered(filter in filter()) {
        let text = filter.to_string();
        prop_assume!(text.len() <= MAX_FILTER_BYTES);
        let starts = text.match_indices(' ').map(|(i, _)| i + 1).chain([0]);
        for start in starts.filter(|start| text[..*start].matches('"').count() % 2 == 0) {
            let rest = &text[start..];
            let word = rest.split(|c: char| !c.is_alphanumeric()).next().unwrap_or_default();
            let is_word = word.starts_with(|c: char| c.is_ascii_lowercase());
            // Quotes within quotes are not counted well; constants are not offered.
            if !is_word || text.contains('\\') || matches!(word, "true" | "false") {
                continue;
            }
            let offered = complete(&text, start, &scene()).choices;
            prop_assert!(
                offered.iter().any(|choice| choice.text.starts_with(word)),
                "`{}` in `{}`: {:?}", word, text, offered
            );
        }
    }
}

/// Whether a text becomes a filter by what may come, within a few steps.
fn can_be_finished(text: &str) -> bool {
    fn search(text: &str, depth: usize, left: &mut usize) -> bool {
        if !text.trim().is_empty() && Filter::parse(text).is_ok() {
            return true;
        }
        if depth == 0 || *left == 0 {
            return false;
        }
        *left -= 1;
        let scene = scene();
        let Offers { mut found, open, .. } = offers(text, &scene);
        // What closes comes first.
        let closes = |text: &str| matches!(text, ")" | "\"" | ">" | "]" | "'");
        found.sort_by_key(|o| (!closes(&o.text), o.rank != Rank::Silent, o.rank));
        let next = |o: &Offer| {
            let blank = if o.rank == Rank::Silent { "" } else { " " };
            format!("{}{}{blank}", &text[..o.at], o.text)
        };
        let number = open.then(|| format!("{text}1"));
        found.iter().map(next).chain(number).any(|longer| search(&longer, depth - 1, left))
    }
    search(text, 40, &mut 4000)
}

#[test]
fn every_condition_is_exemplified_and_explained() {
    let manual = include_str!("../../../../docs/FILTERS.md");
    let kinds: Vec<_> = Leaf::kinds().collect();
    for (number, (kind, example)) in kinds.iter().enumerate() {
        let filter = Filter::parse(example).unwrap_or_else(|e| panic!("{}", e.pointed(example)));
        let Filter::Leaf(leaf) = &filter else { panic!("`{example}` is more than a condition") };
        assert_eq!(discriminant(leaf), discriminant(kind), "`{example}` is another condition");
        assert_eq!(Filter::parse(&filter.to_string()).as_ref(), Ok(&filter), "{example}");
        assert!(manual.contains(example), "docs/FILTERS.md lacks `{example}`");
        let text = kind.to_string();
        let default = Filter::parse(&text).unwrap_or_else(|e| panic!("{}", e.pointed(&text)));
        assert_eq!(default, Filter::Leaf(kind.clone()), "the usual one of kind {number}");
    }
}

#[test]
fn everything_that_menus_offer_is_a_filter_of_the_scene() {
    let spot = Spot { centre: DVec3::new(1.0, -2.5, 1e-3), radius: 0.25 };
    let proposals = Leaf::proposals(&scene(), spot);
    for (kind, example) in Leaf::kinds() {
        let made = proposals.iter().filter_map(|proposal| proposal.made.as_ref());
        let mut of_kind = made.filter(|leaf| discriminant(*leaf) == discriminant(&kind));
        assert!(of_kind.next().is_some(), "no menu offers what `{example}` is");
    }
    for Proposal { menu, label, meaning, made } in proposals {
        let made = made.expect("this scene has names of every kind");
        let text = made.to_string();
        let read = Filter::parse(&text).unwrap_or_else(|e| panic!("{}", e.pointed(&text)));
        assert_eq!(read, Filter::Leaf(made), "{menu:?}, {label}");
        assert!(read.compile(&scene()).is_ok(), "{text}");
        assert!(!label.is_empty() && !meaning.is_empty(), "{text}");
    }
}

#[test]
fn words_of_one_set_differ() {
    fn differ<T: Worded>() {
        let words: Vec<&str> = T::WORDS.iter().map(|(_, word)| word.text).collect();
        for (i, word) in words.iter().enumerate() {
            assert!(!words[..i].contains(word), "`{word}` twice");
        }
        for (number, value) in T::all().enumerate() {
            assert_eq!(value.word().text, words[number], "each has its own word");
            assert!(!value.word().meaning.is_empty(), "`{}` says nothing", words[number]);
        }
    }
    differ::<Place>();
    differ::<Attribute>();
    differ::<Comparison>();
    differ::<On>();
    differ::<VertexClass>();
    differ::<Among>();
}
