//! Order in every file of the repository.

use crate::names::{lies_under, test_modules, tuple_parameters};
use crate::workspace::{Source, sources, texts};

/// Lines that a file of code may have. Longer ones hold more than one idea.
const LONGEST: usize = 700;

/// What no file may hold, and why. This file, which must name them, is left out.
const UNWANTED: [(&str, &str); 10] = [
    ("/home/", "the path of somebody's machine"),
    ("/root/", "the path of somebody's machine"),
    ("/tmp/", "the path of somebody's machine"),
    ("/Users/", "the path of somebody's machine"),
    ("TODO", "a note to oneself: do it, or describe the limit"),
    ("FIXME", "a note to oneself: fix it, or describe the limit"),
    ("XXX", "a note to oneself"),
    ("<<<<<<<", "left over from a merge"),
    (">>>>>>>", "left over from a merge"),
    ("\t", "a tab: indent with spaces"),
];

fn is_code(path: &str) -> bool {
    path != "tests/it/tidy.rs" && path != "Cargo.lock" && !path.starts_with("scenes/")
}

fn complaints(file: &Source) -> Vec<String> {
    let mut found = Vec::new();
    for (i, line) in file.text.lines().enumerate() {
        let mut complain = |why: &str| found.push(format!("{}:{} holds {why}", file.path, i + 1));
        for (_, why) in UNWANTED.iter().filter(|(unwanted, _)| line.contains(unwanted)) {
            complain(why);
        }
        if line.ends_with(' ') {
            complain("a space at its end");
        }
        if line.ends_with('\r') {
            complain("a carriage return");
        }
    }
    if !file.text.is_empty() && !file.text.ends_with('\n') {
        found.push(format!("{} does not end with a line break", file.path));
    }
    found
}

#[test]
fn files_hold_nothing_unwanted() {
    let files = texts();
    let found: Vec<_> =
        files.iter().filter(|file| is_code(&file.path)).flat_map(complaints).collect();
    assert!(found.is_empty(), "{}", found.join("\n"));
}

#[test]
fn files_fit_a_head() {
    for file in sources(&["proto", "rs", "wgsl"]) {
        let lines = file.text.lines().count();
        assert!(lines <= LONGEST, "{} has {lines} lines; {LONGEST} is the limit", file.path);
    }
}

/// Where parameters have names: a tuple among them would hide how many there are.
const NAMED: [&str; 4] = ["common", "proto", "tracer-server", "viewer-client"];

/// The functions that take tuples apart, but those of tests.
fn tuples_taken_apart(files: &[Source]) -> Vec<String> {
    let tests = test_modules(files);
    let is_test = |path: &str| tests.iter().any(|test| lies_under(path, test));
    let named = |file: &&Source| NAMED.iter().any(|room| lies_under(&file.path, room));
    let told = |file: &Source| {
        let functions = tuple_parameters(file).into_iter();
        let path = file.path.clone();
        functions.map(move |(name, line)| {
            format!(
                "{path}:{line} `{name}` takes a tuple apart: give it a struct or a parameter each"
            )
        })
    };
    files.iter().filter(named).filter(|file| !is_test(&file.path)).flat_map(told).collect()
}

#[test]
fn parameters_have_names() {
    let found = tuples_taken_apart(&sources(&["rs"]));
    assert!(found.is_empty(), "{}", found.join("\n"));
}

#[test]
fn planted_tuples_are_found() {
    let found = |path: &str, text: &str| {
        let parent = Source::made_up("tracer-server/src/lib.rs", "#[cfg(test)] mod laws;");
        let path = format!("tracer-server/src/{path}");
        tuples_taken_apart(&[parent, Source::made_up(&path, text)]).len()
    };
    let planted = "fn f<T: Fn(u8)>(x: T, (a, b): (u8, &[T])) {}";
    assert_eq!(found("x.rs", planted), 1);
    assert_eq!(found("x.rs", "impl X { fn g(&self, (a, b): (u8, u8)) {} }"), 1, "in a block");
    assert_eq!(found("laws.rs", planted), 0, "in a test");
    assert_eq!(found("x.rs", &format!("#[cfg(test)] mod tests {{ {planted} }}")), 0, "in a test");
    let allowed = "fn f(pair: (u8, u8), (): ()) { |(a, b): (u8, u8)| a + b; }";
    assert_eq!(found("x.rs", allowed), 0, "closures, whole tuples and nothing at all");
}

#[test]
fn planted_disorder_is_found() {
    let planted = |text: &str| complaints(&Source::made_up("common/src/x.rs", text)).len();
    assert_eq!(planted("fn f() {}\n"), 0, "in order");
    assert_eq!(planted("fn f() {}"), 1, "no line break at the end");
    assert_eq!(planted("// TODO \n"), 2, "a note, and a space behind it");
    assert_eq!(planted("const X: &str = \"/home/me/x\";\n"), 1, "a path");
}
