//! The Rust twins of the structs in `wgsl/`.

use bytemuck::{Pod, Zeroable};
use glam::{Mat4, Vec2, Vec3, Vec4};

/// Strategies that have a colour of their own; later ones share the last.
pub const PALETTE_SIZE: usize = 16;
/// Colours from low to high, between which the shader interpolates.
pub const RAMP_SIZE: usize = 8;

/// Declares a struct, and lists the offsets of its fields for the test that compares them with WGSL.
macro_rules! twin {
    ($(#[$meta:meta])* pub struct $name:ident {
        $($(#[doc = $doc:literal])* pub $field:ident: $type:ty,)*
    }) => {
        $(#[$meta])*
        pub struct $name {
            $($(#[doc = $doc])* pub $field: $type,)*
        }

        impl $name {
            /// Name and byte offset of every field.
            #[cfg(test)]
            pub(crate) const OFFSETS: &[(&str, usize)] =
                &[$((stringify!($field), std::mem::offset_of!($name, $field)),)*];
        }
    };
}

twin! {
    /// What every pipeline knows of the picture being drawn; twin of `Frame`. Lengths are in scene
    /// units, widths and radii in pixels, colours linear.
    #[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
    #[repr(C)]
    pub struct FrameUniforms {
        /// From scene units to clip space, depth reversed (1 near, 0 at infinity).
        pub view_projection: Mat4,
        /// The eye.
        pub eye: Vec3,
        /// Distance of the near plane.
        pub near: f32,
        /// The scene's up direction.
        pub up: Vec3,
        /// 1 for a dark theme, 0 for a light one.
        pub dark: f32,
        /// Where the light is that surfaces are seen by.
        pub light: Vec3,
        /// 1 for Phong's model, 0 for one with a soft sky.
        pub phong: f32,
        /// The colour of all paths where colour says nothing.
        pub constant: Vec3,
        /// What crossing paths do: 0 covers, 1 adds light.
        pub glow: f32,
        /// The plane whose positive side is drawn.
        pub clip: Vec4,
        /// Width of lines.
        pub line_width: f32,
        /// Opacity of the newest, brightest line.
        pub line_opacity: f32,
        /// Relative opacity behind surfaces.
        pub hidden_opacity: f32,
        /// Relative opacity at the lens end.
        pub lens_opacity: f32,
        /// Radius of the dots at the light end.
        pub start_radius: f32,
        /// Radius of the dots at other vertices.
        pub dot_radius: f32,
        /// Opacity of surfaces.
        pub surface_opacity: f32,
        /// Relative opacity of surfaces that face away.
        pub back_opacity: f32,
        /// Strength of the wireframe.
        pub edge_strength: f32,
        /// 1 for shaded surfaces, 0 for their colours as they are.
        pub shaded: f32,
        /// Strength of the depth cue.
        pub cue_strength: f32,
        /// Distance where the depth cue begins.
        pub cue_begin: f32,
        /// Inverse of the distance over which the depth cue grows.
        pub cue_inverse_reach: f32,
        /// Newer paths after which a path has faded to 1/e.
        pub fade_age: f32,
        /// Relative opacity that paths fade to.
        pub faded: f32,
        /// log2 of the radiance that is drawn darkest.
        pub darkest: f32,
        /// Inverse of the stops between the darkest and the brightest radiance.
        pub inverse_range: f32,
        /// Relative opacity of paths that the filter does not match.
        pub unmatched_opacity: f32,
        /// Ordinal of the newest path.
        pub newest: u32,
        /// What the colour says.
        pub color_mode: u32,
        /// 1 for dots at the two ends only.
        pub ends_only: u32,
        /// 1 for logarithmic scales.
        pub logarithmic: u32,
        /// 1 to tint the two ends.
        pub tint_ends: u32,
        /// 1 to draw textures.
        pub textured: u32,
        /// Width and height of the picture in pixels.
        pub size: Vec2,
        /// What follows begins at a multiple of 16 bytes.
        pub padding: [u32; 2],
        /// Colours that stay apart.
        pub palette: [Vec4; PALETTE_SIZE],
        /// Colours from low to high.
        pub ramp: [Vec4; RAMP_SIZE],
    }
}

/// One vertex of a polyline: 24 bytes.
#[derive(Clone, Copy, Debug, PartialEq, Default, Pod, Zeroable)]
#[repr(C)]
pub struct LinePoint {
    /// Position in scene units.
    pub position: [f32; 3],
    /// Colour and radiance code.
    pub color: [u8; 4],
    /// Number of the path since the viewer started, in 24 bits; above them acceptance and dwell, see
    /// [`path_word`].
    pub ordinal: u32,
    /// Role bits and kind, strategy and number of edges (see [`strategy_and_edges`]), colours of chain
    /// and class, code of the throughput ([`THROUGHPUT_CODE`]).
    pub info: [u8; 4],
}

/// Bits of a path's number; those above tell how it was accepted, and how long its chain stayed.
pub const ORDINAL_BITS: u32 = 24;

/// What a path's points have in common: its number, wrapping, its acceptance probability in
/// fifteenths, and log2 of its dwell in steps, up to 15.
pub fn path_word(ordinal: u32, acceptance: f32, dwell: u32) -> u32 {
    let acceptance = (acceptance.clamp(0.0, 1.0) * 15.0).round() as u32;
    let dwell = dwell.max(1).ilog2().min(15);
    ordinal & ((1 << ORDINAL_BITS) - 1) | acceptance << ORDINAL_BITS | dwell << (ORDINAL_BITS + 4)
}

/// Strategy and number of edges, up to 15 each, in one byte.
pub fn strategy_and_edges(strategy: u8, edges: usize) -> u8 {
    strategy.min(15) | (edges.min(15) as u8) << 4
}

/// Codes a stop, and the stop (log2) of code 1: what a throughput's byte means. 0 is unknown.
pub const THROUGHPUT_CODE: [f32; 2] = [8.0, -28.0];

impl LinePoint {
    /// How the struct is read, from location 0 on.
    pub const ATTRIBUTES: [Attribute; 4] = [
        Attribute { offset: 0, format: AttributeFormat::Float32x3 },
        Attribute { offset: 12, format: AttributeFormat::Unorm8x4 },
        Attribute { offset: 16, format: AttributeFormat::Uint32 },
        Attribute { offset: 20, format: AttributeFormat::Uint8x4 },
    ];
}

/// One corner of a triangle: 32 bytes.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct MeshVertex {
    /// Position in scene units.
    pub position: [f32; 3],
    /// Unit normal in 32767ths; then the texture's number from 1, or 0 without.
    pub normal: [i16; 4],
    /// Square root of the linear colour, and the kind of material.
    pub color: [u8; 4],
    /// Texture coordinates, upwards.
    pub texcoord: [f32; 2],
}

impl MeshVertex {
    /// How the struct is read, from location 0 on.
    pub const ATTRIBUTES: [Attribute; 4] = [
        Attribute { offset: 0, format: AttributeFormat::Float32x3 },
        Attribute { offset: 12, format: AttributeFormat::Snorm16x4 },
        Attribute { offset: 20, format: AttributeFormat::Unorm8x4 },
        Attribute { offset: 24, format: AttributeFormat::Float32x2 },
    ];
}

/// One member of a vertex, as the vertex stage reads it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Attribute {
    /// Bytes from the start of the vertex.
    pub offset: u64,
    /// How its bytes become numbers.
    pub format: AttributeFormat,
}

/// How the bytes of an attribute become numbers in the shader.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AttributeFormat {
    /// Two floats.
    Float32x2,
    /// Three floats.
    Float32x3,
    /// Four bytes as numbers from 0 to 1.
    Unorm8x4,
    /// Four signed shorts as numbers from -1 to 1.
    Snorm16x4,
    /// Four small integers.
    Uint8x4,
    /// One integer.
    Uint32,
}

/// Bits of the first component of [`LinePoint::info`].
pub mod role {
    /// A path's vertex on the light.
    pub const START: u8 = 1;
    /// The last point of a polyline; no segment follows.
    pub const LAST: u8 = 2;
    /// Part of a drawing aid rather than of a path: its colour is taken as it is.
    pub const ANNOTATION: u8 = 4;
    /// The filter leaves the path out.
    pub const DIMMED: u8 = 8;
    /// The kind of a vertex lies above the bits, this far up.
    pub const KIND_SHIFT: u8 = 4;
}

/// Values of the last component of [`MeshVertex::color`].
pub mod material_kind {
    /// An opaque surface.
    pub const OPAQUE: u8 = 0;
    /// Lets light through.
    pub const TRANSPARENT: u8 = 1;
    /// Emits light.
    pub const EMITTER: u8 = 2;
    /// A mirror.
    pub const MIRROR: u8 = 3;
}

/// Stops (log2) that the radiance code spans.
pub(crate) const CODE_STOPS: f32 = 64.0;
/// The lowest of them.
pub(crate) const CODE_LOWEST: f32 = -40.0;

/// A radiance as a byte, in quarter stops from 2^-40 to 2^24.
pub fn encode_radiance(radiance: f32) -> u8 {
    let stops = radiance.max(f32::MIN_POSITIVE).log2();
    (((stops - CODE_LOWEST) / CODE_STOPS).clamp(0.0, 1.0) * 255.0).round() as u8
}

/// The stops (log2 of the radiance) that a byte stands for.
pub fn decode_radiance(code: u8) -> f32 {
    f32::from(code) / 255.0 * CODE_STOPS + CODE_LOWEST
}
