//! Light path expressions: regular expressions over what happens along a path [Heckbert 1990], in
//! the grammar of the Open Shading Language.
//!
//! An expression is parsed to a small tree and compiled once to a table of states, so that a path
//! costs one look into the table a vertex.

mod automaton;
mod parse;
mod symbol;

use std::fmt;
use std::ops::Range;

use super::offers::Within;
use super::quote::Quoted;
use super::word::NameList;
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
    /// Where it stands in the text it was read from, in bytes.
    span: Range<usize>,
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
        Ok(Self { text: text.to_owned(), node, labels, direction, span: 0..text.len() })
    }

    /// The same expression, read from the quotes of a longer text.
    pub(super) fn placed(mut self, quoted: &Quoted) -> Self {
        self.span = quoted.outer_range(0..self.text.len());
        self.labels.iter_mut().for_each(|label| label.offset = quoted.outer(label.offset));
        self
    }

    /// True where a way of going on and a kind of scattering stand side by side, which are two vertices
    /// and mostly meant as one.
    pub(super) fn is_likely_mistaken(&self) -> bool {
        self.node.has_split_event()
    }

    /// The text it was parsed from.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Compiles it for a scene, whose materials are the labels.
    pub(super) fn compile(&self, scene: &FilterScene) -> Result<LightPathAutomaton, FilterError> {
        let mut labels = vec![0; scene.materials.len()];
        for (number, name) in (1..).zip(&self.labels) {
            let named = scene.materials_named(NameList::Materials, name)?;
            for (label, named) in labels.iter_mut().zip(named) {
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
            scene.background(),
        );
        automaton.ok_or_else(|| {
            let message = "the light path expression needs too large a table; use smaller \
                repetition counts, or `*` instead of large ones";
            FilterError::new(self.span.clone(), message)
        })
    }
}

/// What may come at the end of an expression that is still being written.
pub(super) fn offers(text: &str, scene: &FilterScene) -> Within {
    let is_whole = LightPathExpression::parse(text).is_ok();
    Within { found: parse::offers(text, scene), is_whole }
}

impl fmt::Display for LightPathExpression {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

impl Default for LightPathExpression {
    /// Every path.
    fn default() -> Self {
        Self::parse("C.*L").expect("an expression")
    }
}

impl Node {
    /// True where a reflection or refraction is followed by a kind of scattering.
    fn has_split_event(&self) -> bool {
        let is = |node: &Self, letters: &str| match node {
            Self::Event(atoms, false) => match atoms.as_slice() {
                [Atom { bases, label: None }] => {
                    letters.chars().any(|letter| Bases::of_letter(letter) == Some(*bases))
                }
                _ => false,
            },
            Self::Event(..) | Self::Sequence(_) | Self::Either(_) | Self::Repeat { .. } => false,
        };
        match self {
            Self::Event(..) => false,
            Self::Sequence(nodes) => {
                let split = |pair: &[Self]| is(&pair[0], "RTV") && is(&pair[1], "DGSs");
                nodes.windows(2).any(split) || nodes.iter().any(Self::has_split_event)
            }
            Self::Either(nodes) => nodes.iter().any(Self::has_split_event),
            Self::Repeat { node, .. } => node.has_split_event(),
        }
    }

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
