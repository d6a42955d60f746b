//! Rendering one image with any integrator, round by round, with a report at the end.

use std::time::{Duration, Instant};

use cpu_time::ProcessTime;
use serde::Serialize;

use crate::chain::{ChainStatistics, Ensemble, EnsembleSettings, Prospect};
use crate::film::Film;
use crate::integrator::pssmlt::{PrimaryEnsemble, PrimarySettings, STEPS};
use crate::integrator::{BidirectionalTracer, PathTracer};
use crate::parallel::Stop;
use crate::path::Failure;
use crate::scene::{RayCounts, Scene};

/// How an image is made.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Integrator {
    /// Metropolis light transport.
    Mlt,
    /// Metropolis light transport in primary-sample space.
    Pssmlt,
    /// Bidirectional path tracing.
    Bdpt,
    /// Path tracing with light sampling.
    Path,
}

impl Integrator {
    /// Its name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Mlt => "mlt",
            Self::Pssmlt => "pssmlt",
            Self::Bdpt => "bdpt",
            Self::Path => "path",
        }
    }
}

/// When an image is done.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Budget {
    /// After this many mutations, or samples, for each pixel.
    PerPixel(u64),
    /// After the first round that ends later than this.
    Time(Duration),
}

/// What to render and how.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RenderSettings {
    /// The integrator.
    pub integrator: Integrator,
    /// When to stop.
    pub budget: Budget,
    /// Seed and threads, and the chains of [`Integrator::Mlt`] and [`Integrator::Pssmlt`].
    pub ensemble: EnsembleSettings,
    /// What [`Integrator::Pssmlt`] needs besides.
    pub primary: PrimarySettings,
}

/// An image with the story of how it was made.
#[derive(Clone, Debug)]
pub struct Rendering {
    /// Radiance in the file's units.
    pub image: Film,
    /// The story.
    pub report: Report,
}

/// What a render took and what its chains did.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Report {
    /// The scene's name.
    pub scene: String,
    /// Digest of the scene's content.
    pub scene_hash: String,
    /// Name of the integrator.
    pub integrator: String,
    /// Renderer behind primary-sample space; none for other integrators.
    pub primary_sampler: Option<&'static str>,
    /// Probability of a large step in primary-sample space.
    pub large_step: Option<f64>,
    /// Number of the run.
    pub seed: u64,
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// Longest path in edges.
    pub max_edges: usize,
    /// Worker threads.
    pub threads: usize,
    /// Markov chains; zero without.
    pub chains: usize,
    /// Mutations, or samples, of all pixels together.
    pub mutations: u64,
    /// True when it was stopped before its budget was spent.
    pub stopped: bool,
    /// Seconds of wall clock, seeding included.
    pub wall_seconds: f64,
    /// Seconds of all cores together, seeding included.
    pub cpu_seconds: f64,
    /// Of these, the seconds of wall clock that seeding took.
    pub seeding_seconds: f64,
    /// Mutations, or samples, a second of wall clock after seeding.
    pub rate: f64,
    /// Closest-hit rays.
    pub rays: u64,
    /// Shadow rays.
    pub shadow_rays: u64,
    /// Mean luminance of the image, as the seeds estimate it; zero for other integrators.
    pub normalization: f64,
    /// Its standard error.
    pub normalization_error: f64,
    /// Bidirectional samples behind it.
    pub bootstrap_samples: u64,
    /// Longest time that a chain stayed at one path, in steps.
    pub longest_dwell: u64,
    /// Proposals refused because a number was NaN, infinite or negative.
    pub not_finite: u64,
    /// One entry a strategy.
    pub strategies: Vec<StrategyReport>,
    /// What the pilot found of each strategy before the chains started; empty for other
    /// integrators.
    pub prospects: Vec<Prospect>,
    /// Mean of the image in each channel.
    pub mean: [f64; 3],
    /// Relative mean squared error against the reference, if there was one.
    pub relative_mse: Option<f64>,
    /// Sum of the image over the sum of the reference, if there was one.
    pub mean_ratio: Option<f64>,
}

/// What one strategy did. Rates are shares of all tries.
#[derive(Clone, Debug, Default, Serialize)]
pub struct StrategyReport {
    /// Its name.
    pub name: String,
    /// Tries.
    pub proposed: u64,
    /// Proposals that were complete paths with light on them.
    pub generated: u64,
    /// Proposals that became the state.
    pub accepted: u64,
    /// Mean acceptance probability of all tries.
    pub mean_acceptance: f64,
    /// Failures with their reasons, most frequent first; none that did not happen.
    pub failures: Vec<(String, u64)>,
}

/// One integrator at work.
enum Work {
    Mlt(Ensemble),
    Pssmlt(PrimaryEnsemble),
    Bdpt(BidirectionalTracer),
    Path(PathTracer),
}

/// How far a render has come, for a progress bar.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Progress {
    /// Samples drawn for seeds so far.
    Seeding(u64),
    /// Share of the image's budget spent, from 0 to 1.
    Rendering(f64),
}

/// Renders `scene`; `on_progress` hears how far it has come.
pub fn render(
    scene: &Scene,
    settings: &RenderSettings,
    on_progress: impl FnMut(Progress),
) -> Rendering {
    render_until(&Stop::default(), scene, settings, on_progress)
}

/// Renders `scene` until the budget is spent, or until it is told to `stop`: the image is then what
/// there is by that time, and black where not a single mutation, or sample, has been made.
pub fn render_until(
    stop: &Stop,
    scene: &Scene,
    settings: &RenderSettings,
    mut on_progress: impl FnMut(Progress),
) -> Rendering {
    let (wall, cpu) = (Instant::now(), ProcessTime::now());
    let mut work = Work::new(stop, scene, settings, |n| on_progress(Progress::Seeding(n)));
    let seeding_seconds = wall.elapsed().as_secs_f64();
    let rounds = work.rounds(scene, settings.budget);
    let mut done = 0;
    loop {
        let spent = match settings.budget {
            Budget::PerPixel(_) => done as f64 / rounds.count.max(1) as f64,
            Budget::Time(limit) => wall.elapsed().as_secs_f64() / limit.as_secs_f64().max(1e-9),
        };
        on_progress(Progress::Rendering(spent.min(1.0)));
        // Even when seeding has taken all the time, one round makes an image.
        let timed_out = spent >= 1.0 && done > 0;
        if timed_out || done == rounds.count || work.is_dark() || stop.is_set() {
            break;
        }
        work.advance(scene, rounds.size(done), settings.ensemble.threads);
        done += 1;
    }
    let image = work.image(scene);
    let wall_seconds = wall.elapsed().as_secs_f64();
    let mutations = work.mutations(scene);
    let camera = scene.camera();
    let mean = image.mean();
    let report = Report {
        scene: scene.name().to_owned(),
        scene_hash: scene.hash().to_owned(),
        integrator: settings.integrator.name().to_owned(),
        seed: settings.ensemble.seed,
        width: camera.width,
        height: camera.height,
        max_edges: scene.max_edges(),
        threads: settings.ensemble.threads,
        mutations,
        stopped: stop.is_set(),
        wall_seconds,
        cpu_seconds: cpu.elapsed().as_secs_f64(),
        seeding_seconds,
        rate: mutations as f64 / (wall_seconds - seeding_seconds).max(1e-9),
        mean: mean.into(),
        ..work.report(scene)
    };
    Rendering { image, report }
}

/// A budget cut into rounds of equal steps for all chains.
#[derive(Clone, Copy, Debug)]
struct Rounds {
    /// Number of rounds; as good as endless under a time limit.
    count: u64,
    /// Steps of a chain, or samples of a pixel, in all rounds together.
    total: u64,
}

impl Rounds {
    /// Steps of round number `round`: all rounds differ by at most one.
    fn size(self, round: u64) -> u64 {
        if self.count == u64::MAX {
            return self.total;
        }
        self.total / self.count + u64::from(round < self.total % self.count)
    }
}

impl Work {
    fn new(
        stop: &Stop,
        scene: &Scene,
        settings: &RenderSettings,
        on_seeding: impl FnMut(u64),
    ) -> Self {
        let seed = settings.ensemble.seed;
        match settings.integrator {
            Integrator::Mlt => {
                Self::Mlt(Ensemble::until(stop, scene, &settings.ensemble, on_seeding))
            }
            Integrator::Pssmlt => {
                let settings = (&settings.ensemble, settings.primary);
                Self::Pssmlt(PrimaryEnsemble::until(stop, scene, settings, on_seeding))
            }
            Integrator::Bdpt => Self::Bdpt(BidirectionalTracer::new(scene, seed)),
            Integrator::Path => Self::Path(PathTracer::new(scene, seed)),
        }
    }

    fn rounds(&self, scene: &Scene, budget: Budget) -> Rounds {
        const STEPS_UNDER_A_TIME_LIMIT: u64 = 512;
        /// Samples of all pixels together between two looks at the clock, if a pixel's one is not more.
        const SAMPLES_OF_A_ROUND: u64 = 1 << 17;
        let pixels = scene.camera().pixel_count() as u64;
        let Some(chains) = self.chain_count() else {
            return match budget {
                Budget::PerPixel(samples) => {
                    let at_once = (SAMPLES_OF_A_ROUND / pixels.max(1)).max(1);
                    let count = samples.div_ceil(at_once).max(samples.min(100));
                    Rounds { count, total: samples }
                }
                Budget::Time(_) => Rounds { count: u64::MAX, total: 1 },
            };
        };
        match budget {
            Budget::PerPixel(mutations) => {
                let all = mutations * pixels;
                let total = all.div_ceil(chains.max(1) as u64);
                Rounds { count: total.min(100), total }
            }
            Budget::Time(_) => Rounds { count: u64::MAX, total: STEPS_UNDER_A_TIME_LIMIT },
        }
    }

    /// True when no light reaches the film, so that there is nothing to do.
    fn is_dark(&self) -> bool {
        self.chain_count() == Some(0)
    }

    /// Number of chains, where there are any.
    fn chain_count(&self) -> Option<usize> {
        match self {
            Self::Mlt(ensemble) => Some(ensemble.chain_count()),
            Self::Pssmlt(ensemble) => Some(ensemble.chain_count()),
            Self::Bdpt(_) | Self::Path(_) => None,
        }
    }

    fn advance(&mut self, scene: &Scene, amount: u64, threads: usize) {
        match self {
            Self::Mlt(ensemble) => drop(ensemble.advance(scene, amount, None)),
            Self::Pssmlt(ensemble) => ensemble.advance(scene, amount),
            Self::Bdpt(tracer) => tracer.advance(scene, amount, threads),
            Self::Path(tracer) => tracer.advance(scene, amount, threads),
        }
    }

    fn image(&self, scene: &Scene) -> Film {
        match self {
            Self::Mlt(ensemble) => ensemble.image(scene),
            Self::Pssmlt(ensemble) => ensemble.image(scene),
            Self::Bdpt(tracer) => tracer.image(scene),
            Self::Path(tracer) => tracer.image(scene),
        }
    }

    fn mutations(&self, scene: &Scene) -> u64 {
        let pixels = scene.camera().pixel_count() as u64;
        match self {
            Self::Mlt(ensemble) => ensemble.steps(),
            Self::Pssmlt(ensemble) => ensemble.steps(),
            Self::Bdpt(tracer) => tracer.samples() * pixels,
            Self::Path(tracer) => tracer.samples() * pixels,
        }
    }

    /// The part of the report that depends on the integrator.
    fn report(&self, scene: &Scene) -> Report {
        match self {
            Self::Mlt(ensemble) => {
                let bootstrap_samples = ensemble.bootstrap().sample_count();
                let names = ensemble.mixture().names();
                let statistics = ensemble.statistics();
                let normalization = ensemble.normalization(scene);
                Report {
                    chains: ensemble.chain_count(),
                    bootstrap_samples,
                    prospects: ensemble.prospects().to_vec(),
                    ..chain_report(&names, &statistics, normalization)
                }
            }
            Self::Pssmlt(ensemble) => {
                let PrimarySettings { sampler, large_step } = ensemble.settings();
                let names = STEPS.map(str::to_owned);
                let statistics = ensemble.statistics();
                let normalization = ensemble.normalization(scene);
                Report {
                    chains: ensemble.chain_count(),
                    bootstrap_samples: ensemble.pool().sample_count(),
                    primary_sampler: Some(sampler.name()),
                    large_step: Some(large_step),
                    ..chain_report(&names, &statistics, normalization)
                }
            }
            Self::Bdpt(tracer) => ray_report(tracer.rays()),
            Self::Path(tracer) => ray_report(tracer.rays()),
        }
    }
}

/// What chains have done; `normalization` comes with its standard error.
fn chain_report(
    names: &[String],
    statistics: &ChainStatistics,
    (normalization, normalization_error): (f64, f64),
) -> Report {
    Report {
        rays: statistics.rays,
        shadow_rays: statistics.shadow_rays,
        normalization,
        normalization_error,
        longest_dwell: statistics.longest_dwell,
        not_finite: statistics.not_finite(),
        strategies: strategy_reports(names, statistics),
        ..Report::default()
    }
}

fn ray_report(RayCounts { rays, shadow_rays }: RayCounts) -> Report {
    Report { rays, shadow_rays, ..Report::default() }
}

fn strategy_reports(names: &[String], statistics: &ChainStatistics) -> Vec<StrategyReport> {
    let report = |(name, counts): (&String, &crate::chain::StrategyCounts)| {
        let mut failures: Vec<(String, u64)> = Failure::ALL
            .iter()
            .map(|&reason| (reason.name().to_owned(), counts.failures[reason as usize]))
            .filter(|(_, count)| *count > 0)
            .collect();
        failures.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
        StrategyReport {
            name: name.clone(),
            proposed: counts.proposed,
            generated: counts.generated,
            accepted: counts.accepted,
            mean_acceptance: counts.acceptance_sum / counts.proposed.max(1) as f64,
            failures,
        }
    };
    names.iter().zip(&statistics.strategies).map(report).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::fixtures::diffuse_room;

    const INTEGRATORS: [Integrator; 4] =
        [Integrator::Mlt, Integrator::Pssmlt, Integrator::Bdpt, Integrator::Path];

    fn settings(integrator: Integrator, per_pixel: u64) -> RenderSettings {
        let ensemble = EnsembleSettings {
            chains: 32,
            threads: 2,
            bootstrap_samples: 1 << 14,
            ..EnsembleSettings::default()
        };
        let budget = Budget::PerPixel(per_pixel);
        RenderSettings { integrator, budget, ensemble, primary: PrimarySettings::default() }
    }

    #[test]
    fn a_stopped_render_is_an_image_of_what_was_done() {
        let scene = diffuse_room().build();
        for integrator in INTEGRATORS {
            let stop = Stop::default();
            let stop_late = |at| match at {
                Progress::Rendering(share) if share >= 0.2 => stop.set(),
                Progress::Rendering(_) | Progress::Seeding(_) => {}
            };
            let Rendering { image, report } =
                render_until(&stop, &scene, &settings(integrator, 50), stop_late);
            let name = integrator.name();
            assert!(report.stopped, "{name}");
            let share = report.mutations as f64 / (50 * scene.camera().pixel_count()) as f64;
            assert!((0.19..0.3).contains(&share), "{name}: {share} of the work");
            let whole = render(&scene, &settings(integrator, 50), |_| ());
            assert!(!whole.report.stopped, "{name}");
            let ratio = image.mean().luminance() / whole.image.mean().luminance();
            assert!((ratio - 1.0).abs() < 0.1, "{name}: {ratio} of the light");
        }
    }

    /// The luminance of an image of chains is that of their seeds, however many steps each has taken.
    #[test]
    fn chains_that_stop_within_a_round_count_what_they_did() {
        let scene = diffuse_room().build();
        for integrator in [Integrator::Mlt, Integrator::Pssmlt] {
            let stop = Stop::default();
            let told = stop.clone();
            let begun = std::sync::Barrier::new(2);
            let Rendering { image, report } = std::thread::scope(|scope| {
                scope.spawn(|| {
                    begun.wait();
                    std::thread::sleep(Duration::from_millis(5));
                    told.set();
                });
                let mut waiting = true;
                let on_progress = |at| match at {
                    Progress::Rendering(_) if std::mem::take(&mut waiting) => drop(begun.wait()),
                    Progress::Rendering(_) | Progress::Seeding(_) => {}
                };
                render_until(&stop, &scene, &settings(integrator, 1 << 16), on_progress)
            });
            assert!(report.stopped && report.mutations > 0, "{report:?}");
            if integrator == Integrator::Mlt {
                let ratio = image.mean().luminance() / report.normalization;
                assert!((ratio - 1.0).abs() < 1e-9, "{ratio}");
            }
        }
    }

    #[test]
    fn what_is_stopped_before_it_has_seeds_has_no_image() {
        let scene = diffuse_room().build();
        for integrator in INTEGRATORS {
            let stop = Stop::default();
            stop.set();
            let Rendering { image, report } =
                render_until(&stop, &scene, &settings(integrator, 4), |_| ());
            assert!(report.stopped && report.mutations == 0, "{report:?}");
            assert_eq!(image.mean(), common::Rgb::BLACK, "{}", integrator.name());
        }
    }
}
