//! Conditions: what a filter may ask of one path.
//!
//! To add one: write its file with an `impl Condition`, declare the module, add a line to the list in
//! `conditions!` below and an example of its text to `docs/FILTERS.md`. Parser, printer, completion,
//! complaints, the rows and menus of viewers and the laws that tests hold follow from it.
//! `docs/EXTEND.md` walks through it.

pub mod film;
pub mod light_path;
pub mod number;
pub mod segment;
pub mod strategy;
pub mod vertex;

use std::fmt::{self, Debug, Display, Formatter};

use super::form::{Described, Form, Proposal, Spot, Walk};
use super::parse::Leaves;
use super::print::text_of;
use super::{FilterError, FilterScene};
use crate::{PathHeader, VertexRecord};

/// One kind of condition. Its description is all that a parser, a printer, a user's hand on it and a
/// random test need.
pub(super) trait Condition: Described + Clone + Debug + Default + PartialEq {
    /// The condition bound to a scene.
    type Predicate: Predicate;

    /// A text of it, for complaints and the manual.
    const EXAMPLE: &'static str;

    /// Binds it to a scene: names become indices, coordinates the scene's own.
    fn bind(&self, scene: &FilterScene) -> Result<Self::Predicate, FilterError>;

    /// What a menu offers of it; regions lie at `spot`.
    fn proposals(scene: &FilterScene, spot: Spot) -> Vec<Proposal<Self>>;

    /// The condition widened by what a path misses, see [`Gap::by`], and what that is called.
    fn widened(&self, _by: f64) -> Option<(&'static str, Self)> {
        None
    }

    /// What somebody should know who wrote this.
    fn remark(&self) -> Option<&'static str> {
        None
    }
}

/// A condition bound to a scene, which judges paths without allocating.
pub(super) trait Predicate: Clone + Debug {
    /// Whether a path meets it.
    fn holds(&self, header: &PathHeader, path: &[VertexRecord]) -> bool;

    /// By how much a path misses it; `None` where there is no measure.
    fn gap(&self, _header: &PathHeader, _path: &[VertexRecord]) -> Option<Gap> {
        None
    }
}

/// By how much a path misses a condition.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Gap {
    /// For people: in the units of the scene file, film coordinates or the unit of a number.
    pub(super) by: f64,
    /// In the size of the region, or of the number that is asked for.
    pub(super) relative: f64,
}

/// Makes of one list the enums of conditions, free and bound, and every `match` on them.
macro_rules! conditions {
    ($($(#[$doc:meta])* $variant:ident($condition:ty),)*) => {
        /// One condition.
        #[derive(Clone, Debug, PartialEq)]
        pub enum Leaf {
            $($(#[$doc])* $variant($condition),)*
        }

        /// A condition bound to a scene.
        #[derive(Clone, Debug)]
        pub(super) enum BoundLeaf {
            $($variant(<$condition as Condition>::Predicate),)*
        }

        impl Described for Leaf {
            fn describe(&mut self, form: &mut dyn Form) -> Walk {
                match self {
                    $(Self::$variant(condition) => condition.describe(form),)*
                }
            }
        }

        impl Leaves for Leaf {
            fn kinds() -> impl Iterator<Item = (Self, &'static str)> {
                [$((
                    Self::$variant(<$condition>::default()),
                    <$condition as Condition>::EXAMPLE,
                ),)*].into_iter()
            }

            fn summary() -> Option<String> {
                let examples = [$(<$condition as Condition>::EXAMPLE),*];
                Some(format!("a condition such as `{}`", examples.join("`, `")))
            }
        }

        impl Leaf {
            /// A text of each condition.
            pub const EXAMPLES: &'static [&'static str] = &[
                $(<$condition as Condition>::EXAMPLE),*
            ];

            /// What a menu offers on paths of a scene; regions lie at `spot`.
            pub fn proposals(scene: &FilterScene, spot: Spot) -> Vec<Proposal<Self>> {
                let mut all = Vec::new();
                $({
                    let own = <$condition as Condition>::proposals(scene, spot);
                    all.extend(own.into_iter().map(|proposal| proposal.map(Self::$variant)));
                })*
                all
            }

            /// The condition widened by what a path misses, and what that is called.
            pub fn widened(&self, by: f64) -> Option<(&'static str, Self)> {
                match self {
                    $(Self::$variant(condition) => {
                        let (label, wide) = condition.widened(by)?;
                        Some((label, Self::$variant(wide)))
                    })*
                }
            }

            /// What somebody should know who wrote this.
            pub fn remark(&self) -> Option<&'static str> {
                match self {
                    $(Self::$variant(condition) => condition.remark(),)*
                }
            }

            pub(super) fn bind(&self, scene: &FilterScene) -> Result<BoundLeaf, FilterError> {
                Ok(match self {
                    $(Self::$variant(condition) => BoundLeaf::$variant(condition.bind(scene)?),)*
                })
            }
        }

        impl BoundLeaf {
            #[inline]
            pub(super) fn holds(&self, header: &PathHeader, path: &[VertexRecord]) -> bool {
                match self {
                    $(Self::$variant(predicate) => predicate.holds(header, path),)*
                }
            }

            pub(super) fn gap(&self, header: &PathHeader, path: &[VertexRecord]) -> Option<Gap> {
                match self {
                    $(Self::$variant(predicate) => predicate.gap(header, path),)*
                }
            }
        }
    };
}

conditions! {
    /// Something holds at vertices.
    Vertices(vertex::VertexCondition),
    /// Segments pass through a region.
    Segments(segment::SegmentCondition),
    /// The sequence of events fits an expression.
    LightPath(light_path::LightPathCondition),
    /// The film point lies in a rectangle.
    Film(film::FilmCondition),
    /// A number lies in a range.
    Number(number::NumberCondition),
    /// One of these strategies made the path.
    Strategy(strategy::StrategyCondition),
}

impl Display for Leaf {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_str(&text_of(self))
    }
}
