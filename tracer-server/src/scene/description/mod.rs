//! A scene as its author wrote it: plain data in the author's own units, before anything is traced.
//!
//! Every loader ends here, and [`crate::scene::Scene`] begins here.

pub(crate) mod check;
mod hash;
mod light;
mod material;

use common::{CameraPose, MAX_VERTICES, Rgb};
use glam::{DMat3, DVec3, Vec2, Vec3};

use crate::bsdf::{ColorInput, Inputs, NumberInput};
pub(crate) use hash::digest;
pub use light::{LightDescription, LightKind, SkyImage};
pub use material::{Coding, Material, Texels, Texture};

/// Longest path that any scene may ask for, in edges.
pub const MAX_EDGES: usize = MAX_VERTICES - 1;

/// A whole scene in the units of its file.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneDescription {
    /// A name for people: the built-in's, or the file's stem.
    pub name: String,
    /// Where the camera stands.
    pub camera: CameraPose,
    /// Film width in pixels.
    pub width: u32,
    /// Film height in pixels.
    pub height: u32,
    /// Longest path, in edges from light to camera (1 = a lamp seen directly).
    pub max_edges: usize,
    /// Materials; shapes refer to them by index.
    pub materials: Vec<Material>,
    /// Textures; materials refer to them by index.
    pub textures: Vec<Texture>,
    /// Triangle meshes.
    pub meshes: Vec<Mesh>,
    /// Analytic spheres.
    pub spheres: Vec<Sphere>,
    /// Lights without a surface.
    pub lights: Vec<LightDescription>,
    /// The camera's lens; none is an ideal pinhole.
    pub lens: Option<ThinLens>,
}

impl SceneDescription {
    /// A scene without anything to see.
    pub fn empty(
        name: impl Into<String>,
        camera: CameraPose,
        [width, height]: [u32; 2],
        max_edges: usize,
    ) -> Self {
        Self {
            name: name.into(),
            camera,
            width,
            height,
            max_edges,
            materials: Vec::new(),
            textures: Vec::new(),
            meshes: Vec::new(),
            spheres: Vec::new(),
            lights: Vec::new(),
            lens: None,
        }
    }
}

/// Inputs on the average over their textures.
impl Inputs for SceneDescription {
    /// Black where there is no such texture.
    fn color(&self, input: ColorInput) -> Rgb {
        match input {
            ColorInput::Constant(color) => color,
            ColorInput::Texture { texture, factor } => {
                let texture = self.textures.get(usize::from(texture));
                texture.map_or(Rgb::BLACK, Texture::mean) * factor
            }
        }
    }

    /// Zero where there is no such texture.
    fn number(&self, input: NumberInput) -> f64 {
        match input {
            NumberInput::Constant(number) => number,
            NumberInput::Texture { texture, factor } => {
                let factor = Rgb::grey(factor);
                self.color(ColorInput::Texture { texture, factor }).luminance()
            }
        }
    }
}

/// A thin lens.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ThinLens {
    /// Radius of the aperture, positive.
    pub radius: f64,
    /// Distance along the view direction of the plane that is sharp, positive.
    pub focus: f64,
}

/// An indexed triangle mesh.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// The name in the scene file.
    pub name: String,
    /// Vertex positions.
    pub positions: Vec<DVec3>,
    /// Vertex indices; counter-clockwise seen from the front side.
    pub triangles: Vec<[u32; 3]>,
    /// Index of the material, one a triangle.
    pub materials: Vec<u16>,
    /// Shading normals at the three corners, one triple a triangle; empty for a flat mesh. They
    /// need no unit length; where one is zero, the triangle's own normal stands for it.
    pub normals: Vec<[Vec3; 3]>,
    /// Texture coordinates at the three corners, one triple a triangle; empty where there are
    /// none. `u` runs to the right of the image and `v` upwards.
    pub texcoords: Vec<[Vec2; 3]>,
}

/// A sphere whose front side is its outside.
#[derive(Clone, Debug, PartialEq)]
pub struct Sphere {
    /// The name in the scene file.
    pub name: String,
    /// Its middle.
    pub centre: DVec3,
    /// Its radius, positive.
    pub radius: f64,
    /// From directions in the scene to those of its texture, whose poles are at +y and -y: a rotation,
    /// or a mirrored one.
    pub turn: DMat3,
    /// Index of the material.
    pub material: u16,
}
