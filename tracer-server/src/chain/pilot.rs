//! A look at a scene before its chains start: where its light is, and what each strategy makes of it.
//!
//! What the pilot finds sets the lengths that the independent mutation draws and the weights of the
//! mixture, which then stay as they are: they are constants to the chains, so that no image is biased
//! by them. Its random numbers are its own, so nothing depends on the pool that seeds the chains.

use std::fmt;

use glam::DVec2;
use serde::Serialize;

use crate::math::{Rng, Stream};
use crate::mutation::{Independent, Mixture, MixtureBasis, Mutation as _, StrategyOptions};
use crate::parallel::{self, Stop};
use crate::path::{BidirectionalSampler, CameraSample, Draft, Path};
use crate::scene::{RayCounts, Scene, Tracer};
use crate::target::Base;

/// Samples that one stream of random numbers serves.
const CHUNK: u64 = 512;
/// A strategy whose paths hold less than this share of the light gets the least weight.
const DIM: f64 = 1e-5;
/// The least weight, as a share of all.
const LEAST: f64 = 0.005;
/// A strategy for less than this share of the light keeps its own weight: its paths are hard, and few
/// of its proposals succeed, but no other strategy can take its place.
const COMMON: f64 = 0.5;
/// How far a weight may be from the strategy's own, as a factor either way.
const FREEDOM: f64 = 3.0;

/// What the pilot found of one strategy.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Prospect {
    /// The strategy's name.
    pub name: String,
    /// Share of the light on paths that it can change.
    pub light: f64,
    /// Mean acceptance of its proposals there.
    pub acceptance: f64,
    /// Closest-hit and shadow rays that a proposal takes.
    pub rays: f64,
    /// Scales of the picture that light crosses for each ray: the mean of acceptance times the
    /// binary logarithm of one and the jump in pixels.
    pub gain: f64,
    /// The weight that it has, as a share of all.
    pub weight: f64,
}

impl fmt::Display for Prospect {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{}: {:.1} % of the steps; {:.2} % of the light, acceptance {:.2} with {:.1} rays a try",
            self.name,
            100.0 * self.weight,
            100.0 * self.light,
            self.acceptance,
            self.rays
        )
    }
}

/// A path that a bidirectional sample held.
#[derive(Clone, Copy, Debug)]
pub struct Sighting {
    /// Number of the sample.
    pub sample: u32,
    /// Film point, from 0 to 1.
    pub film: [f32; 2],
    /// Edges of the path.
    pub edges: usize,
    /// What it stands for: `1 / S` over the odds of roulette.
    pub weight: f64,
    /// `S_B` of every base sampler.
    density_sums: [f64; Base::ALL.len()],
}

impl Sighting {
    /// `S_B`: zero where the base sampler cannot find the path.
    pub fn density_sum(&self, base: Base) -> f64 {
        self.density_sums[base as usize]
    }
}

/// What the pilot has seen.
#[derive(Debug)]
pub struct Survey {
    /// The strategies for the chains, with their weights.
    pub mixture: Mixture,
    /// What it found of each strategy.
    pub prospects: Vec<Prospect>,
    /// Every path of its samples.
    pub sightings: Vec<Sighting>,
    /// Bidirectional samples.
    pub samples: u64,
    /// Rays that they took.
    pub rays: RayCounts,
}

/// What one chunk of samples yields.
#[derive(Clone, Debug, Default)]
struct Found {
    sightings: Vec<Sighting>,
    rays: RayCounts,
    lengths: Vec<f64>,
    total: f64,
    strategies: Vec<Tries>,
}

/// The proposals of one strategy, weighed with the light of the paths they start from.
#[derive(Clone, Copy, Debug, Default)]
struct Tries {
    light: f64,
    acceptance: f64,
    jumps: f64,
    rays: f64,
}

/// How large the pilot is.
#[derive(Clone, Debug)]
pub struct PilotSettings {
    /// Number of the run; the same number finds the same.
    pub seed: u64,
    /// Worker threads; what is found does not depend on it.
    pub threads: usize,
    /// Bidirectional samples.
    pub samples: u64,
    /// Tells it to look no further: what it has found by then is of no use.
    pub stop: Stop,
}

/// Looks at the scene, and makes the mixture for its chains.
pub fn survey(scene: &Scene, options: &StrategyOptions, settings: &PilotSettings) -> Survey {
    let basis = MixtureBasis::of(scene, &[]);
    let blind = Mixture::new(options, &basis);
    let found = look(scene, &blind, settings);
    let mut mixture = Mixture::new(options, &MixtureBasis::of(scene, &found.lengths));
    let mut prospects: Vec<Prospect> = blind
        .names()
        .into_iter()
        .zip(&found.strategies)
        .map(|(n, t)| t.prospect(n, found.total))
        .collect();
    if options.adapts() && found.total > 0.0 {
        mixture.set_weights(&adapted(&mixture.weights(), &prospects));
    }
    let total: f64 = mixture.weights().iter().sum();
    for (prospect, weight) in prospects.iter_mut().zip(mixture.weights()) {
        prospect.weight = weight / total;
    }
    let samples = settings.samples.div_ceil(CHUNK) * CHUNK;
    Survey { mixture, prospects, sightings: found.sightings, samples, rays: found.rays }
}

/// Weights that favour what crosses many scales of the picture for each ray.
fn adapted(usual: &[f64], prospects: &[Prospect]) -> Vec<f64> {
    // Starting anew frees chains that are stuck, which no single proposal shows.
    let common =
        |prospect: &Prospect| prospect.light >= COMMON && prospect.name != Independent::NAME;
    let both = || usual.iter().zip(prospects).filter(|(_, prospect)| common(prospect));
    let total: f64 = both().map(|(weight, _)| weight).sum();
    let mean = both().map(|(weight, prospect)| weight * prospect.gain).sum::<f64>() / total;
    let favoured = |(weight, prospect): (&f64, &Prospect)| {
        if prospect.light < DIM {
            return 0.0;
        }
        let favour = (prospect.gain / mean).sqrt();
        if !common(prospect) || favour.is_nan() {
            return *weight;
        }
        weight * favour.clamp(1.0 / FREEDOM, FREEDOM)
    };
    let weights: Vec<f64> = usual.iter().zip(prospects).map(favoured).collect();
    let total: f64 = weights.iter().sum();
    weights.iter().map(|weight| (weight / total).max(LEAST)).collect()
}

impl Tries {
    fn prospect(&self, name: String, total: f64) -> Prospect {
        let per = |sum: f64, whole: f64| if whole > 0.0 { sum / whole } else { 0.0 };
        Prospect {
            name,
            light: per(self.light, total),
            acceptance: per(self.acceptance, self.light),
            rays: per(self.rays, self.light),
            gain: per(self.jumps, self.rays),
            weight: 0.0,
        }
    }
}

fn look(scene: &Scene, mixture: &Mixture, settings: &PilotSettings) -> Found {
    let chunks = settings.samples.div_ceil(CHUNK);
    let parts = parallel::map(
        settings.threads,
        0..chunks,
        || Scout::new(scene, settings.seed),
        |scout, number| (!settings.stop.is_set()).then(|| scout.chunk(mixture, number)),
    );
    let mut found = Found::new(scene, mixture);
    for part in parts.iter().flatten() {
        found.merge(part);
    }
    found
}

impl Found {
    fn new(scene: &Scene, mixture: &Mixture) -> Self {
        Self {
            sightings: Vec::new(),
            rays: RayCounts::default(),
            lengths: vec![0.0; scene.max_edges() + 1],
            total: 0.0,
            strategies: vec![Tries::default(); mixture.len()],
        }
    }

    fn merge(&mut self, part: &Self) {
        self.total += part.total;
        self.sightings.extend_from_slice(&part.sightings);
        self.rays = self.rays.and(part.rays);
        self.lengths.iter_mut().zip(&part.lengths).for_each(|(sum, part)| *sum += part);
        for (sum, part) in self.strategies.iter_mut().zip(&part.strategies) {
            sum.light += part.light;
            sum.acceptance += part.acceptance;
            sum.jumps += part.jumps;
            sum.rays += part.rays;
        }
    }
}

/// One worker of the pilot.
struct Scout<'s> {
    scene: Tracer<'s>,
    seed: u64,
    sampler: BidirectionalSampler,
    draft: Box<Draft>,
    x: Box<Path>,
    y: Box<Path>,
}

impl<'s> Scout<'s> {
    fn new(scene: &'s Scene, seed: u64) -> Self {
        let scene = Tracer::new(scene);
        let sampler = BidirectionalSampler::new(&scene);
        let (draft, x, y) = (Box::default(), Box::default(), Box::default());
        Self { scene, seed, sampler, draft, x, y }
    }

    fn chunk(&mut self, mixture: &Mixture, number: u64) -> Found {
        // Even numbers feed the sampler, odd ones the strategies.
        let mut rng = Rng::new(self.seed, Stream::Pilot, number << 1);
        let mut choice = Rng::new(self.seed, Stream::Pilot, number << 1 | 1);
        self.draft.displacements = number << 24;
        let mut found = Found::new(&self.scene, mixture);
        for sample in 0..CHUNK {
            let Self { scene, sampler, x, .. } = self;
            let before = RayCounts::of(scene);
            let aim = CameraSample::from_numbers(scene, &mut rng);
            let mut sum = 0.0;
            sampler.sample(scene, aim, &mut rng, |path, weight| {
                found.lengths[path.edge_count()] += weight;
                found.sightings.push(Sighting {
                    sample: (number * CHUNK + sample) as u32,
                    film: path.film().as_vec2().to_array(),
                    edges: path.edge_count(),
                    weight,
                    density_sums: Base::ALL.map(|base| base.density_sum(path)),
                });
                for (index, tries) in found.strategies.iter_mut().enumerate() {
                    let applies = mixture.get(index).applicable(path);
                    tries.light += weight * f64::from(u8::from(applies));
                }
                sum += weight;
                // One of the sample's paths, in proportion to their light.
                if choice.uniform() * sum < weight {
                    (**x).clone_from(path);
                }
            });
            found.total += sum;
            found.rays = found.rays.and(RayCounts::of(scene).since(before));
            if sum > 0.0 {
                self.try_all(mixture, sum, &mut choice, &mut found.strategies);
            }
        }
        found
    }

    /// Draws one proposal of each strategy from the path that was chosen, which stands for `light`.
    fn try_all(&mut self, mixture: &Mixture, light: f64, rng: &mut Rng, tries: &mut [Tries]) {
        let Self { scene, draft, x, y, .. } = self;
        let camera = scene.camera();
        let size = DVec2::new(f64::from(camera.width), f64::from(camera.height));
        for (index, tries) in tries.iter_mut().enumerate() {
            let strategy = mixture.get(index);
            if !strategy.applicable(x) {
                continue;
            }
            let before = rays(scene);
            let drawn = strategy.propose(scene, x, rng, draft, y);
            tries.rays += light * (rays(scene) - before);
            let ratio = drawn.map_or(0.0, |proposal| proposal.ratio);
            if ratio > 0.0 {
                let a = ratio.min(1.0);
                let jump = ((y.film() - x.film()) * size).length();
                tries.acceptance += light * a;
                tries.jumps += light * a * (1.0 + jump).log2();
            }
        }
    }
}

/// Rays of both sorts that a worker has cast.
fn rays(scene: &Tracer<'_>) -> f64 {
    let counts = RayCounts::of(scene);
    (counts.rays + counts.shadow_rays) as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::fixtures::{diffuse_room, specular_room};

    fn settings(threads: usize) -> PilotSettings {
        PilotSettings { seed: 3, threads, samples: 4096, stop: Stop::default() }
    }

    #[test]
    fn the_pilot_does_not_depend_on_threads() {
        let scene = specular_room().build();
        let options = StrategyOptions::default();
        let alone = survey(&scene, &options, &settings(1));
        let together = survey(&scene, &options, &settings(3));
        assert_eq!(alone.prospects, together.prospects);
        assert_eq!(alone.rays, together.rays);
        let weights = alone.mixture.weights();
        assert_eq!(weights, together.mixture.weights());
        assert_ne!(weights, survey(&scene, &off(), &settings(1)).mixture.weights());
    }

    fn off() -> StrategyOptions {
        let mut options = StrategyOptions::default();
        options.adapt = Some(false);
        options
    }

    #[test]
    fn who_switches_it_off_keeps_the_weights() {
        let scene = diffuse_room().build();
        let Survey { mixture, prospects, .. } = survey(&scene, &off(), &settings(2));
        let basis = MixtureBasis::of(&scene, &[]);
        assert_eq!(mixture.weights(), Mixture::new(&off(), &basis).weights());
        assert!(prospects.iter().all(|p| p.name != "multi-chain"), "nothing is specular");
    }

    #[test]
    fn strategies_without_light_get_the_least() {
        let prospect = |light: f64, gain: f64| Prospect { light, gain, ..Prospect::default() };
        let prospects = [prospect(1.0, 2.0), prospect(0.5, 2.0), prospect(1e-6, 9.0)];
        let weights = adapted(&[0.6, 0.2, 0.2], &prospects);
        assert_eq!(weights[2], LEAST, "it has next to no light");
        assert!((weights[0] / weights[1] - 3.0).abs() < 1e-12, "equal gains change nothing");
        let prospects = [prospect(1.0, 4.0), prospect(1.0, 1.0), prospect(0.05, 1e-3)];
        let weights = adapted(&[0.4, 0.4, 0.2], &prospects);
        assert!((weights[0] / weights[1] - 2.0).abs() < 1e-12, "the root of the gains");
        assert!(weights[2] > 0.19, "a specialist keeps its weight: {weights:?}");
        let prospects = [prospect(1.0, 1.0), prospect(1.0, 1e9)];
        let weights = adapted(&[0.5, 0.5], &prospects);
        assert!(weights[1] / weights[0] <= FREEDOM * FREEDOM + 1e-12, "within its freedom");
        assert!(
            adapted(&[0.5, 0.5], &[prospect(1.0, 0.0), prospect(1.0, 0.0)])
                .iter()
                .all(|w| *w > 0.0)
        );
    }
}
