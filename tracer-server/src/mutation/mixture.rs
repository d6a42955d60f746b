//! The choice among strategies.

use common::Camera;

use super::{KINDS, Kind, Strategy, StrategyOptions};
use crate::math::{Rng, pick};
use crate::path::Path;
use crate::scene::{Scene, SceneFeatures};

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

impl<'a> MixtureBasis<'a> {
    /// Of a scene, in which the bootstrap or a pilot has found `energy`.
    pub fn of(scene: &'a Scene, energy: &'a [f64]) -> Self {
        let (camera, max_edges, features) = (scene.camera(), scene.max_edges(), scene.features());
        Self { camera, max_edges, features, energy }
    }
}

/// The strategies of a chain with their weights, fixed for an epoch.
#[derive(Clone, Debug)]
pub struct Mixture {
    entries: Vec<(f64, Strategy)>,
}

impl Mixture {
    /// All strategies that are switched on and that the scene has a use for.
    pub fn new(options: &StrategyOptions, basis: &MixtureBasis<'_>) -> Self {
        let on = |&(index, kind): &(usize, &Kind)| {
            options.weight(index) > 0.0 && (kind.is_possible)(basis.features)
        };
        let entry = |(index, kind): (usize, &Kind)| {
            (options.weight(index), (kind.build)(basis, options.tuning(index)))
        };
        Self { entries: KINDS.iter().enumerate().filter(on).map(entry).collect() }
    }

    /// The names of the strategies that a mixture with these options has on a scene.
    pub fn names_for(
        options: &StrategyOptions,
        camera: &Camera,
        features: SceneFeatures,
    ) -> Vec<String> {
        // What the bootstrap measures changes no name.
        Self::new(options, &MixtureBasis { camera, max_edges: 1, features, energy: &[] }).names()
    }

    /// The weights, in order.
    pub fn weights(&self) -> Vec<f64> {
        self.entries.iter().map(|(weight, _)| *weight).collect()
    }

    /// Sets the weights, in order; zero switches a strategy off. Chains that have started with the
    /// mixture must begin an epoch.
    pub fn set_weights(&mut self, weights: &[f64]) {
        for ((weight, _), new) in self.entries.iter_mut().zip(weights) {
            *weight = *new;
        }
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
        let entries = self.entries.iter().enumerate();
        let may_act = |&(_, (weight, strategy)): &(usize, &(f64, Strategy))| {
            *weight > 0.0 && strategy.applicable(x)
        };
        let applicable = entries.filter(may_act);
        pick(rng.uniform() * total, applicable.map(|(index, (weight, _))| (index, *weight)))
    }
}
