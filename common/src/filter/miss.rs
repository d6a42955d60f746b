//! How near paths came to being wanted, where none was.

use serde::{Deserialize, Serialize};

use super::condition::Gap;
use super::{CompiledFilter, Tree};
use crate::{PathHeader, PathId, VertexRecord};

/// How far a condition counts that has no measure, such as a name: as far as a region misses by its
/// own size, or a number by itself.
const UNMEASURED: f64 = 1.0;

/// The path that came nearest to being wanted, and what it lacks.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct NearestMiss {
    /// The path.
    pub path: PathId,
    /// How many conditions it should meet; of alternatives, only the nearest one counts.
    pub asked: u32,
    /// Those of them that it does not meet; empty where no path can be wanted.
    pub failed: Vec<Shortfall>,
}

/// A condition that a path does not meet.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Shortfall {
    /// The condition, counted as [`CompiledFilter::condition_texts`] does.
    pub condition: u32,
    /// By how much: a distance in the units of the scene file, film coordinates or the units of the
    /// number that is compared. Absent where there is no measure, as for names and negations.
    pub by: Option<f64>,
}

/// How far a path is from being wanted; the less, the nearer.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub(super) struct Lack {
    /// Conditions that it should meet and does not.
    missing: u32,
    /// By how much all together, each over its own scale.
    distance: f64,
    /// Conditions that it should meet.
    asked: u32,
}

impl Lack {
    const NONE: Self = Self { missing: 0, distance: 0.0, asked: 0 };
    /// No path can do what is asked.
    const HOPELESS: Self = Self { missing: 1, distance: f64::INFINITY, asked: 1 };

    fn and(self, other: Self) -> Self {
        Self {
            missing: self.missing + other.missing,
            distance: self.distance + other.distance,
            asked: self.asked + other.asked,
        }
    }

    /// True when less is missing than in `other`.
    pub(super) fn is_less_than(self, other: Self) -> bool {
        (self.missing, self.distance) < (other.missing, other.distance)
    }
}

/// A path whose conditions are known.
struct Judged<'a> {
    filter: &'a CompiledFilter,
    header: &'a PathHeader,
    path: &'a [VertexRecord],
    conditions: u64,
}

impl CompiledFilter {
    /// How far a path that meets `conditions` is from being wanted.
    pub(super) fn lack(&self, header: &PathHeader, path: &[VertexRecord], conditions: u64) -> Lack {
        Judged { filter: self, header, path, conditions }.lack(&self.root, true)
    }

    /// What a path that meets `conditions` lacks.
    pub fn miss(&self, header: &PathHeader, path: &[VertexRecord], conditions: u64) -> NearestMiss {
        let judged = Judged { filter: self, header, path, conditions };
        let asked = judged.lack(&self.root, true).asked;
        let mut failed = Vec::new();
        judged.collect(&self.root, true, &mut failed);
        NearestMiss { path: header.id, asked, failed }
    }
}

impl Judged<'_> {
    fn holds(&self, leaf: usize) -> bool {
        self.conditions >> leaf & 1 == 1
    }

    /// By how much the path misses a condition that it should meet.
    fn gap(&self, leaf: usize) -> Option<Gap> {
        let gap = self.filter.leaves.get(leaf)?.gap(self.header, self.path)?;
        (gap.by.is_finite() && gap.relative.is_finite()).then_some(gap)
    }

    /// What is missing for `node` to be `wanted`, true or false.
    fn lack(&self, node: &Tree<usize>, wanted: bool) -> Lack {
        match node {
            Tree::Constant(value) if *value == wanted => Lack::NONE,
            Tree::Constant(_) => Lack::HOPELESS,
            Tree::Not(part) => self.lack(part, !wanted),
            Tree::And(parts) if wanted => self.all(parts, wanted),
            Tree::Or(parts) if !wanted => self.all(parts, wanted),
            Tree::And(parts) | Tree::Or(parts) => {
                self.nearest(parts, wanted).map_or(Lack::HOPELESS, |(_, lack)| lack)
            }
            Tree::Leaf(leaf) if self.holds(*leaf) == wanted => Lack { asked: 1, ..Lack::NONE },
            Tree::Leaf(leaf) => {
                let gap = if wanted { self.gap(*leaf) } else { None };
                let distance = gap.map_or(UNMEASURED, |gap| gap.relative);
                Lack { missing: 1, distance, asked: 1 }
            }
        }
    }

    fn all(&self, parts: &[Tree<usize>], wanted: bool) -> Lack {
        parts.iter().fold(Lack::NONE, |sum, part| sum.and(self.lack(part, wanted)))
    }

    /// The part that misses least, of which one is enough.
    fn nearest<'n>(
        &self,
        parts: &'n [Tree<usize>],
        wanted: bool,
    ) -> Option<(&'n Tree<usize>, Lack)> {
        let lacks = parts.iter().map(|part| (part, self.lack(part, wanted)));
        lacks.reduce(|best, other| if other.1.is_less_than(best.1) { other } else { best })
    }

    /// The conditions that [`Self::lack`] counts as missing.
    fn collect(&self, node: &Tree<usize>, wanted: bool, failed: &mut Vec<Shortfall>) {
        match node {
            Tree::Constant(_) => {}
            Tree::Not(part) => self.collect(part, !wanted, failed),
            Tree::And(parts) if wanted => {
                for part in parts {
                    self.collect(part, wanted, failed);
                }
            }
            Tree::Or(parts) if !wanted => {
                for part in parts {
                    self.collect(part, wanted, failed);
                }
            }
            Tree::And(parts) | Tree::Or(parts) => {
                if let Some((part, _)) = self.nearest(parts, wanted) {
                    self.collect(part, wanted, failed);
                }
            }
            Tree::Leaf(leaf) if self.holds(*leaf) == wanted => {}
            Tree::Leaf(leaf) => {
                let by = if wanted { self.gap(*leaf) } else { None };
                failed.push(Shortfall { condition: *leaf as u32, by: by.map(|gap| gap.by) });
            }
        }
    }
}
