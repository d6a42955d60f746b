//! Numbers that a path can be asked for.

use crate::{Event, PathHeader, SceneFrame, VertexKind, VertexRecord};
use glam::Vec3;

/// A number that belongs to a path.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Attribute {
    /// Edges from the light to the camera; 1 is a lamp seen directly.
    Edges,
    /// Length of the polyline, in the file's units.
    Length,
    /// The path's value to a bidirectional path tracer: `1 / S(x)`, in luminance of the image.
    Luminance,
    /// Acceptance probability of the mutation that made the path.
    Acceptance,
    /// Steps that the chain stayed here while it was watched.
    Dwell,
    /// Index of the chain.
    Chain,
    /// The time between two changes of the chain's settings or seed.
    Epoch,
    /// The step of the epoch whose acceptance made the path.
    Step,
    /// Vertices that scatter diffusely.
    Diffuse,
    /// Vertices that scatter glossily.
    Glossy,
    /// Mirror reflections and smooth refractions.
    Specular,
}

/// How a number compares.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Comparison {
    /// `==`.
    Equal,
    /// `!=`.
    NotEqual,
    /// `<`.
    Less,
    /// `<=`.
    AtMost,
    /// `>`.
    Greater,
    /// `>=`.
    AtLeast,
}

impl Attribute {
    /// All of them.
    pub const ALL: [Self; 11] = [
        Self::Edges,
        Self::Length,
        Self::Luminance,
        Self::Acceptance,
        Self::Dwell,
        Self::Chain,
        Self::Epoch,
        Self::Step,
        Self::Diffuse,
        Self::Glossy,
        Self::Specular,
    ];

    /// All of them, with their names and what else they are called.
    pub(super) const NAMES: [(Self, &'static str, Option<&'static str>); 11] = [
        (Self::Edges, "edges", Some("depth")),
        (Self::Length, "length", None),
        (Self::Luminance, "luminance", None),
        (Self::Acceptance, "acceptance", None),
        (Self::Dwell, "dwell", None),
        (Self::Chain, "chain", None),
        (Self::Epoch, "epoch", None),
        (Self::Step, "step", None),
        (Self::Diffuse, "diffuse", None),
        (Self::Glossy, "glossy", None),
        (Self::Specular, "specular", None),
    ];

    /// The attribute called `name`.
    pub fn named(name: &str) -> Option<Self> {
        let found = Self::NAMES.iter().find(|(_, own, other)| *own == name || *other == Some(name));
        found.map(|&(attribute, ..)| attribute)
    }

    /// Its name in a filter's text.
    pub fn name(self) -> &'static str {
        let found = Self::NAMES.iter().find(|(attribute, ..)| *attribute == self);
        found.map_or("edges", |&(_, name, _)| name)
    }

    /// True where every value is a whole number.
    pub fn is_whole(self) -> bool {
        !matches!(self, Self::Length | Self::Luminance | Self::Acceptance)
    }

    /// By how much a number that travels is larger than in the units of the file.
    pub(super) fn scale(self, frame: SceneFrame) -> f64 {
        match self {
            Self::Length => frame.scale,
            Self::Luminance => frame.light.recip(),
            _ => 1.0,
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
    pub(super) fn rounded(self, value: f64) -> f64 {
        if self.is_whole() { value } else { f64::from(value as f32) }
    }
}

fn length(path: &[VertexRecord]) -> f64 {
    let point = |v: &VertexRecord| Vec3::from_array(v.position).as_dvec3();
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

impl Comparison {
    /// All of them.
    pub const ALL: [Self; 6] =
        [Self::AtLeast, Self::AtMost, Self::Equal, Self::Greater, Self::Less, Self::NotEqual];

    /// All of them, with their signs; a sign stands before those that it begins with.
    pub(super) const SIGNS: [(Self, &'static str); 6] = [
        (Self::Equal, "=="),
        (Self::NotEqual, "!="),
        (Self::AtMost, "<="),
        (Self::AtLeast, ">="),
        (Self::Less, "<"),
        (Self::Greater, ">"),
    ];

    /// Its sign in a filter's text.
    pub fn sign(self) -> &'static str {
        let found = Self::SIGNS.iter().find(|(comparison, _)| *comparison == self);
        found.map_or("==", |&(_, sign)| sign)
    }

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
