//! Selectors as a viewer shows them: regions of four kinds.

use super::condition::segment::SegmentCondition;
use super::condition::vertex::{VertexCheck, VertexCondition};
use super::{Filter, Leaf, Place, Tree, Volume};

/// How selectors of a kind combine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SelectorKind {
    /// Green: the path starts, at the light, in any of them.
    Start,
    /// Red: the path ends, at the camera, in any of them.
    End,
    /// Yellow: a vertex lies in any of them.
    Any,
    /// White: each of them holds a vertex.
    All,
}

impl SelectorKind {
    /// All kinds.
    pub const ALL: [Self; 4] = [Self::Start, Self::End, Self::Any, Self::All];
}

/// A region that paths are selected by.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Selector {
    /// How it combines with others.
    pub kind: SelectorKind,
    /// The region, in the file's units.
    pub volume: Volume,
    /// Whether a segment that passes through is enough, or a vertex must lie inside.
    pub by_segment: bool,
}

impl Selector {
    /// What the selector asks for by itself.
    fn filter(&self) -> Filter {
        let place = match self.kind {
            SelectorKind::Start => Place::Start,
            SelectorKind::End => Place::End,
            SelectorKind::Any | SelectorKind::All => Place::Any,
        };
        Filter::Leaf(if self.by_segment {
            Leaf::Segments(SegmentCondition { place, volume: self.volume })
        } else {
            let test = Tree::Leaf(VertexCheck::Inside(self.volume));
            Leaf::Vertices(VertexCondition { place, test })
        })
    }
}

impl Filter {
    /// What a set of selectors asks for: the kinds are AND-ed; a kind without selectors asks nothing.
    pub fn from_selectors(selectors: &[Selector]) -> Self {
        let groups = SelectorKind::ALL.into_iter().filter_map(|kind| {
            let of_kind = selectors.iter().filter(|selector| selector.kind == kind);
            let mut parts: Vec<Self> = of_kind.map(Selector::filter).collect();
            match (kind, parts.len()) {
                (_, 0) => None,
                (_, 1) => parts.pop(),
                (SelectorKind::All, _) => Some(Self::And(parts)),
                _ => Some(Self::Or(parts)),
            }
        });
        Self::all_of(groups.collect())
    }
}
