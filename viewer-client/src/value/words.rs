//! Reading a command word by word, with complaints that name what is wrong.

use thiserror::Error;

/// Why a text is no command.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum CommandError {
    /// There is nothing to read.
    #[error("a command is missing")]
    Nothing,
    /// A parameter is not there.
    #[error("the parameter {0} is missing")]
    MissingParameter(String),
    /// No command begins so.
    #[error("unknown command `{found}`; {remedy}")]
    Unknown {
        /// The words that should begin one.
        found: String,
        /// What to do.
        remedy: String,
    },
    /// A word that should be a number.
    #[error("{parameter}: `{found}` is not a number")]
    NotANumber {
        /// The parameter.
        parameter: String,
        /// What stands in its place.
        found: String,
    },
    /// A number that makes no sense there.
    #[error("{parameter} must lie between {limits}, and {found} does not")]
    OutOfRange {
        /// The parameter.
        parameter: String,
        /// What was given.
        found: String,
        /// The limits.
        limits: String,
    },
    /// A word that is none of the choices.
    #[error("`{found}` is not one of: {choices}")]
    NoChoice {
        /// What was given.
        found: String,
        /// What would do.
        choices: String,
    },
    /// A name that is none.
    #[error("a name must have 1 to {0} characters")]
    NoName(usize),
    /// Numbers that are no path.
    #[error("this is not a path in the form used by links to views")]
    NoPath,
    /// A filter that cannot be read.
    #[error("the filter cannot be read: {0}")]
    BadFilter(String),
    /// Words after the end.
    #[error("unexpected `{0}` at the end")]
    TooMuch(String),
}

impl CommandError {
    /// A complaint about a word that is none of `choices`.
    pub(super) fn no_choice(found: &str, choices: &str) -> Self {
        Self::NoChoice { found: found.to_owned(), choices: choices.to_owned() }
    }
}

/// The words of a command that are still to be read.
#[derive(Clone, Debug)]
pub struct Words<'a> {
    rest: &'a str,
}

impl<'a> Words<'a> {
    /// All words of a text.
    pub fn new(text: &'a str) -> Self {
        Self { rest: text.trim() }
    }

    /// The next word, without reading it.
    pub fn peek(&self) -> Option<&'a str> {
        self.rest.split_whitespace().next()
    }

    /// The next word.
    pub fn word(&mut self) -> Option<&'a str> {
        let word = self.peek()?;
        self.rest = self.rest.strip_prefix(word).unwrap_or_default().trim_start();
        Some(word)
    }

    /// Reads these words if they are the next ones.
    pub fn skip(&mut self, words: &str) -> bool {
        let mut after = self.clone();
        let found = words.split(' ').all(|word| after.word() == Some(word));
        if found {
            *self = after;
        }
        found
    }

    /// The next word, which stands for the parameter `name`.
    pub(super) fn parameter(&mut self, name: &str) -> Result<&'a str, CommandError> {
        self.word().ok_or_else(|| CommandError::MissingParameter(name.to_uppercase()))
    }

    /// All that is left, as it was written.
    pub(super) fn rest(&mut self, name: &str) -> Result<&'a str, CommandError> {
        let rest = std::mem::take(&mut self.rest);
        if rest.is_empty() {
            return Err(CommandError::MissingParameter(name.to_owned()));
        }
        Ok(rest)
    }

    /// Nothing may follow.
    pub fn end(mut self) -> Result<(), CommandError> {
        match self.word() {
            Some(word) => Err(CommandError::TooMuch(word.to_owned())),
            None => Ok(()),
        }
    }
}
