//! What the driver may change of the chains.

use crate::{Author, StrategyId};

/// Largest weight of a strategy.
pub const MAX_WEIGHT: f64 = 1e6;
/// Smallest relative standard error of b that may be asked for.
pub const LEAST_PRECISION: f64 = 1e-4;
/// Largest one.
pub const MOST_PRECISION: f64 = 0.1;

/// Changes what the chains do. Every change but a pause and its end opens an epoch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ChainCommand {
    /// Stops all chains where they are.
    Pause,
    /// Lets them go on.
    Resume,
    /// Changes how often a strategy is chosen; 0 switches it off. The picture goes on, since every
    /// mixture leads to the same one.
    SetWeight {
        /// The strategy.
        strategy: StrategyId,
        /// Its weight relative to the others, at most [`MAX_WEIGHT`].
        weight: f64,
    },
    /// Restarts with a pool of samples that estimates b, the mean luminance of the image, to this
    /// relative standard error, from [`LEAST_PRECISION`] to [`MOST_PRECISION`].
    SetPrecision(f64),
    /// Restarts everything, the picture included, with this seed.
    Restart {
        /// The same number gives the same picture.
        seed: u64,
    },
}

/// What the chains are at.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ChainState {
    /// The time between two changes; paths and statistics name it.
    pub epoch: u32,
    /// False while they are paused.
    pub running: bool,
    /// The weight of each strategy, in the announced order; empty until the chains have started.
    pub weights: Vec<f64>,
    /// Number of the run.
    pub seed: u64,
    /// Relative standard error of b that was asked for.
    pub precision: f64,
    /// What was changed last, for people; blank before any change.
    pub change: String,
    /// Who changed it.
    pub by: Option<Author>,
}
