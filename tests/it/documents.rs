//! The documents say what is so: files and tests that they name exist, and every entry of a registry
//! has its place in them.

use tracer_server::bsdf::MODELS;
use tracer_server::mutation::KINDS;

use crate::workspace::{root, sources, text};

/// Documents that map the code.
const MAPS: [&str; 3] = ["README.md", "docs/ARCHITECTURE.md", "docs/NOTATION.md"];

/// Everything between backticks in `prose`.
fn quoted(prose: &str) -> Vec<&str> {
    prose.split('`').skip(1).step_by(2).collect()
}

/// True for a path into the repository, such as `common/src/lib.rs` or `docs/`.
fn is_path(name: &str) -> bool {
    let folders = [
        "common/",
        "docs/",
        "proto/",
        "scenes/",
        "shaders/",
        "tests/",
        "tracer-server/",
        "viewer-client/",
    ];
    folders.iter().any(|folder| name.starts_with(folder)) && !name.contains([' ', '<', '{', '*'])
}

#[test]
fn named_files_exist() {
    for document in MAPS {
        for name in quoted(&text(document)).into_iter().filter(|name| is_path(name)) {
            assert!(root().join(name).exists(), "{document} names {name}, which does not exist");
        }
    }
}

#[test]
fn links_lead_somewhere() {
    for document in sources(&["md"]) {
        let folder = root().join(&document.path);
        let folder = folder.parent().expect("a file lies in a folder");
        for rest in document.text.split("](").skip(1) {
            let target = rest.split([')', '#']).next().unwrap_or_default();
            let is_local = !target.is_empty() && !target.contains("://");
            let exists = folder.join(target).exists();
            assert!(!is_local || exists, "{} links to {target}: no such file", document.path);
        }
    }
}

#[test]
fn claimed_tests_exist() {
    let claims = claims();
    let proofs: Vec<_> = claims.iter().filter_map(|row| row.rsplit('|').nth(1)).collect();
    assert!(proofs.len() > 3, "the table of claims is read: {proofs:?}");
    let code = sources(&["rs"]);
    for name in proofs.into_iter().flat_map(quoted) {
        let heading = format!("fn {name}(");
        let exists = code.iter().any(|file| file.text.contains(&heading));
        assert!(exists, "README.md relies on the test {name}, which does not exist");
    }
}

/// The rows of README's table of claims: what is claimed, and the tests that prove it.
fn claims() -> Vec<String> {
    let readme = text("README.md");
    let rows = readme.lines().skip_while(|line| !line.starts_with("| Claim")).skip(2);
    rows.take_while(|line| line.starts_with('|')).map(str::to_owned).collect()
}

#[test]
fn every_strategy_and_every_model_is_claimed() {
    let claims = claims();
    for strategy in KINDS {
        let name = strategy.name.replace([' ', '-'], "_");
        let law = format!("`{name}_leaves_the_target_alone`");
        let claimed = claims.iter().any(|row| row.contains(&law));
        assert!(claimed, "README.md does not claim {law} of the strategy {}", strategy.name);
        let caught = |row: &String| row.contains(&format!("`wrong_{name}_"));
        assert!(claims.iter().any(caught), "README.md names no mutants of {}", strategy.name);
    }
    for model in MODELS {
        let name = format!("`{}`", model.name);
        assert!(claims.iter().any(|row| row.contains(&name)), "README.md claims nothing of {name}");
    }
}

#[test]
fn the_scenes_readme_shows_every_model() {
    let readme = text("scenes/README.md");
    for model in MODELS {
        let name = format!("\"{}\"", model.name);
        let entry = readme.split("[[materials]]").skip(1).find(|entry| entry.contains(&name));
        let entry = entry.unwrap_or_else(|| panic!("scenes/README.md shows no {name}"));
        let entry = entry.split("\n\n").next().unwrap_or_default();
        for parameter in model.parameters {
            let told = entry.contains(parameter.name);
            assert!(told, "scenes/README.md does not tell of {} of {name}", parameter.name);
        }
    }
}

#[test]
fn the_front_page_is_short() {
    let lines = text("README.md").lines().count();
    assert!(lines <= 150, "README.md has {lines} lines; 150 is the limit");
}

#[test]
fn paths_are_told_from_other_words() {
    let prose = "See `common/src/lib.rs` and `Path`, `docs/`, `tests/it/*.rs`.";
    let paths: Vec<_> = quoted(prose).into_iter().filter(|name| is_path(name)).collect();
    assert_eq!(paths, ["common/src/lib.rs", "docs/"], "paths only");
}
