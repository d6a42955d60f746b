//! A filter bound to a scene: names are indices, coordinates are the scene's own.

use std::ops::Range;

use glam::{DVec3, Vec3};

use super::attribute::{is_diffuse, is_glossy, is_light, is_specular};
use super::lpe::LightPathAutomaton;
use super::syntax::MAX_DEPTH;
use super::{
    Attribute, Comparison, Filter, FilterError, FilterScene, Leaf, Named, Place, VertexClass,
    VertexTest, Volume,
};
use crate::{Event, PathHeader, VertexKind, VertexRecord};

/// Most conditions of one filter: their outcomes are bits of one number.
pub const MAX_LEAVES: usize = 64;
/// Most parts of one condition about a vertex.
const MAX_VERTEX_TESTS: usize = 256;

/// A filter that judges the paths of one scene, without allocating.
#[derive(Clone, Debug)]
pub struct CompiledFilter {
    text: String,
    pub(super) root: Node,
    pub(super) leaves: Vec<CompiledLeaf>,
    leaf_texts: Vec<String>,
    /// Scene units that make one of the file.
    pub(super) scale: f64,
}

#[derive(Clone, Debug)]
pub(super) enum Node {
    Constant(bool),
    Not(Box<Self>),
    And(Vec<Self>),
    Or(Vec<Self>),
    Leaf(usize),
}

#[derive(Clone, Debug)]
pub(super) enum CompiledLeaf {
    Vertex { place: Place, test: CompiledTest },
    Segment { place: Place, volume: Volume },
    LightPath(Box<LightPathAutomaton>),
    Film { min: [f32; 2], max: [f32; 2] },
    Number { attribute: Attribute, scale: f64, comparison: Comparison, value: f64 },
    Range { attribute: Attribute, scale: f64, least: f64, most: f64 },
    Strategy(Vec<u8>),
}

#[derive(Clone, Debug)]
pub(super) enum CompiledTest {
    Inside(Volume),
    /// One flag a material.
    Material(Vec<bool>),
    /// Like [`Self::Material`], for the start of a path only.
    Light(Vec<bool>),
    Object(Vec<Range<u32>>),
    Is(VertexClass),
    Not(Box<Self>),
    And(Vec<Self>),
    Or(Vec<Self>),
}

impl Filter {
    /// Binds the filter to a scene.
    pub fn compile(&self, scene: &FilterScene) -> Result<CompiledFilter, FilterError> {
        let mut compiler = Compiler { scene, leaves: Vec::new(), leaf_texts: Vec::new() };
        let root = compiler.node(self, 0)?;
        let Compiler { leaves, leaf_texts, .. } = compiler;
        let scale = scene.frame.scale;
        Ok(CompiledFilter { text: self.to_string(), root, leaves, leaf_texts, scale })
    }
}

struct Compiler<'a> {
    scene: &'a FilterScene,
    leaves: Vec<CompiledLeaf>,
    leaf_texts: Vec<String>,
}

/// A complaint about a tree that no text could have made, so that it has no position.
fn refused<T>(message: impl Into<String>) -> Result<T, FilterError> {
    Err(FilterError::new(0..0, message))
}

impl Compiler<'_> {
    fn node(&mut self, filter: &Filter, depth: usize) -> Result<Node, FilterError> {
        if depth > MAX_DEPTH {
            return refused(format!("nested deeper than {MAX_DEPTH} levels; flatten the filter"));
        }
        let mut parts = |parts: &[Filter]| {
            parts.iter().map(|part| self.node(part, depth + 1)).collect::<Result<Vec<_>, _>>()
        };
        Ok(match filter {
            Filter::Constant(value) => Node::Constant(*value),
            Filter::Not(part) => Node::Not(Box::new(self.node(part, depth + 1)?)),
            Filter::And(all) => Node::And(parts(all)?),
            Filter::Or(any) => Node::Or(parts(any)?),
            Filter::Leaf(leaf) => {
                if self.leaves.len() == MAX_LEAVES {
                    let message = format!("more than {MAX_LEAVES} conditions; use fewer");
                    return refused(message);
                }
                let compiled = self.leaf(leaf, depth)?;
                self.leaves.push(compiled);
                self.leaf_texts.push(leaf.to_string());
                Node::Leaf(self.leaves.len() - 1)
            }
        })
    }

    fn leaf(&self, leaf: &Leaf, depth: usize) -> Result<CompiledLeaf, FilterError> {
        let frame = self.scene.frame;
        Ok(match leaf {
            Leaf::Vertex { place, test } => {
                let test = self.vertex_test(test, depth, &mut 0)?;
                CompiledLeaf::Vertex { place: *place, test }
            }
            Leaf::Segment { place, volume } => {
                CompiledLeaf::Segment { place: *place, volume: self.volume(volume)? }
            }
            Leaf::LightPath(expression) => {
                CompiledLeaf::LightPath(Box::new(expression.compile(self.scene)?))
            }
            Leaf::Film { min, max } => CompiledLeaf::Film {
                min: min.map(|coordinate| coordinate as f32),
                max: max.map(|coordinate| coordinate as f32),
            },
            &Leaf::Number { attribute, comparison, value } => {
                let (scale, value) = (attribute.scale(frame), attribute.rounded(value));
                CompiledLeaf::Number { attribute, scale, comparison, value }
            }
            &Leaf::Range { attribute, least, most } => CompiledLeaf::Range {
                attribute,
                scale: attribute.scale(frame),
                least: attribute.rounded(least),
                most: attribute.rounded(most),
            },
            Leaf::Strategy(names) => {
                let named = names.iter().map(|name| self.scene.strategy_named(name));
                CompiledLeaf::Strategy(named.collect::<Result<_, _>>()?)
            }
        })
    }

    fn vertex_test(
        &self,
        test: &VertexTest,
        depth: usize,
        count: &mut usize,
    ) -> Result<CompiledTest, FilterError> {
        *count += 1;
        if depth > MAX_DEPTH || *count > MAX_VERTEX_TESTS {
            return refused("a condition about a vertex is too large; split it");
        }
        let mut parts = |parts: &[VertexTest]| {
            let compile = |part| self.vertex_test(part, depth + 1, count);
            parts.iter().map(compile).collect::<Result<Vec<_>, _>>()
        };
        Ok(match test {
            VertexTest::Inside(volume) => CompiledTest::Inside(self.volume(volume)?),
            VertexTest::On(Named::Object, name) => {
                CompiledTest::Object(self.scene.objects_named(name)?)
            }
            VertexTest::On(Named::Material, name) => {
                CompiledTest::Material(self.scene.materials_named(name)?)
            }
            VertexTest::On(Named::Light, name) => {
                CompiledTest::Light(self.scene.materials_named(name)?)
            }
            VertexTest::Is(class) => CompiledTest::Is(*class),
            VertexTest::Not(part) => {
                CompiledTest::Not(Box::new(self.vertex_test(part, depth + 1, count)?))
            }
            VertexTest::And(all) => CompiledTest::And(parts(all)?),
            VertexTest::Or(any) => CompiledTest::Or(parts(any)?),
        })
    }

    /// The region in scene units.
    fn volume(&self, volume: &Volume) -> Result<Volume, FilterError> {
        if let Some(complaint) = volume.complaint() {
            return refused(complaint);
        }
        let frame = self.scene.frame;
        Ok(match *volume {
            Volume::Sphere { centre, radius } => {
                Volume::Sphere { centre: frame.to_scene(centre), radius: radius * frame.scale }
            }
            Volume::Box { min, max } => {
                Volume::Box { min: frame.to_scene(min), max: frame.to_scene(max) }
            }
        })
    }
}

impl CompiledFilter {
    /// The filter's text.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// True when every path is wanted, whatever it is.
    pub fn wants_all(&self) -> bool {
        matches!(self.root, Node::Constant(true))
    }

    /// The text of each condition, in the order of the bits of [`Self::conditions`].
    pub fn condition_texts(&self) -> &[String] {
        &self.leaf_texts
    }

    /// True when the path is wanted.
    #[inline]
    pub fn matches(&self, header: &PathHeader, path: &[VertexRecord]) -> bool {
        self.root.holds(&|leaf| self.leaves[leaf].holds(header, path))
    }

    /// Which conditions the path meets, each by itself: bit `i` for condition `i`.
    pub fn conditions(&self, header: &PathHeader, path: &[VertexRecord]) -> u64 {
        let bit = |(i, leaf): (usize, &CompiledLeaf)| u64::from(leaf.holds(header, path)) << i;
        self.leaves.iter().enumerate().map(bit).sum()
    }

    /// Whether a path is wanted that meets these conditions.
    pub fn wants(&self, conditions: u64) -> bool {
        self.root.holds(&|leaf| conditions >> leaf & 1 == 1)
    }
}

impl Node {
    fn holds(&self, leaf: &impl Fn(usize) -> bool) -> bool {
        match self {
            Self::Constant(value) => *value,
            Self::Not(part) => !part.holds(leaf),
            Self::And(parts) => parts.iter().all(|part| part.holds(leaf)),
            Self::Or(parts) => parts.iter().any(|part| part.holds(leaf)),
            Self::Leaf(index) => leaf(*index),
        }
    }
}

impl CompiledLeaf {
    fn holds(&self, header: &PathHeader, path: &[VertexRecord]) -> bool {
        match self {
            Self::Vertex { place, test } => {
                let inner = path.get(1..path.len().saturating_sub(1)).unwrap_or_default();
                of_place(*place, path, inner, |vertex| test.holds(vertex))
            }
            Self::Segment { place, volume } => {
                let meets = |i: usize| match path.get(i..i + 2) {
                    Some([a, b]) => volume.meets_segment(point(a), point(b)),
                    _ => false,
                };
                let count = path.len().saturating_sub(1);
                match place {
                    Place::Start => meets(0),
                    Place::End => count > 0 && meets(count - 1),
                    Place::Any => (0..count).any(meets),
                    Place::All => (0..count).all(meets),
                }
            }
            Self::LightPath(automaton) => automaton.matches(path),
            Self::Film { min, max } => (0..2).all(|i| (min[i]..=max[i]).contains(&header.film[i])),
            Self::Number { attribute, scale, comparison, value } => {
                let own = attribute.rounded(attribute.value(header, path, *scale));
                comparison.holds(own, *value)
            }
            Self::Range { attribute, scale, least, most } => {
                let own = attribute.rounded(attribute.value(header, path, *scale));
                (*least..=*most).contains(&own)
            }
            Self::Strategy(indices) => indices.contains(&header.strategy.0),
        }
    }
}

/// Whether `holds` does at `place`, where [`Place::All`] means `inner`.
fn of_place<T>(place: Place, all: &[T], inner: &[T], holds: impl Fn(&T) -> bool) -> bool {
    match place {
        Place::Start => all.first().is_some_and(holds),
        Place::End => all.last().is_some_and(holds),
        Place::Any => all.iter().any(holds),
        Place::All => inner.iter().all(holds),
    }
}

pub(super) fn point(vertex: &VertexRecord) -> DVec3 {
    Vec3::from_array(vertex.position).as_dvec3()
}

impl CompiledTest {
    pub(super) fn holds(&self, vertex: &VertexRecord) -> bool {
        let on = |flags: &[bool]| flags.get(usize::from(vertex.material)).copied().unwrap_or(false);
        match self {
            Self::Inside(volume) => volume.contains(point(vertex)),
            // The lens is on no material; its index there is of no meaning.
            Self::Material(flags) => vertex.kind != VertexKind::Eye && on(flags),
            Self::Light(flags) => is_light(vertex) && on(flags),
            Self::Object(ranges) => ranges.iter().any(|range| range.contains(&vertex.primitive)),
            Self::Is(class) => class.holds(vertex),
            Self::Not(part) => !part.holds(vertex),
            Self::And(parts) => parts.iter().all(|part| part.holds(vertex)),
            Self::Or(parts) => parts.iter().any(|part| part.holds(vertex)),
        }
    }
}

impl VertexClass {
    fn holds(self, vertex: &VertexRecord) -> bool {
        match self {
            Self::Diffuse => is_diffuse(vertex),
            Self::Glossy => is_glossy(vertex),
            Self::Specular => is_specular(vertex),
            Self::Reflect => vertex.event == Event::Reflect,
            Self::Refract => vertex.event == Event::Transmit,
            Self::Light => is_light(vertex),
            Self::Camera => vertex.kind == VertexKind::Eye,
        }
    }
}
