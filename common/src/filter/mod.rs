//! Which paths: one boolean tree over conditions, with a text form.
//!
//! A [`Filter`] is parsed from its text or put together from [`Selector`]s, and printed back to the
//! same tree; a [`FilterText`] keeps both. Every condition is one file in `condition/`, which
//! describes itself once to whoever reads, prints, completes or edits it ([`Form`]).
//! [`Filter::compile`] binds a filter to a scene, which turns names into indices and coordinates into
//! the scene's own; the [`CompiledFilter`] then judges paths without allocating. [`FilterTally`]
//! counts what it saw, and which share of the image's energy that is.

mod compile;
mod complete;
pub mod condition;
mod error;
mod lpe;
mod miss;
mod offers;
mod parse;
mod print;
mod quote;
mod reader;
mod scene;
mod selector;
mod tally;
mod text;
mod tree;
mod word;

pub use compile::{CompiledFilter, MAX_LEAVES};
pub use complete::{Choice, Completion, complete};
pub use condition::film::FilmCondition;
pub use condition::place::Place;
pub use condition::vertex::{VertexCheck, VertexTest};
pub use condition::volume::Volume;
pub use condition::{Described, Form, Leaf, NumberPart, Proposal, Spot, Unit};
pub use error::FilterError;
pub use lpe::LightPathExpression;
pub use miss::{NearestMiss, Shortfall};
pub use scene::{FilterMaterial, FilterObject, FilterScene, is_same_strategy};
pub use selector::{Selector, SelectorKind};
pub use tally::{FilterCounts, FilterTally};
pub use text::{FilterText, MAX_FILTER_BYTES};
pub use tree::Tree;
pub use word::{NameList, Stop, Walk, Word, Worded};

/// How much larger than needed a region or a bound becomes that is widened for a path.
const MARGIN: f64 = 1.02;

/// Which paths are wanted.
///
/// Positions are in the units of the scene file, so that a text means the same wherever it goes.
pub type Filter = Tree<Leaf>;

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
