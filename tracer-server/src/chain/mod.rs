//! Markov chains over paths.

mod archive;
mod blocks;
mod bootstrap;
mod checkpoint;
mod diagnose;
mod ensemble;
mod kernel;
mod monitor;
mod pilot;
mod pool;
mod statistics;
mod watch;

use common::{ChainId, PathHeader, PathId, StrategyId};

use crate::film::Film;
use crate::math::{Rng, Stream};
use crate::mutation::Proposal;
use crate::path::{Draft, Failure, Kept, Path};
use crate::scene::Tracer;

pub use archive::{Archive, Gone, Round};
pub use bootstrap::{Drawing, PoolKey, Source, draw_pool};
pub use checkpoint::Checkpoint;
pub use ensemble::{Ensemble, EnsembleSettings, LANES};
pub use kernel::Kernel;
pub use pilot::{PilotSettings, Prospect, Sighting, Survey, survey};
pub use pool::{Normalization, Pool};
pub use statistics::{ChainStatistics, StrategyCounts};
pub use watch::Watch;

pub use monitor::LongestStay;

use kernel::Standing;
use monitor::Monitor;

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
    epoch: u32,
    rng: Rng,
    current: Box<Path>,
    proposal: Box<Path>,
    draft: Box<Draft>,
    /// What the kernel says of the current path.
    standing: Standing,
    /// Weight that the current path has gathered since it was last splatted.
    pending: f64,
    /// What a splat of weight one counts on the film.
    gain: f64,
    steps: u64,
    /// The step that made the current path, and its acceptance probability and strategy.
    arrival: (u64, f64, StrategyId),
    trial: Option<Trial>,
    statistics: ChainStatistics,
    /// Who looks at every step, if anyone does.
    monitor: Option<Box<Monitor>>,
}

/// The last proposal of a chain, looked at closely.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Trial {
    /// What the strategy drew.
    pub proposal: Proposal,
    /// `Z` of the path before.
    pub mixture_current: f64,
    /// `Z` of the proposed path; zero where the strategy does not apply to it.
    pub mixture_proposed: f64,
    /// `rho` of the path before.
    pub target_current: f64,
    /// `rho` of the proposed path.
    pub target_proposed: f64,
}

/// The probability of accepting a proposal of ratio `ratio`, or `None` when it is no number. The
/// comparison is written so that NaN fails it: `f64::min` would turn it into certainty.
#[inline]
pub(crate) fn acceptance(ratio: f64) -> Option<f64> {
    if ratio >= 0.0 { Some(ratio.min(1.0)) } else { None }
}

impl Chain {
    /// A chain that starts at `seed`. Its stream is keyed by the run's seed number and its id.
    pub fn new(id: ChainId, run_seed: u64, seed: Path, kernel: &Kernel) -> Self {
        Self::with_stream(id, Rng::new(run_seed, Stream::Chain, u64::from(id.0)), seed, kernel)
    }

    /// A chain that starts at `seed` and draws its numbers from `rng`.
    pub fn with_stream(id: ChainId, rng: Rng, seed: Path, kernel: &Kernel) -> Self {
        Self {
            id,
            epoch: 0,
            rng,
            standing: kernel.stand(&seed),
            current: Box::new(seed),
            proposal: Box::default(),
            draft: Box::default(),
            pending: 0.0,
            gain: 1.0,
            steps: 0,
            arrival: (0, 1.0, PathHeader::NO_STRATEGY),
            trial: None,
            statistics: ChainStatistics::new(kernel.mixture.len()),
            monitor: None,
        }
    }

    /// The chain with every splat on the film multiplied by `gain`.
    #[must_use]
    pub fn with_gain(mut self, gain: f64) -> Self {
        self.gain = gain;
        self
    }

    /// Opens an epoch with another kernel of the same target: the path stays, the counts begin anew.
    pub fn begin_epoch(&mut self, epoch: u32, kernel: &Kernel, film: &mut Film) {
        self.flush(film);
        self.epoch = epoch;
        self.steps = 0;
        self.arrival = (0, 1.0, PathHeader::NO_STRATEGY);
        self.standing = kernel.stand(&self.current);
        self.statistics = ChainStatistics::new(kernel.mixture.len());
        if let Some(monitor) = &mut self.monitor {
            monitor.begin(self.id, &self.current);
        }
    }

    /// Has every step from now on looked at, for [`Ensemble::diagnostics`]. The chain takes the same
    /// steps as without; `size` is that of the film.
    pub fn watch_every_step(&mut self, size: [u32; 2]) {
        self.monitor = Some(Box::new(Monitor::new(self.id, size, &self.current)));
    }

    /// Who looks at every step.
    fn monitor(&self) -> Option<&Monitor> {
        self.monitor.as_deref()
    }

    /// Steps since the chain came to its current path.
    pub fn stay(&self) -> u64 {
        self.steps - self.arrival.0
    }

    /// Which chain this is.
    pub fn id(&self) -> ChainId {
        self.id
    }

    /// The current path.
    pub fn current(&self) -> &Path {
        &self.current
    }

    /// The last proposal where it was a complete path, and else what it left of an older one. After an
    /// accepted step it is the path before.
    pub fn proposed(&self) -> &Path {
        &self.proposal
    }

    /// What the last step made before it was complete, or failed.
    pub fn draft(&self) -> &Draft {
        &self.draft
    }

    /// The last proposal; `None` where there was none.
    pub fn trial(&self) -> Option<&Trial> {
        self.trial.as_ref()
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
    pub fn step(&mut self, scene: &Tracer<'_>, kernel: &Kernel, film: &mut Film) -> Step {
        self.steps += 1;
        self.trial = None;
        self.draft.cut = None;
        let mixture = &kernel.mixture;
        let total = self.standing.mixture_total;
        let chosen = mixture.choose(&self.current, total, &mut self.rng);
        let Some(strategy) = chosen else {
            self.pending += 1.0;
            self.look(0.0);
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
            Ok(proposal) => self.decide(strategy, &proposal, kernel, film),
            Err(failure) => self.fail(strategy, failure),
        };
        self.statistics.record(&step);
        step
    }

    fn fail(&mut self, strategy: usize, failure: Failure) -> Step {
        self.pending += 1.0;
        self.look(0.0);
        Step { strategy, acceptance: 0.0, outcome: Outcome::Failed(failure) }
    }

    #[inline]
    fn decide(
        &mut self,
        strategy: usize,
        proposal: &Proposal,
        kernel: &Kernel,
        film: &mut Film,
    ) -> Step {
        let weighed = self.weigh(strategy, proposal, kernel, self.standing);
        let Some((a, standing)) = weighed else {
            return self.fail(strategy, Failure::NotFinite);
        };
        self.pending += 1.0 - a;
        if a > 0.0 && self.rng.uniform() < a {
            self.flush(film);
            self.depart(a);
            std::mem::swap(&mut self.current, &mut self.proposal);
            self.pending = a;
            self.standing = standing;
            self.statistics.leave(self.stay());
            self.arrival = (self.steps, a, StrategyId(strategy as u8));
            self.arrive();
            let Kept { light: kept_light, eye: kept_eye } = proposal.kept;
            let outcome = Outcome::Accepted { kept_light, kept_eye };
            return Step { strategy, acceptance: a, outcome };
        }
        if a > 0.0 {
            let weight = a * standing.importance.share * self.gain;
            film.splat(self.proposal.pixel(), self.proposal.unit_color() * weight);
        }
        self.look(a);
        Step { strategy, acceptance: a, outcome: Outcome::Rejected }
    }

    /// The acceptance probability of a proposal and what the kernel says of it; `None` where it is no
    /// number. `before` is what it says of the current path.
    #[inline]
    fn weigh(
        &mut self,
        strategy: usize,
        proposal: &Proposal,
        kernel: &Kernel,
        before: Standing,
    ) -> Option<(f64, Standing)> {
        // The strategy must also be chosen in the reverse move: Z(x) / Z(y), or never.
        let applies_back = kernel.mixture.get(strategy).applicable(&self.proposal);
        let after = kernel.stand(&self.proposal);
        let mixing = if applies_back { before.mixture_total / after.mixture_total } else { 0.0 };
        self.trial = Some(Trial {
            proposal: *proposal,
            mixture_current: before.mixture_total,
            mixture_proposed: if applies_back { after.mixture_total } else { 0.0 },
            target_current: before.importance.rho,
            target_proposed: after.importance.rho,
        });
        let aim = after.importance.rho / before.importance.rho;
        Some((acceptance(proposal.ratio * mixing * aim)?, after))
    }

    /// Tries a mutation by `strategy` with numbers from `rng`, and stays: neither the path nor the
    /// chain's own stream moves, and nothing is recorded.
    pub fn probe(
        &mut self,
        scene: &Tracer<'_>,
        kernel: &Kernel,
        strategy: usize,
        rng: &mut Rng,
    ) -> Step {
        self.trial = None;
        self.draft.cut = None;
        let failed = |reason| Step { strategy, acceptance: 0.0, outcome: Outcome::Failed(reason) };
        let mixture = &kernel.mixture;
        if !mixture.get(strategy).applicable(&self.current) {
            return failed(Failure::NoSubpath);
        }
        let displacements = self.draft.displacements;
        self.draft.displacements = (rng.uniform() * (1_u64 << 40) as f64) as u64;
        let proposed = mixture.get(strategy).propose(
            scene,
            &self.current,
            rng,
            &mut self.draft,
            &mut self.proposal,
        );
        self.draft.displacements = displacements;
        let proposal = match proposed {
            Ok(proposal) => proposal,
            Err(reason) => return failed(reason),
        };
        let before = kernel.stand(&self.current);
        let Some((acceptance, _)) = self.weigh(strategy, &proposal, kernel, before) else {
            return failed(Failure::NotFinite);
        };
        let Kept { light: kept_light, eye: kept_eye } = proposal.kept;
        let outcome = if acceptance > 0.0 && rng.uniform() < acceptance {
            Outcome::Accepted { kept_light, kept_eye }
        } else {
            Outcome::Rejected
        };
        Step { strategy, acceptance, outcome }
    }

    /// Shows the monitor a step that stays, after a proposal of probability `acceptance`.
    #[inline]
    fn look(&mut self, acceptance: f64) {
        if let Some(monitor) = &mut self.monitor {
            monitor.propose(acceptance);
            monitor.step();
        }
    }

    /// Shows the monitor that the current path is about to be left.
    #[inline]
    fn depart(&mut self, acceptance: f64) {
        if let Some(mut monitor) = self.monitor.take() {
            monitor.propose(acceptance);
            monitor.settle(self);
            self.monitor = Some(monitor);
        }
    }

    /// Shows the monitor a new current path, at which the step ends.
    #[inline]
    fn arrive(&mut self) {
        if let Some(monitor) = &mut self.monitor {
            monitor.arrive(&self.current);
            monitor.step();
        }
    }

    /// Brings the monitor's tables up to date.
    fn settle(&mut self) {
        if let Some(mut monitor) = self.monitor.take() {
            monitor.settle(self);
            self.monitor = Some(monitor);
        }
    }

    /// Adds the current path's gathered weight to the film.
    pub fn flush(&mut self, film: &mut Film) {
        if self.pending > 0.0 {
            let weight = self.pending * self.standing.importance.share * self.gain;
            film.splat(self.current.pixel(), self.current.unit_color() * weight);
            self.pending = 0.0;
        }
    }

    /// The current path's header; `dwell` and `weight` are for the watcher to fill in.
    pub fn header(&self) -> PathHeader {
        let path = &self.current;
        let (step, acceptance, strategy) = self.arrival;
        PathHeader {
            id: PathId { chain: self.id, epoch: self.epoch, step },
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
