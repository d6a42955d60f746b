//! `connect`, `share`, `screenshot`, `copy`: what goes beyond the window.

use std::fmt;

use super::Form;
use super::layout::PanelName;
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
    /// Copies what a part of the window says, as text.
    Copy(Source),
}

/// A part of the window that has something to say.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    /// The state of the session.
    Status,
    /// A panel.
    Panel(PanelName),
}

impl fmt::Display for Source {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Status => f.write_str("status"),
            Self::Panel(name) => name.fmt(f),
        }
    }
}

/// Stands for the address of the daemon inside this program.
pub const HOME: &str = "home";

pub(super) const FORMS: &[Form] = &[
    (
        "connect HOST:PORT|LINK|home",
        "watch another daemon, follow a link, or go back to the own one",
    ),
    ("share", "copy a link that restores camera, filter, selection and colours"),
    ("screenshot FILE.png", "write the whole window as an image"),
    ("copy NAME|status", "copy what a panel says, or the state of the session, as text"),
];

impl fmt::Display for DeskCommand {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Connect(address) => write!(f, "connect {address}"),
            Self::Share => write!(f, "share"),
            Self::Screenshot(file) => write!(f, "screenshot {file}"),
            Self::Copy(source) => write!(f, "copy {source}"),
        }
    }
}

/// Reads what follows `verb`, which is `connect`, `share`, `screenshot` or `copy`.
pub(super) fn parse(verb: &str, words: &mut Words<'_>) -> Result<DeskCommand, CommandError> {
    Ok(match verb {
        "connect" => DeskCommand::Connect(words.rest("HOST:PORT")?),
        "share" => DeskCommand::Share,
        "copy" if words.peek() == Some("status") => {
            words.next("NAME")?;
            DeskCommand::Copy(Source::Status)
        }
        "copy" => DeskCommand::Copy(Source::Panel(words.choice("NAME", &PanelName::ALL)?)),
        "screenshot" => DeskCommand::Screenshot(words.rest("FILE")?),
        other => return Err(CommandError::Unknown(other.to_owned())),
    })
}
