//! The choice among strategies.

use common::Camera;
use serde::{Deserialize, Serialize};

use super::{
    Bidirectional, CausticPerturbation, Independent, LensPerturbation, LensSubpath, MultiChain,
    Strategy,
};
use crate::math::Rng;
use crate::path::Path;
use crate::scene::SceneFeatures;

/// How often each strategy is chosen, relative to the others; zero switches one off.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct StrategyWeights {
    /// Of the bidirectional mutation.
    pub bidirectional: f64,
    /// Of the independent mutation.
    pub independent: f64,
    /// Of the lens perturbation.
    pub lens: f64,
    /// Of the lens subpath mutation.
    pub lens_subpath: f64,
    /// Of the caustic perturbation.
    pub caustic: f64,
    /// Of the multi-chain perturbation.
    pub multi_chain: f64,
}

impl Default for StrategyWeights {
    fn default() -> Self {
        Self {
            bidirectional: 0.36,
            independent: 0.04,
            lens: 0.3,
            lens_subpath: 0.06,
            caustic: 0.14,
            multi_chain: 0.1,
        }
    }
}

impl StrategyWeights {
    /// No strategy at all: a base for mixtures of a few.
    pub const NONE: Self = Self {
        bidirectional: 0.0,
        independent: 0.0,
        lens: 0.0,
        lens_subpath: 0.0,
        caustic: 0.0,
        multi_chain: 0.0,
    };
}

/// What strategies are built from.
#[derive(Clone, Copy, Debug)]
pub struct MixtureBasis<'a> {
    /// The render camera.
    pub camera: &'a Camera,
    /// Longest path, in edges.
    pub max_edges: usize,
    /// What the scene contains; strategies for what it does not contain are left out.
    pub features: SceneFeatures,
    /// Entry `k`: the light that paths of `k` edges carry, as the bootstrap has measured it.
    pub energy: &'a [f64],
}

/// The strategies of a chain with their weights. Fixed before the chain starts.
#[derive(Clone, Debug)]
pub struct Mixture {
    entries: Vec<(f64, Strategy)>,
}

impl Mixture {
    /// All strategies with a positive weight that the scene has a use for.
    pub fn new(weights: &StrategyWeights, basis: &MixtureBasis<'_>) -> Self {
        let &MixtureBasis { camera, max_edges, features, energy } = basis;
        let multi_chain = if features.specular { weights.multi_chain } else { 0.0 };
        let all = [
            (weights.bidirectional, Strategy::Bidirectional(Bidirectional { max_edges })),
            (weights.independent, Strategy::Independent(Independent::new(energy, max_edges))),
            (weights.lens, Strategy::Lens(LensPerturbation::new(camera))),
            (weights.lens_subpath, Strategy::LensSubpath(LensSubpath { max_edges })),
            (weights.caustic, Strategy::Caustic(CausticPerturbation::new(camera))),
            (multi_chain, Strategy::MultiChain(MultiChain::new(camera))),
        ];
        Self { entries: all.into_iter().filter(|(weight, _)| *weight > 0.0).collect() }
    }

    /// The names of the strategies that a mixture with these weights has on a scene.
    pub fn names_for(
        weights: &StrategyWeights,
        camera: &Camera,
        features: SceneFeatures,
    ) -> Vec<String> {
        // What the bootstrap measures changes no name.
        Self::new(weights, &MixtureBasis { camera, max_edges: 1, features, energy: &[] }).names()
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
