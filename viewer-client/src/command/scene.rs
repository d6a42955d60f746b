//! `scene ...`: how surfaces and drawing aids look.

use std::fmt;

use super::Form;
use super::words::{CommandError, Switch, Words};

/// What may be done to the look of the scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SceneCommand {
    /// How surfaces are drawn.
    Shading(Shading),
    /// Opacity of all surfaces.
    Opacity(f32),
    /// Makes surfaces that face away almost invisible, to look into rooms.
    Cutaway(Switch),
    /// The model of the render camera.
    Camera(Switch),
    /// The grid on the ground.
    Grid(Switch),
}

/// How surfaces are drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Shading {
    /// Lit by a headlight.
    #[default]
    Shaded,
    /// Lit, with the edges of triangles.
    Edges,
    /// Edges of triangles only.
    Wireframe,
    /// Not at all.
    Off,
}

impl Shading {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Shaded, Self::Edges, Self::Wireframe, Self::Off];
}

impl fmt::Display for Shading {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Shaded => "shaded",
            Self::Edges => "edges",
            Self::Wireframe => "wireframe",
            Self::Off => "off",
        })
    }
}

pub(super) const FORMS: &[Form] = &[
    ("scene shading shaded|edges|wireframe|off", "how surfaces are drawn"),
    ("scene opacity X", "opacity of all surfaces (0 to 1)"),
    ("scene cutaway on|off|toggle", "look through surfaces from behind"),
    ("scene camera on|off|toggle", "the model of the render camera"),
    ("scene grid on|off|toggle", "the grid on the ground"),
];

impl fmt::Display for SceneCommand {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Shading(shading) => write!(f, "shading {shading}"),
            Self::Opacity(x) => write!(f, "opacity {x}"),
            Self::Cutaway(switch) => write!(f, "cutaway {switch}"),
            Self::Camera(switch) => write!(f, "camera {switch}"),
            Self::Grid(switch) => write!(f, "grid {switch}"),
        }
    }
}

pub(super) fn parse(words: &mut Words<'_>) -> Result<SceneCommand, CommandError> {
    Ok(match words.next("scene command")? {
        "shading" => SceneCommand::Shading(words.choice("SHADING", &Shading::ALL)?),
        "opacity" => SceneCommand::Opacity(words.number("X", 0.0..=1.0)?),
        "cutaway" => SceneCommand::Cutaway(words.switch()?),
        "camera" => SceneCommand::Camera(words.switch()?),
        "grid" => SceneCommand::Grid(words.switch()?),
        other => return Err(CommandError::Unknown(format!("scene {other}"))),
    })
}
