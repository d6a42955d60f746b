//! Counts of what a chain has done.

use super::{Outcome, Step};
use crate::path::Failure;

const REASONS: usize = Failure::ALL.len();

/// Counts of one strategy. Rates are shares of all tries.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StrategyCounts {
    /// Steps that chose the strategy.
    pub proposed: u64,
    /// Proposals that were complete paths with light on them.
    pub generated: u64,
    /// Proposals that became the state.
    pub accepted: u64,
    /// Sum of acceptance probabilities, failures counting zero.
    pub acceptance_sum: f64,
    /// Failures by [`Failure`] code.
    pub failures: [u64; REASONS],
}

/// Counts of one chain, or of many added up.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ChainStatistics {
    /// One entry a strategy.
    pub strategies: Vec<StrategyCounts>,
    /// Steps.
    pub steps: u64,
    /// Closest-hit rays.
    pub rays: u64,
    /// Shadow rays.
    pub shadow_rays: u64,
    /// Longest time at one path, in steps.
    pub longest_dwell: u64,
}

impl ChainStatistics {
    /// Zero counts for a number of strategies.
    pub fn new(strategies: usize) -> Self {
        Self { strategies: vec![StrategyCounts::default(); strategies], ..Self::default() }
    }

    /// Counts one step.
    #[inline]
    pub fn record(&mut self, step: &Step) {
        self.steps += 1;
        let counts = &mut self.strategies[step.strategy];
        counts.proposed += 1;
        counts.acceptance_sum += step.acceptance;
        match step.outcome {
            Outcome::Failed(reason) => counts.failures[reason as usize] += 1,
            Outcome::Rejected => counts.generated += 1,
            Outcome::Accepted { .. } => {
                counts.generated += 1;
                counts.accepted += 1;
            }
        }
    }

    /// Counts that a state was left after `dwell` steps.
    pub fn leave(&mut self, dwell: u64) {
        self.longest_dwell = self.longest_dwell.max(dwell);
    }

    /// Adds the counts of another chain.
    pub fn add(&mut self, other: &Self) {
        for (sum, counts) in self.strategies.iter_mut().zip(&other.strategies) {
            sum.proposed += counts.proposed;
            sum.generated += counts.generated;
            sum.accepted += counts.accepted;
            sum.acceptance_sum += counts.acceptance_sum;
            for (total, count) in sum.failures.iter_mut().zip(counts.failures) {
                *total += count;
            }
        }
        self.steps += other.steps;
        self.rays += other.rays;
        self.shadow_rays += other.shadow_rays;
        self.longest_dwell = self.longest_dwell.max(other.longest_dwell);
    }

    /// Proposals refused because a number was NaN, infinite or negative.
    pub fn not_finite(&self) -> u64 {
        self.strategies.iter().map(|s| s.failures[Failure::NotFinite as usize]).sum()
    }
}
