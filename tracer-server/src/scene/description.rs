//! A scene as its author wrote it: plain data in the author's own units, before anything is traced.
//!
//! Every loader ends here, and [`super::Scene`] begins here.

use common::{CameraPose, Rgb};
use glam::{DMat3, DVec3, Vec2, Vec3};

use super::sky::SkyImage;

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

/// A thin lens.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ThinLens {
    /// Radius of the aperture, positive.
    pub radius: f64,
    /// Distance along the view direction of the plane that is sharp, positive.
    pub focus: f64,
}

/// A light without a surface.
#[derive(Clone, Debug, PartialEq)]
pub struct LightDescription {
    /// The name in the scene file.
    pub name: String,
    /// What it is.
    pub glow: Glow,
}

/// The kinds of lights without a surface.
#[derive(Clone, Debug, PartialEq)]
pub enum Glow {
    /// Shines equally in all directions.
    Point {
        /// Where.
        position: DVec3,
        /// Radiant intensity: power per solid angle.
        intensity: Rgb,
    },
    /// Shines into a cone.
    Spot {
        /// Where.
        position: DVec3,
        /// Where to; of any length.
        direction: DVec3,
        /// Radiant intensity in the middle.
        intensity: Rgb,
        /// Half angle in degrees beyond which it is dark.
        cutoff: f64,
        /// Half angle in degrees up to which it is fully bright, at most `cutoff`; between the two
        /// it falls smoothly.
        beam: f64,
    },
    /// Parallel light from infinitely far away.
    Directional {
        /// Direction in which the light travels; of any length.
        direction: DVec3,
        /// Irradiance of a surface that faces it.
        irradiance: Rgb,
    },
    /// Light from all around; at most one.
    Environment {
        /// Radiance, or what the texels of the image are multiplied by.
        radiance: Rgb,
        /// The image; without one, the radiance is the same everywhere.
        image: Option<SkyImage>,
        /// Turns the image's axes (see [`SkyImage`]) to those of the scene.
        rotation: DMat3,
    },
}

impl Glow {
    /// What it emits, as its file tells it.
    pub fn color(&self) -> Rgb {
        match *self {
            Self::Point { intensity, .. } | Self::Spot { intensity, .. } => intensity,
            Self::Directional { irradiance, .. } => irradiance,
            Self::Environment { radiance, .. } => radiance,
        }
    }

    /// True when it emits nothing.
    pub fn is_dark(&self) -> bool {
        let black =
            |image: &SkyImage| image.texels.iter().all(|texel| texel.iter().all(|&c| c == 0.0));
        self.color().is_black()
            || matches!(self, Self::Environment { image: Some(image), .. } if black(image))
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
