//! `path ...`: the path that is looked at.

use std::fmt;

use super::Form;
use super::words::{CommandError, Words};
use crate::pick::Aim;

/// What may be done with a path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PathCommand {
    /// Selects the path under the cursor; again, the next one there.
    Pick(Aim),
    /// Selects the path at which a chain stayed longest, or the next in that order.
    Stay(u8),
    /// Selects none.
    Deselect,
    /// Brings a vertex of it into the middle of the view.
    Vertex(VertexStep),
}

/// Which vertex.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum VertexStep {
    /// One further towards the camera.
    Next,
    /// One further towards the light.
    Previous,
    /// This one, counted from the light, which is 0.
    To(u8),
}

impl fmt::Display for VertexStep {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Next => write!(f, "next"),
            Self::Previous => write!(f, "previous"),
            Self::To(index) => write!(f, "{index}"),
        }
    }
}

pub(super) const FORMS: &[Form] = &[
    (
        "path pick RIGHT UP REACH",
        "select the path at tangents from the view direction; again, the next one there",
    ),
    ("path stay RANK", "select a path at which a chain stayed long; the longest stay is 0"),
    ("path none", "select no path"),
    ("path vertex next|previous|INDEX", "look at a vertex of the selected path"),
];

impl fmt::Display for PathCommand {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Pick(Aim { at: [x, y], reach }) => write!(f, "pick {x} {y} {reach}"),
            Self::Stay(rank) => write!(f, "stay {rank}"),
            Self::Deselect => write!(f, "none"),
            Self::Vertex(step) => write!(f, "vertex {step}"),
        }
    }
}

pub(super) fn parse(words: &mut Words<'_>) -> Result<PathCommand, CommandError> {
    const TANGENT: std::ops::RangeInclusive<f32> = -100.0..=100.0;
    Ok(match words.next("path command")? {
        "pick" => PathCommand::Pick(Aim {
            at: [words.number("RIGHT", TANGENT)?, words.number("UP", TANGENT)?],
            reach: words.number("REACH", 0.0..=1.0)?,
        }),
        "stay" => PathCommand::Stay(words.count("RANK", 0..=255)? as u8),
        "none" => PathCommand::Deselect,
        "vertex" => PathCommand::Vertex(match words.peek() {
            Some("next") => words.next("vertex").map(|_| VertexStep::Next)?,
            Some("previous") => words.next("vertex").map(|_| VertexStep::Previous)?,
            _ => VertexStep::To(words.count("INDEX", 0..=255)? as u8),
        }),
        other => return Err(CommandError::Unknown(format!("path {other}"))),
    })
}
