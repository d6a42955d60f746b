//! `connect`, `share`, `screenshot`: what goes beyond the window.

use std::fmt;

use super::Form;
use super::words::{CommandError, Words};

/// What goes beyond the window.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum DeskCommand {
    /// Watches another daemon, at HOST:PORT or where a link leads.
    Connect(String),
    /// Copies a link that restores what is seen.
    Share,
    /// Writes the whole window as PNG.
    Screenshot(String),
}

pub(super) const FORMS: &[Form] = &[
    ("connect HOST:PORT|LINK", "watch another daemon, or follow a link"),
    ("share", "copy a link that restores camera, filter and colours"),
    ("screenshot FILE.png", "write the whole window as an image"),
];

impl fmt::Display for DeskCommand {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Connect(address) => write!(f, "connect {address}"),
            Self::Share => write!(f, "share"),
            Self::Screenshot(file) => write!(f, "screenshot {file}"),
        }
    }
}

/// Reads what follows `verb`, which is `connect`, `share` or `screenshot`.
pub(super) fn parse(verb: &str, words: &mut Words<'_>) -> Result<DeskCommand, CommandError> {
    Ok(match verb {
        "connect" => DeskCommand::Connect(words.rest("HOST:PORT")?),
        "share" => DeskCommand::Share,
        "screenshot" => DeskCommand::Screenshot(words.rest("FILE")?),
        other => return Err(CommandError::Unknown(other.to_owned())),
    })
}
