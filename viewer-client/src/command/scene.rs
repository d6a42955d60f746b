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
    /// The light that surfaces are seen by.
    Light(Light),
    /// How surfaces answer it.
    Lighting(Lighting),
    /// What the handles of selectors do.
    Handles(Handles),
    /// Cuts away what lies on one side of a plane.
    Clip(ClipSide),
    /// Where the plane lies, from 0 to 1 across the scene.
    Cut(f32),
}

/// What a plane cuts away.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ClipSide {
    /// Nothing.
    #[default]
    Off,
    /// Smaller x.
    X,
    /// Larger x.
    MinusX,
    /// Smaller y.
    Y,
    /// Larger y.
    MinusY,
    /// Smaller z.
    Z,
    /// Larger z.
    MinusZ,
}

impl ClipSide {
    /// All of them.
    pub const ALL: [Self; 7] =
        [Self::Off, Self::X, Self::MinusX, Self::Y, Self::MinusY, Self::Z, Self::MinusZ];

    /// The direction in which the rest lies, or `None` when nothing is cut.
    pub fn normal(self) -> Option<[f32; 3]> {
        Some(match self {
            Self::Off => return None,
            Self::X => [1.0, 0.0, 0.0],
            Self::MinusX => [-1.0, 0.0, 0.0],
            Self::Y => [0.0, 1.0, 0.0],
            Self::MinusY => [0.0, -1.0, 0.0],
            Self::Z => [0.0, 0.0, 1.0],
            Self::MinusZ => [0.0, 0.0, -1.0],
        })
    }
}

impl fmt::Display for ClipSide {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Off => "off",
            Self::X => "x",
            Self::MinusX => "-x",
            Self::Y => "y",
            Self::MinusY => "-y",
            Self::Z => "z",
            Self::MinusZ => "-z",
        })
    }
}

/// Where the light of the preview is.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Light {
    /// At the eye, wherever that goes.
    #[default]
    Camera,
    /// At a point, in the file's units.
    At([f64; 3]),
}

impl fmt::Display for Light {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Camera => f.write_str("camera"),
            Self::At([x, y, z]) => write!(f, "at {x} {y} {z}"),
        }
    }
}

/// How surfaces answer the light of the preview.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Lighting {
    /// With a soft sky, so that nothing is black.
    #[default]
    Soft,
    /// By Phong's model, with the numbers of the Lvis of 2014.
    Phong,
}

impl Lighting {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Soft, Self::Phong];
}

impl fmt::Display for Lighting {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Soft => "soft",
            Self::Phong => "phong",
        })
    }
}

/// What the handles of selectors do.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Handles {
    /// They move along an axis.
    #[default]
    Move,
    /// They scale.
    Scale,
}

impl Handles {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Move, Self::Scale];
}

impl fmt::Display for Handles {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Move => "move",
            Self::Scale => "scale",
        })
    }
}

/// How surfaces are drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Shading {
    /// Lit, with their textures.
    #[default]
    Shaded,
    /// Lit, each in one colour.
    Plain,
    /// Their textures and colours alone, without light.
    Texture,
    /// Lit, with the edges of triangles.
    Edges,
    /// Edges of triangles only.
    Wireframe,
    /// Not at all.
    Off,
}

impl Shading {
    /// All of them.
    pub const ALL: [Self; 6] =
        [Self::Shaded, Self::Plain, Self::Texture, Self::Edges, Self::Wireframe, Self::Off];
}

impl fmt::Display for Shading {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Shaded => "shaded",
            Self::Plain => "plain",
            Self::Texture => "texture",
            Self::Edges => "edges",
            Self::Wireframe => "wireframe",
            Self::Off => "off",
        })
    }
}

pub(super) const FORMS: &[Form] = &[
    ("scene shading shaded|plain|texture|edges|wireframe|off", "how surfaces are drawn"),
    ("scene opacity X", "opacity of all surfaces (0 to 1)"),
    ("scene cutaway on|off|toggle", "look through surfaces from behind"),
    ("scene camera on|off|toggle", "the model of the render camera"),
    ("scene grid on|off|toggle", "the grid on the ground"),
    ("scene light camera|at X Y Z", "the light of the preview, in the file's units"),
    ("scene lighting soft|phong", "how surfaces answer the light of the preview"),
    ("scene handles move|scale", "what the handles of selectors do"),
    ("scene clip off|x|-x|y|-y|z|-z", "cut away what lies before a plane along an axis"),
    ("scene cut X", "where the plane lies across the scene (0 to 1)"),
];

impl fmt::Display for SceneCommand {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Shading(shading) => write!(f, "shading {shading}"),
            Self::Opacity(x) => write!(f, "opacity {x}"),
            Self::Cutaway(switch) => write!(f, "cutaway {switch}"),
            Self::Camera(switch) => write!(f, "camera {switch}"),
            Self::Grid(switch) => write!(f, "grid {switch}"),
            Self::Light(light) => write!(f, "light {light}"),
            Self::Lighting(lighting) => write!(f, "lighting {lighting}"),
            Self::Handles(handles) => write!(f, "handles {handles}"),
            Self::Clip(side) => write!(f, "clip {side}"),
            Self::Cut(place) => write!(f, "cut {place}"),
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
        "light" => SceneCommand::Light(light(words)?),
        "lighting" => SceneCommand::Lighting(words.choice("LIGHTING", &Lighting::ALL)?),
        "handles" => SceneCommand::Handles(words.choice("HANDLES", &Handles::ALL)?),
        "clip" => SceneCommand::Clip(words.choice("SIDE", &ClipSide::ALL)?),
        "cut" => SceneCommand::Cut(words.number("X", 0.0..=1.0)?),
        other => return Err(CommandError::Unknown(format!("scene {other}"))),
    })
}

fn light(words: &mut Words<'_>) -> Result<Light, CommandError> {
    const FAR: f64 = 1e12;
    match words.next("light's place")? {
        "camera" => Ok(Light::Camera),
        "at" => {
            let mut axis = |name| words.within(name, -FAR..=FAR);
            Ok(Light::At([axis("X")?, axis("Y")?, axis("Z")?]))
        }
        other => Err(CommandError::Unknown(format!("scene light {other}"))),
    }
}
