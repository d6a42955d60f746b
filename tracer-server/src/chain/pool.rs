//! Independent samples that give both the normalisation and the starts of chains.
//!
//! Because both come from one pool, the image is unbiased however short the chains are
//! [Veach 1997, section 11.3.1].

use super::BootstrapSettings;
use crate::math::{Accumulator, Rng};
use crate::parallel::{self, Stop};

/// Samples that one worker draws in one go.
const CHUNK: u64 = 2048;

/// The weights of numbered samples. A sample can be drawn again by its number.
#[derive(Clone, Debug)]
pub struct Pool {
    weights: Vec<f64>,
    total: Accumulator,
}

impl Pool {
    /// Draws samples until the mean weight is known well enough and the starts are diverse, or until
    /// the budget is spent. A pool that was told to `stop` is not whole, and has no starts.
    ///
    /// `weigh` gives the weight of the sample with a number; `start` makes what a worker needs for
    /// that. `on_progress` hears the number of samples drawn.
    pub fn new<S: Send>(
        settings: &BootstrapSettings,
        start: impl Fn() -> S + Sync,
        weigh: impl Fn(&mut S, u64) -> f64 + Sync,
        stop: &Stop,
        mut on_progress: impl FnMut(u64),
    ) -> Self {
        let mut pool = Self { weights: Vec::new(), total: Accumulator::default() };
        let draw = |state: &mut S, number: u64| -> Vec<f64> {
            let samples = number * CHUNK..(number + 1) * CHUNK;
            if stop.is_set() { Vec::new() } else { samples.map(|n| weigh(state, n)).collect() }
        };
        let mut target = settings.min_samples.max(CHUNK);
        loop {
            let chunks = pool.weights.len() as u64 / CHUNK..target.div_ceil(CHUNK);
            let drawn = parallel::map(settings.threads, chunks, &start, draw);
            if stop.is_set() {
                pool.weights.clear();
                return pool;
            }
            for weights in drawn {
                pool.add(weights);
            }
            let drawn = pool.sample_count();
            on_progress(drawn);
            if pool.is_good(settings) || drawn >= settings.max_samples {
                return pool;
            }
            target = (2 * drawn).min(settings.max_samples);
        }
    }

    fn add(&mut self, weights: Vec<f64>) {
        for &weight in &weights {
            self.total.add(weight);
        }
        self.weights.extend(weights);
    }

    fn is_good(&self, settings: &BootstrapSettings) -> bool {
        let precise = self.total.standard_error() <= settings.relative_error * self.total.mean();
        let sum = self.total.sum();
        let diversity = sum * sum / self.total.sum_of_squares();
        precise && diversity >= 10.0 * f64::from(settings.chains)
    }

    /// `b`: the mean weight.
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

    /// Numbers and weights of `count` samples by systematic resampling: one random offset, equal
    /// distances along the cumulated weights. Empty when no sample has any weight.
    pub fn resample(&self, count: u32, rng: &mut Rng) -> Vec<(u64, f64)> {
        let total: f64 = self.weights.iter().sum();
        if !(total > 0.0) {
            return Vec::new();
        }
        let offset = rng.uniform();
        let (mut sample, mut cumulated) = (0, self.weights[0]);
        let pick = |j: u32| {
            let position = (offset + f64::from(j)) / f64::from(count) * total;
            while cumulated <= position && sample + 1 < self.weights.len() {
                sample += 1;
                cumulated += self.weights[sample];
            }
            // Rounding at the end of the table could stop at a sample without light.
            while self.weights[sample] == 0.0 {
                sample -= 1;
            }
            (sample as u64, self.weights[sample])
        };
        (0..count).map(pick).collect()
    }
}
