//! Rendering one image with any integrator, round by round, with a report at the end.

pub mod auto;
mod pace;

use std::time::{Duration, Instant};

use cpu_time::ProcessTime;
use serde::Serialize;

use crate::chain::{ChainStatistics, Ensemble, EnsembleSettings, Normalization, Prospect};
use crate::film::Film;
use crate::integrator::pssmlt::{PrimaryEnsemble, PrimarySettings, STEPS};
use crate::integrator::{BidirectionalTracer, PathTracer};
use crate::parallel::Stop;
use crate::path::Failure;
use crate::replicate::{Dial, Ledger, Outlook};
use crate::scene::{RayCounts, Scene};
use pace::Pace;

pub use auto::Wish;

/// How an image is made.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Integrator {
    /// Base samples for what they find well, and Metropolis light transport for the rest.
    Auto,
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
            Self::Auto => "auto",
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
    /// When this much time has passed.
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
    /// What [`Integrator::Auto`] is told of the division of the work.
    pub dial: Dial,
}

/// An image with the story of how it was made.
#[derive(Clone, Debug)]
pub struct Rendering {
    /// Radiance in the file's units.
    pub image: Film,
    /// The story.
    pub report: Report,
    /// Sums over whole replicates, which tell the errors of the image; none for other integrators than
    /// [`Integrator::Auto`], or of a single replicate.
    pub errors: Option<Ledger>,
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
    /// Base samples among them.
    pub base_samples: u64,
    /// Whole replicates; zero for other integrators than `auto`, as all that is told of replicates.
    pub replicates: u64,
    /// Which replicates the image holds, as `--replicates` takes it: the same bits again.
    pub selection: String,
    /// How the work is divided between base samples and chains.
    pub outlook: Option<Outlook>,
    /// The noise: root of the relative mean squared error, as the spread of replicates tells.
    pub noise: Option<f64>,
    /// Standard error of the mean luminance of the image.
    pub mean_error: Option<f64>,
    /// Kurtosis of the replicates' mean luminances: where it is large, errors are not to be trusted.
    pub mean_kurtosis: Option<f64>,
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
    /// Pixels of the reference that have no value, and were left out of both.
    pub reference_missing: usize,
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

/// Samples that tell how long seeds take, and are thrown away.
const PROBE: u64 = 2048;

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
    on_progress: impl FnMut(Progress) + Send,
) -> Rendering {
    render_until(&Stop::default(), scene, settings, on_progress)
}

/// Renders `scene` until the budget is spent, or until it is told to `stop`: the image is then what
/// there is by that time, and black where not a single mutation, or sample, has been made.
pub fn render_until(
    stop: &Stop,
    scene: &Scene,
    settings: &RenderSettings,
    mut on_progress: impl FnMut(Progress) + Send,
) -> Rendering {
    if settings.integrator == Integrator::Auto {
        return auto::plain(stop, scene, settings, &mut on_progress);
    }
    let (wall, cpu) = (Instant::now(), ProcessTime::now());
    let mut work = Work::new(stop, scene, settings, |n| on_progress(Progress::Seeding(n)));
    let seeding_seconds = wall.elapsed().as_secs_f64();
    let mut pace = Pace::new(&work, scene, settings.budget, wall);
    loop {
        on_progress(Progress::Rendering(pace.spent()));
        let amount = pace.next().filter(|_| !work.is_dark() && !stop.is_set());
        let Some(amount) = amount else { break };
        work.advance(scene, amount, settings.ensemble.threads);
        pace.done(amount);
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
    Rendering { image, report, errors: None }
}

impl Work {
    fn new(
        stop: &Stop,
        scene: &Scene,
        settings: &RenderSettings,
        on_seeding: impl FnMut(u64),
    ) -> Self {
        let mut settings = *settings;
        let has_seeds = matches!(settings.integrator, Integrator::Mlt | Integrator::Pssmlt);
        if let Budget::Time(limit) = settings.budget
            && has_seeds
        {
            let wanted = settings.ensemble.bootstrap_samples;
            let begun = Instant::now();
            settings.ensemble.bootstrap_samples = PROBE.min(wanted);
            drop(Self::seeded(stop, scene, &settings, |_| ()));
            settings.ensemble.bootstrap_samples =
                pace::affordable_samples(limit, PROBE, begun.elapsed()).max(PROBE).min(wanted);
        }
        Self::seeded(stop, scene, &settings, on_seeding)
    }

    fn seeded(
        stop: &Stop,
        scene: &Scene,
        settings: &RenderSettings,
        on_seeding: impl FnMut(u64),
    ) -> Self {
        let seed = settings.ensemble.seed;
        match settings.integrator {
            // Pictures of replicates are made elsewhere.
            Integrator::Auto | Integrator::Mlt => {
                Self::Mlt(Ensemble::until(stop, scene, &settings.ensemble, on_seeding))
            }
            Integrator::Pssmlt => {
                let RenderSettings { ensemble, primary, .. } = settings;
                Self::Pssmlt(PrimaryEnsemble::until(stop, scene, ensemble, *primary, on_seeding))
            }
            Integrator::Bdpt => Self::Bdpt(BidirectionalTracer::new(scene, seed)),
            Integrator::Path => Self::Path(PathTracer::new(scene, seed)),
        }
    }

    /// Work that cannot be done in parts: a step of every chain, or a sample.
    fn unit(&self) -> u64 {
        self.chain_count().map_or(1, |chains| chains.max(1) as u64)
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

    /// Does `amount` mutations or samples, of all pixels together: whole passes first, and what is left
    /// of one through points anywhere on the film.
    fn advance(&mut self, scene: &Scene, amount: u64, threads: usize) {
        let pixels = scene.camera().pixel_count() as u64;
        let (passes, rest) = (amount / pixels, amount % pixels);
        let steps = amount / self.unit();
        match self {
            Self::Mlt(ensemble) => drop(ensemble.advance(scene, steps, None)),
            Self::Pssmlt(ensemble) => ensemble.advance(scene, steps),
            Self::Bdpt(tracer) => {
                tracer.advance(scene, passes, threads);
                tracer.scatter(scene, rest);
            }
            Self::Path(tracer) => {
                tracer.advance(scene, passes, threads);
                tracer.scatter(scene, rest);
            }
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
            Self::Bdpt(tracer) => tracer.samples() * pixels + tracer.scattered(),
            Self::Path(tracer) => tracer.samples() * pixels + tracer.scattered(),
        }
    }

    /// The part of the report that depends on the integrator.
    fn report(&self, scene: &Scene) -> Report {
        match self {
            Self::Mlt(ensemble) => {
                let bootstrap_samples = ensemble.pool().sample_count();
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

/// What chains have done.
fn chain_report(
    names: &[String],
    statistics: &ChainStatistics,
    Normalization { b: normalization, error: normalization_error }: Normalization,
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
        let (primary, dial) = (PrimarySettings::default(), Dial::default());
        RenderSettings { integrator, budget, ensemble, primary, dial }
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
            let Rendering { image, report, .. } =
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
            let Rendering { image, report, .. } = std::thread::scope(|scope| {
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
            let Rendering { image, report, .. } =
                render_until(&stop, &scene, &settings(integrator, 4), |_| ());
            assert!(report.stopped && report.mutations == 0, "{report:?}");
            assert_eq!(image.mean(), common::Rgb::BLACK, "{}", integrator.name());
        }
    }
}
