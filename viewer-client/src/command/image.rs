//! `image ...`: how the progressive image is shown.

use std::fmt;

use super::Form;
use super::words::{CommandError, Words};

/// What may be done to the image on screen; the tracer's film is untouched.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ImageCommand {
    /// Brightness in stops: each doubles it.
    Exposure(f32),
    /// Brightness that suits the scene.
    Auto,
    /// Screen points a film pixel.
    Zoom(f32),
    /// As large as its panel.
    Fit,
}

pub(super) const FORMS: &[Form] = &[
    ("image exposure STOPS", "brightness; each stop doubles it (-20 to 20)"),
    ("image auto", "brightness that suits the scene"),
    ("image zoom FACTOR", "screen points a film pixel"),
    ("image fit", "as large as its panel"),
];

impl fmt::Display for ImageCommand {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Exposure(stops) => write!(f, "exposure {stops}"),
            Self::Auto => write!(f, "auto"),
            Self::Zoom(factor) => write!(f, "zoom {factor}"),
            Self::Fit => write!(f, "fit"),
        }
    }
}

pub(super) fn parse(words: &mut Words<'_>) -> Result<ImageCommand, CommandError> {
    Ok(match words.next("image command")? {
        "exposure" => ImageCommand::Exposure(words.number("STOPS", -20.0..=20.0)?),
        "auto" => ImageCommand::Auto,
        "zoom" => ImageCommand::Zoom(words.number("FACTOR", 0.05..=32.0)?),
        "fit" => ImageCommand::Fit,
        other => return Err(CommandError::Unknown(format!("image {other}"))),
    })
}
