//! `play ...`: a file of paths, step by step.

use std::fmt;

use super::Form;
use super::words::{CommandError, Switch, Words};

/// What may be done with a file of paths.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PlayCommand {
    /// Goes on by itself, or stands still.
    Run(Switch),
    /// Steps a second.
    Rate(f32),
    /// Shows a step, counted from 0.
    To(u32),
    /// So many steps forward, or back.
    By(i32),
    /// On to the next accepted step.
    Accepted,
}

pub(super) const FORMS: &[Form] = &[
    ("play on|off|toggle", "play the steps of a file of paths"),
    ("play rate STEPS", "how many a second"),
    ("play to INDEX", "show a step, counted from 0"),
    ("play by STEPS", "so many steps forward, or back"),
    ("play accepted", "on to the next accepted step"),
];

impl fmt::Display for PlayCommand {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Run(switch) => write!(f, "{switch}"),
            Self::Rate(rate) => write!(f, "rate {rate}"),
            Self::To(index) => write!(f, "to {index}"),
            Self::By(steps) => write!(f, "by {steps}"),
            Self::Accepted => write!(f, "accepted"),
        }
    }
}

pub(super) fn parse(words: &mut Words<'_>) -> Result<PlayCommand, CommandError> {
    const MOST: i32 = 1_000_000_000;
    Ok(match words.peek() {
        Some("rate") => {
            words.next("play command")?;
            PlayCommand::Rate(words.number("STEPS", 0.05..=2000.0)?)
        }
        Some("to") => {
            words.next("play command")?;
            PlayCommand::To(words.count("INDEX", 0..=MOST as u32)?)
        }
        Some("by") => {
            words.next("play command")?;
            PlayCommand::By(words.within("STEPS", -MOST..=MOST)?)
        }
        Some("accepted") => words.next("play command").map(|_| PlayCommand::Accepted)?,
        _ => PlayCommand::Run(words.switch()?),
    })
}
