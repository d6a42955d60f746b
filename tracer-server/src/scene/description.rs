//! A scene as its author wrote it: plain data in the author's own units, before anything is traced.
//!
//! Every loader ends here, and [`super::Scene`] begins here.

use common::{CameraPose, Rgb};
use glam::{DVec3, Vec2, Vec3};

pub use super::material::{BsdfDescription, Coding, ColorInput, Material, NumberInput, Texture};

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
}

impl SceneDescription {
    /// The colour of an input on the average over its texture; black where there is no such
    /// texture.
    pub fn mean_color(&self, input: ColorInput) -> Rgb {
        match input {
            ColorInput::Constant(color) => color,
            ColorInput::Texture { texture, factor } => {
                let texture = self.textures.get(usize::from(texture));
                texture.map_or(Rgb::BLACK, Texture::mean) * factor
            }
        }
    }

    /// The number of an input on the average over its texture; zero where there is no such texture.
    pub fn mean_number(&self, input: NumberInput) -> f64 {
        match input {
            NumberInput::Constant(number) => number,
            NumberInput::Texture { texture, factor } => {
                let factor = Rgb::grey(factor);
                self.mean_color(ColorInput::Texture { texture, factor }).luminance()
            }
        }
    }
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
    /// Index of the material.
    pub material: u16,
}
