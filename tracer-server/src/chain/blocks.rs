//! How long a chain remembers: means over ever longer blocks of its steps
//! [Flyvbjerg and Petersen 1989].
//!
//! Blocks of two are merged from level to level, so that a step costs two additions on average and
//! nothing is stored but sums.

/// Levels: blocks of up to 2^40 steps.
const LEVELS: usize = 41;
/// Blocks that a level must have before its variance is believed: to about six per cent.
const ENOUGH: u64 = 512;

/// Sums over the blocks of one length.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Level {
    count: u64,
    sum: f64,
    squares: f64,
    /// The mean of the last block while it waits for its partner.
    waiting: f64,
}

impl Level {
    fn mean(&self) -> f64 {
        self.sum / self.count as f64
    }

    fn variance(&self) -> f64 {
        let mean = self.mean();
        (self.squares / self.count as f64 - mean * mean).max(0.0)
    }
}

/// Sums over blocks of every length that is a power of two.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Blocks {
    levels: [Level; LEVELS],
}

impl Default for Blocks {
    fn default() -> Self {
        Self { levels: [Level::default(); LEVELS] }
    }
}

impl Blocks {
    /// Takes in the value of the next step.
    #[inline]
    pub(super) fn push(&mut self, value: f64) {
        let mut mean = value;
        for level in &mut self.levels {
            level.count += 1;
            level.sum += mean;
            level.squares += mean * mean;
            if level.count % 2 == 1 {
                level.waiting = mean;
                return;
            }
            mean = 0.5 * (level.waiting + mean);
        }
    }

    /// Adds the sums of another chain. The result can be asked, but takes no more steps.
    pub(super) fn add(&mut self, other: &Self) {
        for (sum, level) in self.levels.iter_mut().zip(&other.levels) {
            sum.count += level.count;
            sum.sum += level.sum;
            sum.squares += level.squares;
        }
    }

    /// Steps taken in.
    pub(super) fn steps(&self) -> u64 {
        self.levels[0].count
    }

    /// Mean and variance of the values.
    pub(super) fn moments(&self) -> (f64, f64) {
        (self.levels[0].mean(), self.levels[0].variance())
    }

    /// Correlation between neighbouring blocks of `2^k` steps, at index `k`, as far as there are
    /// enough of them. Two blocks of variance `V` and correlation `r` have a mean of variance
    /// `V (1 + r) / 2`.
    pub(super) fn correlations(&self) -> Vec<f32> {
        let pairs = self.levels.iter().zip(&self.levels[1..]);
        let known =
            pairs.take_while(|(block, merged)| merged.count >= ENOUGH && block.variance() > 0.0);
        known
            .map(|(block, merged)| (2.0 * merged.variance() / block.variance() - 1.0) as f32)
            .map(|r| r.clamp(-1.0, 1.0))
            .collect()
    }

    /// How many steps are worth an independent one: the variance of the mean over that of as many
    /// independent values, at the length of blocks where it is largest. `None` while nothing varies
    /// or too little is known.
    pub(super) fn correlation_steps(&self) -> Option<f64> {
        let variance = self.levels[0].variance();
        let known = self.levels.iter().zip(0..).take_while(|(level, _)| level.count >= ENOUGH);
        let inflation = known.map(|(level, k)| 2_f64.powi(k) * level.variance() / variance);
        inflation.reduce(f64::max).filter(|steps| steps.is_finite())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{Rng, Stream};

    /// Chains of `x' = rho x + sqrt(1 - rho^2) noise`, whose correlation over n steps is rho^n.
    fn chains(rho: f64, count: u64, steps: u64) -> Blocks {
        let mut pooled = Blocks::default();
        for chain in 0..count {
            let mut rng = Rng::new(11, Stream::Laboratory, chain);
            // A sum of twelve uniforms is as good as normal here, where only moments count.
            let mut noise = || (0..12).map(|_| rng.uniform()).sum::<f64>() - 6.0;
            let mut blocks = Blocks::default();
            let mut x = noise();
            for _ in 0..steps {
                blocks.push(x);
                x = rho * x + (1.0 - rho * rho).sqrt() * noise();
            }
            pooled.add(&blocks);
        }
        pooled
    }

    /// The exact correlation between the means of neighbouring blocks of n steps.
    fn exact(rho: f64, n: i32) -> f64 {
        let weight = |lag: i32| f64::from(n - (lag - n).abs());
        let covariance: f64 = (1..2 * n).map(|lag| weight(lag) * rho.powi(lag)).sum();
        let variance: f64 =
            f64::from(n) + (1..n).map(|lag| 2.0 * f64::from(n - lag) * rho.powi(lag)).sum::<f64>();
        covariance / variance
    }

    #[test]
    fn the_memory_of_a_known_process_is_found() {
        for rho in [0.0, 0.5, 0.95] {
            let blocks = chains(rho, 32, 1 << 15);
            let found = blocks.correlations();
            assert!(found.len() > 8, "{} scales", found.len());
            for (k, &r) in found.iter().enumerate() {
                // The standard error of a correlation is at most that of independent pairs.
                let pairs = (blocks.steps() >> (k + 1)) as f64;
                let correlated = (1.0 + rho) / (1.0 - rho);
                let error = (correlated / pairs).sqrt().max(1.0 / pairs.sqrt());
                let z = (f64::from(r) - exact(rho, 1 << k)) / error;
                assert!(z.abs() < 6.0, "rho {rho}, blocks of 2^{k}: {r} is {z} errors off");
            }
            let steps = blocks.correlation_steps().expect("enough is known");
            let truth = (1.0 + rho) / (1.0 - rho);
            // The largest of several levels, each known to six per cent, lies somewhat too high.
            assert!((0.9..1.35).contains(&(steps / truth)), "rho {rho}: {steps} for {truth}");
        }
    }

    /// Breaking the law must show: values that are held for two steps are no independent ones.
    #[test]
    fn a_repeated_step_is_no_new_one() {
        let mut rng = Rng::new(5, Stream::Laboratory, 0);
        let mut blocks = Blocks::default();
        for _ in 0..1 << 16 {
            let value = rng.uniform();
            blocks.push(value);
            blocks.push(value);
        }
        let r = blocks.correlations();
        assert_eq!(r.first(), Some(&1.0), "each pair is twice the same");
        assert!(r[1].abs() < 0.05, "and pairs are independent: {}", r[1]);
        let steps = blocks.correlation_steps().expect("enough is known");
        assert!((1.8..2.6).contains(&steps), "two steps are worth one: {steps}");
    }

    #[test]
    fn what_does_not_vary_says_nothing() {
        let mut blocks = Blocks::default();
        (0..10_000).for_each(|_| blocks.push(3.0));
        assert_eq!(blocks.correlation_steps(), None, "no variance");
        assert!(blocks.correlations().is_empty(), "no correlation");
        assert_eq!(Blocks::default().correlation_steps(), None, "no steps");
    }
}
