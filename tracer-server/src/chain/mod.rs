//! Markov chains over paths.

mod bootstrap;
mod ensemble;
mod pilot;
mod pool;
mod statistics;
mod watch;

use common::{ChainId, PathHeader, PathId, StrategyId};

use crate::film::Film;
use crate::math::{Rng, Stream};
use crate::mutation::{Mixture, Proposal};
use crate::path::{Draft, Failure, Path};
use crate::scene::Tracer;

pub use bootstrap::{Bootstrap, BootstrapSettings};
pub use ensemble::{Ensemble, EnsembleSettings, LANES};
pub use pilot::{PilotSettings, Prospect, explore};
pub use pool::Pool;
pub use statistics::{ChainStatistics, StrategyCounts};
pub use watch::Watch;

/// What became of one step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// No proposal came about; the chain stayed.
    Failed(Failure),
    /// The proposal lost against its acceptance probability; the chain stayed.
    Rejected,
    /// The proposal is the new state. It shares this many vertices with the old one, from the
    /// light end and from the lens end.
    Accepted {
        /// From the light end.
        kept_light: usize,
        /// From the lens end.
        kept_eye: usize,
    },
}

/// One trial of a chain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step {
    /// Index of the strategy in the mixture.
    pub strategy: usize,
    /// Acceptance probability; zero for a failure.
    pub acceptance: f64,
    /// What became of it.
    pub outcome: Outcome,
}

/// One Markov chain: its state, its random stream and its counts.
#[derive(Clone, Debug)]
pub struct Chain {
    id: ChainId,
    rng: Rng,
    current: Box<Path>,
    proposal: Box<Path>,
    draft: Box<Draft>,
    /// `Z` of the current path.
    mixture_total: f64,
    /// Weight that the current path has gathered since it was last splatted.
    pending: f64,
    steps: u64,
    /// The step that made the current path, and its acceptance probability and strategy.
    arrival: (u64, f64, StrategyId),
    statistics: ChainStatistics,
}

/// The probability of accepting a proposal of ratio `ratio`, or `None` when it is no number. The
/// comparison is written so that NaN fails it: `f64::min` would turn it into certainty.
#[inline]
pub(crate) fn acceptance(ratio: f64) -> Option<f64> {
    if ratio >= 0.0 { Some(ratio.min(1.0)) } else { None }
}

impl Chain {
    /// A chain that starts at `seed`. Its stream is keyed by the run's seed number and its id.
    pub fn new(id: ChainId, run_seed: u64, seed: Path, mixture: &Mixture) -> Self {
        Self {
            id,
            rng: Rng::new(run_seed, Stream::Chain, u64::from(id.0)),
            mixture_total: mixture.total(&seed),
            current: Box::new(seed),
            proposal: Box::default(),
            draft: Box::default(),
            pending: 0.0,
            steps: 0,
            arrival: (0, 1.0, PathHeader::NO_STRATEGY),
            statistics: ChainStatistics::new(mixture.len()),
        }
    }

    /// Which chain this is.
    pub fn id(&self) -> ChainId {
        self.id
    }

    /// The current path.
    pub fn current(&self) -> &Path {
        &self.current
    }

    /// Steps taken.
    pub fn steps(&self) -> u64 {
        self.steps
    }

    /// Counts since the start.
    pub fn statistics(&self) -> &ChainStatistics {
        &self.statistics
    }

    /// Tries one mutation. Both the current path and the proposal are recorded with their expected
    /// weights [Veach 1997, section 11.5]; the current one when it is left.
    #[inline]
    pub fn step(&mut self, scene: &Tracer<'_>, mixture: &Mixture, film: &mut Film) -> Step {
        self.steps += 1;
        let chosen = mixture.choose(&self.current, self.mixture_total, &mut self.rng);
        let Some(strategy) = chosen else {
            self.pending += 1.0;
            let outcome = Outcome::Failed(Failure::NoSubpath);
            return Step { strategy: 0, acceptance: 0.0, outcome };
        };
        let proposed = mixture.get(strategy).propose(
            scene,
            &self.current,
            &mut self.rng,
            &mut self.draft,
            &mut self.proposal,
        );
        let step = match proposed {
            Ok(proposal) => self.decide(strategy, &proposal, mixture, film),
            Err(failure) => self.fail(strategy, failure),
        };
        self.statistics.record(&step);
        step
    }

    fn fail(&mut self, strategy: usize, failure: Failure) -> Step {
        self.pending += 1.0;
        Step { strategy, acceptance: 0.0, outcome: Outcome::Failed(failure) }
    }

    #[inline]
    fn decide(
        &mut self,
        strategy: usize,
        proposal: &Proposal,
        mixture: &Mixture,
        film: &mut Film,
    ) -> Step {
        // The strategy must also be chosen in the reverse move: Z(x) / Z(y), or never.
        let applies_back = mixture.get(strategy).applicable(&self.proposal);
        let total = mixture.total(&self.proposal);
        let mixing = if applies_back { self.mixture_total / total } else { 0.0 };
        let Some(a) = acceptance(proposal.ratio * mixing) else {
            return self.fail(strategy, Failure::NotFinite);
        };
        self.pending += 1.0 - a;
        if a > 0.0 && self.rng.uniform() < a {
            self.flush(film);
            std::mem::swap(&mut self.current, &mut self.proposal);
            self.pending = a;
            self.mixture_total = total;
            self.statistics.leave(self.steps - self.arrival.0);
            self.arrival = (self.steps, a, StrategyId(strategy as u8));
            let Proposal { kept_light, kept_eye, .. } = *proposal;
            let outcome = Outcome::Accepted { kept_light, kept_eye };
            return Step { strategy, acceptance: a, outcome };
        }
        if a > 0.0 {
            film.splat(self.proposal.pixel(), self.proposal.unit_color() * a);
        }
        Step { strategy, acceptance: a, outcome: Outcome::Rejected }
    }

    /// Adds the current path's gathered weight to the film.
    pub fn flush(&mut self, film: &mut Film) {
        if self.pending > 0.0 {
            film.splat(self.current.pixel(), self.current.unit_color() * self.pending);
            self.pending = 0.0;
        }
    }

    /// The current path's header; `dwell` and `weight` are for the watcher to fill in.
    fn header(&self) -> PathHeader {
        let path = &self.current;
        let (step, acceptance, strategy) = self.arrival;
        PathHeader {
            id: PathId { chain: self.id, epoch: 0, step },
            strategy,
            dwell: 0,
            weight: 0.0,
            acceptance: acceptance as f32,
            film: path.film().as_vec2().to_array(),
            luminance: (1.0 / path.density_sum()) as f32,
            rgb: path.unit_color().to_f32(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn acceptance_refuses_what_is_no_number() {
        assert_eq!(acceptance(0.25), Some(0.25), "a plain ratio");
        assert_eq!(acceptance(f64::INFINITY), Some(1.0), "the reverse move is certain");
        assert_eq!(acceptance(f64::NAN), None, "NaN must not be accepted");
        assert_eq!(acceptance(-1.0), None, "a negative ratio is an error");
    }
}
