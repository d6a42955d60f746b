//! Light path expressions: regular expressions over what happens along a path [Heckbert 1990], in
//! the grammar of the Open Shading Language.
//!
//! An expression is parsed to a small tree and compiled once to a table of states, so that a path
//! costs one look into the table a vertex.

mod automaton;
mod parse;
mod symbol;

use std::fmt;

use super::{FilterError, FilterScene, Name};
use symbol::Bases;

pub(super) use automaton::LightPathAutomaton;

/// From which end an expression reads a path.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Direction {
    FromCamera,
    FromLight,
}

/// A light path expression that was parsed.
#[derive(Clone, Debug)]
pub struct LightPathExpression {
    text: String,
    node: Node,
    labels: Vec<Name>,
    direction: Direction,
    /// Bytes before it in the text it was read from.
    offset: usize,
}

impl PartialEq for LightPathExpression {
    fn eq(&self, other: &Self) -> bool {
        self.text == other.text
    }
}

/// An event of the alphabet under a label: both must fit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Atom {
    bases: Bases,
    /// Number of the label; `None` where any or none will do.
    label: Option<usize>,
}

/// The tree of an expression.
#[derive(Clone, Debug, PartialEq)]
enum Node {
    /// One vertex at which one of the atoms fits or, where the flag is set, none.
    Event(Vec<Atom>, bool),
    Sequence(Vec<Self>),
    Either(Vec<Self>),
    Repeat {
        node: Box<Self>,
        least: u32,
        most: Option<u32>,
    },
}

impl LightPathExpression {
    /// Parses an expression such as `CS*DL` or `L.*'glass'.*C`.
    ///
    /// It is read from the camera unless it can only begin at a light.
    pub fn parse(text: &str) -> Result<Self, FilterError> {
        let (node, labels) = parse::parse(text)?;
        let mut first = Bases(0);
        node.collect_first(&mut first);
        let direction = if first.meets(Bases::CAMERA) {
            Direction::FromCamera
        } else if first.meets(Bases::LIGHTS) {
            Direction::FromLight
        } else {
            let message = "a path begins at the camera or at a light; begin with `C`, `L` or `.*`";
            return Err(FilterError::new(0..text.len(), message));
        };
        Ok(Self { text: text.to_owned(), node, labels, direction, offset: 0 })
    }

    /// The same expression, which stands `offset` bytes into a longer text.
    pub(super) fn moved(mut self, offset: usize) -> Self {
        self.offset += offset;
        self.labels.iter_mut().for_each(|label| label.offset += offset);
        self
    }

    /// The text it was parsed from.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Compiles it for a scene, whose materials are the labels.
    pub(super) fn compile(&self, scene: &FilterScene) -> Result<LightPathAutomaton, FilterError> {
        let mut labels = vec![0; scene.material_count()];
        for (number, name) in (1..).zip(&self.labels) {
            for (label, named) in labels.iter_mut().zip(scene.materials_named(name)?) {
                if named {
                    *label = number;
                }
            }
        }
        let automaton = LightPathAutomaton::new(
            &self.node,
            self.labels.len(),
            self.direction,
            labels,
            scene.background,
        );
        automaton.ok_or_else(|| {
            let message = "the light path expression needs too large a table; use smaller \
                           repetitions, and `*` instead of large numbers";
            FilterError::new(self.offset..self.offset + self.text.len(), message)
        })
    }
}

impl fmt::Display for LightPathExpression {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

impl Node {
    /// Adds the events that a path fitting the node may begin with; returns whether the node fits
    /// no vertices at all, so that what follows it may come first.
    fn collect_first(&self, first: &mut Bases) -> bool {
        match self {
            Self::Event(atoms, negated) => {
                // An event whose label is excluded may come under another label.
                let counts = |atom: &&Atom| !*negated || atom.label.is_none();
                let union = |all: Bases, atom: &Atom| all.or(atom.bases);
                let bases = atoms.iter().filter(counts).fold(Bases(0), union);
                *first = first.or(if *negated { bases.complement() } else { bases });
                false
            }
            Self::Sequence(nodes) => nodes.iter().all(|node| node.collect_first(first)),
            Self::Either(nodes) => {
                nodes.iter().fold(false, |empty, node| node.collect_first(first) | empty)
            }
            Self::Repeat { node, least, most } => {
                if *most == Some(0) {
                    return true;
                }
                node.collect_first(first) || *least == 0
            }
        }
    }
}
