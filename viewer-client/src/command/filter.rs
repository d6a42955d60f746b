//! `filter ...`: which paths are shown.

use std::fmt;

use common::Filter;

use super::Form;
use super::words::{CommandError, Words};

/// What may be done to the filter. `docs/FILTERS.md` has the grammar of its text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum FilterCommand {
    /// This text is the filter from now on; its grammar is right.
    Set(String),
    /// All paths are wanted.
    Clear,
}

pub(super) const FORMS: &[Form] = &[
    ("filter set TEXT", "show the paths that a filter wants; see docs/FILTERS.md"),
    ("filter clear", "show all paths"),
];

impl fmt::Display for FilterCommand {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Set(text) => write!(f, "set {text}"),
            Self::Clear => write!(f, "clear"),
        }
    }
}

pub(super) fn parse(words: &mut Words<'_>) -> Result<FilterCommand, CommandError> {
    Ok(match words.next("filter command")? {
        "set" => {
            let text = words.rest("TEXT")?;
            let problem = Filter::parse(&text).err();
            match problem {
                Some(problem) => return Err(CommandError::BadFilter(problem.to_string())),
                None => FilterCommand::Set(text),
            }
        }
        "clear" => FilterCommand::Clear,
        other => return Err(CommandError::Unknown(format!("filter {other}"))),
    })
}
