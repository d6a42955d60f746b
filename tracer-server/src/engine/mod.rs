//! The daemon's chains at work: rounds without end, with reports to the hub in between, and changes
//! where the driver wants them.

mod runner;

use std::io;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::Receiver;
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use common::{ChainCommand, ChainTotals, FailureCount, FilmFrame, Statistics, StrategyStatistics};
use tracing::warn;

use crate::chain::{Archive, Ensemble, EnsembleSettings, Normalization, StrategyCounts};
use crate::hub::Hub;
use crate::path::Failure;
use crate::scene::Scene;
use crate::steering::Envelope;
use runner::ChainRunner;

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
    /// Starts the chains of `scene`, publishes what they do, and follows `orders`. What is shown of
    /// them is kept in the `archive`.
    pub fn start(
        scene: Arc<Scene>,
        settings: &EnsembleSettings,
        hub: Hub,
        archive: Arc<Archive>,
        orders: Receiver<Envelope<ChainCommand>>,
    ) -> io::Result<Self> {
        let stop = Arc::new(AtomicBool::new(false));
        let (settings, stopped) = (*settings, Arc::clone(&stop));
        let thread = thread::Builder::new().name("lvis-engine".to_owned()).spawn(move || {
            ChainRunner::new(&scene, &settings, &hub, &archive).run(&orders, &stopped);
        })?;
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

/// Decides when the film and the statistics are due.
struct Reporter {
    threads: usize,
    /// When the epoch began.
    started: Instant,
    /// When statistics were published last.
    statistics_at: Instant,
    /// Since when steps are counted for the rate, and how many there were then.
    counted_at: Instant,
    steps_at: u64,
    film_at: Option<Instant>,
}

impl Reporter {
    /// A reporter of chains that begin now.
    fn new(settings: &EnsembleSettings) -> Self {
        let now = Instant::now();
        Self {
            threads: settings.threads,
            started: now,
            statistics_at: now,
            counted_at: now,
            steps_at: 0,
            film_at: None,
        }
    }

    /// Another epoch begins, after `steps` steps on the film. Reports keep their pace.
    fn begin_epoch(&mut self, steps: u64) {
        let now = Instant::now();
        (self.started, self.counted_at, self.steps_at) = (now, now, steps);
        self.film_at = None;
    }

    /// True when counts and diagnostics are due.
    fn is_due(&self) -> bool {
        self.statistics_at.elapsed() >= STATISTICS_INTERVAL
    }

    /// Publishes what is due of an epoch.
    fn report(&mut self, scene: &Scene, ensemble: &Ensemble, epoch: u32, hub: &Hub) {
        let now = Instant::now();
        if self.film_at.is_none_or(|at| now >= at) {
            hub.publish_film(Arc::new(film_frame(scene, ensemble)));
            let rest = FILM_INTERVAL.max(now.elapsed() * FILM_COST);
            self.film_at = Some(now + rest);
        }
        if self.is_due() {
            let interval = now - self.counted_at;
            let steps = ensemble.steps().saturating_sub(self.steps_at);
            let rate = steps as f64 / interval.as_secs_f64().max(f64::MIN_POSITIVE);
            let elapsed = now - self.started;
            let mut statistics = statistics(scene, ensemble);
            statistics.epoch = epoch;
            statistics.threads = self.threads as u32;
            statistics.elapsed_seconds = elapsed.as_secs_f64();
            statistics.mutations_per_second = rate;
            hub.publish_statistics(Arc::new(statistics));
            self.statistics_at = now;
            self.counted_at = now;
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
    let Normalization { b: normalization, error: normalization_error } =
        ensemble.normalization(scene);
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
        diagnostics: ensemble.diagnostics().map(Arc::new),
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
