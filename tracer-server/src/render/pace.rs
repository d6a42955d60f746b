//! How much is done at a time, so that a budget is met.

use std::time::{Duration, Instant};

use super::{Budget, Work};
use crate::scene::Scene;

/// Rounds of a budget that is no time, at least.
const ROUNDS: u64 = 100;
/// Mutations or samples of all pixels together in a round, about, where that is less: so often it is seen
/// whether to stop.
const SAMPLES: u64 = 1 << 17;
/// A round under a time limit takes a share of the time that is left, within these limits.
const SHORTEST: f64 = 0.02;
/// See [`SHORTEST`].
const LONGEST: f64 = 0.2;
/// See [`SHORTEST`].
const SHARE: f64 = 0.25;

/// Share of a time limit that seeds may take.
const SEEDING: f64 = 0.2;

/// How many samples for seeds there is time for, where `drawn` of them took so long: that, and nothing
/// that is in the samples, decides how many there are.
pub(super) fn affordable_samples(limit: Duration, drawn: u64, took: Duration) -> u64 {
    (SEEDING * limit.as_secs_f64() / took.as_secs_f64().max(1e-9) * drawn as f64) as u64
}

/// Cuts a budget into rounds.
#[derive(Debug)]
pub(super) struct Pace {
    budget: Budget,
    /// When the render began, and when its seeds were there.
    began: Instant,
    seeded: Instant,
    /// What cannot be done in parts, and what makes a first image.
    unit: u64,
    first: u64,
    /// All work of a budget that is no time.
    total: u64,
    rounds: u64,
    done: u64,
}

impl Pace {
    /// For `work` that begins now, of a render that began at `began`.
    pub(super) fn new(work: &Work, scene: &Scene, budget: Budget, began: Instant) -> Self {
        let pixels = scene.camera().pixel_count() as u64;
        let unit = work.unit();
        let total = match budget {
            Budget::PerPixel(per_pixel) => (per_pixel * pixels).div_ceil(unit) * unit,
            Budget::Time(_) => u64::MAX,
        };
        // Samples begin with one through every pixel.
        let first = if work.chain_count().is_some() { unit } else { pixels };
        let seeded = Instant::now();
        Self { budget, began, seeded, unit, first, total, rounds: 0, done: 0 }
    }

    /// Share of the budget that is spent, from 0 to 1.
    pub(super) fn spent(&self) -> f64 {
        if self.done == 0 {
            return 0.0;
        }
        let spent = match self.budget {
            Budget::PerPixel(_) => self.done as f64 / self.total.max(1) as f64,
            Budget::Time(limit) => self.began.elapsed().as_secs_f64() / limit.as_secs_f64(),
        };
        spent.min(1.0)
    }

    /// Mutations or samples of the next round, of all pixels together; `None` when all is done.
    pub(super) fn next(&self) -> Option<u64> {
        match self.budget {
            Budget::PerPixel(_) => self.next_of_total(),
            Budget::Time(limit) => self.next_in(limit),
        }
    }

    /// Rounds differ by at most one unit, or one pass over all pixels.
    fn next_of_total(&self) -> Option<u64> {
        let grain = self.first.max(self.unit);
        let all = self.total / grain;
        let rounds = all.clamp(1, ROUNDS).max(self.total / SAMPLES).min(all.max(1));
        let upto = |round: u64| {
            if round >= rounds {
                self.total
            } else {
                (all / rounds * round + (all % rounds).min(round)) * grain
            }
        };
        let amount = upto(self.rounds + 1).saturating_sub(self.done);
        (amount > 0 && self.done < self.total).then_some(amount)
    }

    /// As much as will take a share of the time that is left, at the speed so far.
    fn next_in(&self, limit: Duration) -> Option<u64> {
        if self.done == 0 {
            return Some(self.first);
        }
        let left = limit.saturating_sub(self.began.elapsed()).as_secs_f64();
        let speed = self.done as f64 / self.seeded.elapsed().as_secs_f64().max(1e-9);
        let time = left.min((left * SHARE).clamp(SHORTEST, LONGEST));
        let mut amount = (speed * time) as u64 / self.unit * self.unit;
        if amount > self.first {
            // Whole passes, while there is time for some.
            amount = amount / self.first * self.first;
        }
        let worth = 0.5 * self.unit as f64 / speed;
        (left > worth && amount > 0).then_some(amount)
    }

    /// A round of that size is done.
    pub(super) fn done(&mut self, amount: u64) {
        self.done += amount;
        self.rounds += 1;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn seeds_take_a_fifth_of_the_time_at_most() {
        let samples = |limit, took| {
            let (limit, took) = (Duration::from_millis(limit), Duration::from_millis(took));
            affordable_samples(limit, 2048, took)
        };
        assert_eq!(samples(10_000, 1000), 4096, "two seconds of ten");
        assert_eq!(samples(100, 1000), 40, "less than were drawn");
        assert!(samples(1000, 0) > 1 << 30, "what takes no time is free");
    }
}
