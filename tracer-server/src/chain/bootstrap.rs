//! The pool of bidirectional samples that gives both the normalisation and the chains' seeds.

use super::{EnsembleSettings, Pool};
use crate::math::{Rng, Stream};
use crate::parallel::Stop;
use crate::path::{Aim, BidirectionalSampler, Path};
use crate::scene::{Scene, Tracer};

/// How large the pool may become.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BootstrapSettings {
    /// Number of the run; the same number gives the same pool.
    pub seed: u64,
    /// Worker threads; the pool does not depend on it.
    pub threads: usize,
    /// Samples drawn before anything is judged.
    pub min_samples: u64,
    /// Samples drawn at most.
    pub max_samples: u64,
    /// Relative standard error of the normalisation that is good enough.
    pub relative_error: f64,
    /// Seeds that will be asked for.
    pub chains: u32,
}

impl From<&EnsembleSettings> for BootstrapSettings {
    fn from(settings: &EnsembleSettings) -> Self {
        Self {
            seed: settings.seed,
            threads: settings.threads,
            min_samples: (settings.bootstrap_samples / 8).max(1),
            max_samples: settings.bootstrap_samples,
            relative_error: settings.precision,
            chains: settings.chains,
        }
    }
}

/// The pool, reduced to what is needed of it.
#[derive(Clone, Debug)]
pub struct Bootstrap {
    seed: u64,
    pool: Pool,
}

impl Bootstrap {
    /// Draws samples until the normalisation is good enough and the seeds are diverse, or until
    /// the budget is spent; where it is told to `stop`, there are no seeds. `on_progress` hears the
    /// number of samples drawn.
    pub fn new(
        scene: &Scene,
        settings: &BootstrapSettings,
        stop: &Stop,
        on_progress: impl FnMut(u64),
    ) -> Self {
        let seed = settings.seed;
        let start = || Replay::new(scene, seed);
        let pool = Pool::new(settings, start, Replay::weight, stop, on_progress);
        Self { seed, pool }
    }

    /// `b`: the mean luminance of the image, in film units of the scene.
    pub fn normalization(&self) -> f64 {
        self.pool.normalization()
    }

    /// Standard error of `b`.
    pub fn normalization_error(&self) -> f64 {
        self.pool.normalization_error()
    }

    /// Number of samples.
    pub fn sample_count(&self) -> u64 {
        self.pool.sample_count()
    }

    /// `count` seeds by systematic resampling of the pool, and among the paths of each sample.
    /// Empty when no sample carries light.
    pub fn seeds(&self, scene: &Scene, count: u32) -> Vec<Path> {
        let mut rng = Rng::new(self.seed, Stream::Resampling, 0);
        let mut replay = Replay::new(scene, self.seed);
        let samples = self.pool.resample(count, &mut rng);
        samples.into_iter().map(|(n, weight)| replay.pick(n, weight, rng.uniform())).collect()
    }
}

/// Rebuilds samples of the pool from their keys.
struct Replay<'s> {
    scene: Tracer<'s>,
    seed: u64,
    sampler: BidirectionalSampler,
}

impl<'s> Replay<'s> {
    fn new(scene: &'s Scene, seed: u64) -> Self {
        let scene = Tracer::new(scene);
        let sampler = BidirectionalSampler::new(&scene);
        Self { scene, seed, sampler }
    }

    fn sample(&mut self, number: u64, visit: impl FnMut(&Path, f64)) {
        let mut rng = Rng::new(self.seed, Stream::Bootstrap, number);
        let aim = Aim::from_numbers(&self.scene, &mut rng);
        self.sampler.sample(&self.scene, aim, &mut rng, visit);
    }

    fn weight(&mut self, number: u64) -> f64 {
        let mut sum = 0.0;
        self.sample(number, |_, weight| sum += weight);
        sum
    }

    /// One path of a sample, chosen by `u` in proportion to the paths' weights.
    fn pick(&mut self, number: u64, expected: f64, u: f64) -> Path {
        let (mut rest, mut sum) = (u * expected, 0.0);
        let mut chosen = None;
        self.sample(number, |path, weight| {
            sum += weight;
            if rest >= 0.0 {
                chosen = Some(path.clone());
                rest -= weight;
            }
        });
        debug_assert_eq!(sum.to_bits(), expected.to_bits(), "a sample was not rebuilt exactly");
        chosen.unwrap_or_default()
    }
}
