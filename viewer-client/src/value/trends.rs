//! How the chains do over time: differences between successive counts of the daemon, which sees every
//! step.

use std::collections::VecDeque;

use common::Statistics;

/// Readings that are kept, at two a second: ten minutes.
const MOST: usize = 1200;

/// One reading.
#[derive(Clone, Debug, PartialEq)]
pub struct Reading {
    /// Seconds since the epoch began.
    pub seconds: f64,
    /// Mean acceptance probability of each strategy's proposals since the reading before; NaN where it
    /// made none.
    pub acceptance: Vec<f64>,
    /// Potential scale reduction between chains; zero while unknown.
    pub r_hat: f64,
}

/// The readings of the present epoch.
#[derive(Clone, Debug, Default)]
pub struct Trends {
    epoch: u32,
    /// Proposals and the sum of their acceptance probabilities, a strategy, at the last reading.
    last: Vec<(u64, f64)>,
    readings: VecDeque<Reading>,
}

impl Trends {
    /// Takes in new counts.
    pub fn push(&mut self, statistics: &Statistics) {
        if statistics.epoch != self.epoch {
            self.clear();
            self.epoch = statistics.epoch;
        }
        let counts: Vec<(u64, f64)> =
            statistics.strategies.iter().map(|s| (s.proposed, s.acceptance_sum)).collect();
        let newer = self.readings.back().is_none_or(|r| statistics.elapsed_seconds > r.seconds);
        if !newer {
            // The daemon repeats itself while nothing new is counted.
            return;
        }
        let before = |index: usize| self.last.get(index).copied().unwrap_or_default();
        let acceptance = counts.iter().enumerate().map(|(index, (proposed, sum))| {
            let (old_proposed, old_sum) = before(index);
            (sum - old_sum) / proposed.saturating_sub(old_proposed) as f64
        });
        let reading = Reading {
            seconds: statistics.elapsed_seconds,
            acceptance: acceptance.map(|a| if a.is_finite() { a } else { f64::NAN }).collect(),
            r_hat: statistics.diagnostics.as_ref().map_or(0.0, |d| d.r_hat),
        };
        if self.readings.len() == MOST {
            self.readings.pop_front();
        }
        self.readings.push_back(reading);
        self.last = counts;
    }

    /// Forgets all readings.
    pub fn clear(&mut self) {
        *self = Self::default();
    }

    /// The readings, oldest first.
    pub fn readings(&self) -> impl ExactSizeIterator<Item = &Reading> {
        self.readings.iter()
    }
}

#[cfg(test)]
mod tests {
    use common::StrategyStatistics;

    use super::*;

    fn counts(seconds: f64, proposed: u64, acceptance_sum: f64) -> Statistics {
        let strategy =
            StrategyStatistics { proposed, acceptance_sum, ..StrategyStatistics::default() };
        let strategies = vec![strategy, StrategyStatistics::default()];
        Statistics { elapsed_seconds: seconds, strategies, ..Statistics::default() }
    }

    #[test]
    fn a_reading_tells_what_was_new() {
        let mut trends = Trends::default();
        trends.push(&counts(1.0, 100, 50.0));
        trends.push(&counts(1.0, 100, 50.0));
        trends.push(&counts(2.0, 300, 60.0));
        let found: Vec<_> = trends.readings().map(|r| (r.seconds, r.acceptance[0])).collect();
        assert_eq!(found, [(1.0, 0.5), (2.0, 0.05)], "ten of two hundred, not sixty of 300");
        assert!(trends.readings().all(|r| r.acceptance[1].is_nan()), "no proposal, no mean");
        trends.push(&Statistics { epoch: 1, ..counts(0.5, 10, 10.0) });
        assert_eq!(trends.readings().len(), 1, "epochs never mix");
        for i in 0..5000 {
            trends.push(&Statistics { epoch: 1, ..counts(f64::from(i), 10, 10.0) });
        }
        assert_eq!(trends.readings().len(), MOST, "bounded");
    }
}
