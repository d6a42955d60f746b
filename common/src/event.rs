//! What happens at a vertex of a path, in Heckbert's alphabet and in detail.

use serde::{Deserialize, Serialize};

/// The kind of a path vertex (Heckbert's alphabet; `M` is a scattering event in a medium).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[repr(u8)]
pub enum VertexKind {
    /// A point on an area light: the start of a path.
    Light = 0,
    /// A connectable (non-Dirac) scattering event on a surface, glossy ones included.
    Diffuse = 3,
    /// A Dirac scattering event: mirror reflection or smooth refraction.
    Specular = 4,
    /// The lens: the end of a path.
    Eye = 6,
}

impl VertexKind {
    /// The letter in a path's class string, such as `LSDE`.
    pub fn letter(self) -> char {
        match self {
            Self::Light => 'L',
            Self::Diffuse => 'D',
            Self::Specular => 'S',
            Self::Eye => 'E',
        }
    }

    /// A word for panels and tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Light => "light",
            Self::Diffuse => "diffuse",
            Self::Specular => "specular",
            Self::Eye => "eye",
        }
    }

    /// The kind that travels as `code`, or `None` for a code this version does not know.
    pub fn from_code(code: u8) -> Option<Self> {
        [Self::Light, Self::Diffuse, Self::Specular, Self::Eye]
            .into_iter()
            .find(|kind| *kind as u8 == code)
    }
}

/// Which lobe a scattering vertex used. The same points with another event are another path.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[repr(u8)]
pub enum Event {
    /// No scattering: an end of the path.
    End = 0,
    /// Non-Dirac reflection.
    Diffuse = 1,
    /// Mirror reflection.
    Reflect = 2,
    /// Smooth refraction.
    Transmit = 3,
    /// Non-Dirac reflection or refraction by a rough boundary.
    Glossy = 4,
}

impl Event {
    /// The event that travels as `code`, or `None` for a code this version does not know.
    pub fn from_code(code: u8) -> Option<Self> {
        [Self::End, Self::Diffuse, Self::Reflect, Self::Transmit, Self::Glossy]
            .into_iter()
            .find(|event| *event as u8 == code)
    }

    /// True for Dirac events, whose directions no connection can hit.
    pub fn is_specular(self) -> bool {
        matches!(self, Self::Reflect | Self::Transmit)
    }

    /// A word for panels and tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::End => "end",
            Self::Diffuse => "diffuse",
            Self::Reflect => "reflect",
            Self::Transmit => "refract",
            Self::Glossy => "glossy",
        }
    }
}
