//! What a loader says to the person whose file it reads: where, what, and what to do.

use std::fmt;
use std::io;
use std::path::{Path, PathBuf};

use thiserror::Error;

/// A spot in a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Place {
    /// The file, as the user named it or as the scene refers to it.
    pub file: PathBuf,
    /// Line, counted from 1, where it is known.
    pub line: Option<usize>,
    /// Column in characters, counted from 1, where it is known.
    pub column: Option<usize>,
}

impl Place {
    /// A whole file.
    pub fn file(file: &Path) -> Self {
        Self { file: file.to_path_buf(), line: None, column: None }
    }

    /// A line of a file.
    pub fn line(file: &Path, line: usize) -> Self {
        Self { line: Some(line), ..Self::file(file) }
    }

    /// The line and column of a byte offset into the text of a file.
    pub fn offset(file: &Path, text: &str, offset: usize) -> Self {
        let before = text.get(..offset).unwrap_or(text);
        let line = before.matches('\n').count() + 1;
        let column = before.rsplit('\n').next().map_or(0, |l| l.chars().count()) + 1;
        Self { column: Some(column), ..Self::line(file, line) }
    }

    /// An error at this place.
    pub(crate) fn error(self, message: impl Into<String>) -> LoadError {
        LoadError::Malformed { place: self, message: message.into() }
    }

    /// A warning at this place.
    pub(crate) fn warning(self, message: impl Into<String>) -> Warning {
        Warning { place: self, message: message.into() }
    }
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.file.display())?;
        for number in [self.line, self.column].into_iter().flatten() {
            write!(f, ":{number}")?;
        }
        Ok(())
    }
}

/// Something that a scene asks for and does not get, or gets in another way.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Warning {
    /// Where it asks.
    pub place: Place,
    /// What, and what happens instead.
    pub message: String,
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.place, self.message)
    }
}

/// Why a scene does not load.
#[derive(Debug, Error)]
pub enum LoadError {
    /// Neither a built-in scene nor a file.
    #[error("{}", not_found(spec, *closest, known))]
    NotFound {
        /// What was asked for.
        spec: String,
        /// The built-in scene whose name is nearest, if any is near.
        closest: Option<&'static str>,
        /// The names of all built-in scenes.
        known: Vec<&'static str>,
    },
    /// A file type that Lvis does not read.
    #[error("{}: {kind} scenes are not supported; use a .toml, .obj or Mitsuba .xml file", path.display())]
    Unsupported {
        /// The file.
        path: PathBuf,
        /// What it seems to be, for people.
        kind: String,
    },
    /// A directory without a scene, or with several.
    #[error("{}", ambiguous(path, found))]
    Directory {
        /// The directory.
        path: PathBuf,
        /// The scene files in it.
        found: Vec<String>,
    },
    /// The system refuses to read a file.
    #[error("cannot read {}: {source}", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: io::Error,
    },
    /// A file above its limit.
    #[error("{} has {size} bytes; at most {limit} are read from such a file", path.display())]
    TooLarge {
        /// The file.
        path: PathBuf,
        /// Its size in bytes.
        size: u64,
        /// The limit in bytes.
        limit: u64,
    },
    /// Content that makes no scene.
    #[error("{place}: {message}")]
    Malformed {
        /// Where.
        place: Place,
        /// What is wrong, and what to do.
        message: String,
    },
}

fn not_found(spec: &str, closest: Option<&str>, known: &[&str]) -> String {
    let hint = closest.map_or_else(String::new, |name| format!(" Did you mean `{name}`?"));
    let names = known.join(", ");
    format!(
        "no scene `{spec}`: there is no such file or directory, and no built-in scene of that \
         name.{hint} Built in: {names}"
    )
}

fn ambiguous(path: &Path, found: &[String]) -> String {
    if found.is_empty() {
        format!("{}: this directory holds no .toml, .xml or .obj scene", path.display())
    } else {
        format!(
            "{}: this directory holds {} scenes; name one of them: {}",
            path.display(),
            found.len(),
            found.join(", ")
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_offset_becomes_a_line_and_a_column() {
        let place = |offset| Place::offset(Path::new("a"), "ab\ncd\n", offset).to_string();
        assert_eq!(place(0), "a:1:1");
        assert_eq!(place(2), "a:1:3");
        assert_eq!(place(4), "a:2:2");
        assert_eq!(place(99), "a:3:1", "past the end is the end");
    }
}
