//! The scene as a viewer draws it.

use glam::DVec3;
use serde::{Deserialize, Serialize};

use crate::{Camera, FilterObject, Rgb};

/// How the coordinates and the light that travel relate to those of the scene file.
///
/// The daemon works, and sends everything, in a frame whose origin is the middle of the scene's
/// bounding box and whose unit is a power of two times the file's: `scene = (world - centre) * scale`.
/// Light is divided by another one.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SceneFrame {
    /// The middle of the bounding box, in the file's units.
    pub centre: DVec3,
    /// A power of two that makes the largest extent lie in [1024, 2048).
    pub scale: f64,
    /// A power of two that radiances of the file are divided by; 1 where a daemon does not tell.
    pub light: f64,
}

impl SceneFrame {
    /// The point of the file that `scene` stands for.
    pub fn to_world(self, scene: DVec3) -> DVec3 {
        scene / self.scale + self.centre
    }

    /// The point that stands for `world`.
    pub fn to_scene(self, world: DVec3) -> DVec3 {
        (world - self.centre) * self.scale
    }
}

/// What a viewer needs to know of a material.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MaterialInfo {
    /// The name in the scene file.
    pub name: String,
    /// The model, such as `lambert`, `mirror` or `dielectric`.
    pub model: String,
    /// A colour to draw it with: its reflectance, or its transmittance for glass.
    pub color: Rgb,
    /// Emitted radiance; black where it is no light.
    pub emission: Rgb,
    /// True where it lets light through, so that a viewer can draw it translucent.
    pub transparent: bool,
    /// Index of the picture that its colour is read from, if it has one.
    pub texture: Option<u16>,
}

/// A picture that is laid over surfaces and repeats in both directions, for viewers: no larger than
/// they need.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct TexturePreview {
    /// Texels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// sRGB codes of red, green and blue (IEC 61966-2-1), row by row from the top.
    pub texels: Vec<[u8; 3]>,
}

impl TexturePreview {
    /// Texels a side at most, so that one fits into a message.
    pub const MAX_SIDE: u32 = 512;
    /// Textures of one scene at most.
    pub const MAX_COUNT: usize = 256;
}

/// The scene's surfaces as indexed triangles, in scene units (see [`SceneFrame`]).
///
/// Curved shapes arrive tessellated; `primitives` names the shape each triangle belongs to, so that
/// a vertex record's `primitive` can be matched with what is drawn.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SceneMesh {
    /// Vertex positions.
    pub positions: Vec<[f32; 3]>,
    /// Unit normals, one a vertex.
    pub normals: Vec<[f32; 3]>,
    /// Texture coordinates, one a vertex, or none at all where no material has a texture. (0, 0) is
    /// the lower left corner of a picture and (1, 1) the upper right one.
    pub texcoords: Vec<[f32; 2]>,
    /// Three vertex indices a triangle.
    pub triangles: Vec<[u32; 3]>,
    /// Index into `materials`, one a triangle.
    pub triangle_materials: Vec<u16>,
    /// The traced primitive, one a triangle.
    pub primitives: Vec<u32>,
    /// The materials.
    pub materials: Vec<MaterialInfo>,
    /// The objects that have names, each with its primitives.
    pub objects: Vec<FilterObject>,
    /// The pictures that materials refer to.
    pub textures: Vec<TexturePreview>,
    /// The render camera.
    pub camera: Option<Camera>,
}

impl SceneMesh {
    /// The object that a primitive belongs to, where it has a name.
    pub fn object(&self, primitive: u32) -> Option<&str> {
        let named = self.objects.iter().find(|object| object.primitives.contains(&primitive));
        named.map(|object| object.name.as_str())
    }
}
