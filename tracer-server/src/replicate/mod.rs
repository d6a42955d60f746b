//! The unit of work of a picture: a replicate, which is a whole small picture by itself.
//!
//! A replicate has its own base samples, its own pool of bidirectional samples, which gives its share
//! of `b` and the seeds of its own chains, and its own film. Its picture is `base + b times the
//! histogram of its chains`, and that is unbiased however small the pool and however short the chains,
//! since the distribution of the seeds times b has the right expectation. So is the mean over
//! replicates; its error falls with their number, that of b included, and their spread tells it.
//!
//! A replicate consists of a number of equal parts. A part is one base sample through every pixel, and
//! after it some steps of every chain. After any number of parts the picture so far is unbiased.
//!
//! Everything in a replicate follows from scene, plan and its number: neither the number of threads
//! nor the range of replicates that is worked on changes a bit of it.

#[cfg(test)]
mod error_laws;
#[cfg(test)]
mod laws;
mod ledger;
mod part;
mod pilot;
mod plan;
mod run;
mod selection;

use common::ChainId;

use crate::base::{BaseSampler, Pass};
use crate::chain::{Chain, ChainStatistics, PoolKey, Source};
use crate::film::Film;
use crate::math::{Rng, Strata, Stream};
use crate::scene::{RayCounts, Tracer};

pub use ledger::{Estimate, Ledger, Row, TILE};
pub use part::{Origin, Part, PartError};
pub use pilot::{Dial, PlanSettings, prepare};
pub use plan::{Outlook, Plan, Share};
pub use run::{Advance, Limits, Picture, Tail};
pub use selection::Selection;

/// Rows of the film, or chains, between two looks at whether the work is to stop.
const GLANCE: usize = 16;

/// One replicate at work.
#[derive(Debug)]
pub struct Replicate<'a, 's> {
    scene: &'a Tracer<'s>,
    plan: &'a Plan,
    number: u64,
    /// `b` of this replicate.
    normalization: f64,
    chains: Vec<Chain>,
    base: Option<BaseSampler>,
    strata: Strata,
    film: Film,
    parts: u32,
    rays_before: RayCounts,
}

/// What a replicate came to.
#[derive(Debug)]
pub struct Outcome {
    /// What it is worth, as a share of a whole replicate: its parts over those of the plan.
    pub share: Share,
    /// Its picture, in film units of the scene.
    pub film: Film,
    /// What is told of it.
    pub row: Row,
    /// What its chains did.
    pub statistics: ChainStatistics,
}

impl<'a, 's> Replicate<'a, 's> {
    /// Draws the pool of the replicate number `number` and seeds its chains. `film` is taken to splat
    /// on, whatever is on it.
    pub fn begin(scene: &'a Tracer<'s>, plan: &'a Plan, number: u64, mut film: Film) -> Self {
        let rays_before = RayCounts::of(scene);
        film.clear();
        let strata = Strata::new(plan.seed, Stream::Base, number);
        let base = plan.base.map(|base| BaseSampler::new(scene, base));
        let mut replicate = Self {
            scene,
            plan,
            number,
            normalization: 0.0,
            chains: Vec::new(),
            base,
            strata,
            film,
            parts: 0,
            rays_before,
        };
        if plan.chains > 0 {
            replicate.seed();
        }
        replicate
    }

    fn seed(&mut self) {
        let &Plan { seed, pool, chains, steps, ref kernel, .. } = self.plan;
        // The pilot's pools have numbers of their own.
        let key = PoolKey { seed, number: self.number + 1 };
        let mut source = Source::new(self.scene, key, &kernel.target);
        let drawn = source.pool(pool);
        self.normalization = drawn.normalization();
        let pixels = self.scene.camera().pixel_count() as f64;
        let gain = self.normalization * pixels / (f64::from(chains) * steps as f64);
        let seeds = source.seeds(&drawn, chains);
        let chain = |(id, path)| {
            let rng = Rng::new(seed, Stream::Chain, self.number << 20 | u64::from(id));
            Chain::with_stream(ChainId(id), rng, path, kernel).with_gain(gain)
        };
        self.chains = (0..).zip(seeds).map(chain).collect();
    }

    /// Works on one part; false, and the replicate is of no more use, when `stop` said so meanwhile.
    pub fn part(&mut self, stop: &dyn Fn() -> bool) -> bool {
        let Self { scene, plan, base, film, chains, .. } = self;
        if let Some(base) = base {
            let pass = Pass { strata: self.strata, index: self.parts };
            let height = film.height();
            for first in (0..height).step_by(GLANCE) {
                if stop() {
                    return false;
                }
                base.pass(scene, pass, first..(first + GLANCE as u32).min(height), film);
            }
        }
        for some in chains.chunks_mut(GLANCE) {
            if stop() {
                return false;
            }
            for chain in some {
                for _ in 0..plan.steps {
                    chain.step(scene, &plan.kernel, film);
                }
                chain.flush(film);
            }
        }
        self.parts += 1;
        true
    }

    /// Parts that are done.
    pub fn parts(&self) -> u32 {
        self.parts
    }

    /// Ends it with the parts that are done; at least one is.
    pub fn finish(self) -> Outcome {
        let Self { scene, plan, number, normalization, mut film, parts, .. } = self;
        film.scale(1.0 / f64::from(parts));
        let mut statistics = ChainStatistics::new(plan.kernel.mixture.len());
        for chain in &self.chains {
            statistics.add(chain.statistics());
            // A chain that never left where it is has the longest stay of all.
            statistics.leave(chain.stay());
        }
        let rays = RayCounts::of(scene).since(self.rays_before);
        (statistics.rays, statistics.shadow_rays) = (rays.rays, rays.shadow_rays);
        let pixels = scene.camera().pixel_count() as u64;
        let row = Row {
            number,
            normalization,
            mean: film.mean().luminance(),
            samples: if plan.base.is_some() { pixels * u64::from(parts) } else { 0 },
            steps: statistics.steps,
            rays: rays.rays,
            shadow_rays: rays.shadow_rays,
        };
        Outcome { share: Share { parts, of: plan.parts }, film, row, statistics }
    }
}
