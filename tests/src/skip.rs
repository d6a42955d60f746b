//! Tests that cannot run where they are.

use std::env;
use std::fs::OpenOptions;
use std::io::Write as _;
use std::path::Path;
use std::thread;

/// Names the file that lists what was skipped.
const LIST: &str = "LVIS_SKIPPED";

/// Says that the present test does not run here, and why.
///
/// Test runners know only "passed" and "failed", and hide what a test prints that has passed. So the
/// name of the test and the reason are also added to the file that the variable `LVIS_SKIPPED` names:
/// a test that was skipped must not look as if it had run.
#[expect(clippy::print_stderr, reason = "it is for whoever runs one test by hand")]
pub fn skip(reason: &str) {
    let thread = thread::current();
    let test = thread.name().unwrap_or("a test");
    eprintln!("skipped: {test}: {reason}");
    if let Some(list) = env::var_os(LIST).filter(|list| !list.is_empty()) {
        add(Path::new(&list), test, reason);
    }
}

/// Tests run at the same time, so each line is written in one piece.
fn add(list: &Path, test: &str, reason: &str) {
    let line = format!("{test}: {reason}\n");
    let file = OpenOptions::new().create(true).append(true).open(list);
    let written = file.and_then(|mut file| file.write_all(line.as_bytes()));
    if let Err(error) = written {
        panic!("cannot tell in {} that {test} was skipped: {error}", list.display());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_skipped_is_listed_line_by_line() {
        let folder = tempfile::tempdir().expect("a folder");
        let list = folder.path().join("skipped");
        for (test, reason) in [("one", "no network"), ("another", "no display")] {
            add(&list, test, reason);
        }
        let text = std::fs::read_to_string(&list).expect("a list");
        assert_eq!(text, "one: no network\nanother: no display\n");
    }
}
