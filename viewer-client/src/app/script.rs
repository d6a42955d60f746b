//! Files of commands.

use std::path::{Path, PathBuf};

use thiserror::Error;

use crate::command::{Command, CommandError};

/// No script is larger.
const LARGEST: u64 = 1 << 20;

/// Why a script cannot be run.
#[derive(Debug, Error)]
pub enum ScriptError {
    /// The file cannot be read.
    #[error("cannot read the script {0}: {1}")]
    Unreadable(PathBuf, std::io::Error),
    /// The file is no script.
    #[error("the script {0} is larger than 1 MiB")]
    TooLarge(PathBuf),
    /// A line is no command.
    #[error("{file}, line {line}: {error}")]
    BadLine {
        /// The script.
        file: PathBuf,
        /// Its line, counted from one.
        line: usize,
        /// What is wrong.
        error: CommandError,
    },
}

/// Reads a script: one command a line, `#` begins a comment.
pub fn read(file: &Path) -> Result<Vec<Command>, ScriptError> {
    let unreadable = |error| ScriptError::Unreadable(file.to_owned(), error);
    if std::fs::metadata(file).map_err(unreadable)?.len() > LARGEST {
        return Err(ScriptError::TooLarge(file.to_owned()));
    }
    let text = std::fs::read_to_string(file).map_err(unreadable)?;
    parse(&text).map_err(|(line, error)| ScriptError::BadLine {
        file: file.to_owned(),
        line,
        error,
    })
}

fn parse(text: &str) -> Result<Vec<Command>, (usize, CommandError)> {
    let uncommented = |line: &str| line.split('#').next().unwrap_or("").trim().to_owned();
    let lines = text.lines().map(uncommented).zip(1..).filter(|(line, _)| !line.is_empty());
    lines.map(|(line, number)| line.parse().map_err(|error| (number, error))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn comments_and_empty_lines_are_skipped() {
        let commands = parse("# a view\n\ncamera frame # all of it\n  quit\n").expect("a script");
        let texts: Vec<String> = commands.iter().map(ToString::to_string).collect();
        assert_eq!(texts, ["camera frame", "quit"], "two commands");
    }

    #[test]
    fn mistakes_name_their_line() {
        let (line, _) = parse("quit\n\ncloud width wide\n").expect_err("no number");
        assert_eq!(line, 3, "the line");
        let error = read(Path::new("no/such/script")).expect_err("no file").to_string();
        assert!(error.contains("no/such/script"), "{error}");
    }
}
