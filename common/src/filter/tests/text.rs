//! The text form: what is printed reads back, and what is wrong is told where.

use super::*;

#[test]
fn spellings_mean_the_same() {
    for (spelled, plain) in [
        ("", "true"),
        ("  ", "true"),
        ("edges>=4&&!lpe\"CD+L\"", "edges >= 4 and not lpe \"CD+L\""),
        ("depth = 2 | depth = 3", "edges == 2 or edges == 3"),
        ("strategy != seed", "strategy != \"seed\""),
        ("strategy in (lens, \"lens subpath\")", "strategy in (\"lens\" , \"lens subpath\")"),
        ("any in sphere(1,2.5,-3e1,.5)", "any in sphere(1, 2.5, -30, 0.5)"),
        ("a", ""),
    ] {
        match Filter::parse(spelled) {
            Ok(filter) => assert_eq!(filter, Filter::parse(plain).expect(plain), "{spelled}"),
            Err(_) => assert_eq!(plain, "", "{spelled}"),
        }
    }
    let precedence = Filter::parse("edges > 1 or edges > 2 and edges > 3").expect("well-formed");
    assert!(matches!(precedence, Filter::Or(parts) if parts.len() == 2), "`and` binds tighter");
}

/// Text, the first byte at fault, and a word that the complaint must hold.
const FAULTS: &[(&str, usize, &str)] = &[
    ("any in sphere(0, 0, 0)", 21, "`,`"),
    ("any in sphere(0, 0, 0, 0)", 7, "radius"),
    ("any in box(1, 0, 0, 0, 1, 1)", 7, "smallest corner"),
    ("any in cone(1)", 7, "sphere"),
    ("any on metal", 7, "material"),
    ("any under sphere(0, 0, 0, 1)", 4, "through"),
    ("edges ~ 3", 6, "=="),
    ("edges >= three", 9, "number"),
    ("edges in 6..3", 9, "empty"),
    ("edges > 3 xor edges < 2", 10, "and"),
    ("(edges > 3", 10, ")"),
    ("edges > 3)", 9, "end of the filter"),
    ("lengthy > 3", 0, "condition"),
    ("strategy == \"lens", 12, "closed"),
    ("lpe CD*L", 4, "quotes"),
    ("lpe \"C(D*L\"", 10, ")"),
    ("lpe \"CD{65}L\"", 8, "64"),
    ("lpe \"CX\"", 6, "event"),
    ("lpe \"D+\"", 5, "camera"),
    ("lpe \"C<RT>L\"", 6, "both"),
    ("film in rect(1, 0, 0, 1)", 12, "left"),
    ("luminance > 1e999", 12, "too large"),
    ("any on material \"glas\"", 16, "did you mean \"glass\""),
    ("any on object \"xyz\"", 14, "table, vase"),
    ("strategy == caustic", 12, "bidirectional"),
    ("lpe \"C.*'lmap'.*L\"", 9, "lamp"),
];

#[test]
fn faults_are_told_where_they_are() {
    for &(text, start, word) in FAULTS {
        let found = Filter::parse(text).and_then(|filter| filter.compile(&scene()));
        let error = found.expect_err(text);
        assert_eq!(error.span.start, start, "`{text}`: {}", error.pointed(text));
        assert!(error.message.contains(word), "`{text}` lacks `{word}`: {}", error.message);
    }
    let text = "edges > 1 and\n  edges ~ 2";
    let error = Filter::parse(text).expect_err("no such sign");
    let pointed = error.pointed(text);
    assert!(pointed.starts_with("  edges ~ 2\n        ^\n"), "{pointed}");
}

#[test]
fn the_examples_of_the_manual_are_filters() {
    let manual = include_str!("../../../../docs/FILTERS.md");
    let examples = manual.split("```filter\n").nth(1).and_then(|rest| rest.split("```").next());
    let examples: Vec<&str> = examples.expect("a block of examples").lines().collect();
    assert!(examples.len() >= 8, "{examples:?}");
    for example in examples {
        let filter = Filter::parse(example).unwrap_or_else(|e| panic!("{}", e.pointed(example)));
        assert_eq!(Filter::parse(&filter.to_string()), Ok(filter), "{example}");
    }
    // Expressions stand in the second column, in backticks.
    let table = manual.split("| Path | Expression |\n").nth(1).expect("a table of expressions");
    let rows: Vec<&str> = table.lines().skip(1).take_while(|row| row.starts_with('|')).collect();
    assert!(rows.len() >= 5, "{rows:?}");
    for row in rows {
        let expression = row.split('`').nth(1).expect("an expression");
        assert!(LightPathExpression::parse(expression).is_ok(), "{expression}");
    }
}

#[test]
fn sizes_are_bounded() {
    let nested = format!("{}edges > 1{}", "(".repeat(400), ")".repeat(400));
    assert!(Filter::parse(&nested).expect_err("deep").message.contains("deeper"), "parentheses");
    let not = format!("{}edges > 1", "not ".repeat(400));
    assert!(Filter::parse(&not).expect_err("deep").message.contains("deeper"), "negations");
    let long = " ".repeat(MAX_FILTER_BYTES + 1);
    assert!(Filter::parse(&long).expect_err("long").message.contains("bytes"), "length");
    let many = vec!["edges > 1"; MAX_LEAVES + 1].join(" or ");
    let many = Filter::parse(&many).expect("well-formed").compile(&scene());
    assert!(many.expect_err("many").message.contains("conditions"), "conditions");
    let bomb = "lpe \"C((((D{64}S?){64}){64}){64}){64}L\"";
    let bomb = Filter::parse(bomb).expect("well-formed").compile(&scene());
    assert!(bomb.expect_err("large").message.contains("table"), "automaton");
    let blowup = "lpe \"C.*D.{20}L\"";
    let blowup = Filter::parse(blowup).expect("well-formed").compile(&scene());
    assert!(blowup.expect_err("large").message.contains("table"), "2^20 states");
}
