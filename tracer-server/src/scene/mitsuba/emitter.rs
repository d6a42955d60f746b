//! Emitters that belong to no shape.

use common::Rgb;
use glam::{DMat3, DVec3};

use super::document::Element;
use crate::scene::description::{LightDescription, LightKind};
use crate::scene::reading::diagnostic::{LoadError, Warning};
use crate::scene::reading::image::read_sky;

/// Half angle in degrees of a spot that does not tell its own.
const DEFAULT_CUTOFF: f64 = 20.0;

/// Reads an `emitter`, and what of it is not supported; `None` for an unknown kind.
pub(super) fn read(
    emitter: Element<'_>,
    warnings: &mut Vec<Warning>,
) -> Result<Option<LightDescription>, LoadError> {
    let to_world = emitter.transform("to_world")?;
    let (place, ahead) =
        (to_world.transform_point3(DVec3::ZERO), to_world.transform_vector3(DVec3::Z));
    let kind = match emitter.plugin()?.as_str() {
        "point" => LightKind::Point {
            position: emitter.point("position")?.unwrap_or(place),
            intensity: color(emitter, "intensity")?,
        },
        "spot" => {
            warnings.push(
                emitter.warning("its intensity falls off smoothly with the cosine of the angle"),
            );
            let cutoff = emitter.number("cutoff_angle")?.unwrap_or(DEFAULT_CUTOFF);
            LightKind::Spot {
                position: place,
                direction: ahead,
                intensity: color(emitter, "intensity")?,
                cutoff,
                beam: emitter.number("beam_width")?.unwrap_or(0.75 * cutoff),
            }
        }
        "directional" => LightKind::Directional {
            direction: emitter.point("direction")?.unwrap_or(ahead),
            irradiance: color(emitter, "irradiance")?,
        },
        "constant" => LightKind::Environment {
            radiance: color(emitter, "radiance")?,
            image: None,
            rotation: DMat3::IDENTITY,
        },
        "envmap" => image(emitter, DMat3::from_mat4(to_world))?,
        _ => {
            let message = "ignored: unknown emitter; supported: area (in a shape), point, spot, \
                directional, constant, envmap";
            warnings.push(emitter.warning(message));
            return Ok(None);
        }
    };
    Ok(Some(LightDescription { name: emitter.label(), kind }))
}

/// A colour; one where it is absent.
fn color(emitter: Element<'_>, name: &str) -> Result<Rgb, LoadError> {
    Ok(emitter.color(name)?.unwrap_or(Rgb::WHITE))
}

/// An image around the scene. The renderer's images have the axes that ours have.
fn image(emitter: Element<'_>, rotation: DMat3) -> Result<LightKind, LoadError> {
    let name = emitter.string("filename")?.ok_or_else(|| {
        emitter.error("the parameter `filename` is missing: the file with the image")
    })?;
    let rigid = (rotation.transpose() * rotation - DMat3::IDENTITY).to_cols_array();
    if rigid.iter().any(|off| off.abs() > 1e-6) || rotation.determinant() < 0.0 {
        let message = "its transform must be a rotation; remove scales and mirrors";
        return Err(emitter.error(message));
    }
    let image = read_sky(&emitter.file(&name)).map_err(|message| emitter.error(message))?;
    let radiance = Rgb::grey(emitter.number("scale")?.unwrap_or(1.0));
    Ok(LightKind::Environment { radiance, image: Some(image), rotation })
}
