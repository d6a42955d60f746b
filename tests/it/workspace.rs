//! The repository as a list of texts.

use std::fs;
use std::path::{Path, PathBuf};

/// A text file of the repository.
#[derive(Clone, Debug)]
pub(crate) struct Source {
    /// Its path from the root, with forward slashes.
    pub(crate) path: String,
    /// Its content.
    pub(crate) text: String,
}

impl Source {
    /// A file that exists only in a test.
    pub(crate) fn made_up(path: &str, text: &str) -> Self {
        Self { path: path.to_owned(), text: text.to_owned() }
    }
}

/// What in the root is none of ours.
const SKIPPED: [&str; 2] = [".git", "target"];

/// The folder that holds the workspace's `Cargo.toml`.
pub(crate) fn root() -> PathBuf {
    let tests = Path::new(env!("CARGO_MANIFEST_DIR"));
    tests.parent().expect("the crate lies in a folder of the workspace").to_owned()
}

/// Every file that is UTF-8 text, sorted by path.
pub(crate) fn texts() -> Vec<Source> {
    let root = root();
    let mut paths = Vec::new();
    collect(&root, &SKIPPED, &mut paths);
    paths.sort();
    let read = |path: PathBuf| {
        let text = fs::read_to_string(&path).ok()?;
        let local = path.strip_prefix(&root).expect("found below the root");
        Some(Source { path: local.to_string_lossy().replace('\\', "/"), text })
    };
    paths.into_iter().filter_map(read).collect()
}

/// Every file whose name ends in one of `extensions`, sorted by path.
pub(crate) fn sources(extensions: &[&str]) -> Vec<Source> {
    let mut all = texts();
    all.retain(|source| {
        Path::new(&source.path)
            .extension()
            .is_some_and(|found| extensions.iter().any(|wanted| found == *wanted))
    });
    assert!(!all.is_empty(), "no file ends in any of {extensions:?}");
    all
}

/// The text of one file, which must exist.
pub(crate) fn text(path: &str) -> String {
    fs::read_to_string(root().join(path)).unwrap_or_else(|error| panic!("{path}: {error}"))
}

fn collect(folder: &Path, skipped: &[&str], paths: &mut Vec<PathBuf>) {
    let entries = fs::read_dir(folder).expect("a folder of the repository can be listed");
    for entry in entries {
        let path = entry.expect("an entry of a folder can be read").path();
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        if skipped.contains(&name.as_ref()) {
            continue;
        }
        if path.is_dir() {
            collect(&path, &[], paths);
        } else {
            paths.push(path);
        }
    }
}
