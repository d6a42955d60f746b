//! The world that is traced: a description brought to scene units, with its hierarchies and lights.

mod accel;
mod build;
mod corners;
mod emitter;
mod features;
mod lamp;
mod light;
mod paint;
mod preview;
mod sky;
mod surface;
mod tracer;

use std::borrow::Cow;
use std::f64::consts::{PI, TAU};

use common::{Camera, FilterObject, Rgb, SceneFrame};
use glam::{DVec2, DVec3};

use crate::bsdf::{Bsdf, BsdfDescription, Local};
use crate::scene::description::{Material, SceneDescription};
use accel::Accel;
use corners::Corners;
use emitter::Emitters;
use paint::{Map, Painted};

pub use accel::{Anchor, Hit};
pub use build::SceneError;
pub use features::SceneFeatures;
pub use lamp::Emission;
pub use light::{LampInfo, LightSample};
pub use surface::NO_PRIMITIVE;
pub use tracer::{RayCounts, Tracer};

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
    features: SceneFeatures,
    accel: Accel,
    primitives: Vec<Primitive>,
    surfaces: Vec<SurfaceMaterial>,
    corners: Corners,
    maps: Vec<Map>,
    emitters: Emitters,
    /// Of the lights without a surface.
    lamp_names: Vec<String>,
    objects: Vec<FilterObject>,
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
    /// Its model; with the mean of a texture.
    bsdf: Bsdf,
    /// What it is rebuilt from at every point, if it reads textures.
    textured: Option<BsdfDescription>,
    /// True when its back is black.
    one_sided: bool,
    /// Radiance in scene units.
    emission: Rgb,
}

impl SurfaceMaterial {
    /// The material with emission in scene units.
    fn new(scene: &SceneDescription, material: &Material, emission_factor: f64) -> Self {
        let bsdf = material.bsdf.build(scene);
        Self {
            name: material.name.clone(),
            bsdf,
            textured: material.bsdf.is_textured().then_some(material.bsdf),
            one_sided: !material.two_sided && !bsdf.is_transparent(),
            emission: material.emission * emission_factor,
        }
    }
}

/// Texture coordinates on a sphere with poles at +y and -y: longitude from +x towards +z, and
/// latitude from the south.
fn globe(normal: DVec3) -> DVec2 {
    let longitude = normal.z.atan2(normal.x) / TAU;
    DVec2::new(longitude, 1.0 - normal.y.clamp(-1.0, 1.0).acos() / PI)
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

    /// The meshes and spheres by name, each with its primitives.
    pub fn objects(&self) -> &[FilterObject] {
        &self.objects
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
        self.frame.light
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

    /// The scattering at a point of a surface, all of it a function of the point alone: with
    /// texture, shading normal and black back, as far as the point has any.
    #[inline]
    pub fn local(&self, at: &Anchor, material: u16) -> Local<'_> {
        let surface = &self.surfaces[usize::from(material)];
        let mut local = Local::flat(Cow::Borrowed(&surface.bsdf), at.normal);
        let triangle = self.accel.triangles().get(at.primitive as usize);
        if let Some(description) = &surface.textured {
            let uv = if let Some(triangle) = triangle {
                self.corners.texcoord(at.primitive, triangle, at.position)
            } else {
                let sphere = at.primitive as usize - self.accel.triangles().len();
                Some(globe(self.corners.turn(sphere) * at.normal))
            };
            if let Some(uv) = uv {
                let painted = description.rebuild(&surface.bsdf, &Painted { maps: &self.maps, uv });
                local = Local::flat(Cow::Owned(painted), at.normal);
            }
        }
        let normal = triangle.and_then(|t| self.corners.normal(at.primitive, t, at.position));
        if let Some(normal) = normal {
            local = local.shaded(normal);
        }
        if surface.one_sided { local.one_sided() } else { local }
    }

    /// The scattering model of a material; a textured one with the mean of its texture.
    #[inline]
    pub fn bsdf(&self, material: u16) -> &Bsdf {
        &self.surfaces[usize::from(material)].bsdf
    }

    /// The scattering models of all materials; a textured one with the mean of its texture.
    pub fn models(&self) -> impl Iterator<Item = &Bsdf> {
        self.surfaces.iter().map(|surface| &surface.bsdf)
    }
}
