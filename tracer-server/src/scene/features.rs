//! What a scene contains, found once, and what it therefore does not pay for.

use common::Camera;
use serde::Serialize;

use super::emitter::Emitters;
use crate::bsdf::Bsdf;

/// What the transport code may have to deal with.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[expect(
    clippy::struct_excessive_bools,
    reason = "each feature is there or not, whatever the others"
)]
pub struct SceneFeatures {
    /// Some reachable material has a Dirac lobe.
    pub specular: bool,
    /// Some shape is an analytic sphere.
    pub spheres: bool,
    /// A ray that leaves the scene meets an environment.
    pub environment: bool,
    /// A walk from the eye can hit some light: a surface or the environment.
    pub hittable: bool,
    /// The lens has an area.
    pub aperture: bool,
}

impl SceneFeatures {
    /// Looks through what is traced: the models of all surfaces, by material, the number of analytic
    /// spheres, the lights and the camera.
    pub(super) fn of(used: &[&Bsdf], spheres: usize, lights: &Emitters, camera: &Camera) -> Self {
        let environment = lights.sky().is_some();
        Self {
            specular: used.iter().any(|bsdf| bsdf.has_dirac_lobe()),
            spheres: spheres > 0,
            environment,
            hittable: environment || !lights.list().is_empty(),
            aperture: camera.has_aperture(),
        }
    }

    /// What the absent features switch off, in words, for the log and for people.
    pub fn switched_off(self) -> Vec<&'static str> {
        let mut off = Vec::new();
        if !self.specular {
            off.push("no mirror or glass: every vertex can be connected, and the multi-chain perturbation is off");
        }
        if !self.spheres {
            off.push("no analytic sphere: the sphere tree is never searched");
        }
        if !self.environment {
            off.push("no environment: a ray that leaves the scene is lost");
        }
        if !self.hittable {
            off.push(
                "no light with a surface: paths from the eye never end on a light, and what only mirrors or glass could show of a lamp is missing",
            );
        }
        if !self.aperture {
            off.push("no aperture: the lens is a point and never moves");
        }
        off
    }
}
