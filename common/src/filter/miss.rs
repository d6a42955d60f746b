//! How near paths came to being wanted, where none was.

use glam::DVec3;
use serde::{Deserialize, Serialize};

use super::compile::{CompiledFilter, CompiledLeaf, CompiledTest, Node, point};
use super::{Attribute, Comparison, Place, Volume};
use crate::{PathHeader, PathId, VertexRecord};

/// How far a condition counts that has no measure, such as a name: as far as a region misses by its
/// own size, or a number by itself.
const UNMEASURED: f64 = 1.0;
/// Steps of the search for the point of a segment that is nearest to a box; each leaves two thirds.
const SEARCH: usize = 48;

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
    fn gap(&self, leaf: usize) -> Option<f64> {
        let gap = self.filter.leaves.get(leaf)?.gap(self.header, self.path, self.filter.scale)?;
        gap.is_finite().then_some(gap)
    }

    /// What is missing for `node` to be `wanted`, true or false.
    fn lack(&self, node: &Node, wanted: bool) -> Lack {
        match node {
            Node::Constant(value) if *value == wanted => Lack::NONE,
            Node::Constant(_) => Lack::HOPELESS,
            Node::Not(part) => self.lack(part, !wanted),
            Node::And(parts) if wanted => self.all(parts, wanted),
            Node::Or(parts) if !wanted => self.all(parts, wanted),
            Node::And(parts) | Node::Or(parts) => {
                self.nearest(parts, wanted).map_or(Lack::HOPELESS, |(_, lack)| lack)
            }
            Node::Leaf(leaf) if self.holds(*leaf) == wanted => Lack { asked: 1, ..Lack::NONE },
            Node::Leaf(leaf) => {
                let gap = if wanted { self.gap(*leaf) } else { None };
                let reach = self.filter.leaves.get(*leaf).map_or(1.0, CompiledLeaf::reach);
                let distance =
                    gap.map_or(UNMEASURED, |gap| gap * self.filter.scale_of(*leaf) / reach);
                Lack { missing: 1, distance, asked: 1 }
            }
        }
    }

    fn all(&self, parts: &[Node], wanted: bool) -> Lack {
        parts.iter().fold(Lack::NONE, |sum, part| sum.and(self.lack(part, wanted)))
    }

    /// The part that misses least, of which one is enough.
    fn nearest<'n>(&self, parts: &'n [Node], wanted: bool) -> Option<(&'n Node, Lack)> {
        let lacks = parts.iter().map(|part| (part, self.lack(part, wanted)));
        lacks.reduce(|best, other| if other.1.is_less_than(best.1) { other } else { best })
    }

    /// The conditions that [`Self::lack`] counts as missing.
    fn collect(&self, node: &Node, wanted: bool, failed: &mut Vec<Shortfall>) {
        match node {
            Node::Constant(_) => {}
            Node::Not(part) => self.collect(part, !wanted, failed),
            Node::And(parts) if wanted => {
                for part in parts {
                    self.collect(part, wanted, failed);
                }
            }
            Node::Or(parts) if !wanted => {
                for part in parts {
                    self.collect(part, wanted, failed);
                }
            }
            Node::And(parts) | Node::Or(parts) => {
                if let Some((part, _)) = self.nearest(parts, wanted) {
                    self.collect(part, wanted, failed);
                }
            }
            Node::Leaf(leaf) if self.holds(*leaf) == wanted => {}
            Node::Leaf(leaf) => {
                let by = if wanted { self.gap(*leaf) } else { None };
                failed.push(Shortfall { condition: *leaf as u32, by });
            }
        }
    }
}

impl CompiledFilter {
    /// What turns a gap of a condition back into the unit of its [`CompiledLeaf::reach`].
    fn scale_of(&self, leaf: usize) -> f64 {
        match self.leaves.get(leaf) {
            Some(CompiledLeaf::Vertex { .. } | CompiledLeaf::Segment { .. }) => self.scale,
            _ => 1.0,
        }
    }
}

impl CompiledLeaf {
    /// By how much a path misses the condition: lengths in the file's units, `scale` of which make
    /// one of the file.
    fn gap(&self, header: &PathHeader, path: &[VertexRecord], scale: f64) -> Option<f64> {
        match self {
            Self::Vertex { place, test } => {
                let inner = path.get(1..path.len().saturating_sub(1)).unwrap_or_default();
                let gap = |vertex: &VertexRecord| test.gap(vertex);
                let gap = match place {
                    Place::Start => path.first().and_then(gap),
                    Place::End => path.last().and_then(gap),
                    Place::Any => least(path.iter().map(gap)),
                    Place::All => most(inner.iter().map(gap)),
                };
                gap.map(|gap| gap / scale)
            }
            Self::Segment { place, volume } => {
                let gap = |pair: &[VertexRecord]| match pair {
                    [a, b] => Some(volume.distance_to_segment(point(a), point(b))),
                    _ => None,
                };
                let mut pairs = path.windows(2);
                let gap = match place {
                    Place::Start => pairs.next().and_then(gap),
                    Place::End => pairs.next_back().and_then(gap),
                    Place::Any => least(pairs.map(gap)),
                    Place::All => most(pairs.map(gap)),
                };
                gap.map(|gap| gap / scale)
            }
            Self::Film { min, max } => {
                let outside = |i: usize| outside(header.film[i], min[i], max[i]);
                Some(f64::from(outside(0).hypot(outside(1))))
            }
            Self::Number { attribute, scale, comparison, value } => match comparison {
                Comparison::NotEqual => None,
                _ => Some((attribute.value(header, path, *scale) - value).abs()),
            },
            Self::Range { attribute, scale, least, most } => {
                let own = attribute.value(header, path, *scale);
                Some((least - own).max(own - most).max(0.0))
            }
            Self::LightPath(_) | Self::Strategy(_) => None,
        }
    }

    /// What a gap of one is worth: the size of a region in scene units, or of a number.
    fn reach(&self) -> f64 {
        match self {
            Self::Vertex { test, .. } => test.reach().unwrap_or(1.0),
            Self::Segment { volume, .. } => volume.reach(),
            Self::Number { attribute, value, .. } => reach_of(*attribute, *value),
            Self::Range { attribute, least, .. } => reach_of(*attribute, *least),
            Self::Film { .. } | Self::LightPath(_) | Self::Strategy(_) => 1.0,
        }
    }
}

/// How much of a number is much.
fn reach_of(attribute: Attribute, value: f64) -> f64 {
    let least = if attribute.is_whole() { 1.0 } else { f64::MIN_POSITIVE };
    value.abs().max(least)
}

/// The least of the gaps that can be measured.
fn least(gaps: impl Iterator<Item = Option<f64>>) -> Option<f64> {
    gaps.flatten().reduce(f64::min)
}

/// The largest of the gaps, all of which must be measured.
fn most(gaps: impl Iterator<Item = Option<f64>>) -> Option<f64> {
    gaps.reduce(|a, b| Some(a?.max(b?))).flatten()
}

/// How far a number lies outside a range.
fn outside(x: f32, min: f32, max: f32) -> f32 {
    (min - x).max(x - max).max(0.0)
}

impl CompiledTest {
    /// How far a vertex is from where the test holds, in scene units; `None` without a measure.
    fn gap(&self, vertex: &VertexRecord) -> Option<f64> {
        if self.holds(vertex) {
            return Some(0.0);
        }
        match self {
            Self::Inside(volume) => Some(volume.distance(point(vertex))),
            Self::And(parts) => most(parts.iter().map(|part| part.gap(vertex))),
            Self::Or(parts) => least(parts.iter().map(|part| part.gap(vertex))),
            _ => None,
        }
    }

    /// The size of the first region that it names.
    fn reach(&self) -> Option<f64> {
        match self {
            Self::Inside(volume) => Some(volume.reach()),
            Self::And(parts) | Self::Or(parts) => parts.iter().find_map(Self::reach),
            _ => None,
        }
    }
}

impl Volume {
    /// How far outside `point` lies; zero inside.
    fn distance(&self, point: DVec3) -> f64 {
        match *self {
            Self::Sphere { centre, radius } => ((point - centre).length() - radius).max(0.0),
            Self::Box { min, max } => (point - point.clamp(min, max)).length(),
        }
    }

    /// How far the segment from `a` to `b` passes by; zero where it meets the region. The distance to
    /// a convex region is convex along the segment, so that a search by thirds finds the least.
    fn distance_to_segment(&self, a: DVec3, b: DVec3) -> f64 {
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..SEARCH {
            let third = (high - low) / 3.0;
            let [left, right] = [low + third, high - third];
            if self.distance(a.lerp(b, left)) <= self.distance(a.lerp(b, right)) {
                high = right;
            } else {
                low = left;
            }
        }
        self.distance(a.lerp(b, 0.5 * (low + high)))
    }

    /// Its size: a radius, or half of a box's diagonal.
    fn reach(&self) -> f64 {
        let reach = match *self {
            Self::Sphere { radius, .. } => radius,
            Self::Box { min, max } => 0.5 * (max - min).length(),
        };
        reach.max(f64::MIN_POSITIVE)
    }
}
