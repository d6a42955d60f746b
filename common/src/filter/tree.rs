//! Boolean trees: of conditions on paths, and of tests at one vertex.

use super::FilterError;

/// No tree is deeper than this.
pub(super) const MAX_DEPTH: usize = 24;

/// A boolean combination of leaves.
#[derive(Clone, Debug, PartialEq)]
pub enum Tree<T> {
    /// Always, or never.
    Constant(bool),
    /// Where the other one does not hold.
    Not(Box<Self>),
    /// Where all of them hold.
    And(Vec<Self>),
    /// Where any of them holds.
    Or(Vec<Self>),
    /// Where the leaf holds.
    Leaf(T),
}

impl<T> Default for Tree<T> {
    fn default() -> Self {
        Self::Constant(true)
    }
}

impl<T> Tree<T> {
    /// Whether it holds, where `leaf` tells whether a leaf does.
    #[inline]
    pub fn holds(&self, leaf: &impl Fn(&T) -> bool) -> bool {
        match self {
            Self::Constant(value) => *value,
            Self::Not(part) => !part.holds(leaf),
            Self::And(parts) => parts.iter().all(|part| part.holds(leaf)),
            Self::Or(parts) => parts.iter().any(|part| part.holds(leaf)),
            Self::Leaf(own) => leaf(own),
        }
    }

    /// The leaves from the left to the right.
    pub fn leaves(&self) -> Vec<&T> {
        match self {
            Self::Constant(_) => Vec::new(),
            Self::Not(part) => part.leaves(),
            Self::And(parts) | Self::Or(parts) => parts.iter().flat_map(Self::leaves).collect(),
            Self::Leaf(leaf) => vec![leaf],
        }
    }

    /// True for several parts that are joined.
    pub fn is_group(&self) -> bool {
        matches!(self, Self::And(_) | Self::Or(_))
    }

    /// Its opposite, without a second `not`.
    #[must_use]
    pub fn negated(self) -> Self {
        match self {
            Self::Not(part) => *part,
            other => Self::Not(Box::new(other)),
        }
    }

    /// The tree that holds where all parts do; a part that always holds is left out.
    pub fn all_of(parts: Vec<Self>) -> Self {
        let asks = |part: &Self| !matches!(part, Self::Constant(true));
        let mut parts: Vec<Self> = parts.into_iter().filter(asks).collect();
        if parts.len() > 1 { Self::And(parts) } else { parts.pop().unwrap_or_default() }
    }

    /// The tree with its leaf of this number, counted as [`Self::leaves`] does, changed; without it
    /// where `change` answers nothing.
    #[must_use]
    pub fn with_leaf(self, number: usize, change: impl FnOnce(T) -> Option<T>) -> Self {
        let mut place = Some((number, change));
        self.edited(&mut place).unwrap_or_default()
    }

    /// `None` where nothing is left. `place` holds how many leaves come before the one to be changed,
    /// until that was found.
    fn edited<F: FnOnce(T) -> Option<T>>(self, place: &mut Option<(usize, F)>) -> Option<Self> {
        let mut each = |parts: Vec<Self>| -> Vec<Self> {
            parts.into_iter().filter_map(|part| part.edited(place)).collect()
        };
        match self {
            Self::Constant(_) => Some(self),
            Self::Not(part) => part.edited(place).map(Self::negated),
            Self::And(parts) => joined(each(parts), Self::And),
            Self::Or(parts) => joined(each(parts), Self::Or),
            Self::Leaf(leaf) => match place.take() {
                Some((0, change)) => change(leaf).map(Self::Leaf),
                Some((before, change)) => {
                    *place = Some((before - 1, change));
                    Some(Self::Leaf(leaf))
                }
                None => Some(Self::Leaf(leaf)),
            },
        }
    }

    /// The same tree of other leaves, or why one of them or the depth is refused.
    pub(super) fn try_map<U>(
        &self,
        leaf: &mut impl FnMut(&T) -> Result<U, FilterError>,
    ) -> Result<Tree<U>, FilterError> {
        self.try_map_at(0, leaf)
    }

    fn try_map_at<U>(
        &self,
        depth: usize,
        leaf: &mut impl FnMut(&T) -> Result<U, FilterError>,
    ) -> Result<Tree<U>, FilterError> {
        if depth > MAX_DEPTH {
            return Err(FilterError::of_tree(too_deep()));
        }
        let mut each = |parts: &[Self]| -> Result<Vec<_>, _> {
            parts.iter().map(|part| part.try_map_at(depth + 1, leaf)).collect()
        };
        Ok(match self {
            Self::Constant(value) => Tree::Constant(*value),
            Self::Not(part) => Tree::Not(Box::new(part.try_map_at(depth + 1, leaf)?)),
            Self::And(parts) => Tree::And(each(parts)?),
            Self::Or(parts) => Tree::Or(each(parts)?),
            Self::Leaf(own) => Tree::Leaf(leaf(own)?),
        })
    }
}

/// The complaint about a tree that is too deep.
pub(super) fn too_deep() -> String {
    format!("nested deeper than {MAX_DEPTH} levels; flatten the filter")
}

/// Several parts as one; `None` without any.
fn joined<T>(
    mut parts: Vec<Tree<T>>,
    join: impl FnOnce(Vec<Tree<T>>) -> Tree<T>,
) -> Option<Tree<T>> {
    if parts.len() > 1 { Some(join(parts)) } else { parts.pop() }
}
