//! Pools of bidirectional samples, which give both a normalisation and the chains' seeds.

use super::Pool;
use crate::math::{Rng, Stream};
use crate::parallel::{self, Stop};
use crate::path::{BidirectionalSampler, CameraSample, Path};
use crate::scene::{Scene, Tracer};
use crate::target::Target;

/// Samples that one worker draws in one go.
const CHUNK: u64 = 2048;

/// Which pool: pools of different keys share no random number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PoolKey {
    /// Number of the run; the same number gives the same pool.
    pub seed: u64,
    /// Number of the pool in the run.
    pub number: u64,
}

/// Draws the samples of a pool, and draws them again.
///
/// The samples are bidirectional ones over all splits, whatever base sampler there is: seeds of a path
/// tracer would never be what path tracing cannot find.
#[derive(Debug)]
pub struct Source<'a, 's> {
    scene: &'a Tracer<'s>,
    key: PoolKey,
    target: &'a Target,
    sampler: BidirectionalSampler,
}

impl<'a, 's> Source<'a, 's> {
    /// The source of seeds for chains that visit `target`.
    pub fn new(scene: &'a Tracer<'s>, key: PoolKey, target: &'a Target) -> Self {
        Self { scene, key, target, sampler: BidirectionalSampler::new(scene) }
    }

    /// Draws the first `count` samples.
    pub fn pool(&mut self, count: u64) -> Pool {
        Pool::of((0..count).map(|number| self.weight(number)).collect())
    }

    /// Numbered samples are spread over keys far apart, so that no pool meets another.
    fn sample(&mut self, number: u64, mut visit: impl FnMut(&Path, f64)) {
        let index = self.key.number << 32 | number;
        let mut rng = Rng::new(self.key.seed, Stream::Bootstrap, index);
        let aim = CameraSample::from_numbers(self.scene, &mut rng);
        let target = self.target;
        self.sampler.sample(self.scene, aim, &mut rng, |path, weight| {
            visit(path, weight * target.importance(path).rho);
        });
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
            if rest >= 0.0 && weight > 0.0 {
                chosen = Some(path.clone());
                rest -= weight;
            }
        });
        debug_assert_eq!(sum.to_bits(), expected.to_bits(), "a sample was not rebuilt exactly");
        chosen.unwrap_or_default()
    }

    /// `count` seeds by systematic resampling of the pool, and among the paths of each sample.
    /// Empty when no sample has any weight.
    pub fn seeds(&mut self, pool: &Pool, count: u32) -> Vec<Path> {
        let mut rng = Rng::new(self.key.seed, Stream::Resampling, self.key.number);
        let samples = pool.resample(count, &mut rng);
        samples.into_iter().map(|(n, weight)| self.pick(n, weight, rng.uniform())).collect()
    }
}

/// How a pool is drawn on many threads.
#[derive(Clone, Copy, Debug)]
pub struct Drawing<'a> {
    /// Samples of the pool.
    pub samples: u64,
    /// Worker threads; the pool does not depend on it.
    pub threads: usize,
    /// A pool that is told to stop is empty.
    pub stop: &'a Stop,
}

/// Draws a pool of seeds for chains that visit `target`. `on_progress` hears the number of samples drawn.
pub fn draw_pool(
    scene: &Scene,
    key: PoolKey,
    target: &Target,
    drawing: Drawing<'_>,
    on_progress: impl FnMut(u64),
) -> Pool {
    let start = || Tracer::new(scene);
    let draw = |tracer: &mut Tracer<'_>, numbers: std::ops::Range<u64>| {
        let mut source = Source::new(tracer, key, target);
        numbers.map(|number| source.weight(number)).collect()
    };
    Pool::gather(drawing, start, draw, on_progress)
}

impl Pool {
    /// Gathers weights in chunks, which `draw` gives by their numbers.
    pub fn gather<S: Send>(
        drawing: Drawing<'_>,
        start: impl Fn() -> S + Sync,
        draw: impl Fn(&mut S, std::ops::Range<u64>) -> Vec<f64> + Sync,
        mut on_progress: impl FnMut(u64),
    ) -> Self {
        /// Chunks between two reports.
        const REPORT: u64 = 8;
        let Drawing { samples, threads, stop } = drawing;
        let chunks = samples.div_ceil(CHUNK);
        let mut weights = Vec::new();
        for first in (0..chunks).step_by(REPORT as usize) {
            let numbers = first..(first + REPORT).min(chunks);
            let drawn = parallel::map(threads, numbers, &start, |state, chunk| {
                let numbers = chunk * CHUNK..((chunk + 1) * CHUNK).min(samples);
                if stop.is_set() { Vec::new() } else { draw(state, numbers) }
            });
            if stop.is_set() {
                return Self::of(Vec::new());
            }
            weights.extend(drawn.into_iter().flatten());
            on_progress(weights.len() as u64);
        }
        Self::of(weights)
    }
}
