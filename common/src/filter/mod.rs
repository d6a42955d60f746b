//! Which paths: one boolean tree over conditions, with a text form.
//!
//! A [`Filter`] is parsed from its text or put together from [`Selector`]s, and printed back to the
//! same tree. [`Filter::compile`] binds it to a scene, which turns names into indices and
//! coordinates into the scene's own; the [`CompiledFilter`] then judges paths without allocating.
//! [`FilterTally`] counts what it saw, and which share of the image's energy that is.

mod attribute;
mod compile;
mod error;
mod lpe;
mod miss;
mod number;
mod parse;
mod print;
mod scene;
mod selector;
mod syntax;
mod tally;
mod volume;

pub use attribute::{Attribute, Comparison};
pub use compile::{CompiledFilter, MAX_LEAVES};
pub use error::FilterError;
pub use lpe::LightPathExpression;
pub use miss::{NearestMiss, Shortfall};
pub use parse::MAX_FILTER_BYTES;
pub use scene::{FilterObject, FilterScene};
pub use selector::{Selector, SelectorKind};
pub use tally::{FilterCounts, FilterTally};
pub use volume::Volume;

/// Which paths are wanted.
///
/// Positions are in the units of the scene file, so that a text means the same wherever it goes.
#[derive(Clone, Debug, PartialEq)]
pub enum Filter {
    /// All paths, or none.
    Constant(bool),
    /// The paths that the other one does not want.
    Not(Box<Self>),
    /// The paths that all of them want.
    And(Vec<Self>),
    /// The paths that any of them wants.
    Or(Vec<Self>),
    /// The paths that meet a condition.
    Leaf(Leaf),
}

impl Default for Filter {
    fn default() -> Self {
        Self::Constant(true)
    }
}

/// One condition.
#[derive(Clone, Debug, PartialEq)]
pub enum Leaf {
    /// Something holds at vertices.
    Vertex {
        /// At which.
        place: Place,
        /// What.
        test: VertexTest,
    },
    /// Segments pass through a region.
    Segment {
        /// Which.
        place: Place,
        /// The region.
        volume: Volume,
    },
    /// The sequence of events fits an expression.
    LightPath(LightPathExpression),
    /// The film point lies in a rectangle.
    Film {
        /// Least `u` (to the right) and `v` (downwards).
        min: [f64; 2],
        /// Largest `u` and `v`.
        max: [f64; 2],
    },
    /// A number compares to another.
    Number {
        /// The number.
        attribute: Attribute,
        /// How it compares.
        comparison: Comparison,
        /// To what.
        value: f64,
    },
    /// A number lies in a range, both ends included.
    Range {
        /// The number.
        attribute: Attribute,
        /// The least value.
        least: f64,
        /// The largest value.
        most: f64,
    },
    /// One of these strategies made the path; `seed` means none did.
    Strategy(Vec<Name>),
}

/// Which vertices or segments of a path a condition is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// The one at the light.
    Start,
    /// The one at the camera.
    End,
    /// At least one of them, the ends included.
    Any,
    /// Every vertex between the ends, or every segment. Holds where there is none.
    All,
}

impl Place {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Start, Self::End, Self::Any, Self::All];

    pub(super) const NAMES: [(Self, &'static str); 4] =
        [(Self::Start, "start"), (Self::End, "end"), (Self::Any, "any"), (Self::All, "all")];
}

/// What may hold at one vertex. All parts of one test are about the same vertex.
#[derive(Clone, Debug, PartialEq)]
pub enum VertexTest {
    /// It lies in a region.
    Inside(Volume),
    /// It lies on something that has a name.
    On(Named, Name),
    /// This is what happens there.
    Is(VertexClass),
    /// The other does not hold.
    Not(Box<Self>),
    /// All hold.
    And(Vec<Self>),
    /// At least one holds.
    Or(Vec<Self>),
}

/// What has names.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Named {
    /// An object of the scene.
    Object,
    /// A material.
    Material,
    /// A light, by the name of its material; the vertex must be the path's start.
    Light,
}

impl Named {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Object, Self::Material, Self::Light];

    /// Its word in a filter's text.
    pub fn name(self) -> &'static str {
        Self::NAMES.iter().find(|(kind, _)| *kind == self).map_or("", |&(_, name)| name)
    }

    pub(super) const NAMES: [(Self, &'static str); 3] =
        [(Self::Object, "object"), (Self::Material, "material"), (Self::Light, "light")];
}

/// What can happen at a vertex.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum VertexClass {
    /// Diffuse scattering.
    Diffuse,
    /// Glossy scattering.
    Glossy,
    /// A mirror or a smooth refraction.
    Specular,
    /// Mirror reflection.
    Reflect,
    /// Smooth refraction.
    Refract,
    /// The start on a light.
    Light,
    /// The end on the lens.
    Camera,
}

impl VertexClass {
    /// All of them.
    pub const ALL: [Self; 7] = [
        Self::Diffuse,
        Self::Glossy,
        Self::Specular,
        Self::Reflect,
        Self::Refract,
        Self::Light,
        Self::Camera,
    ];

    /// Its word in a filter's text.
    pub fn name(self) -> &'static str {
        Self::NAMES.iter().find(|(class, _)| *class == self).map_or("", |&(_, name)| name)
    }

    pub(super) const NAMES: [(Self, &'static str); 7] = [
        (Self::Diffuse, "diffuse"),
        (Self::Glossy, "glossy"),
        (Self::Specular, "specular"),
        (Self::Reflect, "reflect"),
        (Self::Refract, "refract"),
        (Self::Light, "light"),
        (Self::Camera, "camera"),
    ];
}

/// A name in a filter, and where in the text it stands.
#[derive(Clone, Debug, Default)]
pub struct Name {
    /// The name.
    pub text: String,
    /// Bytes before it in the text it was read from.
    pub offset: usize,
}

impl PartialEq for Name {
    fn eq(&self, other: &Self) -> bool {
        self.text == other.text
    }
}

impl From<&str> for Name {
    fn from(text: &str) -> Self {
        Self { text: text.to_owned(), offset: 0 }
    }
}

#[cfg(test)]
mod tests;
