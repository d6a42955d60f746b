//! Numbers that a path can be asked for. To add one: its word and an arm in each `match` below.

use super::volume::point;
use crate::filter::word::words;
use crate::{Event, PathHeader, SceneFrame, VertexKind, VertexRecord};

words! {
    /// A number that belongs to a path.
    pub enum Attribute: "The number that is asked for" {
        Edges = "edges" or "depth", "edges from the light to the camera; 1 is a lamp seen directly";
        Length = "length", "length of the line, in the units of the scene file";
        Luminance = "luminance", "luminance that the path carries, in the unit of the image";
        Acceptance = "acceptance", "probability with which the path was accepted";
        Dwell = "dwell", "steps that the chain stayed while it was watched";
        Chain = "chain", "number of the chain";
        Epoch = "epoch", "number of the epoch, the time between two changes of the chains' \
            settings or seed";
        Step = "step", "step of the epoch at which the path was accepted";
        Diffuse = "diffuse", "vertices that scatter diffusely";
        Glossy = "glossy", "vertices that scatter glossily";
        Specular = "specular", "vertices on mirrors and clear glass";
    }
}

words! {
    /// How a number compares.
    pub enum Comparison: "How it compares" {
        AtLeast = ">=", "at least";
        AtMost = "<=", "at most";
        Equal = "==" or "=", "exactly";
        Greater = ">", "more than";
        Less = "<", "less than";
        NotEqual = "!=", "anything but";
    }
}

impl Attribute {
    /// True where every value is a whole number.
    pub fn is_whole(self) -> bool {
        match self {
            Self::Length | Self::Luminance | Self::Acceptance => false,
            Self::Edges
            | Self::Dwell
            | Self::Chain
            | Self::Epoch
            | Self::Step
            | Self::Diffuse
            | Self::Glossy
            | Self::Specular => true,
        }
    }

    /// What is usually asked of it.
    pub(super) fn usual(self) -> (Comparison, f64) {
        match self {
            Self::Edges => (Comparison::AtLeast, 3.0),
            Self::Acceptance => (Comparison::AtMost, 0.1),
            Self::Dwell => (Comparison::AtLeast, 100.0),
            Self::Chain | Self::Epoch => (Comparison::Equal, 0.0),
            Self::Length
            | Self::Luminance
            | Self::Step
            | Self::Diffuse
            | Self::Glossy
            | Self::Specular => (Comparison::AtLeast, 1.0),
        }
    }

    /// By how much a number that travels is larger than in the units of the file.
    pub(super) fn scale(self, frame: SceneFrame) -> f64 {
        match self {
            Self::Length => frame.scale,
            Self::Luminance => frame.light.recip(),
            Self::Edges
            | Self::Acceptance
            | Self::Dwell
            | Self::Chain
            | Self::Epoch
            | Self::Step
            | Self::Diffuse
            | Self::Glossy
            | Self::Specular => 1.0,
        }
    }

    /// Its value for a path whose numbers are `scale` times those in the file's units.
    #[inline]
    pub(super) fn value(self, header: &PathHeader, path: &[VertexRecord], scale: f64) -> f64 {
        let count = |is: fn(&VertexRecord) -> bool| path.iter().filter(|v| is(v)).count() as f64;
        match self {
            Self::Edges => path.len().saturating_sub(1) as f64,
            Self::Length => length(path) / scale,
            Self::Luminance => f64::from(header.luminance) / scale,
            Self::Acceptance => f64::from(header.acceptance),
            Self::Dwell => f64::from(header.dwell),
            Self::Chain => f64::from(header.id.chain.0),
            Self::Epoch => f64::from(header.id.epoch),
            Self::Step => header.id.step as f64,
            Self::Diffuse => count(is_diffuse),
            Self::Glossy => count(is_glossy),
            Self::Specular => count(is_specular),
        }
    }

    /// `value` as precise as the attribute is: what travels in single precision compares in it.
    #[inline]
    pub(super) fn rounded(self, value: f64) -> f64 {
        if self.is_whole() { value } else { f64::from(value as f32) }
    }
}

impl Comparison {
    /// Whether `a` compares so to `b`.
    #[inline]
    pub(super) fn holds(self, a: f64, b: f64) -> bool {
        match self {
            Self::Equal => a == b,
            Self::NotEqual => a != b,
            Self::Less => a < b,
            Self::AtMost => a <= b,
            Self::Greater => a > b,
            Self::AtLeast => a >= b,
        }
    }
}

fn length(path: &[VertexRecord]) -> f64 {
    path.windows(2).map(|pair| (point(&pair[1]) - point(&pair[0])).length()).sum()
}

/// True where `vertex` scatters diffusely.
pub(super) fn is_diffuse(vertex: &VertexRecord) -> bool {
    vertex.kind == VertexKind::Diffuse && vertex.event == Event::Diffuse
}

/// True where `vertex` scatters glossily.
pub(super) fn is_glossy(vertex: &VertexRecord) -> bool {
    vertex.event == Event::Glossy
}

/// True where `vertex` is a mirror or a smooth refraction.
pub(super) fn is_specular(vertex: &VertexRecord) -> bool {
    vertex.kind == VertexKind::Specular
}

/// True where `vertex` starts a path, on whatever light.
pub(super) fn is_light(vertex: &VertexRecord) -> bool {
    match vertex.kind {
        VertexKind::Light => true,
        VertexKind::Diffuse | VertexKind::Specular | VertexKind::Eye => false,
    }
}
