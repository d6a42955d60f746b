//! Conditions: what a filter may ask of one path.
//!
//! To add one: write its file with an `impl Condition`, declare the module, add a line to the list in
//! `conditions!` below and an example of its text to `docs/FILTERS.md`. Parser, printer, completion,
//! complaints, the rows and menus of viewers and the laws that tests hold follow from it.
//! `docs/EXTEND.md` walks through it.
//!
//! A condition describes itself to a [`Form`]: its words, signs, numbers and names in the order of its
//! text. Whoever implements that trait reads it from a text, prints it, lets a user edit it or draws one
//! at random; completion and complaints come from the reader. So none of them has to know any
//! condition, and none can disagree with another.

pub mod attribute;
pub mod film;
pub mod light_path;
pub mod number;
pub mod place;
pub mod segment;
pub mod strategy;
pub mod vertex;
pub mod volume;

use std::fmt::Debug;

use glam::DVec3;

use super::word::{NameList, Walk, Word, Worded};
use super::{FilterError, FilterScene, LightPathExpression, Name};
use crate::{PathHeader, VertexRecord};

use vertex::VertexTest;

/// Something that describes itself to a form.
pub trait Described {
    /// Names every part in the order of the text. A part may decide which parts follow it: they are
    /// read, shown and changed one after the other.
    fn describe(&mut self, form: &mut dyn Form) -> Walk;
}

/// Whoever follows a description.
pub trait Form {
    /// A word that is always the same.
    fn word(&mut self, word: &'static Word) -> Walk;

    /// A sign between the other parts, with the blanks that are printed around it. What it means is
    /// blank where nobody needs to be told.
    fn sign(&mut self, sign: &'static str, meaning: &'static str) -> Walk;

    /// One of several words, by its number; `about` tells what is chosen.
    fn choice(&mut self, about: &'static str, words: &[Word], chosen: &mut usize) -> Walk;

    /// A number.
    fn number(&mut self, about: &NumberPart, value: &mut f64) -> Walk;

    /// The name of something in the scene.
    fn name(&mut self, list: NameList, name: &mut Name) -> Walk;

    /// One or several such names, separated by commas.
    fn names(&mut self, list: NameList, names: &mut Vec<Name>) -> Walk;

    /// A light path expression in quotes.
    fn expression(&mut self, expression: &mut LightPathExpression) -> Walk;

    /// What is asked of one vertex.
    fn vertex(&mut self, test: &mut VertexTest) -> Walk;

    /// A place in what was followed so far, for [`Self::check`].
    fn mark(&self) -> usize {
        0
    }

    /// What is wrong with the parts since a mark, where something is.
    fn check(&mut self, since: usize, complaint: Option<&'static str>) -> Walk;

    /// Where a region lies that is asked for without telling where.
    fn spot(&self) -> Spot {
        Spot::default()
    }
}

/// What a number in a condition is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NumberPart {
    /// What it says.
    pub about: &'static str,
    /// The least value that makes sense given its neighbours.
    pub least: f64,
    /// The largest.
    pub most: f64,
    /// Its unit.
    pub unit: Unit,
}

/// What a number counts or measures, which tells in which steps it changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unit {
    /// Whole things.
    Count,
    /// Lengths in the scene.
    Length,
    /// Coordinates on the film, where 1 is all of it.
    Film,
    /// Anything else.
    Plain,
}

/// A place in a scene and a length, in the units of its file: where a new region lies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spot {
    /// The place.
    pub centre: DVec3,
    /// The length.
    pub radius: f64,
}

impl Default for Spot {
    fn default() -> Self {
        Self { centre: DVec3::ZERO, radius: 1.0 }
    }
}

/// Something new that a menu can offer.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Proposal<T> {
    /// The menu that it stands in, or the topmost one.
    pub menu: Option<&'static str>,
    /// The line of the menu.
    pub label: String,
    /// What it means.
    pub meaning: &'static str,
    /// What is made; nothing if the line only says that there is nothing to choose.
    pub made: Option<T>,
}

impl<T> Proposal<T> {
    /// The same line, which makes something else of it.
    pub(super) fn map<U>(self, make: impl FnOnce(T) -> U) -> Proposal<U> {
        let Self { menu, label, meaning, made } = self;
        Proposal { menu, label, meaning, made: made.map(make) }
    }
}

/// Lets the form choose among the values of a closed set.
pub(super) fn choose<T: Worded>(form: &mut dyn Form, value: &mut T) -> Walk {
    let words: Vec<Word> = T::WORDS.iter().map(|&(_, word)| word).collect();
    let mut chosen = T::WORDS.iter().position(|(known, _)| known == value).unwrap_or(0);
    form.choice(T::ABOUT, &words, &mut chosen)?;
    if let Some(&(found, _)) = T::WORDS.get(chosen) {
        *value = found;
    }
    Ok(())
}

/// What stands at the leaves of a tree that is read.
pub(super) trait Leaves: Described + Sized {
    /// Something to read each kind of leaf into, with an example of its text.
    fn kinds() -> impl Iterator<Item = (Self, &'static str)>;

    /// What a leaf is, where none of them begins as the text goes on; nothing where their first words
    /// are told.
    fn summary() -> Option<String> {
        None
    }
}

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
