//! A scene as its author wrote it: plain data in the author's own units, before anything is traced.
//!
//! Every loader ends here, and [`super::Scene`] begins here.

use common::{CameraPose, Rgb};
use glam::DVec3;

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
    /// Triangle meshes.
    pub meshes: Vec<Mesh>,
    /// Analytic spheres.
    pub spheres: Vec<Sphere>,
}

/// How a surface scatters and emits.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// The name in the scene file.
    pub name: String,
    /// How it scatters.
    pub bsdf: BsdfDescription,
    /// Radiance emitted from the front side (the side the normal points to); black for none.
    pub emission: Rgb,
}

/// The parameters of a scattering model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum BsdfDescription {
    /// Ideal diffuse reflection on both sides.
    Lambert {
        /// Albedo, each channel in [0, 1].
        reflectance: Rgb,
    },
    /// Ideal mirror on both sides.
    Mirror {
        /// Reflectance at every angle, each channel in [0, 1].
        reflectance: Rgb,
    },
    /// A smooth boundary between two transparent media.
    Dielectric {
        /// Index of refraction behind the surface over the one in front of it.
        eta: f64,
        /// Tint of reflected light, each channel in [0, 1].
        reflectance: Rgb,
        /// Tint of refracted light, each channel in [0, 1].
        transmittance: Rgb,
    },
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
