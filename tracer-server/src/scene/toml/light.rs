//! `[[lights]]` of a scene file.

use std::path::Path;

use common::Rgb;
use glam::{DMat3, DVec3};
use serde::Deserialize;

use super::material::Color;
use crate::scene::description::check::Fault;
use crate::scene::description::{LightDescription, LightKind};
use crate::scene::reading::image::read_sky;
use crate::scene::reading::shape::Rotation;

/// `[[lights]]`: a light without a surface; exactly one of `point`, `spot`, `directional` and
/// `environment`.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct LightEntry {
    /// A name for people.
    pub(crate) name: String,
    /// `{ position, intensity }`: shines equally in all directions.
    point: Option<PointEntry>,
    /// `{ position, target, intensity, cutoff, beam }`: shines into a cone.
    spot: Option<SpotEntry>,
    /// `{ direction, irradiance }`: parallel light from infinitely far away.
    directional: Option<DirectionalEntry>,
    /// `{ radiance, image, rotate }`: light from all around; at most one in a scene.
    environment: Option<EnvironmentEntry>,
}

#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct PointEntry {
    /// Where.
    position: DVec3,
    /// Power per solid angle, a number or `[r, g, b]`.
    intensity: Color,
}

#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct SpotEntry {
    /// Where.
    position: DVec3,
    /// A point in the middle of the cone.
    target: DVec3,
    /// Power per solid angle in the middle, a number or `[r, g, b]`.
    intensity: Color,
    /// Half angle in degrees beyond which it is dark, up to 180; default 30.
    #[serde(default = "thirty")]
    cutoff: f64,
    /// Half angle in degrees up to which it is fully bright; default three quarters of `cutoff`.
    beam: Option<f64>,
}

fn thirty() -> f64 {
    30.0
}

#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct DirectionalEntry {
    /// Direction in which the light travels; of any length.
    direction: DVec3,
    /// Irradiance of a surface that faces it, a number or `[r, g, b]`.
    irradiance: Color,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct EnvironmentEntry {
    /// Radiance, a number or `[r, g, b]`; multiplies the image where there is one; default 1.
    radiance: Option<Color>,
    /// An image in latitude and longitude (.hdr, .exr, .png or .jpg), relative to the scene file.
    /// Its top is +y and its middle column +z; radiance is even over a pixel.
    image: Option<String>,
    /// Rotations that apply in order: `{ axis = [x, y, z], degrees = d }`.
    #[serde(default)]
    rotate: Vec<Rotation>,
}

impl LightEntry {
    /// The light, or the field that is wrong. Reads the image that it names, relative to `folder`.
    pub(crate) fn light(&self, folder: &Path) -> Result<LightDescription, Fault> {
        let kind = match (self.point, self.spot, self.directional, &self.environment) {
            (Some(point), None, None, None) => {
                LightKind::Point { position: point.position, intensity: point.intensity.into() }
            }
            (None, Some(spot), None, None) => LightKind::Spot {
                position: spot.position,
                direction: spot.target - spot.position,
                intensity: spot.intensity.into(),
                cutoff: spot.cutoff,
                beam: spot.beam.unwrap_or(0.75 * spot.cutoff),
            },
            (None, None, Some(sun), None) => LightKind::Directional {
                direction: sun.direction,
                irradiance: sun.irradiance.into(),
            },
            (None, None, None, Some(environment)) => environment.kind(folder)?,
            _ => {
                let message = "give exactly one of point, spot, directional or environment";
                return Err(Fault::new("name", message));
            }
        };
        Ok(LightDescription { name: self.name.clone(), kind })
    }
}

impl EnvironmentEntry {
    fn kind(&self, folder: &Path) -> Result<LightKind, Fault> {
        let image = self.image.as_ref().map(|name| read_sky(&folder.join(name))).transpose();
        let mut rotation = DMat3::IDENTITY;
        for turn in &self.rotate {
            rotation =
                turn.matrix().map_err(|message| Fault::new("environment", message))? * rotation;
        }
        Ok(LightKind::Environment {
            radiance: self.radiance.map_or(Rgb::WHITE, Rgb::from),
            image: image.map_err(|message| Fault::new("environment", message))?,
            rotation,
        })
    }
}
