//! Changes to a tree.

use super::*;

fn filter(text: &str) -> Filter {
    Filter::parse(text).expect(text)
}

#[test]
fn conditions_are_changed_and_dropped_by_number() {
    let text = "not edges == 2 and (dwell > 3 or chain == 1) and lpe \"CDL\"";
    let without = |number| filter(text).with_leaf(number, |_| None).to_string();
    assert_eq!(without(0), "(dwell > 3 or chain == 1) and lpe \"CDL\"", "with its `not`");
    assert_eq!(without(1), "not edges == 2 and chain == 1 and lpe \"CDL\"", "one of two");
    assert_eq!(without(3), "not edges == 2 and (dwell > 3 or chain == 1)", "the last");
    assert_eq!(without(4), text, "there is no such condition");
    let nothing = filter("edges == 2").with_leaf(0, |_| None);
    assert_eq!(nothing, Filter::default(), "nothing is left");
    let other = filter("step < 9").leaves()[0].clone();
    let changed = filter(text).with_leaf(2, |_| Some(other));
    assert_eq!(changed, filter(&text.replace("chain == 1", "step < 9")), "in its place");
}

#[test]
fn a_text_is_read_once_and_kept() {
    let written = FilterText::read("edges>=4 &  depth<9");
    assert_eq!(written.text(), "edges>=4 &  depth<9", "as it was written");
    assert_eq!(written.tree(), Ok(&filter("edges >= 4 and edges < 9")), "and what it says");
    assert_eq!(FilterText::from(&filter("edges>=4")).text(), "edges >= 4", "printed");
    assert_eq!(FilterText::from(&Filter::default()), FilterText::default(), "every path");
    assert!(FilterText::read("  ").wants_all() && FilterText::default().wants_all(), "every path");
    let wrong = FilterText::read("edges >");
    assert!(wrong.error().is_some_and(|error| error.span.start == 7), "{:?}", wrong.error());
    assert!(!wrong.wants_all(), "it is no other filter");
    assert_eq!(wrong.text(), "edges >", "and not lost");
    let long = Filter::Or(vec![filter("luminance > 0.123456789"); 200]);
    assert!(FilterText::from(&long).error().is_some(), "too long to be read anywhere else");
}
