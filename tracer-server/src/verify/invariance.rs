//! Whether a way of proposing leaves the distribution of light over paths alone.
//!
//! Bidirectional samples represent that distribution without bias, so applying a strategy to them,
//! rejections included, must leave the expectation of every function of the path as it was. No
//! burn-in, no reference image and no convergence is involved.

use tests::Accumulator;

use super::flow::{Flows, MIN_MOVES};
use super::functionals;
use crate::chain::acceptance;
use crate::math::{Rng, Stream};
use crate::mutation::{Proposal, Strategy};
use crate::parallel;
use crate::path::{BidirectionalSampler, CameraSample, ClassKey, Draft, Failure, Path};
use crate::scene::{Scene, Tracer};
use crate::target::Target;

/// Samples that one stream of random numbers serves.
const CHUNK: u64 = 500;
/// A quantity is judged when its changes come from at least this many samples of equal weight: a
/// mean of few heavy samples is not normally distributed.
const MIN_EFFECTIVE: f64 = 100.0;

/// Draws a proposal from a path: a strategy, or anything else that claims to be one.
pub type Propose<'a> = dyn Fn(&Tracer<'_>, &Path, &mut Rng, &mut Draft, &mut Path) -> Result<Proposal, Failure>
    + Sync
    + 'a;

/// A strategy by itself, as a chain uses it: never where it does not apply, and never to where it
/// could not be chosen for the way back.
pub fn by_itself(
    strategy: &Strategy,
) -> impl Fn(&Tracer<'_>, &Path, &mut Rng, &mut Draft, &mut Path) -> Result<Proposal, Failure> + '_
{
    move |scene, x, rng, draft, y| {
        if !strategy.applicable(x) {
            return Err(Failure::NoSubpath);
        }
        let proposal = strategy.propose(scene, x, rng, draft, y)?;
        if strategy.applicable(y) { Ok(proposal) } else { Err(Failure::KindChanged) }
    }
}

/// What is put to the test: a way of proposing, and what its chain is to visit.
#[derive(Clone, Copy)]
#[expect(missing_debug_implementations, reason = "it holds a closure")]
pub struct Walk<'a> {
    /// The way of proposing, with ratios for the light alone.
    pub propose: &'a Propose<'a>,
    /// What the chain visits.
    pub target: &'a Target,
}

/// How a law is put to the test.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Test {
    /// Applies this many steps, coin included.
    Steps(usize),
    /// Draws this many proposals from every path and weighs them with their acceptance.
    Proposals(usize),
}

impl Test {
    fn repeats(self) -> usize {
        match self {
            Self::Steps(_) => 1,
            Self::Proposals(proposals) => proposals,
        }
    }

    fn steps(self) -> usize {
        match self {
            Self::Steps(steps) => steps,
            Self::Proposals(_) => 1,
        }
    }
}

/// One run of a test.
#[derive(Clone, Copy, Debug)]
pub struct Run {
    /// What is done to each path.
    pub test: Test,
    /// Bidirectional samples.
    pub samples: u64,
    /// Number of the whole check.
    pub seed: u64,
    /// Number of this run within it: runs of different numbers share no random number.
    pub number: u64,
    /// Worker threads; the result does not depend on it.
    pub threads: usize,
}

/// What a run has gathered of one function.
#[derive(Clone, Debug, Default)]
struct Watched {
    /// Its change, one value a sample.
    differences: Accumulator,
    /// Sum of the magnitudes of these values.
    magnitude: f64,
    /// Proposals that raised it.
    up: u64,
    /// Proposals that lowered it.
    down: u64,
}

/// What a run has gathered of all functions and flows.
#[derive(Clone, Debug, Default)]
pub struct Gathered {
    watched: Vec<Watched>,
    /// Flows between classes; empty for [`Test::Steps`].
    pub flows: Flows,
    /// Bidirectional samples.
    pub samples: u64,
    /// Steps and proposals tried.
    pub tries: u64,
    /// Those that could be accepted.
    pub possible: u64,
    /// Ratios that were NaN or negative.
    pub not_finite: u64,
}

/// How far one quantity is from what it must be.
#[derive(Clone, Debug, PartialEq)]
pub struct Score {
    /// Its name.
    pub name: String,
    /// Deviation in standard errors.
    pub z: f64,
}

impl Gathered {
    /// The functions that enough proposals have moved, by number.
    pub fn function_scores(&self) -> Vec<(usize, f64)> {
        let judged = self.watched.iter().enumerate().filter(|(_, watched)| watched.is_judged());
        judged
            .map(|(index, watched)| {
                (index, watched.differences.mean() / watched.differences.standard_error())
            })
            .collect()
    }

    fn merge(&mut self, part: &Self) {
        self.watched.resize(self.watched.len().max(part.watched.len()), Watched::default());
        for (sum, part) in self.watched.iter_mut().zip(&part.watched) {
            sum.differences.merge(&part.differences);
            sum.magnitude += part.magnitude;
            sum.up += part.up;
            sum.down += part.down;
        }
        self.flows.merge(&part.flows);
        self.samples += part.samples;
        self.tries += part.tries;
        self.possible += part.possible;
        self.not_finite += part.not_finite;
    }
}

impl Watched {
    fn is_judged(&self) -> bool {
        let n = self.differences.count() as f64;
        let squares = self.differences.variance() * (n - 1.0);
        // NaN counts as judged, so that it is seen.
        let is_spread = !(self.magnitude * self.magnitude < MIN_EFFECTIVE * squares);
        self.up >= MIN_MOVES && self.down >= MIN_MOVES && is_spread
    }
}

/// Does one run; `on_chunk` hears how many samples a finished piece had.
pub fn gather(
    scene: &Scene,
    walk: Walk<'_>,
    run: &Run,
    on_chunk: &(dyn Fn(u64) + Sync),
) -> Gathered {
    let chunks = run.samples.div_ceil(CHUNK);
    let parts = parallel::map(
        run.threads,
        0..chunks,
        || Bench::new(scene),
        |bench, number| {
            let part = bench.chunk(walk, run, number);
            on_chunk(CHUNK);
            part
        },
    );
    let mut total = Gathered::default();
    for part in &parts {
        total.merge(part);
    }
    total
}

/// One worker's sampler and hand.
struct Bench<'s> {
    scene: Tracer<'s>,
    sampler: BidirectionalSampler,
    hand: Hand,
}

/// What a strategy works with.
struct Hand {
    rng: Rng,
    draft: Box<Draft>,
    x: Box<Path>,
    y: Box<Path>,
    before: Vec<f64>,
    after: Vec<f64>,
    /// Change of each function in the current sample.
    sums: Vec<f64>,
}

impl<'s> Bench<'s> {
    fn new(scene: &'s Scene) -> Self {
        let scene = Tracer::new(scene);
        let sampler = BidirectionalSampler::new(&scene);
        let hand = Hand {
            rng: Rng::new(0, Stream::Verification, 0),
            draft: Box::default(),
            x: Box::default(),
            y: Box::default(),
            before: Vec::new(),
            after: Vec::new(),
            sums: Vec::new(),
        };
        Self { scene, sampler, hand }
    }

    fn chunk(&mut self, walk: Walk<'_>, run: &Run, number: u64) -> Gathered {
        let Self { scene, sampler, hand } = self;
        let mut gathered = Gathered { samples: CHUNK, ..Gathered::default() };
        let count = functionals::names().len();
        gathered.watched.resize(count, Watched::default());
        hand.sums.resize(count, 0.0);
        // Evenly spread displacements go on from a number that no other worker has a say in.
        hand.draft.displacements = number << 24;
        // Even numbers feed the sampler, odd ones the strategy.
        let key = |index: u64| run.number << 44 | index << 1;
        let mut rng = Rng::new(run.seed, Stream::Verification, key(number));
        for sample in 0..CHUNK {
            let aim = CameraSample::from_numbers(scene, &mut rng);
            hand.rng = Rng::new(run.seed, Stream::Verification, key(number * CHUNK + sample) | 1);
            hand.sums.fill(0.0);
            sampler.sample(scene, aim, &mut rng, |path, weight| {
                // Samples stand for the light, and with this factor for what the chain visits.
                let weight = weight * walk.target.importance(path).rho;
                if weight > 0.0 {
                    let sample = Sample { path, weight };
                    hand.try_all(scene, sample, walk, run.test, &mut gathered);
                }
            });
            for (watched, &sum) in gathered.watched.iter_mut().zip(&hand.sums) {
                watched.differences.push(sum);
                watched.magnitude += sum.abs();
            }
            gathered.flows.finish_sample();
        }
        gathered
    }
}

/// A path that stands for so much of what the chain visits.
#[derive(Clone, Copy)]
struct Sample<'a> {
    path: &'a Path,
    weight: f64,
}

impl Hand {
    /// Mutates a path as often as the test asks, and takes note of where it goes.
    fn try_all(
        &mut self,
        scene: &Tracer<'_>,
        Sample { path, weight }: Sample<'_>,
        walk: Walk<'_>,
        test: Test,
        gathered: &mut Gathered,
    ) {
        self.before.clear();
        for _ in 0..test.repeats() {
            let share = self.mutate(scene, path, walk, test, gathered);
            if share == 0.0 || *self.x == *path {
                continue;
            }
            if self.before.is_empty() {
                functionals::evaluate(path, &mut self.before);
            }
            self.tally(path, weight * share, test, gathered);
        }
    }

    /// Mutates `path` and leaves the result in `x`; returns the share of the path's weight that the
    /// result stands for.
    fn mutate(
        &mut self,
        scene: &Tracer<'_>,
        path: &Path,
        walk: Walk<'_>,
        test: Test,
        gathered: &mut Gathered,
    ) -> f64 {
        let Self { rng, draft, x, y, .. } = self;
        (**x).clone_from(path);
        let mut rho = walk.target.importance(x).rho;
        let mut share = 1.0 / test.repeats() as f64;
        for _ in 0..test.steps() {
            gathered.tries += 1;
            let drawn = (walk.propose)(scene, x, rng, draft, y);
            let (ratio, aim) = drawn
                .map_or((0.0, rho), |proposal| (proposal.ratio, walk.target.importance(y).rho));
            let a = acceptance(ratio * (aim / rho));
            gathered.not_finite += u64::from(a.is_none());
            // A chain refuses what is no number.
            let a = a.unwrap_or(0.0);
            gathered.possible += u64::from(a > 0.0);
            let moves = match test {
                Test::Steps(_) => a > rng.uniform(),
                Test::Proposals(_) => {
                    share *= a;
                    a > 0.0
                }
            };
            if moves {
                rho = aim;
                std::mem::swap(x, y);
            }
        }
        share
    }

    /// Adds the weighted change of every function to its sum, and counts which way it moved.
    fn tally(&mut self, path: &Path, weight: f64, test: Test, gathered: &mut Gathered) {
        let Self { x, before, after, sums, .. } = self;
        functionals::evaluate(x, after);
        let values = after.iter().zip(before.iter());
        for ((sum, watched), (a, b)) in sums.iter_mut().zip(&mut gathered.watched).zip(values) {
            *sum += weight * (a - b);
            watched.up += u64::from(a > b);
            watched.down += u64::from(a < b);
        }
        if matches!(test, Test::Proposals(_)) {
            gathered.flows.add(ClassKey::of(path), ClassKey::of(x), weight);
        }
    }
}
