//! Files of commands.

use std::path::{Path, PathBuf};

use thiserror::Error;

use crate::command::Command;
use crate::value::CommandError;

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

/// Reads a script: one command a line, `#` begins a comment except within quotes.
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
    let uncommented = |line: &str| {
        let end = outside_quotes(line).find(|(_, letter)| *letter == '#');
        line[..end.map_or(line.len(), |(i, _)| i)].trim().to_owned()
    };
    let lines = text.lines().map(uncommented).zip(1..).filter(|(line, _)| !line.is_empty());
    lines.map(|(line, number)| line.parse().map_err(|error| (number, error))).collect()
}

/// The letters of a text that stand in no double quotes, with their places. A quote that is never
/// closed is a letter as any other; `\"` does not close one.
fn outside_quotes(text: &str) -> impl Iterator<Item = (usize, char)> {
    let mut rest = 0..text.len();
    std::iter::from_fn(move || {
        loop {
            let place = rest.start;
            let letter = text[rest.clone()].chars().next()?;
            rest.start += letter.len_utf8();
            if letter == '"'
                && let Some(length) = closing_quote(&text[rest.clone()])
            {
                rest.start += length;
            } else {
                return Some((place, letter));
            }
        }
    })
}

/// The bytes of `text` up to a quote that closes it, that included.
fn closing_quote(text: &str) -> Option<usize> {
    let mut letters = text.char_indices();
    while let Some((i, letter)) = letters.next() {
        match letter {
            '"' => return Some(i + 1),
            '\\' => drop(letters.next()),
            _ => {}
        }
    }
    None
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

    /// Names as exporters write them, in a filter.
    #[test]
    fn odd_names_survive_a_script() {
        let filter = r#"any on material "Rough Grey #1" or lpe "C.*'O\\'Brien \"glass\"'.*L""#;
        let script = format!("filter set {filter} # they are \"odd\"\nfilter keep стекло #2\nquit");
        let texts: Vec<String> =
            parse(&script).expect("a script").iter().map(ToString::to_string).collect();
        assert_eq!(texts, [format!("filter set {filter}").as_str(), "filter keep стекло", "quit"]);
        let open = parse("image save 15\" screen.exr # a comment").expect("a script");
        assert_eq!(open[0].to_string(), "image save 15\" screen.exr", "a quote alone is none");
    }

    #[test]
    fn mistakes_name_their_line() {
        let (line, _) = parse("quit\n\ncloud width wide\n").expect_err("no number");
        assert_eq!(line, 3, "the line");
        let error = read(Path::new("no/such/script")).expect_err("no file").to_string();
        assert!(error.contains("no/such/script"), "{error}");
    }
}
