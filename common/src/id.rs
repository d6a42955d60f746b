//! Names that are numbers, one type each so that they cannot be mixed up.

use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Serialize};
use thiserror::Error;

/// One Markov chain with its own random stream.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct ChainId(pub u32);

impl ChainId {
    /// The explorer, which is none of the chains that make the image.
    pub const EXPLORER: Self = Self(u32::MAX);
}

/// A mutation strategy: an index into the names announced in [`crate::Welcome`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct StrategyId(pub u8);

/// A material: an index into the list that travels with the scene's geometry.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct MaterialId(pub u16);

/// Identifies one state of one chain permanently.
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
        match self.chain {
            ChainId::EXPLORER => write!(f, "explorer.{}.{}", self.epoch, self.step),
            ChainId(chain) => write!(f, "{chain}.{}.{}", self.epoch, self.step),
        }
    }
}

/// A text that names no path.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error("a path is named CHAIN.EPOCH.STEP, such as 3.0.1024 or explorer.1.7")]
pub struct NoPathId;

impl FromStr for PathId {
    type Err = NoPathId;

    fn from_str(text: &str) -> Result<Self, NoPathId> {
        let mut parts = text.split('.');
        let mut part = || parts.next().ok_or(NoPathId);
        let (chain, epoch, step) = (part()?, part()?, part()?);
        let chain = match chain {
            "explorer" => ChainId::EXPLORER,
            number => ChainId(number.parse().or(Err(NoPathId))?),
        };
        let (epoch, step) = (epoch.parse().or(Err(NoPathId))?, step.parse().or(Err(NoPathId))?);
        if parts.next().is_some() { Err(NoPathId) } else { Ok(Self { chain, epoch, step }) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_paths_survive_their_text() {
        for chain in [ChainId(0), ChainId(77), ChainId::EXPLORER] {
            let id = PathId { chain, epoch: 3, step: u64::MAX };
            assert_eq!(id.to_string().parse(), Ok(id));
        }
        for text in ["", "1", "1.2", "1.2.3.4", "a.1.2", "-1.0.0", "1.0.x", "explorer"] {
            assert_eq!(text.parse::<PathId>(), Err(NoPathId), "{text}");
        }
    }
}
