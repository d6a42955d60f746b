//! What is offered while a filter is written.

use super::*;

/// What is offered at the end of a text.
fn offered(text: &str) -> Vec<String> {
    let found = complete(text, text.len(), &scene()).choices;
    found.into_iter().map(|choice| choice.text).collect()
}

#[test]
fn what_is_offered_fits_the_place() {
    for (text, first, count) in [
        ("any on m", "material ", 1),
        ("any on material ", "\"glass\" ", 5),
        ("any on material \"w", "\"wall\" ", 1),
        ("any on material WA", "\"wall\" ", 1),
        ("start on light ", "\"lamp\" ", 3),
        ("any on object ta", "\"table\" ", 1),
        ("any is re", "reflect ", 2),
        ("any (in sphere(0, 1, 0, 1) and i", "in ", 2),
        ("any in s", "sphere(", 1),
        ("edges ", ">= ", 7),
        ("edges >", ">= ", 1),
        ("edges >= 3 a", "and ", 1),
        ("(edges >= 3", ") ", 1),
        ("film ", "in rect(", 1),
        ("fi", "film in rect(", 1),
        ("strategy == ", "\"bidirectional\" ", 4),
        ("strategy i", "in (", 1),
        ("strategy in (\"lens\", l", "\"lens\" ", 2),
        ("strategy in (\"lens\"", ", ", 2),
        ("not lu", "luminance ", 1),
        ("l", "lpe \"", 3),
        ("lpe \"C.*<T", "D", 7),
        ("lpe \"C<RS'", "glass'", 5),
        ("lpe \"C<RS'w", "wall'", 1),
        ("lpe \"", "C", 5),
    ] {
        let offered = offered(text);
        assert_eq!(offered.first().map(String::as_str), Some(first), "`{text}`: {offered:?}");
        assert_eq!(offered.len(), count, "`{text}`: {offered:?}");
    }
    for text in ["edges >= ", "any in sphere(0, ", "any on material \"glas\" x", "edges == 3"] {
        assert_eq!(offered(text), Vec::<String>::new(), "`{text}`");
    }
}

#[test]
fn the_usual_comes_first() {
    let offers = offered("");
    let place = |word: &str| offers.iter().position(|offer| offer.trim_end() == word);
    let usual = ["any", "start", "end", "all", "lpe \"", "film in rect(", "strategy", "not"];
    let places: Vec<_> = usual.map(|word| place(word).expect(word)).to_vec();
    assert!(places.is_sorted(), "at the beginning: {offers:?}");
    assert!(place("not") < place("edges"), "a long list comes last: {offers:?}");
    assert_eq!(offered("edges >= 3 and "), offered(""), "and behind an operator");
}

#[test]
fn a_choice_takes_the_place_of_what_is_there() {
    for (before, after, number, expected) in [
        ("any on mat", "", 0, "any on material |"),
        ("any on mat", " \"glass\"", 0, "any on material| \"glass\""),
        ("any on material \"gl", "", 0, "any on material \"glass\" |"),
        ("lpe \"C.*'gl", "", 0, "lpe \"C.*'glass'|"),
        ("any in sp", "", 0, "any in sphere(|"),
    ] {
        let text = format!("{before}{after}");
        let completion = complete(&text, before.len(), &scene());
        let (mut taken, cursor) = completion.taken(&text, number).expect("a choice");
        taken.insert(cursor, '|');
        assert_eq!(taken, expected, "{before}|{after}");
    }
}

#[test]
fn odd_names_are_offered_as_they_are_written() {
    let mut scene = scene();
    let names = ["Material #25", "a;b 100%", "O'Brien \"glass\"", "стекло", "back\\slash"];
    scene.materials = names.map(FilterMaterial::from).to_vec();
    for name in names {
        for (before, after) in [("any on material ", ""), ("lpe \"C.*'", ".*L\"")] {
            let text: String = before.chars().chain(name.chars().take(1)).collect();
            let completion = complete(&text, text.len(), &scene);
            let (taken, _) = completion.taken(&text, 0).expect(name);
            let text = format!("{taken}{after}");
            let filter = Filter::parse(&text).unwrap_or_else(|e| panic!("{}", e.pointed(&text)));
            assert!(filter.compile(&scene).is_ok(), "{text}");
            assert_eq!(Filter::parse(&filter.to_string()), Ok(filter), "{text}");
        }
    }
}

#[test]
fn nothing_that_is_typed_breaks_it() {
    let text = "any (in sphere(0, \u{e9}\u{4e2d}\" lpe \"C<R'\u{4e2d} strategy in (";
    for cursor in 0..=text.len() + 2 {
        let Completion { range, .. } = complete(text, cursor, &scene());
        assert!(text.get(range.clone()).is_some(), "{range:?} at {cursor}");
    }
}
