//! The pool of bidirectional samples that gives both the normalisation and the chains' seeds.
//!
//! Because both come from one pool, the image is unbiased however short the chains are
//! [Veach 1997, section 11.3.1].

use crate::math::{Accumulator, Rng, Stream};
use crate::parallel;
use crate::path::{Aim, BidirectionalSampler, Path};
use crate::scene::{Scene, Tracer};

/// Samples that one worker draws in one go.
const CHUNK: u64 = 2048;

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

/// The pool, reduced to what is needed of it.
#[derive(Clone, Debug)]
pub struct Bootstrap {
    seed: u64,
    weights: Vec<f64>,
    total: Accumulator,
    energy: Vec<f64>,
}

/// What one chunk of samples yields.
struct Chunk {
    weights: Vec<f64>,
    energy: Vec<f64>,
}

impl Bootstrap {
    /// Draws samples until the normalisation is good enough and the seeds are diverse, or until
    /// the budget is spent. `on_progress` hears the number of samples drawn.
    pub fn new(
        scene: &Scene,
        settings: &BootstrapSettings,
        mut on_progress: impl FnMut(u64),
    ) -> Self {
        let mut pool = Self {
            seed: settings.seed,
            weights: Vec::new(),
            total: Accumulator::default(),
            energy: vec![0.0; scene.max_edges() + 1],
        };
        let mut target = settings.min_samples.max(CHUNK);
        loop {
            let first = pool.weights.len() as u64 / CHUNK;
            for chunk in draw_chunks(scene, settings, first..target.div_ceil(CHUNK)) {
                chunk.weights.iter().for_each(|&w| pool.total.add(w));
                pool.weights.extend(chunk.weights);
                for (sum, energy) in pool.energy.iter_mut().zip(chunk.energy) {
                    *sum += energy;
                }
            }
            let drawn = pool.weights.len() as u64;
            on_progress(drawn);
            if pool.is_good(settings) || drawn >= settings.max_samples {
                return pool;
            }
            target = (2 * drawn).min(settings.max_samples);
        }
    }

    fn is_good(&self, settings: &BootstrapSettings) -> bool {
        let precise = self.normalization_error() <= settings.relative_error * self.normalization();
        let sum = self.total.sum();
        let diversity = sum * sum / self.total.sum_of_squares();
        precise && diversity >= 10.0 * f64::from(settings.chains)
    }

    /// `b`: the mean luminance of the image, in film units of the scene.
    pub fn normalization(&self) -> f64 {
        self.total.mean()
    }

    /// Standard error of `b`.
    pub fn normalization_error(&self) -> f64 {
        self.total.standard_error()
    }

    /// Number of samples.
    pub fn sample_count(&self) -> u64 {
        self.total.count()
    }

    /// Entry `k`: the light that paths of `k` edges carry, relative to the others.
    pub fn energy(&self) -> &[f64] {
        &self.energy
    }

    /// `count` seeds by systematic resampling: one random offset, equal distances along the
    /// cumulated weights. Empty when no sample carries light.
    pub fn seeds(&self, scene: &Scene, count: u32) -> Vec<Path> {
        let total: f64 = self.weights.iter().sum();
        if !(total > 0.0) {
            return Vec::new();
        }
        let mut rng = Rng::new(self.seed, Stream::Resampling, 0);
        let offset = rng.uniform();
        let mut seeds = Vec::with_capacity(count as usize);
        let mut replay = Replay::new(scene, self.seed);
        let (mut sample, mut cumulated) = (0, self.weights[0]);
        for j in 0..count {
            let position = (offset + f64::from(j)) / f64::from(count) * total;
            while cumulated <= position && sample + 1 < self.weights.len() {
                sample += 1;
                cumulated += self.weights[sample];
            }
            // Rounding at the end of the table could stop at a sample without light.
            while self.weights[sample] == 0.0 {
                sample -= 1;
            }
            seeds.push(replay.pick(sample as u64, self.weights[sample], rng.uniform()));
        }
        seeds
    }
}

/// Draws the chunks with the given numbers, on several threads, and returns them in order.
fn draw_chunks(
    scene: &Scene,
    settings: &BootstrapSettings,
    chunks: std::ops::Range<u64>,
) -> Vec<Chunk> {
    let mut results: Vec<Option<Chunk>> = chunks.clone().map(|_| None).collect();
    parallel::for_each(
        settings.threads,
        chunks.zip(results.iter_mut()),
        || Replay::new(scene, settings.seed),
        |replay, (number, slot)| *slot = Some(replay.chunk(number)),
    );
    results.into_iter().flatten().collect()
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

    fn weight(&mut self, number: u64, energy: &mut [f64]) -> f64 {
        let mut sum = 0.0;
        self.sample(number, |path, weight| {
            sum += weight;
            energy[path.edge_count()] += weight;
        });
        sum
    }

    fn chunk(&mut self, number: u64) -> Chunk {
        let mut energy = vec![0.0; self.scene.max_edges() + 1];
        let first = number * CHUNK;
        let weights = (first..first + CHUNK).map(|n| self.weight(n, &mut energy)).collect();
        Chunk { weights, energy }
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
