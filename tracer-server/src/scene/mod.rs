//! What paths may ask of the world: surfaces, materials, lights and the camera.

mod accel;
mod appearance;
mod build;
pub mod builtin;
mod description;
mod diagnostic;
mod emitter;
#[cfg(test)]
mod examples;
mod features;
mod file;
#[cfg(test)]
pub(crate) mod fixtures;
mod hash;
pub mod load;
#[cfg(test)]
mod malformed;
mod material;
mod material_check;
mod mtl;
mod mtl_text;
mod obj;
mod obj_text;
mod origin;
mod preview;
mod shape;
mod strategies;
mod surface;
mod text;
mod texture;
mod tracer;
mod validate;
mod viewpoint;

use common::{Camera, Rgb, SceneFrame};
use glam::DVec3;

use crate::bsdf::Bsdf;
use crate::math::{Rng, below_one};
use accel::Accel;
use emitter::Emitters;

pub use accel::{Anchor, Hit};
pub use build::SceneError;
pub use description::{
    BsdfDescription, Coding, ColorInput, Material, Mesh, NumberInput, SceneDescription, Sphere,
    Texture,
};
pub use features::SceneFeatures;
pub use strategies::{StrategySetting, Wish};
pub use surface::NO_PRIMITIVE;
pub use tracer::{RayCounts, Tracer};

/// Longest path that any scene may ask for, in edges.
pub const MAX_EDGES: usize = 64;

/// No emitter, in [`Primitive::emitter`].
const NO_EMITTER: u32 = u32::MAX;

/// An immutable world, in scene units (see [`SceneFrame`]); shared by reference between threads.
///
/// Emission is divided by a power of two near the total power, so that the numbers that paths work
/// with are near one whatever the units of the file; images are multiplied by it on the way out.
#[derive(Debug)]
pub struct Scene {
    name: String,
    hash: String,
    frame: SceneFrame,
    camera: Camera,
    max_edges: usize,
    radiance_scale: f64,
    features: SceneFeatures,
    accel: Accel,
    primitives: Vec<Primitive>,
    surfaces: Vec<SurfaceMaterial>,
    emitters: Emitters,
    warnings: Vec<String>,
}

/// What a primitive is made of.
#[derive(Clone, Copy, Debug)]
struct Primitive {
    material: u16,
    emitter: u32,
}

#[derive(Clone, Debug)]
struct SurfaceMaterial {
    name: String,
    bsdf: Bsdf,
    /// Radiance in scene units.
    emission: Rgb,
}

/// A point on a light, with all that a path needs of it.
#[derive(Clone, Copy, Debug)]
pub struct LightSample {
    /// Where it is.
    pub anchor: Anchor,
    /// Index of its material.
    pub material: u16,
}

/// What a light emits and how likely its points are drawn.
#[derive(Clone, Copy, Debug)]
pub struct Emission {
    /// Radiance on the front side.
    pub radiance: Rgb,
    /// Density with which [`Scene::sample_light`] draws the point, per unit area.
    pub area_pdf: f64,
}

impl Scene {
    /// The scene's name, for people.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Hex digest of the scene's content.
    pub fn hash(&self) -> &str {
        &self.hash
    }

    /// How scene units relate to the units of the file.
    pub fn frame(&self) -> SceneFrame {
        self.frame
    }

    /// The render camera, in scene units.
    pub fn camera(&self) -> &Camera {
        &self.camera
    }

    /// Longest path, in edges.
    pub fn max_edges(&self) -> usize {
        self.max_edges
    }

    /// Multiply a film value by this to get radiance in the units of the file: a power of two.
    pub fn radiance_scale(&self) -> f64 {
        self.radiance_scale
    }

    /// What the scene contains.
    pub fn features(&self) -> SceneFeatures {
        self.features
    }

    /// What had to be mended when the scene was built.
    pub fn warnings(&self) -> &[String] {
        &self.warnings
    }

    /// The nearest surface seen from `from` in the unit `direction`.
    #[inline]
    pub fn closest(&self, from: &Anchor, direction: DVec3) -> Option<Hit> {
        self.accel.closest(from, direction)
    }

    /// True when nothing stands between the two points.
    #[inline]
    pub fn visible(&self, a: &Anchor, b: &Anchor) -> bool {
        self.accel.visible(a, b)
    }

    /// Points of the two primitives nearer than this are too near for visibility and cosines to
    /// mean anything: they lie within the offsets of the rays between them.
    #[inline]
    pub fn reach(&self, a: u32, b: u32) -> f64 {
        self.accel.offset(a) + self.accel.offset(b)
    }

    /// The material of a primitive.
    #[inline]
    pub fn material_of(&self, primitive: u32) -> u16 {
        self.primitives[primitive as usize].material
    }

    /// The scattering model of a material.
    #[inline]
    pub fn bsdf(&self, material: u16) -> &Bsdf {
        &self.surfaces[usize::from(material)].bsdf
    }

    /// The scattering models of all materials; a textured one with the mean of its texture.
    pub fn models(&self) -> impl Iterator<Item = &Bsdf> {
        self.surfaces.iter().map(|surface| &surface.bsdf)
    }

    /// What a primitive emits; `None` where it is no light.
    #[inline]
    pub fn emission(&self, primitive: u32) -> Option<Emission> {
        let emitter = self.emitters.get(self.primitives.get(primitive as usize)?.emitter)?;
        let area_pdf = emitter.probability / emitter.area;
        Some(Emission { radiance: emitter.radiance, area_pdf })
    }

    /// A point on a light with the density that [`Emission::area_pdf`] tells, made of uniform
    /// numbers: the first chooses the light, the other two the point on it.
    #[inline]
    pub fn sample_light(&self, [choice, u, v]: [f64; 3]) -> LightSample {
        let index = self.emitters.choose(choice);
        let primitive = self.emitters.list()[index as usize].primitive;
        let (position, normal) = match self.accel.triangles().get(primitive as usize) {
            Some(triangle) => (triangle.sample(u, v), triangle.normal),
            None => {
                self.accel.balls()[primitive as usize - self.accel.triangles().len()].sample(u, v)
            }
        };
        let anchor = Anchor { position, normal, primitive };
        LightSample { anchor, material: self.material_of(primitive) }
    }

    /// Numbers from which [`Scene::sample_light`] would have made the point `at` of a light; `None`
    /// where the primitive is no light. Among the many numbers that choose the light `rng` draws one
    /// uniformly.
    pub fn invert_light(&self, primitive: u32, at: DVec3, rng: &mut Rng) -> Option<[f64; 3]> {
        let emitter = self.primitives.get(primitive as usize)?.emitter;
        self.emitters.get(emitter)?;
        let (from, to) = self.emitters.share(emitter);
        let choice = below_one(from + rng.uniform() * (to - from));
        let triangles = self.accel.triangles();
        let [u, v] = match triangles.get(primitive as usize) {
            Some(triangle) => triangle.invert(at),
            None => self.accel.balls()[primitive as usize - triangles.len()].invert(at),
        };
        Some([choice, u, v])
    }
}
