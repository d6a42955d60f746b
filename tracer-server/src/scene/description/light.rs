//! Lights without a surface as their author wrote them.

use common::Rgb;
use glam::{DMat3, DVec3};

/// A light without a surface.
#[derive(Clone, Debug, PartialEq)]
pub struct LightDescription {
    /// The name in the scene file.
    pub name: String,
    /// What it is.
    pub kind: LightKind,
}

/// The kinds of lights without a surface.
#[derive(Clone, Debug, PartialEq)]
pub enum LightKind {
    /// Shines equally in all directions.
    Point {
        /// Where.
        position: DVec3,
        /// Radiant intensity: power per solid angle.
        intensity: Rgb,
    },
    /// Shines into a cone.
    Spot {
        /// Where.
        position: DVec3,
        /// Where to; of any length.
        direction: DVec3,
        /// Radiant intensity in the middle.
        intensity: Rgb,
        /// Half angle in degrees beyond which it is dark.
        cutoff: f64,
        /// Half angle in degrees up to which it is fully bright, at most `cutoff`; between the two
        /// it falls smoothly.
        beam: f64,
    },
    /// Parallel light from infinitely far away.
    Directional {
        /// Direction in which the light travels; of any length.
        direction: DVec3,
        /// Irradiance of a surface that faces it.
        irradiance: Rgb,
    },
    /// Light from all around; at most one.
    Environment {
        /// Radiance, or what the texels of the image are multiplied by.
        radiance: Rgb,
        /// The image; without one, the radiance is the same everywhere.
        image: Option<SkyImage>,
        /// Turns the image's axes (see [`SkyImage`]) to those of the scene.
        rotation: DMat3,
    },
}

impl LightKind {
    /// What it emits, as its file tells it.
    pub fn color(&self) -> Rgb {
        match *self {
            Self::Point { intensity, .. } | Self::Spot { intensity, .. } => intensity,
            Self::Directional { irradiance, .. } => irradiance,
            Self::Environment { radiance, .. } => radiance,
        }
    }

    /// True when it emits nothing.
    pub fn is_dark(&self) -> bool {
        let black =
            |image: &SkyImage| image.texels.iter().all(|texel| texel.iter().all(|&c| c == 0.0));
        self.color().is_black()
            || matches!(self, Self::Environment { image: Some(image), .. } if black(image))
    }
}

/// An image of the sky: `width` columns of longitude and `height` rows of latitude.
///
/// In the image's own axes the top row is +y; column zero begins at -z, and the columns go on by +x
/// to +z in the middle of the image.
#[derive(Clone, Debug, PartialEq)]
pub struct SkyImage {
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Radiance, row by row from the top.
    pub texels: Vec<[f32; 3]>,
}
