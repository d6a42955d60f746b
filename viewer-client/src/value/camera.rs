//! Where the camera looks from.

use super::choice::choices;
use super::{CommandError, Value, Words, range};

choices! {
    /// A side to look from.
    pub enum Side {
        /// Where the render camera stands, roughly.
        Front,
        /// From the opposite of the front.
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
}

/// Where the camera is: what it turns around, from how far, and from where.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Viewpoint {
    /// What the view turns around, in scene units.
    pub pivot: [f32; 3],
    /// From the camera to the pivot.
    pub distance: f32,
    /// Degrees to the left of the front, seen from above.
    pub yaw: f32,
    /// Degrees above the horizon.
    pub pitch: f32,
}

impl Value for Viewpoint {
    type Limits = ();

    fn form(_: &str, (): &()) -> String {
        "X Y Z DISTANCE YAW PITCH".to_owned()
    }

    fn read(words: &mut Words<'_>, _: &str, (): &()) -> Result<Self, CommandError> {
        let far = range(-1e7, 1e7);
        Ok(Self {
            pivot: [far.read(words, "X")?, far.read(words, "Y")?, far.read(words, "Z")?],
            distance: range(1e-4, 1e7).read(words, "DISTANCE")?,
            yaw: range(-360.0, 360.0).read(words, "YAW")?,
            pitch: range(-90.0, 90.0).read(words, "PITCH")?,
        })
    }

    fn text(&self) -> String {
        let Self { pivot: [x, y, z], distance, yaw, pitch } = self;
        format!("{x} {y} {z} {distance} {yaw} {pitch}")
    }

    fn examples((): &()) -> Vec<Self> {
        vec![Self { pivot: [1.0, 2.0, -3.0], distance: 40.0, yaw: -12.5, pitch: 8.0 }]
    }
}
