//! How long a chain remembers: means over ever longer blocks of its steps
//! [Flyvbjerg and Petersen 1989].
//!
//! Blocks of two are merged from level to level, and nothing is stored but sums. A chain that stays
//! takes in the same value again and again; that is done for the whole stay at once.

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
    /// Takes in a block; the answer is the mean of a pair that it completes.
    #[inline]
    fn take_one(&mut self, mean: f64) -> Option<f64> {
        self.count += 1;
        self.sum += mean;
        self.squares += mean * mean;
        if self.count.is_multiple_of(2) {
            return Some(0.5 * (self.waiting + mean));
        }
        self.waiting = mean;
        None
    }

    /// Takes in `run` blocks of the same mean; the answer is the mean of the pair that the first one
    /// completes, if it does, and how many pairs of equal ones there are besides.
    #[inline]
    fn take_run(&mut self, mean: f64, run: u64) -> (Option<f64>, u64) {
        if run == 0 {
            return (None, 0);
        }
        let waits = self.count % 2;
        let completed = (waits == 1).then_some(0.5 * (self.waiting + mean));
        self.count += run;
        self.sum += run as f64 * mean;
        self.squares += run as f64 * mean * mean;
        if self.count % 2 == 1 {
            self.waiting = mean;
        }
        (completed, (run - waits) / 2)
    }

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
    /// Takes in the next `steps` steps, all of which have the same value.
    #[inline]
    pub(super) fn push(&mut self, value: f64, steps: u64) {
        // Each level takes a block that was merged with what waited below, if any, and then a run of
        // equal blocks.
        let (mut merged, mut run) = (None, steps);
        for level in &mut self.levels {
            if merged.is_none() && run == 0 {
                return;
            }
            let first = merged.take().and_then(|mean| level.take_one(mean));
            let (next, pairs) = level.take_run(value, run);
            merged = first.or(next);
            run = pairs;
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
                blocks.push(x, 1);
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
            blocks.push(value, 2);
        }
        let r = blocks.correlations();
        assert_eq!(r.first(), Some(&1.0), "each pair is twice the same");
        assert!(r[1].abs() < 0.05, "and pairs are independent: {}", r[1]);
        let steps = blocks.correlation_steps().expect("enough is known");
        assert!((1.8..2.6).contains(&steps), "two steps are worth one: {steps}");
    }

    #[test]
    fn a_stay_is_as_good_as_its_steps() {
        let mut rng = Rng::new(6, Stream::Laboratory, 0);
        let (mut stays, mut steps) = (Blocks::default(), Blocks::default());
        for _ in 0..5000 {
            // Multiples of 1/64, so that sums are exact in any order.
            let value = (64.0 * rng.uniform()).floor() / 64.0;
            let dwell = (40.0 * rng.uniform().powi(3)) as u64;
            stays.push(value, dwell);
            (0..dwell).for_each(|_| steps.push(value, 1));
        }
        assert!(steps.steps() > 10_000, "{} steps", steps.steps());
        for (stay, step) in stays.levels.iter().zip(&steps.levels) {
            assert_eq!(stay.count, step.count, "blocks of every length");
            assert!((stay.sum - step.sum).abs() < 1e-6 * step.sum.abs().max(1.0), "their sums");
            let tolerance = 1e-6 * step.squares.max(1.0);
            assert!((stay.squares - step.squares).abs() < tolerance, "and squares");
        }
    }

    #[test]
    fn what_does_not_vary_says_nothing() {
        let mut blocks = Blocks::default();
        blocks.push(3.0, 10_000);
        assert_eq!(blocks.correlation_steps(), None, "no variance");
        assert!(blocks.correlations().is_empty(), "no correlation");
        assert_eq!(Blocks::default().correlation_steps(), None, "no steps");
    }
}
