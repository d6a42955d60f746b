//! A light path expression as a table of states.

use regex_automata::Anchored;
use regex_automata::MatchKind;
use regex_automata::dfa::{Automaton as _, StartKind, dense};
use regex_automata::nfa::thompson::{self, WhichCaptures};
use regex_automata::util::primitives::StateID;
use regex_automata::util::start;
use regex_syntax::hir::{Class, ClassBytes, ClassBytesRange, Hir, Repetition};

use super::symbol::{BASES, base_of, symbol};
use super::{Atom, Direction, Node};
use crate::VertexRecord;

/// Most bytes of the table, and of each step in making it.
const MAX_BYTES: usize = 1 << 18;

/// A compiled expression: each vertex costs one look into a table.
#[derive(Clone, Debug)]
pub(in crate::filter) struct LightPathAutomaton {
    dfa: dense::DFA<Vec<u32>>,
    start: StateID,
    direction: Direction,
    /// Number of the label of each material, 0 for none that is named.
    labels: Vec<u8>,
    /// The material of the environment.
    background: Option<u16>,
}

impl LightPathAutomaton {
    /// Compiles `node`; `None` when the table would be too large. `labels` holds the number of the
    /// label of each material, up to `label_count`.
    pub(super) fn new(
        node: &Node,
        label_count: usize,
        direction: Direction,
        labels: Vec<u8>,
        background: Option<u16>,
    ) -> Option<Self> {
        let limit = Some(MAX_BYTES);
        let nfa = thompson::Config::new()
            .utf8(false)
            .nfa_size_limit(limit)
            .which_captures(WhichCaptures::None);
        let nfa = thompson::Compiler::new()
            .configure(nfa)
            .build_from_hir(&hir(node, label_count))
            .ok()?;
        let config = dense::Config::new()
            .match_kind(MatchKind::All)
            .start_kind(StartKind::Anchored)
            .dfa_size_limit(limit)
            .determinize_size_limit(limit);
        let dfa = dense::Builder::new().configure(config).build_from_nfa(&nfa).ok()?;
        let start = dfa.start_state(&start::Config::new().anchored(Anchored::Yes)).ok()?;
        Some(Self { dfa, start, direction, labels, background })
    }

    /// True when the whole path, from the light to the lens, fits the expression.
    pub(in crate::filter) fn matches(&self, vertices: &[VertexRecord]) -> bool {
        let last = vertices.len().saturating_sub(1);
        let mut state = self.start;
        for i in 0..vertices.len() {
            let j = match self.direction {
                Direction::FromLight => i,
                Direction::FromCamera => last - i,
            };
            let material = usize::from(vertices[j].material);
            let label = self.labels.get(material).copied().unwrap_or(0);
            let base = base_of(vertices, j, self.background);
            state = self.dfa.next_state(state, symbol(base, usize::from(label)));
            if self.dfa.is_dead_state(state) {
                return false;
            }
        }
        self.dfa.is_match_state(self.dfa.next_eoi_state(state))
    }
}

fn hir(node: &Node, labels: usize) -> Hir {
    match node {
        Node::Event(atoms, negated) => Hir::class(Class::Bytes(class(atoms, *negated, labels))),
        Node::Sequence(nodes) => Hir::concat(nodes.iter().map(|node| hir(node, labels)).collect()),
        Node::Either(nodes) => {
            Hir::alternation(nodes.iter().map(|node| hir(node, labels)).collect())
        }
        Node::Repeat { node, least, most } => Hir::repetition(Repetition {
            min: *least,
            max: *most,
            greedy: true,
            sub: Box::new(hir(node, labels)),
        }),
    }
}

/// The symbols that fit one of `atoms`, or none of them.
fn class(atoms: &[Atom], negated: bool, labels: usize) -> ClassBytes {
    let mut class = ClassBytes::empty();
    for label in 0..=labels {
        for base in 0..BASES {
            let fits = atoms.iter().any(|atom| {
                atom.bases.0 >> base & 1 == 1 && atom.label.is_none_or(|named| named == label)
            });
            if fits != negated {
                let byte = symbol(base, label);
                class.push(ClassBytesRange::new(byte, byte));
            }
        }
    }
    class
}
