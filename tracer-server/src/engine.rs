//! The daemon's chains at work: rounds without end, with reports to the hub in between.

use std::io;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use common::{ChainTotals, FailureCount, FilmFrame, Statistics, StrategyStatistics};
use tracing::{info, warn};

use crate::chain::{Ensemble, EnsembleSettings, StrategyCounts};
use crate::hub::Hub;
use crate::path::Failure;
use crate::scene::Scene;

/// Mutations of all chains together in one round: about a tenth of a second of one core.
const ROUND_MUTATIONS: u64 = 1 << 17;
/// Steps of each chain that are shown in a round, while anyone looks.
const WINDOW: u64 = 32;
/// Time between two reports of statistics.
const STATISTICS_INTERVAL: Duration = Duration::from_millis(500);
/// Shortest time between two snapshots of the film.
const FILM_INTERVAL: Duration = Duration::from_millis(250);
/// A snapshot may cost this share of the chains' time: one part in this many.
const FILM_COST: u32 = 100;

/// Chains that run on threads of their own until the engine is dropped.
#[derive(Debug)]
pub struct Engine {
    stop: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

impl Engine {
    /// Starts the chains of `scene` and publishes what they do.
    pub fn start(scene: Arc<Scene>, settings: &EnsembleSettings, hub: Hub) -> io::Result<Self> {
        let stop = Arc::new(AtomicBool::new(false));
        let (settings, stopped) = (*settings, Arc::clone(&stop));
        let thread = thread::Builder::new()
            .name("lvis-engine".to_owned())
            .spawn(move || run(&scene, &settings, &hub, &stopped))?;
        Ok(Self { stop, thread: Some(thread) })
    }
}

impl Drop for Engine {
    fn drop(&mut self) {
        self.stop.store(true, Ordering::Relaxed);
        if let Some(thread) = self.thread.take()
            && thread.join().is_err()
        {
            warn!("the engine ended in a panic");
        }
    }
}

fn run(scene: &Scene, settings: &EnsembleSettings, hub: &Hub, stop: &AtomicBool) {
    for line in scene.features().switched_off() {
        info!("{line}");
    }
    let mut ensemble = Ensemble::new(scene, settings, |_| ());
    if ensemble.chain_count() == 0 {
        warn!("no light reaches the film; the image stays black");
        hub.publish_film(Arc::new(film_frame(scene, &ensemble)));
        return;
    }
    let (b, error) = ensemble.normalization(scene);
    info!("{} chains; mean luminance {b:.4} +- {error:.1e}", ensemble.chain_count());
    if error > 0.01 * b {
        warn!("the mean luminance is known to {:.1} % only", 100.0 * error / b);
    }
    for prospect in ensemble.prospects() {
        info!("{prospect}");
    }
    let steps = (ROUND_MUTATIONS / ensemble.chain_count() as u64).max(1);
    let mut reporter = Reporter::new(settings);
    while !stop.load(Ordering::Relaxed) {
        let window = hub.wants_paths().then_some(WINDOW);
        let batches = ensemble.advance(scene, steps, window);
        for batch in batches {
            hub.publish_paths(batch);
        }
        reporter.report(scene, &ensemble, hub);
    }
}

/// Decides when the film and the statistics are due.
struct Reporter {
    threads: usize,
    started: Instant,
    statistics_at: Instant,
    steps_at: u64,
    film_at: Option<Instant>,
}

impl Reporter {
    fn new(settings: &EnsembleSettings) -> Self {
        let now = Instant::now();
        Self {
            threads: settings.threads,
            started: now,
            statistics_at: now,
            steps_at: 0,
            film_at: None,
        }
    }

    fn report(&mut self, scene: &Scene, ensemble: &Ensemble, hub: &Hub) {
        let now = Instant::now();
        if self.film_at.is_none_or(|at| now >= at) {
            hub.publish_film(Arc::new(film_frame(scene, ensemble)));
            let rest = FILM_INTERVAL.max(now.elapsed() * FILM_COST);
            self.film_at = Some(now + rest);
        }
        let interval = now - self.statistics_at;
        if interval >= STATISTICS_INTERVAL {
            let steps = ensemble.steps() - self.steps_at;
            let rate = steps as f64 / interval.as_secs_f64();
            let elapsed = now - self.started;
            let mut statistics = statistics(scene, ensemble);
            statistics.threads = self.threads as u32;
            statistics.elapsed_seconds = elapsed.as_secs_f64();
            statistics.mutations_per_second = rate;
            hub.publish_statistics(Arc::new(statistics));
            self.statistics_at = now;
            self.steps_at = ensemble.steps();
        }
    }
}

fn film_frame(scene: &Scene, ensemble: &Ensemble) -> FilmFrame {
    let image = ensemble.image(scene);
    FilmFrame {
        width: image.width(),
        height: image.height(),
        steps: ensemble.steps(),
        pixels: image.into_pixels(),
    }
}

fn statistics(scene: &Scene, ensemble: &Ensemble) -> Statistics {
    let counts = ensemble.statistics();
    let (normalization, normalization_error) = ensemble.normalization(scene);
    Statistics {
        totals: ChainTotals {
            steps: counts.steps,
            rays: counts.rays,
            shadow_rays: counts.shadow_rays,
            not_finite: counts.not_finite(),
            longest_dwell: counts.longest_dwell,
        },
        strategies: counts.strategies.iter().map(strategy_statistics).collect(),
        normalization,
        normalization_error,
        memory_bytes: resident_memory(),
        ..Statistics::default()
    }
}

fn strategy_statistics(counts: &StrategyCounts) -> StrategyStatistics {
    let failure = |&reason: &Failure| FailureCount {
        reason: reason as u8,
        count: counts.failures[reason as usize],
    };
    StrategyStatistics {
        proposed: counts.proposed,
        generated: counts.generated,
        accepted: counts.accepted,
        acceptance_sum: counts.acceptance_sum,
        failures: Failure::ALL.iter().map(failure).filter(|f| f.count > 0).collect(),
    }
}

/// Resident memory of the process in bytes; zero where the system does not tell.
fn resident_memory() -> u64 {
    memory_stats::memory_stats().map_or(0, |stats| stats.physical_mem as u64)
}
