//! The shaders of Lvis: WGSL sources as constants, and the Rust twins of their structs.
//!
//! This crate knows no GPU library: sources and layouts are data. Tests hold every source against
//! naga's validator and every twin against the layout that naga computes.

mod layout;
#[cfg(test)]
mod tests;

pub use layout::{
    Attribute, AttributeFormat, FrameUniforms, LinePoint, MeshVertex, ORDINAL_BITS, PALETTE_SIZE,
    RAMP_SIZE, THROUGHPUT_CODE, decode_radiance, encode_radiance, material_kind, path_word, role,
    strategy_and_edges,
};

/// One WGSL module.
#[derive(Clone, Copy, Debug)]
pub struct Shader {
    /// For labels and error messages.
    pub name: &'static str,
    /// The whole source, the shared uniforms included.
    pub source: &'static str,
}

macro_rules! shader {
    ($name:literal) => {
        Shader {
            name: $name,
            source: concat!(
                include_str!("../wgsl/frame.wgsl"),
                include_str!(concat!("../wgsl/", $name, ".wgsl"))
            ),
        }
    };
}

/// Constant-width polylines and their dots.
pub const LINES: Shader = shader!("lines");
/// Lit surfaces.
pub const MESH: Shader = shader!("mesh");
/// Paths that were drawn apart, over the surfaces.
pub const BLEND: Shader = shader!("blend");
/// The drawn picture into the window.
pub const COMPOSITE: Shader = shader!("composite");

/// Every module that ships.
pub const ALL: [Shader; 4] = [LINES, MESH, BLEND, COMPOSITE];
