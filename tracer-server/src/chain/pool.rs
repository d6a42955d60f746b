//! Independent samples that give both the normalisation and the starts of chains.
//!
//! Because both come from one pool, the image is unbiased however short the chains are
//! [Veach 1997, section 11.3.1].

use crate::math::{Accumulator, Rng};
use crate::scene::Scene;

/// The mean luminance of an image, `b`, as samples tell it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Normalization {
    /// The estimate, in the file's units.
    pub b: f64,
    /// Its standard error.
    pub error: f64,
}

impl Normalization {
    /// As the samples of a pool tell it.
    pub fn of(pool: &Pool, scene: &Scene) -> Self {
        let scale = scene.radiance_scale();
        Self { b: pool.normalization() * scale, error: pool.normalization_error() * scale }
    }
}

/// The weights of numbered samples. A sample can be drawn again by its number.
///
/// How many there are is decided before the first is drawn: a pool that grew until its own spread
/// looked small would stop too early where rare paths are bright, and stop too dark.
#[derive(Clone, Debug)]
pub struct Pool {
    weights: Vec<f64>,
    total: Accumulator,
}

impl Pool {
    /// Of these weights.
    pub fn of(weights: Vec<f64>) -> Self {
        let mut total = Accumulator::default();
        for &weight in &weights {
            total.add(weight);
        }
        Self { weights, total }
    }

    /// Kurtosis of the weights: 3 for a normal distribution, large where few samples have most of the
    /// weight, so that an error of the mean cannot be trusted.
    pub fn kurtosis(&self) -> f64 {
        let (n, mean) = (self.weights.len() as f64, self.total.mean());
        let moment = |power: i32| {
            self.weights.iter().map(|weight| (weight - mean).powi(power)).sum::<f64>() / n
        };
        moment(4) / moment(2).powi(2)
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
