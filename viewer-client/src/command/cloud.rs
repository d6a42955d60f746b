//! `cloud ...`: which paths are on screen, and how they are drawn.

use std::fmt;

use super::Form;
use super::words::{CommandError, Switch, Words};

/// What may be done to the cloud of paths.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CloudCommand {
    /// Takes no new paths, so that the cloud stands still.
    Freeze(Switch),
    /// Forgets every path.
    Clear,
    /// Width of the lines in pixels.
    Width(f32),
    /// Opacity of the newest, brightest path.
    Opacity(f32),
    /// Opacity, relative to the visible part, of what lies behind a surface.
    Hidden(f32),
    /// After how many newer paths a path has faded.
    Fade(f32),
    /// How many of the newest paths are drawn.
    Shown(u32),
    /// Memory for paths, in MiB.
    Budget(u32),
    /// What the colour says.
    Color(ColorMode),
    /// Tints the light end and the camera end.
    Ends(Switch),
    /// Radius of the dots at inner vertices, in pixels; 0 for none.
    Dots(f32),
}

/// What the colour of a path says.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ColorMode {
    /// The light that the path carries.
    #[default]
    Radiance,
    /// The strategy whose proposal it was.
    Strategy,
    /// Its number of edges: blue for short, red for long.
    Length,
}

impl ColorMode {
    /// All, in the order of the shader's codes.
    pub const ALL: [Self; 3] = [Self::Radiance, Self::Strategy, Self::Length];
}

impl fmt::Display for ColorMode {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Radiance => "radiance",
            Self::Strategy => "strategy",
            Self::Length => "length",
        })
    }
}

pub(super) const FORMS: &[Form] = &[
    ("cloud freeze on|off|toggle", "hold the cloud still"),
    ("cloud clear", "forget every path"),
    ("cloud width PIXELS", "width of the lines"),
    ("cloud opacity X", "opacity of the newest paths (0 to 1)"),
    ("cloud hidden X", "relative opacity behind surfaces (0 to 1)"),
    ("cloud fade PATHS", "after how many newer paths a path has faded"),
    ("cloud shown PATHS", "how many of the newest paths are drawn"),
    ("cloud budget MIB", "memory for paths"),
    ("cloud color radiance|strategy|length", "what the colour says"),
    ("cloud ends on|off|toggle", "tint the light end and the camera end"),
    ("cloud dots PIXELS", "radius of the dots at inner vertices, 0 for none"),
];

impl fmt::Display for CloudCommand {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Freeze(switch) => write!(f, "freeze {switch}"),
            Self::Clear => write!(f, "clear"),
            Self::Width(pixels) => write!(f, "width {pixels}"),
            Self::Opacity(x) => write!(f, "opacity {x}"),
            Self::Hidden(x) => write!(f, "hidden {x}"),
            Self::Fade(paths) => write!(f, "fade {paths}"),
            Self::Shown(paths) => write!(f, "shown {paths}"),
            Self::Budget(mebibytes) => write!(f, "budget {mebibytes}"),
            Self::Color(mode) => write!(f, "color {mode}"),
            Self::Ends(switch) => write!(f, "ends {switch}"),
            Self::Dots(pixels) => write!(f, "dots {pixels}"),
        }
    }
}

pub(super) fn parse(words: &mut Words<'_>) -> Result<CloudCommand, CommandError> {
    Ok(match words.next("cloud command")? {
        "freeze" => CloudCommand::Freeze(words.switch()?),
        "clear" => CloudCommand::Clear,
        "width" => CloudCommand::Width(words.number("PIXELS", 0.25..=20.0)?),
        "opacity" => CloudCommand::Opacity(words.number("X", 0.0..=1.0)?),
        "hidden" => CloudCommand::Hidden(words.number("X", 0.0..=1.0)?),
        "fade" => CloudCommand::Fade(words.number("PATHS", 1.0..=1e7)?),
        "shown" => CloudCommand::Shown(words.count("PATHS", 0..=10_000_000)?),
        "budget" => CloudCommand::Budget(words.count("MIB", 8..=65_536)?),
        "color" => CloudCommand::Color(words.choice("MODE", &ColorMode::ALL)?),
        "ends" => CloudCommand::Ends(words.switch()?),
        "dots" => CloudCommand::Dots(words.number("PIXELS", 0.0..=20.0)?),
        other => return Err(CommandError::Unknown(format!("cloud {other}"))),
    })
}
