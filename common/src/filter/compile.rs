//! A filter bound to a scene: names are indices, coordinates are the scene's own.

use super::condition::BoundLeaf;
use super::{Filter, FilterError, FilterScene, Leaf, Tree};
use crate::{PathHeader, VertexRecord};

/// Most conditions of one filter: their outcomes are bits of one number.
pub const MAX_LEAVES: usize = 64;

/// A filter that judges the paths of one scene, without allocating.
#[derive(Clone, Debug)]
pub struct CompiledFilter {
    text: String,
    /// The tree, whose leaves are places in the list of conditions.
    pub(super) root: Tree<usize>,
    pub(super) leaves: Vec<BoundLeaf>,
    leaf_texts: Vec<String>,
}

impl Filter {
    /// Binds the filter to a scene.
    pub fn compile(&self, scene: &FilterScene) -> Result<CompiledFilter, FilterError> {
        let mut leaves = Vec::new();
        let mut leaf_texts = Vec::new();
        let root = self.try_map(&mut |leaf: &Leaf| {
            if leaves.len() == MAX_LEAVES {
                let message = format!("more than {MAX_LEAVES} conditions; use fewer");
                return Err(FilterError::of_tree(message));
            }
            leaves.push(leaf.bind(scene)?);
            leaf_texts.push(leaf.to_string());
            Ok(leaves.len() - 1)
        })?;
        Ok(CompiledFilter { text: self.to_string(), root, leaves, leaf_texts })
    }
}

impl CompiledFilter {
    /// The filter's text.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// True when every path is wanted, whatever it is.
    pub fn wants_all(&self) -> bool {
        matches!(self.root, Tree::Constant(true))
    }

    /// The text of each condition, in the order of the bits of [`Self::conditions`].
    pub fn condition_texts(&self) -> &[String] {
        &self.leaf_texts
    }

    /// True when the path is wanted.
    #[inline]
    pub fn matches(&self, header: &PathHeader, path: &[VertexRecord]) -> bool {
        self.root.holds(&|leaf| self.leaves[*leaf].holds(header, path))
    }

    /// Which conditions the path meets, each by itself: bit `i` for condition `i`.
    pub fn conditions(&self, header: &PathHeader, path: &[VertexRecord]) -> u64 {
        let bit = |(i, leaf): (usize, &BoundLeaf)| u64::from(leaf.holds(header, path)) << i;
        self.leaves.iter().enumerate().map(bit).sum()
    }

    /// Whether a path is wanted that meets these conditions.
    pub fn wants(&self, conditions: u64) -> bool {
        self.root.holds(&|leaf| conditions >> leaf & 1 == 1)
    }
}
