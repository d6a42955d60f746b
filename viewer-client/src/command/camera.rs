//! `camera ...`: how the eye moves.

use std::fmt;

use super::Form;
use super::words::{CommandError, Switch, Words};

/// What the eye may do. Angles in degrees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CameraCommand {
    /// Turns round the pivot: to the right, upwards.
    Orbit(f32, f32),
    /// Shifts the picture, in heights of the viewport: to the right, upwards.
    Pan(f32, f32),
    /// Comes closer by `factor`, towards a point of the viewport.
    Zoom {
        /// How much larger things become; below one to go away.
        factor: f32,
        /// The point that stays put, in half heights of the viewport: to the right, upwards.
        at: [f32; 2],
    },
    /// Turns the head: to the right, upwards.
    Look(f32, f32),
    /// Steps, in sizes of the scene: forward, to the right, upwards.
    Move([f32; 3]),
    /// Flying instead of orbiting.
    Fly(Switch),
    /// Looking through the render camera.
    Through(Switch),
    /// Turns round this point from now on, in scene units, from no farther than this.
    Focus([f32; 3], f32),
    /// Shows the whole scene.
    Frame,
    /// Stands where a link says.
    Place(Place),
    /// Shows the whole scene from one side.
    View(Side),
}

/// A side to look from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// Where the render camera stands, roughly.
    Front,
    /// Opposite to the front.
    Back,
    /// From the left of the front.
    Left,
    /// From the right of the front.
    Right,
    /// From above.
    Top,
    /// From below.
    Bottom,
}

impl Side {
    /// All of them.
    pub const ALL: [Self; 6] =
        [Self::Front, Self::Back, Self::Left, Self::Right, Self::Top, Self::Bottom];
}

impl fmt::Display for Side {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Front => "front",
            Self::Back => "back",
            Self::Left => "left",
            Self::Right => "right",
            Self::Top => "top",
            Self::Bottom => "bottom",
        })
    }
}

/// Where the eye is: what it turns round, from how far, and from where.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// What the view turns round, in scene units.
    pub pivot: [f32; 3],
    /// From the eye to the pivot.
    pub distance: f32,
    /// Degrees to the left of the front, seen from above.
    pub yaw: f32,
    /// Degrees above the horizon.
    pub pitch: f32,
}

pub(super) const FORMS: &[Form] = &[
    ("camera orbit RIGHT UP", "turn round the pivot, in degrees"),
    ("camera pan RIGHT UP", "shift the picture, in heights of the viewport"),
    ("camera zoom FACTOR X Y", "come closer to a point X, Y"),
    ("camera look RIGHT UP", "turn the head, in degrees"),
    ("camera move FORWARD RIGHT UP", "step, in sizes of the scene"),
    ("camera fly on|off|toggle", "fly instead of orbiting"),
    ("camera through on|off|toggle", "look through the render camera"),
    ("camera focus X Y Z DISTANCE", "turn round a point, in scene units, from no farther away"),
    ("camera frame", "show the whole scene"),
    ("camera place X Y Z DISTANCE YAW PITCH", "stand where a link says, in scene units"),
    ("camera view front|back|left|right|top|bottom", "show the scene from one side"),
];

impl fmt::Display for CameraCommand {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Orbit(x, y) => write!(f, "orbit {x} {y}"),
            Self::Pan(x, y) => write!(f, "pan {x} {y}"),
            Self::Zoom { factor, at: [x, y] } => write!(f, "zoom {factor} {x} {y}"),
            Self::Look(x, y) => write!(f, "look {x} {y}"),
            Self::Move([forward, right, up]) => write!(f, "move {forward} {right} {up}"),
            Self::Fly(switch) => write!(f, "fly {switch}"),
            Self::Through(switch) => write!(f, "through {switch}"),
            Self::Focus([x, y, z], d) => write!(f, "focus {x} {y} {z} {d}"),
            Self::Frame => write!(f, "frame"),
            Self::Place(Place { pivot: [x, y, z], distance, yaw, pitch }) => {
                write!(f, "place {x} {y} {z} {distance} {yaw} {pitch}")
            }
            Self::View(side) => write!(f, "view {side}"),
        }
    }
}

pub(super) fn parse(words: &mut Words<'_>) -> Result<CameraCommand, CommandError> {
    const TURN: std::ops::RangeInclusive<f32> = -3600.0..=3600.0;
    const STEP: std::ops::RangeInclusive<f32> = -100.0..=100.0;
    const PLACE: std::ops::RangeInclusive<f32> = -1e6..=1e6;
    const EDGE: std::ops::RangeInclusive<f32> = -20.0..=20.0;
    Ok(match words.next("camera command")? {
        "orbit" => CameraCommand::Orbit(words.number("RIGHT", TURN)?, words.number("UP", TURN)?),
        "pan" => CameraCommand::Pan(words.number("RIGHT", STEP)?, words.number("UP", STEP)?),
        "zoom" => CameraCommand::Zoom {
            factor: words.number("FACTOR", 0.001..=1000.0)?,
            at: [words.number("X", EDGE)?, words.number("Y", EDGE)?],
        },
        "look" => CameraCommand::Look(words.number("RIGHT", TURN)?, words.number("UP", TURN)?),
        "move" => CameraCommand::Move([
            words.number("FORWARD", STEP)?,
            words.number("RIGHT", STEP)?,
            words.number("UP", STEP)?,
        ]),
        "fly" => CameraCommand::Fly(words.switch()?),
        "through" => CameraCommand::Through(words.switch()?),
        "focus" => CameraCommand::Focus(
            [words.number("X", PLACE)?, words.number("Y", PLACE)?, words.number("Z", PLACE)?],
            words.number("DISTANCE", 0.01..=1e6)?,
        ),
        "frame" => CameraCommand::Frame,
        "place" => {
            const FAR: std::ops::RangeInclusive<f32> = -1e7..=1e7;
            CameraCommand::Place(Place {
                pivot: [words.number("X", FAR)?, words.number("Y", FAR)?, words.number("Z", FAR)?],
                distance: words.number("DISTANCE", 1e-4..=1e7)?,
                yaw: words.number("YAW", -360.0..=360.0)?,
                pitch: words.number("PITCH", -90.0..=90.0)?,
            })
        }
        "view" => CameraCommand::View(words.choice("SIDE", &Side::ALL)?),
        other => return Err(CommandError::Unknown(format!("camera {other}"))),
    })
}
