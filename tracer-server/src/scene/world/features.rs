//! What a scene contains, found once, and what it therefore does not pay for.

use common::Camera;
use serde::Serialize;

use super::SurfaceMaterial;
use super::emitter::Emitters;

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
    /// Some triangle is shaded by other normals than its own.
    pub shading_normals: bool,
    /// Some reachable material reads a texture.
    pub textures: bool,
    /// Some reachable material is black on its back.
    pub one_sided: bool,
    /// A ray that leaves the scene meets an environment.
    pub environment: bool,
    /// A walk from the eye can hit some light: a surface or the environment.
    pub hittable: bool,
    /// The lens has an area.
    pub aperture: bool,
}

impl SceneFeatures {
    /// Looks through what is traced: the materials of all surfaces, the number of analytic spheres,
    /// whether any triangle has shading normals, and the lights and the camera.
    pub(super) fn of(
        used: &[&SurfaceMaterial],
        spheres: usize,
        shading_normals: bool,
        lights: &Emitters,
        camera: &Camera,
    ) -> Self {
        let environment = lights.sky().is_some();
        Self {
            specular: used.iter().any(|surface| surface.bsdf.has_dirac_lobe()),
            spheres: spheres > 0,
            shading_normals,
            textures: used.iter().any(|surface| surface.textured.is_some()),
            one_sided: used.iter().any(|surface| surface.one_sided),
            environment,
            hittable: environment || !lights.list().is_empty(),
            aperture: camera.has_aperture(),
        }
    }

    /// What the features that are there ask for, in words, for people.
    pub fn present(self) -> Vec<&'static str> {
        let mut present = Vec::new();
        if self.specular {
            present.push("mirrors or glass: mutations keep specular chains of events");
        }
        if self.spheres {
            present.push("analytic spheres: a second hierarchy is traversed for exact spheres");
        }
        if self.shading_normals {
            present.push("shading normals: walks from the light carry adjoint factors");
        }
        if self.textures {
            present.push("textures: colour or roughness varies over surfaces");
        }
        if self.one_sided {
            present.push("one-sided surfaces: their backs are black");
        }
        if self.environment {
            present.push("environment: a ray that leaves the scene meets light");
        }
        if self.aperture {
            present.push("aperture: mutations move the lens point, too");
        }
        present
    }

    /// What the absent features switch off, in words, for the log and for people.
    pub fn switched_off(self) -> Vec<&'static str> {
        let mut off = Vec::new();
        if !self.specular {
            off.push("no mirror or glass: every vertex can be connected, and the multi-chain perturbation is off");
        }
        if !self.spheres {
            off.push("no analytic sphere: the sphere hierarchy is never traversed");
        }
        if !self.environment {
            off.push("no environment: a ray that leaves the scene is lost");
        }
        if !self.hittable {
            off.push(
                "no light with a surface: paths from the eye never end on a light, and lamps seen \
                only through mirrors or glass are missing",
            );
        }
        if !self.aperture {
            off.push("no aperture: the lens is a point and never moves");
        }
        if !self.shading_normals {
            off.push("no shading normals: the adjoint factors of walks from the light are 1");
        }
        if !self.textures {
            off.push("no textures: no texture coordinates are kept");
        }
        if !self.one_sided {
            off.push("no one-sided surface: no side is tested");
        }
        off
    }
}
