//! Metropolis light transport in primary-sample space [Kelemen et al. 2002].
//!
//! The state of a chain is not a path but the random numbers from which a renderer makes its
//! samples; a step moves all numbers a little, or draws them anew.

mod chain;
mod coordinates;
#[cfg(test)]
mod laws;
mod sampler;

pub use chain::{Balance, PrimaryChain, STEPS};
pub use coordinates::{Draws, LazyPoint, Place, Point, Start};
pub use sampler::{PrimarySampler, Sample, Sampler, SceneSampler};

use crate::chain::{ChainStatistics, Drawing, EnsembleSettings, LANES, Normalization, Pool};
use crate::film::Film;
use crate::math::{Rng, Stream, TorusStep};
use crate::parallel::{self, Stop};
use crate::scene::{RayCounts, Scene};

/// How chains in primary-sample space are run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrimarySettings {
    /// The renderer that they drive.
    pub sampler: PrimarySampler,
    /// Probability of a large step.
    pub large_step: f64,
}

impl Default for PrimarySettings {
    fn default() -> Self {
        Self { sampler: PrimarySampler::default(), large_step: 0.3 }
    }
}

/// Chains in primary-sample space with their common film.
#[derive(Debug)]
pub struct PrimaryEnsemble {
    settings: PrimarySettings,
    pool: Pool,
    lanes: Vec<Lane>,
    threads: usize,
    stop: Stop,
}

/// A film and the chains that splat into it; worked on by one thread at a time.
#[derive(Debug)]
struct Lane {
    film: Film,
    chains: Vec<PrimaryChain<LazyPoint<Rng>>>,
    steps: u64,
    rays: RayCounts,
}

impl PrimaryEnsemble {
    /// Seeds the chains. Without light on the film there are no chains and the image stays black.
    /// `on_progress` hears the number of samples drawn for the seeds.
    pub fn new(
        scene: &Scene,
        ensemble: &EnsembleSettings,
        settings: PrimarySettings,
        on_progress: impl FnMut(u64),
    ) -> Self {
        Self::until(&Stop::default(), scene, ensemble, settings, on_progress)
    }

    /// As [`PrimaryEnsemble::new`], for chains that can be told to stop: before they have seeds, there
    /// will be none; later, some have made more steps than others.
    pub fn until(
        stop: &Stop,
        scene: &Scene,
        ensemble: &EnsembleSettings,
        settings: PrimarySettings,
        on_progress: impl FnMut(u64),
    ) -> Self {
        let seed = ensemble.seed;
        let weigh = |(sampler, sample): &mut (SceneSampler<'_>, Sample), number| {
            sampler.sample(&mut Rng::new(seed, Stream::Bootstrap, number), sample);
            if sample.is_physical() { sample.intensity() } else { 0.0 }
        };
        let (samples, threads) = (ensemble.bootstrap_samples, ensemble.threads.max(1));
        let drawing = Drawing { samples, threads, stop };
        let pool = Pool::gather(
            drawing,
            || (SceneSampler::new(scene, settings.sampler), Sample::default()),
            |state, numbers| numbers.map(|number| weigh(state, number)).collect(),
            on_progress,
        );
        let camera = scene.camera();
        let lane = || Lane {
            film: Film::new(camera.width, camera.height),
            chains: Vec::new(),
            steps: 0,
            rays: RayCounts::default(),
        };
        let mut lanes: Vec<Lane> = (0..LANES).map(|_| lane()).collect();
        let mut sampler = SceneSampler::new(scene, settings.sampler);
        let starts = pool.resample(ensemble.chains, &mut Rng::new(seed, Stream::Resampling, 0));
        for (id, (number, intensity)) in (0_u64..).zip(starts) {
            let coordinates = Rng::new(seed, Stream::Coordinates, id);
            let mut point = LazyPoint::new(coordinates, TorusStep::default());
            let mut sample = Sample::default();
            let again = Rng::new(seed, Stream::Bootstrap, number);
            sampler.sample(&mut point.start(again), &mut sample);
            debug_assert_eq!(sample.intensity().to_bits(), intensity.to_bits(), "another sample");
            let rng = Rng::new(seed, Stream::Chain, id);
            let chain = PrimaryChain::new(rng, point, sample, settings.large_step);
            lanes[id as usize % LANES].chains.push(chain);
        }
        Self { settings, pool, lanes, threads, stop: stop.clone() }
    }

    /// How the chains are run.
    pub fn settings(&self) -> PrimarySettings {
        self.settings
    }

    /// The samples behind normalisation and seeds.
    pub fn pool(&self) -> &Pool {
        &self.pool
    }

    /// Number of chains.
    pub fn chain_count(&self) -> usize {
        self.lanes.iter().map(|lane| lane.chains.len()).sum()
    }

    /// Steps taken by all chains together.
    pub fn steps(&self) -> u64 {
        self.lanes.iter().map(|lane| lane.steps).sum()
    }

    /// Every chain takes `steps` steps.
    pub fn advance(&mut self, scene: &Scene, steps: u64) {
        let PrimarySettings { sampler, large_step } = self.settings;
        let stop = &self.stop;
        let balance = Balance { normalization: self.pool.normalization(), large: large_step };
        parallel::for_each(
            self.threads.min(LANES),
            self.lanes.iter_mut(),
            || (),
            |(), lane| lane.advance(SceneSampler::new(scene, sampler), balance, stop, steps),
        );
    }

    /// The image in radiance of the file's units; black without steps.
    pub fn image(&self, scene: &Scene) -> Film {
        let mut image = Film::sum(self.lanes.iter().map(|lane| &lane.film));
        let pixels = scene.camera().pixel_count() as f64;
        image.scale(scene.radiance_scale() * pixels / self.steps().max(1) as f64);
        image
    }

    /// Mean luminance of the image, in the file's units, as the seeds tell.
    pub fn normalization(&self, scene: &Scene) -> Normalization {
        Normalization::of(&self.pool, scene)
    }

    /// Counts of all chains together; the strategies are [`STEPS`].
    pub fn statistics(&self) -> ChainStatistics {
        let mut sum = ChainStatistics::new(STEPS.len());
        for lane in &self.lanes {
            for chain in &lane.chains {
                sum.add(chain.statistics());
                // A chain that never left where it is has the longest stay of all.
                sum.leave(chain.stay());
            }
            sum.rays += lane.rays.rays;
            sum.shadow_rays += lane.rays.shadow_rays;
        }
        sum
    }
}

impl Lane {
    fn advance(
        &mut self,
        mut sampler: SceneSampler<'_>,
        balance: Balance,
        stop: &Stop,
        steps: u64,
    ) {
        for chain in &mut self.chains {
            self.steps += stop.repeat(steps, || chain.step(&mut sampler, balance, &mut self.film));
            chain.flush(balance, &mut self.film);
        }
        self.rays.add(sampler.scene());
    }
}
