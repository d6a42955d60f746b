//! One Markov chain in primary-sample space.

use super::coordinates::Point;
use super::sampler::{Sample, Sampler};
use crate::chain::{ChainStatistics, Outcome, Step};
use crate::film::Film;
use crate::math::Rng;
use crate::path::Failure;

/// The two kinds of step, as strategies in statistics.
pub const STEPS: [&str; 2] = ["large step", "small step"];

/// What a sample counts on the film.
///
/// The balance heuristic between the chain, which visits the sample with density `I / b`, and the
/// large steps, which are uniform samples besides [Kelemen et al. 2002, section 3.2]. `b` must not change during a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Balance {
    /// `b`: mean intensity of uniform samples.
    pub normalization: f64,
    /// Probability of a large step.
    pub large: f64,
}

impl Balance {
    #[inline]
    fn weight(self, intensity: f64) -> f64 {
        1.0 / (intensity / self.normalization + self.large)
    }
}

/// One chain: its state, its random stream and its counts.
#[derive(Clone, Debug)]
pub struct PrimaryChain<P> {
    rng: Rng,
    point: P,
    large: f64,
    current: Sample,
    proposal: Sample,
    /// Weight that the current sample has gathered since it was last splatted.
    pending: f64,
    steps: u64,
    /// The step that made the current sample.
    arrival: u64,
    statistics: ChainStatistics,
}

impl<P: Point> PrimaryChain<P> {
    /// A chain at `point`, whose numbers make the sample `current`. `large` is the probability of a
    /// large step.
    pub fn new(rng: Rng, point: P, current: Sample, large: f64) -> Self {
        Self {
            rng,
            point,
            large,
            current,
            proposal: Sample::default(),
            pending: 0.0,
            steps: 0,
            arrival: 0,
            statistics: ChainStatistics::new(STEPS.len()),
        }
    }

    /// Counts since the start.
    pub fn statistics(&self) -> &ChainStatistics {
        &self.statistics
    }

    /// Steps since the current sample was accepted.
    pub fn stay(&self) -> u64 {
        self.steps - self.arrival
    }

    /// The current sample.
    #[cfg(test)]
    pub(super) fn current(&self) -> &Sample {
        &self.current
    }

    /// Tries one step. Both samples are recorded with their expected weights, and the proposal of a
    /// large step once more as the uniform sample that it is.
    #[inline]
    pub fn step(&mut self, sampler: &mut impl Sampler, balance: Balance, film: &mut Film) {
        self.steps += 1;
        let large = self.rng.uniform() < self.large;
        self.point.propose(large);
        sampler.sample(&mut self.point, &mut self.proposal);
        let outcome = self.decide(large, balance, film);
        let (acceptance, outcome) = match outcome {
            Ok((a, true)) => (a, Outcome::Accepted { kept_light: 0, kept_eye: 0 }),
            Ok((a, false)) => (a, Outcome::Rejected),
            Err(failure) => {
                self.pending += 1.0;
                (0.0, Outcome::Failed(failure))
            }
        };
        if !matches!(outcome, Outcome::Accepted { .. }) {
            self.point.reject();
        }
        self.statistics.record(&Step { strategy: usize::from(!large), acceptance, outcome });
    }

    /// The acceptance probability of the proposal, and whether it was accepted.
    fn decide(
        &mut self,
        large: bool,
        balance: Balance,
        film: &mut Film,
    ) -> Result<(f64, bool), Failure> {
        let intensity = self.proposal.intensity();
        if !(intensity.is_finite() && self.proposal.is_physical()) {
            return Err(Failure::NotFinite);
        }
        if !(intensity > 0.0) {
            return Err(Failure::ZeroContribution);
        }
        // The state has light on it: the start was drawn in proportion to it.
        let a = (intensity / self.current.intensity()).min(1.0);
        self.pending += 1.0 - a;
        let gathered = a + f64::from(u8::from(large));
        if self.rng.uniform() < a {
            self.flush(balance, film);
            std::mem::swap(&mut self.current, &mut self.proposal);
            self.pending = gathered;
            self.statistics.leave(self.stay());
            self.arrival = self.steps;
            self.point.accept();
            return Ok((a, true));
        }
        self.proposal.splat(gathered * balance.weight(intensity), film);
        Ok((a, false))
    }

    /// Adds the current sample's gathered weight to the film.
    pub fn flush(&mut self, balance: Balance, film: &mut Film) {
        if self.pending > 0.0 {
            let weight = balance.weight(self.current.intensity());
            self.current.splat(self.pending * weight, film);
            self.pending = 0.0;
        }
    }
}
