//! Reading text files with a limit, and the line-by-line form that OBJ and MTL share.

use std::borrow::Cow;
use std::fs::File;
use std::io::{self, Read as _};
use std::path::Path;

use super::diagnostic::{LoadError, Place};

/// The bytes of a regular file of at most `limit` bytes.
pub(crate) fn read_bytes(path: &Path, limit: u64) -> Result<Vec<u8>, LoadError> {
    let unreadable = |source| LoadError::Unreadable { path: path.to_path_buf(), source };
    let too_large = |size| LoadError::TooLarge { path: path.to_path_buf(), size, limit };
    let file = File::open(path).map_err(unreadable)?;
    let metadata = file.metadata().map_err(unreadable)?;
    if !metadata.is_file() {
        return Err(unreadable(io::Error::other("it is not a regular file")));
    }
    if metadata.len() > limit {
        return Err(too_large(metadata.len()));
    }
    let mut bytes = Vec::with_capacity(metadata.len() as usize);
    // The file may grow while it is read.
    file.take(limit + 1).read_to_end(&mut bytes).map_err(unreadable)?;
    let size = bytes.len() as u64;
    if size > limit { Err(too_large(size)) } else { Ok(bytes) }
}

/// The text of a file, which must be UTF-8.
pub(crate) fn read_utf8(path: &Path, limit: u64) -> Result<String, LoadError> {
    let bytes = read_bytes(path, limit)?;
    match String::from_utf8(bytes) {
        Ok(text) => Ok(text),
        Err(error) => {
            let good = error.utf8_error().valid_up_to();
            let bytes = error.into_bytes();
            let line = 1 + bytes.iter().take(good).filter(|&&byte| byte == b'\n').count();
            Err(Place::line(path, line).error("the text is not UTF-8; save the file as UTF-8"))
        }
    }
}

/// The text of a file in which only comments and names may hold bytes that are not UTF-8.
pub(crate) fn read_lossy(path: &Path, limit: u64) -> Result<String, LoadError> {
    let bytes = read_bytes(path, limit)?;
    Ok(match String::from_utf8_lossy(&bytes) {
        Cow::Borrowed(text) => text.to_owned(),
        Cow::Owned(text) => text,
    })
}

/// One statement of an OBJ or MTL file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Statement<'a> {
    /// The line it begins on, counted from 1.
    pub(crate) line: usize,
    /// Its first word.
    pub(crate) keyword: Cow<'a, str>,
    /// The rest, without comment and surrounding space.
    pub(crate) rest: Cow<'a, str>,
}

/// The statements of a text: comments and empty lines left out, lines ending in `\` joined.
pub(crate) fn statements(text: &str) -> impl Iterator<Item = Statement<'_>> {
    let mut lines = text.trim_start_matches('\u{feff}').lines().enumerate();
    std::iter::from_fn(move || {
        loop {
            let (index, raw) = lines.next()?;
            if names_something(raw) {
                if let Some(statement) = split(Cow::Borrowed(raw), index + 1) {
                    return Some(statement);
                }
                continue;
            }
            let mut line = Cow::Borrowed(without_comment(raw));
            while let Some(head) = line.trim_end().strip_suffix('\\') {
                let mut joined = head.to_owned();
                let Some((_, next)) = lines.next() else {
                    line = Cow::Owned(joined);
                    break;
                };
                joined.push(' ');
                joined.push_str(without_comment(next));
                line = Cow::Owned(joined);
            }
            if let Some(statement) = split(line, index + 1) {
                return Some(statement);
            }
        }
    })
}

/// True for statements whose rest is a name, which may hold anything: programs number materials with
/// `#`.
fn names_something(line: &str) -> bool {
    let keyword = cut(line).0;
    keyword.starts_with("map_") || matches!(keyword, "newmtl" | "usemtl" | "mtllib" | "o" | "g")
}

/// A `#` begins a comment at the start of a line or after white space; elsewhere it is part of a
/// name.
pub(crate) fn without_comment(line: &str) -> &str {
    let starts = |at: usize| {
        line.get(..at).is_none_or(|head| head.chars().next_back().is_none_or(char::is_whitespace))
    };
    let comment = line.match_indices('#').map(|(at, _)| at).find(|&at| starts(at));
    comment.and_then(|at| line.get(..at)).unwrap_or(line)
}

fn split(line: Cow<'_, str>, number: usize) -> Option<Statement<'_>> {
    let (keyword, rest) = match line {
        Cow::Borrowed(text) => {
            let (keyword, rest) = cut(text);
            (Cow::Borrowed(keyword), Cow::Borrowed(rest))
        }
        Cow::Owned(text) => {
            let (keyword, rest) = cut(&text);
            (Cow::Owned(keyword.to_owned()), Cow::Owned(rest.to_owned()))
        }
    };
    (!keyword.is_empty()).then_some(Statement { line: number, keyword, rest })
}

fn cut(text: &str) -> (&str, &str) {
    let text = text.trim();
    let end = text.find(char::is_whitespace).unwrap_or(text.len());
    let (keyword, rest) = text.split_at(end);
    (keyword, rest.trim())
}

/// A finite number, or a message that quotes the word.
pub(crate) fn number(word: &str) -> Result<f64, String> {
    match word.parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        Ok(_) => Err(format!("`{word}` is not a finite number")),
        Err(_) => Err(format!("`{word}` is not a number")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn all(text: &str) -> Vec<(usize, String, String)> {
        statements(text).map(|s| (s.line, s.keyword.into_owned(), s.rest.into_owned())).collect()
    }

    #[test]
    fn comments_joins_and_blank_lines() {
        let text = "# head\n\n#comment\n  v 1 2 3 # tail\nf 1 2 \\\n 3\nusemtl Grey #1\nend \\";
        let expected =
            [(4, "v", "1 2 3"), (5, "f", "1 2   3"), (7, "usemtl", "Grey #1"), (8, "end", "")];
        let expected: Vec<_> =
            expected.iter().map(|&(l, k, r)| (l, k.to_owned(), r.to_owned())).collect();
        assert_eq!(all(text), expected);
    }

    #[test]
    fn numbers_must_be_finite() {
        assert_eq!(number("-1.5e3"), Ok(-1500.0));
        for word in ["nan", "inf", "-infinity", "1e999", "1,5", "0x10", ""] {
            assert!(number(word).is_err(), "{word} is no finite number");
        }
    }

    #[test]
    fn a_file_above_its_limit_is_not_read() {
        let directory = tempfile::tempdir().expect("a directory");
        let path = directory.path().join("long.txt");
        std::fs::write(&path, "0123456789").expect("written");
        assert_eq!(read_bytes(&path, 10).expect("just fits").len(), 10);
        assert!(matches!(read_bytes(&path, 9), Err(LoadError::TooLarge { size: 10, .. })));
        assert!(matches!(read_bytes(directory.path(), 9), Err(LoadError::Unreadable { .. })));
    }

    #[test]
    fn bytes_that_are_not_utf8_are_located() {
        let directory = tempfile::tempdir().expect("a directory");
        let path = directory.path().join("latin.toml");
        std::fs::write(&path, b"a = 1\nb = \"\xe9\"\n").expect("written");
        let message = read_utf8(&path, 100).expect_err("not UTF-8").to_string();
        assert!(message.contains("latin.toml:2"), "{message}");
        assert!(read_lossy(&path, 100).is_ok(), "lossy reading goes on");
    }
}
