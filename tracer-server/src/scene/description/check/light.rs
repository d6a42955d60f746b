//! What every light without a surface must fulfil.

use glam::DVec3;

use super::material::check_emission;
use super::{Fault, Part, Problem, check_point};
use crate::scene::description::{LightKind, SceneDescription};

/// Checks all lights without a surface.
pub(crate) fn check_lights(scene: &SceneDescription) -> Result<(), Problem> {
    let skies = scene.lights.iter().enumerate();
    let mut skies = skies.filter(|(_, light)| matches!(light.kind, LightKind::Environment { .. }));
    if let (Some(_), Some((index, _))) = (skies.next(), skies.next()) {
        let message = "the scene already has an environment; it can have only one";
        return Err(Problem::new(Part::Light(index), "environment", message));
    }
    let room = usize::from(u16::MAX) - scene.materials.len().min(usize::from(u16::MAX));
    if scene.lights.len() > room {
        let message = format!("more than {room} lights without a surface");
        return Err(Problem::new(Part::Scene, "lights", message));
    }
    for (index, light) in scene.lights.iter().enumerate() {
        check_kind(&light.kind).map_err(|fault| fault.of(Part::Light(index)))?;
    }
    Ok(())
}

fn check_kind(kind: &LightKind) -> Result<(), Fault> {
    let heading = |direction: DVec3| {
        check_point(direction)?;
        let message = || "the direction has no length".to_owned();
        if direction.length_squared() > 0.0 { Ok(()) } else { Err(message()) }
    };
    check_emission("", kind.color())?;
    match kind {
        LightKind::Point { position, .. } => {
            check_point(*position).map_err(|m| Fault::new("point", m))
        }
        LightKind::Spot { position, direction, cutoff, beam, .. } => {
            check_point(*position).map_err(|m| Fault::new("spot", m))?;
            heading(*direction).map_err(|m| Fault::new("spot", m))?;
            if !(*cutoff > 0.0 && *cutoff <= 180.0 && *beam >= 0.0 && beam <= cutoff) {
                let message = format!(
                    "cutoff {cutoff} must lie above 0 and up to 180 degrees, beam {beam} between 0 \
                     and cutoff"
                );
                return Err(Fault::new("spot", message));
            }
            Ok(())
        }
        LightKind::Directional { direction, .. } => {
            heading(*direction).map_err(|m| Fault::new("directional", m))
        }
        LightKind::Environment { image, .. } => {
            let sound = |texel: &[f32; 3]| texel.iter().all(|c| c.is_finite() && *c >= 0.0);
            let bad = image.as_ref().and_then(|i| i.texels.iter().position(|texel| !sound(texel)));
            match (image, bad) {
                (Some(image), Some(at)) => {
                    let (x, y) = (at % image.width, at / image.width);
                    let message = format!(
                        "pixel ({x}, {y}) of the image is {:?}; all channels must be finite and not \
                         negative",
                        image.texels[at]
                    );
                    Err(Fault::new("environment", message))
                }
                _ => Ok(()),
            }
        }
    }
}
