//! Sums that do not lose small terms.

/// A running sum, sum of squares and count with compensated addition [Neumaier 1974].
#[derive(Clone, Copy, Debug, Default)]
pub struct Accumulator {
    count: u64,
    sum: Compensated,
    squares: Compensated,
}

#[derive(Clone, Copy, Debug, Default)]
struct Compensated {
    sum: f64,
    lost: f64,
}

impl Compensated {
    fn add(&mut self, value: f64) {
        let sum = self.sum + value;
        self.lost += if self.sum.abs() >= value.abs() {
            (self.sum - sum) + value
        } else {
            (value - sum) + self.sum
        };
        self.sum = sum;
    }

    fn total(self) -> f64 {
        self.sum + self.lost
    }
}

impl Accumulator {
    /// Takes in one sample.
    pub fn add(&mut self, value: f64) {
        self.count += 1;
        self.sum.add(value);
        self.squares.add(value * value);
    }

    /// Number of samples.
    pub fn count(&self) -> u64 {
        self.count
    }

    /// Sum of the samples.
    pub fn sum(&self) -> f64 {
        self.sum.total()
    }

    /// Sum of their squares.
    pub fn sum_of_squares(&self) -> f64 {
        self.squares.total()
    }

    /// Their mean; zero without samples.
    pub fn mean(&self) -> f64 {
        if self.count == 0 { 0.0 } else { self.sum() / self.count as f64 }
    }

    /// Standard error of the mean; zero with fewer than two samples.
    pub fn standard_error(&self) -> f64 {
        if self.count < 2 {
            return 0.0;
        }
        let n = self.count as f64;
        let variance = (self.sum_of_squares() / n - self.mean().powi(2)).max(0.0) * n / (n - 1.0);
        (variance / n).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_terms_are_kept() {
        let mut sum = Accumulator::default();
        sum.add(1e16);
        for _ in 0..1000 {
            sum.add(0.5);
        }
        assert_eq!(sum.sum(), 1e16 + 500.0, "a thousand halves were lost");
    }

    #[test]
    fn standard_error_of_a_coin() {
        let mut coin = Accumulator::default();
        for i in 0..100 {
            coin.add(f64::from(i % 2));
        }
        assert!((coin.mean() - 0.5).abs() < 1e-15, "the mean of a fair coin");
        assert!((coin.standard_error() - 0.5 / 99_f64.sqrt()).abs() < 1e-12, "sd / sqrt(n)");
    }
}
