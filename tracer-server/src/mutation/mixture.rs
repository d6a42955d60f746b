//! The choice among strategies.

use common::Camera;
use serde::{Deserialize, Serialize};

use super::{Bidirectional, Independent, LensPerturbation, Mutation as _, Strategy};
use crate::math::Rng;
use crate::path::Path;

/// How often each strategy is chosen, relative to the others; zero switches one off.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct StrategyWeights {
    /// Of the bidirectional mutation.
    pub bidirectional: f64,
    /// Of the independent mutation.
    pub independent: f64,
    /// Of the lens perturbation.
    pub lens: f64,
}

impl Default for StrategyWeights {
    fn default() -> Self {
        Self { bidirectional: 0.5, independent: 0.05, lens: 0.45 }
    }
}

impl StrategyWeights {
    /// Names of the strategies that a mixture with these weights has, in its order.
    pub fn names(&self) -> Vec<String> {
        [
            (self.bidirectional, Bidirectional::NAME),
            (self.independent, Independent::NAME),
            (self.lens, LensPerturbation::NAME),
        ]
        .into_iter()
        .filter(|(weight, _)| *weight > 0.0)
        .map(|(_, name)| name.to_owned())
        .collect()
    }
}

/// The strategies of a chain with their weights. Fixed before the chain starts.
#[derive(Clone, Debug)]
pub struct Mixture {
    entries: Vec<(f64, Strategy)>,
}

impl Mixture {
    /// All strategies with a positive weight. `energy[k]` is the light that paths of `k` edges
    /// carry, as the bootstrap has measured it.
    pub fn new(
        weights: &StrategyWeights,
        camera: &Camera,
        energy: &[f64],
        max_edges: usize,
    ) -> Self {
        let all = [
            (weights.bidirectional, Strategy::Bidirectional(Bidirectional { max_edges })),
            (weights.independent, Strategy::Independent(Independent::new(energy, max_edges))),
            (weights.lens, Strategy::Lens(LensPerturbation::new(camera))),
        ];
        Self { entries: all.into_iter().filter(|(weight, _)| *weight > 0.0).collect() }
    }

    /// Number of strategies.
    pub fn len(&self) -> usize {
        self.entries.len()
    }

    /// True without strategies.
    pub fn is_empty(&self) -> bool {
        self.entries.is_empty()
    }

    /// The strategies' names, in order.
    pub fn names(&self) -> Vec<String> {
        self.entries.iter().map(|(_, strategy)| strategy.name().to_owned()).collect()
    }

    /// The strategy number `index`.
    #[inline]
    pub fn get(&self, index: usize) -> &Strategy {
        &self.entries[index].1
    }

    /// `Z(x)`: the sum of the weights of the strategies that apply to `x`.
    #[inline]
    pub fn total(&self, x: &Path) -> f64 {
        self.entries.iter().filter(|(_, s)| s.applicable(x)).map(|(weight, _)| weight).sum()
    }

    /// One of the strategies that apply to `x`, in proportion to the weights; `total` is `Z(x)`.
    #[inline]
    pub fn choose(&self, x: &Path, total: f64, rng: &mut Rng) -> Option<usize> {
        let mut u = rng.uniform() * total;
        let mut chosen = None;
        for (index, (weight, strategy)) in self.entries.iter().enumerate() {
            if strategy.applicable(x) {
                chosen = Some(index);
                u -= weight;
                if u < 0.0 {
                    break;
                }
            }
        }
        chosen
    }
}
