//! Many chains that make one image.

use std::sync::Arc;
use std::thread;

use common::{ChainId, Diagnostics, PathBatch};

use super::diagnose::{diagnose, longest};
use super::monitor::LongestStay;
use super::{
    Chain, ChainStatistics, Checkpoint, Drawing, Kernel, Normalization, PilotSettings, Pool,
    PoolKey, Prospect, Source, Survey, Watch, draw_pool, survey,
};
use crate::film::Film;
use crate::mutation::{Mixture, StrategyOptions};
use crate::parallel::{self, Stop};
use crate::scene::{RayCounts, Scene, Tracer};
use crate::target::Target;

/// Films that chains are spread over.
///
/// Chain `c` splats into lane `c mod LANES` only and a lane is
/// worked on by one thread at a time, so the image does not depend on the number of threads; no
/// more threads than this have work.
pub const LANES: usize = 8;

/// The pilot has one sample for each so many of the pool.
const PILOT_SHARE: u64 = 16;

/// How chains are run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EnsembleSettings {
    /// Number of the run; the same number gives the same image.
    pub seed: u64,
    /// Number of chains.
    pub chains: u32,
    /// Worker threads; the image does not depend on it.
    pub threads: usize,
    /// What the user wants of the strategies.
    pub strategies: StrategyOptions,
    /// Samples drawn for the normalisation and the seeds.
    pub bootstrap_samples: u64,
}

impl Default for EnsembleSettings {
    fn default() -> Self {
        Self {
            seed: 0,
            chains: 128,
            threads: thread::available_parallelism().map_or(1, Into::into),
            strategies: StrategyOptions::default(),
            bootstrap_samples: 1 << 16,
        }
    }
}

/// Chains with their common film.
#[derive(Debug)]
pub struct Ensemble {
    kernel: Arc<Kernel>,
    prospects: Vec<Prospect>,
    pool: Pool,
    lanes: Vec<Lane>,
    threads: usize,
    stop: Stop,
}

#[derive(Debug)]
struct Lane {
    film: Film,
    chains: Vec<Chain>,
    steps: u64,
    rays: RayCounts,
    /// The chains when the last window on them was opened.
    checkpoints: Vec<Checkpoint>,
}

impl Ensemble {
    /// Seeds the chains. Without light on the film there are no chains and the image stays black.
    /// `on_progress` hears the number of samples drawn for the seeds.
    pub fn new(scene: &Scene, settings: &EnsembleSettings, on_progress: impl FnMut(u64)) -> Self {
        Self::until(&Stop::default(), scene, settings, on_progress)
    }

    /// As [`Ensemble::new`], for chains that can be told to stop: before they have seeds, there will be
    /// none; later, some have made more steps than others.
    pub fn until(
        stop: &Stop,
        scene: &Scene,
        settings: &EnsembleSettings,
        on_progress: impl FnMut(u64),
    ) -> Self {
        let key = PoolKey { seed: settings.seed, number: 0 };
        let (samples, threads) = (settings.bootstrap_samples, settings.threads.max(1));
        let drawing = Drawing { samples, threads, stop };
        let pool = draw_pool(scene, key, &Target::Whole, drawing, on_progress);
        let camera = scene.camera();
        let pilot = PilotSettings {
            seed: settings.seed,
            threads: settings.threads,
            samples: samples.div_ceil(PILOT_SHARE),
            stop: stop.clone(),
        };
        let Survey { mixture, prospects, .. } = survey(scene, &settings.strategies, &pilot);
        let mut lanes: Vec<Lane> = (0..LANES)
            .map(|_| Lane {
                film: Film::new(camera.width, camera.height),
                chains: Vec::new(),
                steps: 0,
                rays: RayCounts::default(),
                checkpoints: Vec::new(),
            })
            .collect();
        let kernel = Arc::new(Kernel::whole(mixture));
        let tracer = Tracer::new(scene);
        let seeds = Source::new(&tracer, key, &Target::Whole).seeds(&pool, settings.chains);
        for (id, seed) in (0_u32..).zip(seeds) {
            let chain = Chain::new(ChainId(id), settings.seed, seed, &kernel);
            lanes[id as usize % LANES].chains.push(chain);
        }
        Self { kernel, prospects, pool, lanes, threads, stop: stop.clone() }
    }

    /// The pool behind the seeds.
    pub fn pool(&self) -> &Pool {
        &self.pool
    }

    /// The strategies.
    pub fn mixture(&self) -> &Mixture {
        &self.kernel.mixture
    }

    /// The law of the chains.
    pub fn kernel(&self) -> &Kernel {
        &self.kernel
    }

    /// The law of the chains, to be kept for as long as their paths are.
    pub fn shared_kernel(&self) -> Arc<Kernel> {
        Arc::clone(&self.kernel)
    }

    /// Opens an epoch, with these weights of the strategies. The image goes on, since it is the same
    /// whatever the mixture; the counts begin anew.
    pub fn begin_epoch(&mut self, epoch: u32, weights: &[f64]) {
        let mut kernel = Kernel::clone(&self.kernel);
        kernel.mixture.set_weights(weights);
        for Lane { film, chains, rays, .. } in &mut self.lanes {
            *rays = RayCounts::default();
            for chain in chains {
                chain.begin_epoch(epoch, &kernel, film);
            }
        }
        self.kernel = Arc::new(kernel);
    }

    /// The states of all chains when the last window on them was opened.
    pub fn take_checkpoints(&mut self) -> Vec<Checkpoint> {
        self.lanes.iter_mut().flat_map(|lane| std::mem::take(&mut lane.checkpoints)).collect()
    }

    /// What the pilot found of each strategy, and the weights that follow.
    pub fn prospects(&self) -> &[Prospect] {
        &self.prospects
    }

    /// Number of chains.
    pub fn chain_count(&self) -> usize {
        self.lanes.iter().map(|lane| lane.chains.len()).sum()
    }

    /// All chains, in the order of the lanes.
    pub fn chains(&self) -> impl Iterator<Item = &Chain> {
        self.lanes.iter().flat_map(|lane| &lane.chains)
    }

    /// Steps taken by all chains together.
    pub fn steps(&self) -> u64 {
        self.lanes.iter().map(|lane| lane.steps).sum()
    }

    /// Has every step of every chain looked at from now on, for [`Ensemble::diagnostics`].
    pub fn monitor(&mut self) {
        for lane in &mut self.lanes {
            let size = [lane.film.width(), lane.film.height()];
            lane.chains.iter_mut().for_each(|chain| chain.watch_every_step(size));
        }
    }

    /// How well the chains explore; `None` without [`Ensemble::monitor`] or steps.
    pub fn diagnostics(&self) -> Option<Diagnostics> {
        diagnose(self.chains())
    }

    /// The longest stays of different chains, the longest first; none without [`Ensemble::monitor`].
    pub fn longest_stays(&self) -> Vec<LongestStay> {
        longest(self.chains().filter_map(Chain::monitor)).into_iter().cloned().collect()
    }

    /// Every chain takes `steps` steps. With a `window`, the states that each chain passes through
    /// in its first `window` steps are returned, in the order of the lanes.
    pub fn advance(&mut self, scene: &Scene, steps: u64, window: Option<u64>) -> Vec<PathBatch> {
        let (kernel, stop) = (&*self.kernel, &self.stop);
        let mut batches: Vec<Vec<PathBatch>> = self.lanes.iter().map(|_| Vec::new()).collect();
        parallel::for_each(
            self.threads.min(LANES),
            self.lanes.iter_mut().zip(batches.iter_mut()),
            || (),
            |(), (lane, out)| *out = lane.advance(scene, kernel, stop, steps, window),
        );
        batches.into_iter().flatten().collect()
    }

    /// Sum of all lanes: `sum_p lum = steps`.
    pub fn splats(&self) -> Film {
        Film::sum(self.lanes.iter().map(|lane| &lane.film))
    }

    /// The image in radiance of the file's units; black without steps.
    pub fn image(&self, scene: &Scene) -> Film {
        let mut image = self.splats();
        let b = self.pool.normalization() * scene.radiance_scale();
        let pixels = scene.camera().pixel_count() as f64;
        let steps = self.steps();
        let factor = if steps == 0 { 0.0 } else { b * pixels / steps as f64 };
        image.scale(factor);
        image
    }

    /// Mean luminance of the image, in the file's units.
    pub fn normalization(&self, scene: &Scene) -> Normalization {
        Normalization::of(&self.pool, scene)
    }

    /// Counts of all chains together.
    pub fn statistics(&self) -> ChainStatistics {
        let mut sum = ChainStatistics::new(self.kernel.mixture.len());
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
        scene: &Scene,
        kernel: &Kernel,
        stop: &Stop,
        steps: u64,
        window: Option<u64>,
    ) -> Vec<PathBatch> {
        let scene = Tracer::new(scene);
        let mut watch = window.map(|window| Watch::new(window, steps));
        self.checkpoints.clear();
        for chain in &mut self.chains {
            let mut left = steps;
            if let Some(watch) = &mut watch {
                watch.begin(chain);
                self.checkpoints.push(chain.checkpoint());
                while watch.is_open() && left > 0 {
                    let step = chain.step(&scene, kernel, &mut self.film);
                    watch.see(chain, &step);
                    left -= 1;
                }
            }
            let done = stop.repeat(left, || {
                chain.step(&scene, kernel, &mut self.film);
            });
            chain.flush(&mut self.film);
            chain.settle();
            self.steps += steps - left + done;
        }
        self.rays.add(&scene);
        watch.map_or_else(Vec::new, Watch::finish)
    }
}
