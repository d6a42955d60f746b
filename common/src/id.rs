//! Names that are numbers, one type each so that they cannot be mixed up.

use std::fmt;

use serde::{Deserialize, Serialize};

/// One Markov chain with its own random stream.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct ChainId(pub u32);

/// A mutation strategy: an index into the names announced in [`crate::Welcome`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct StrategyId(pub u8);

/// A material: an index into the list that travels with the scene's geometry.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct MaterialId(pub u16);

/// Names one state of one chain for ever.
///
/// `step` is the trial whose acceptance made the state; a seed has step 0.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct PathId {
    /// The chain.
    pub chain: ChainId,
    /// The time between two changes of the chain's settings or seed.
    pub epoch: u32,
    /// The trial within the epoch, counted from one.
    pub step: u64,
}

impl fmt::Display for PathId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}.{}.{}", self.chain.0, self.epoch, self.step)
    }
}
