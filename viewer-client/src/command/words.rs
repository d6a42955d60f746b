//! Reading a command word by word, with complaints that name what is wrong.

use std::fmt;
use std::ops::RangeInclusive;
use std::str::{FromStr, SplitWhitespace};

use thiserror::Error;

/// Why a text is no command.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum CommandError {
    /// The text ends too early.
    #[error("a {0} is missing")]
    MissingWord(&'static str),
    /// A parameter is not there.
    #[error("the parameter {0} is missing")]
    MissingParameter(&'static str),
    /// No command begins so.
    #[error("unknown command `{0}`; `viewer-client --help` lists the commands")]
    Unknown(String),
    /// A word that should be a number.
    #[error("{parameter}: `{found}` is not a number")]
    NotANumber {
        /// The parameter.
        parameter: &'static str,
        /// What stands in its place.
        found: String,
    },
    /// A number that makes no sense there.
    #[error("{parameter} must lie between {low} and {high}, and {found} does not")]
    OutOfRange {
        /// The parameter.
        parameter: &'static str,
        /// What was given.
        found: String,
        /// The smallest value.
        low: String,
        /// The largest.
        high: String,
    },
    /// A word that is none of the choices.
    #[error("`{found}` is none of: {choices}")]
    NoChoice {
        /// What was given.
        found: String,
        /// What would do.
        choices: String,
    },
    /// A name that is none.
    #[error("NAME must have 1 to {0} letters, without `;`")]
    NoName(usize),
    /// Numbers that are no path.
    #[error("this is no path as a link to a view writes it")]
    NoPath,
    /// A filter that cannot be read.
    #[error("the filter cannot be read: {0}")]
    BadFilter(String),
    /// Words after the end.
    #[error("`{0}` is too much")]
    TooMuch(String),
}

/// What to do with something that is on or off.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Switch {
    /// Make it on.
    On,
    /// Make it off.
    Off,
    /// Change it.
    Toggle,
}

impl Switch {
    /// All, in the order of help texts.
    pub const ALL: [Self; 3] = [Self::On, Self::Off, Self::Toggle];

    /// The state after a state.
    pub fn apply(self, on: &mut bool) {
        *on = match self {
            Self::On => true,
            Self::Off => false,
            Self::Toggle => !*on,
        };
    }

    /// On or off, as a checkbox says it.
    pub fn to(on: bool) -> Self {
        if on { Self::On } else { Self::Off }
    }
}

impl fmt::Display for Switch {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::On => "on",
            Self::Off => "off",
            Self::Toggle => "toggle",
        })
    }
}

/// The words of a command that are still to be read.
#[derive(Debug)]
pub(super) struct Words<'a> {
    rest: SplitWhitespace<'a>,
}

impl<'a> Words<'a> {
    pub(super) fn new(text: &'a str) -> Self {
        Self { rest: text.split_whitespace() }
    }

    /// The next word, without reading it.
    pub(super) fn peek(&self) -> Option<&'a str> {
        self.rest.clone().next()
    }

    /// The next word, which is a `what`.
    pub(super) fn next(&mut self, what: &'static str) -> Result<&'a str, CommandError> {
        self.rest.next().ok_or(CommandError::MissingWord(what))
    }

    /// A finite number within `range`.
    pub(super) fn number(
        &mut self,
        parameter: &'static str,
        range: RangeInclusive<f32>,
    ) -> Result<f32, CommandError> {
        self.within(parameter, range)
    }

    /// A whole number within `range`.
    pub(super) fn count(
        &mut self,
        parameter: &'static str,
        range: RangeInclusive<u32>,
    ) -> Result<u32, CommandError> {
        self.within(parameter, range)
    }

    /// A number within `range`; NaN and infinities are none.
    pub(super) fn within<T: PartialOrd + FromStr + fmt::Display>(
        &mut self,
        parameter: &'static str,
        range: RangeInclusive<T>,
    ) -> Result<T, CommandError> {
        let word = self.rest.next().ok_or(CommandError::MissingParameter(parameter))?;
        let not_a_number = || CommandError::NotANumber { parameter, found: word.to_owned() };
        let is_finite = word.parse::<f64>().is_ok_and(f64::is_finite);
        let value: T = word.parse().ok().filter(|_| is_finite).ok_or_else(not_a_number)?;
        if range.contains(&value) {
            return Ok(value);
        }
        Err(CommandError::OutOfRange {
            parameter,
            found: word.to_owned(),
            low: range.start().to_string(),
            high: range.end().to_string(),
        })
    }

    /// One of `choices`, recognised by its text.
    pub(super) fn choice<T: Copy + fmt::Display>(
        &mut self,
        parameter: &'static str,
        choices: &[T],
    ) -> Result<T, CommandError> {
        let word = self.rest.next().ok_or(CommandError::MissingParameter(parameter))?;
        choices.iter().copied().find(|c| c.to_string() == word).ok_or_else(|| {
            let choices: Vec<String> = choices.iter().map(ToString::to_string).collect();
            CommandError::NoChoice { found: word.to_owned(), choices: choices.join(", ") }
        })
    }

    /// All that is left, such as the name of a file: words with one space between them.
    pub(super) fn rest(&mut self, parameter: &'static str) -> Result<String, CommandError> {
        let words: Vec<&str> = self.rest.by_ref().collect();
        if words.is_empty() {
            return Err(CommandError::MissingParameter(parameter));
        }
        Ok(words.join(" "))
    }

    /// On, off or toggle.
    pub(super) fn switch(&mut self) -> Result<Switch, CommandError> {
        self.choice("SWITCH", &Switch::ALL)
    }

    /// Nothing may follow.
    pub(super) fn end(mut self) -> Result<(), CommandError> {
        match self.rest.next() {
            Some(word) => Err(CommandError::TooMuch(word.to_owned())),
            None => Ok(()),
        }
    }
}
