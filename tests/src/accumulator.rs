//! Mean and variance of a stream of numbers.

use crate::ZScore;

/// Running mean and variance of independent samples, in one pass and without cancellation
/// \[Welford 1962\].
///
/// ```
/// let mut heights = tests::Accumulator::default();
/// for sample in [1.0, 2.0, 4.0, 5.0] {
///     heights.push(sample);
/// }
/// assert_eq!(heights.mean(), 3.0);
/// assert!(heights.z_against(3.0).0.abs() < 1e-12);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Accumulator {
    count: u64,
    mean: f64,
    /// Sum of the squared deviations from the mean.
    squares: f64,
}

impl Accumulator {
    /// Takes one more sample. A NaN poisons the mean for good, so that no test can pass with it.
    pub fn push(&mut self, sample: f64) {
        self.count += 1;
        let deviation = sample - self.mean;
        self.mean += deviation / self.count as f64;
        self.squares += deviation * (sample - self.mean);
    }

    /// Takes all samples of `other`, as if they had been pushed one by one \[Chan et al. 1983\].
    pub fn merge(&mut self, other: &Self) {
        if other.count == 0 {
            return;
        }
        let (n, m) = (self.count as f64, other.count as f64);
        let deviation = other.mean - self.mean;
        self.count += other.count;
        self.mean += deviation * m / (n + m);
        self.squares += other.squares + deviation * deviation * n * m / (n + m);
    }

    /// The number of samples.
    pub fn count(&self) -> u64 {
        self.count
    }

    /// The mean of the samples; zero without any.
    pub fn mean(&self) -> f64 {
        self.mean
    }

    /// The unbiased estimate of the variance of one sample; NaN with fewer than two.
    pub fn variance(&self) -> f64 {
        if self.count < 2 { f64::NAN } else { self.squares / (self.count - 1) as f64 }
    }

    /// The standard error of the mean; NaN with fewer than two samples.
    pub fn standard_error(&self) -> f64 {
        (self.variance() / self.count as f64).sqrt()
    }

    /// How many standard errors the mean lies above `expected`.
    ///
    /// Samples that are all equal to `expected` give zero; all equal but to something else,
    /// infinity; fewer than two samples, NaN, which fails every test.
    pub fn z_against(&self, expected: f64) -> ZScore {
        let difference = self.mean - expected;
        let error = self.standard_error();
        ZScore(if difference == 0.0 && error == 0.0 { 0.0 } else { difference / error })
    }
}

impl Extend<f64> for Accumulator {
    fn extend<I: IntoIterator<Item = f64>>(&mut self, samples: I) {
        for sample in samples {
            self.push(sample);
        }
    }
}

impl FromIterator<f64> for Accumulator {
    fn from_iter<I: IntoIterator<Item = f64>>(samples: I) -> Self {
        let mut accumulator = Self::default();
        accumulator.extend(samples);
        accumulator
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_large_offset_does_not_cancel() {
        let shifted: Accumulator = [4.0, 7.0, 13.0, 16.0].map(|x| x + 1e9).into_iter().collect();
        assert_eq!(shifted.mean(), 1e9 + 10.0, "the mean is exact");
        assert_eq!(shifted.variance(), 30.0, "the textbook formula would lose every digit");
    }

    #[test]
    fn merging_equals_pushing() {
        let samples: Vec<f64> = (0..100).map(|i| f64::from(i * i % 17)).collect();
        let whole: Accumulator = samples.iter().copied().collect();
        let mut merged = Accumulator::default();
        for part in samples.chunks(7) {
            merged.merge(&part.iter().copied().collect());
        }
        assert_eq!(merged.count(), 100, "nothing is lost");
        assert!((merged.mean() - whole.mean()).abs() < 1e-12, "{merged:?} is not {whole:?}");
        assert!((merged.variance() - whole.variance()).abs() < 1e-10, "{merged:?} / {whole:?}");
    }

    #[test]
    fn degenerate_samples_cannot_pass_by_accident() {
        let constant: Accumulator = [2.0; 5].into_iter().collect();
        assert_eq!(constant.z_against(2.0).0, 0.0, "exact agreement");
        assert_eq!(constant.z_against(1.0).0, f64::INFINITY, "certain disagreement");
        let single: Accumulator = std::iter::once(2.0).collect();
        assert!(single.z_against(2.0).0.is_nan(), "one sample proves nothing");
        let poisoned: Accumulator = [1.0, f64::NAN, 1.0].into_iter().collect();
        assert!(poisoned.z_against(1.0).0.is_nan(), "NaN stays visible");
    }
}
