//! Every citation in the sources resolves in `docs/REFERENCES.md`.
//!
//! A citation is written `\[Veach 1997, section 11.4\]` in a comment, several of them separated by
//! semicolons. Its key is the part up to the year.

use std::collections::BTreeSet;

use crate::workspace::{Source, sources, text};

/// Where the keys are explained.
const REFERENCES: &str = "docs/REFERENCES.md";

/// The keys that the list of references explains, in its order.
fn explained() -> Vec<String> {
    let list = text(REFERENCES);
    let key = |line: &str| Some(line.strip_prefix("- **[")?.split_once("]**")?.0.to_owned());
    list.lines().filter_map(key).collect()
}

/// The keys that a file cites in its comments.
fn cited(file: &Source) -> BTreeSet<String> {
    let comment = |line: &str| -> Option<String> {
        let (_, text) = line.split_once("//")?;
        Some(text.trim_start_matches(['/', '!']).trim().to_owned())
    };
    // A citation may run over the end of a line.
    let prose: Vec<_> = file.text.lines().filter_map(comment).collect();
    keys(&prose.join(" "))
}

/// The citation keys in brackets in `prose`.
fn keys(prose: &str) -> BTreeSet<String> {
    let bracketed = prose.split('[').skip(1).filter_map(|rest| rest.split(']').next());
    bracketed.flat_map(|inside| inside.split(';')).filter_map(key).collect()
}

/// `Veach 1997` of ` Veach 1997, eq. 8.7\`; `None` when this is no citation.
fn key(citation: &str) -> Option<String> {
    let citation = citation.trim().trim_end_matches('\\');
    let head = citation.split(',').next()?.trim();
    let (authors, year) = head.rsplit_once(' ')?;
    let digits = year.trim_end_matches(|c: char| c.is_ascii_lowercase());
    let is_year = digits.len() == 4 && digits.parse().is_ok_and(|y: u32| (1600..2100).contains(&y));
    let is_name = authors.starts_with(char::is_uppercase);
    (is_year && is_name).then(|| head.to_owned())
}

#[test]
fn every_citation_resolves() {
    let explained: BTreeSet<_> = explained().into_iter().collect();
    let mut missing = Vec::new();
    let files = sources(&["proto", "rs", "wgsl"]);
    for file in files.iter().filter(|file| file.path != "tests/it/citations.rs") {
        for key in cited(file).difference(&explained) {
            missing.push(format!("{} cites [{key}], which {REFERENCES} does not list", file.path));
        }
    }
    assert!(missing.is_empty(), "{}", missing.join("\n"));
}

#[test]
fn references_are_sorted_and_said_once() {
    let keys = explained();
    assert!(keys.len() > 10, "the list is read: {keys:?}");
    let fold = |key: &String| key.replace('ä', "a").replace('ö', "o");
    assert!(keys.is_sorted_by(|a, b| fold(a) < fold(b)), "sorted, without repeats: {keys:?}");
    for key in &keys {
        assert_eq!(self::key(key).as_ref(), Some(key), "a key is authors and a year");
    }
}

#[test]
fn citations_are_recognised() {
    let found = |prose: &str| keys(prose).into_iter().collect::<Vec<_>>();
    assert_eq!(found(r"as in \[Veach 1997, eq. 8.7\]."), ["Veach 1997"], "escaped, with a place");
    assert_eq!(found("[Kelemen et al. 2002; Cline et al. 2005b]").len(), 2, "two in one bracket");
    assert_eq!(found("in [0, 1), [`Path`], x[i] or [see 1997]"), [""; 0], "no citations");
    let wrapped =
        Source::made_up("x.rs", "/// after \\[Möller and\n/// Trumbore 1997\\]\nfn f() {}");
    assert!(cited(&wrapped).contains("Möller and Trumbore 1997"), "{:?}", cited(&wrapped));
}
