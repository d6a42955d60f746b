//! The chains with all that the driver may change of them.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError};
use std::time::Duration;

use common::{Author, ChainCommand, ChainState, OrderReply, StrategyId};
use tracing::{info, warn};

use super::{Reporter, film_frame};
use crate::chain::{Archive, Ensemble, EnsembleSettings, Normalization, Round};
use crate::hub::Hub;
use crate::scene::Scene;
use crate::steering::Envelope;

/// Mutations of all chains together in one round: about a tenth of a second of one core.
const ROUND_MUTATIONS: u64 = 1 << 17;
/// Steps of each chain that are shown in a round, while anyone looks.
const WINDOW: u64 = 20;
/// How long paused chains wait before they see whether they are to end.
const PAUSE: Duration = Duration::from_millis(100);
/// Samples drawn at most for a precision that the driver asks for.
const MOST_SAMPLES: u64 = 1 << 22;
/// And at least.
const LEAST_SAMPLES: u64 = 1 << 12;
/// Relative standard error of `b` above which viewers are warned, unless another one was requested.
const USUAL_PRECISION: f64 = 0.01;

/// Runs the chains of a scene round by round, and does in between what the driver asks for.
pub(super) struct ChainRunner<'a> {
    scene: &'a Scene,
    settings: EnsembleSettings,
    hub: &'a Hub,
    archive: &'a Archive,
    ensemble: Ensemble,
    /// Relative standard error of `b` that was asked for.
    precision: f64,
    reporter: Reporter,
    epoch: u32,
    running: bool,
    /// What was changed last, and by whom.
    change: (String, Option<Author>),
    /// Viewers have not been told about a change yet.
    is_change_unsent: bool,
    /// A reply that found no room; no order is followed before it is given.
    unsent_reply: Option<(u64, OrderReply)>,
}

impl<'a> ChainRunner<'a> {
    /// Seeds the chains.
    pub(super) fn new(
        scene: &'a Scene,
        settings: &EnsembleSettings,
        hub: &'a Hub,
        archive: &'a Archive,
    ) -> Self {
        for line in scene.features().switched_off() {
            info!("{line}");
        }
        let ensemble = seeded(scene, settings);
        Self {
            reporter: Reporter::new(settings),
            scene,
            settings: *settings,
            hub,
            archive,
            ensemble,
            precision: USUAL_PRECISION,
            epoch: 0,
            running: true,
            change: (String::new(), None),
            is_change_unsent: true,
            unsent_reply: None,
        }
    }

    /// Runs the chains until `stop`.
    pub(super) fn run(&mut self, orders: &Receiver<Envelope<ChainCommand>>, stop: &AtomicBool) {
        if self.ensemble.chain_count() == 0 {
            self.hub.publish_film(Arc::new(film_frame(self.scene, &self.ensemble)));
        }
        while !stop.load(Ordering::Relaxed) {
            self.tell();
            let works = self.running && self.ensemble.chain_count() > 0;
            // Chains that run look for orders between two rounds, and others wait for them.
            let wait = if works { Duration::ZERO } else { PAUSE };
            let order = if self.unsent_reply.is_none() {
                orders.recv_timeout(wait)
            } else {
                std::thread::sleep(wait);
                Err(RecvTimeoutError::Timeout)
            };
            match order {
                Ok(order) => {
                    self.answer(order);
                    continue;
                }
                Err(RecvTimeoutError::Timeout) => {}
                // Nobody will ever change anything.
                Err(RecvTimeoutError::Disconnected) if works => {}
                Err(RecvTimeoutError::Disconnected) => std::thread::sleep(PAUSE),
            }
            if works {
                self.round();
            }
        }
    }

    fn round(&mut self) {
        let steps = (ROUND_MUTATIONS / self.ensemble.chain_count() as u64).max(1);
        let window = self.hub.wants_paths().then_some(WINDOW);
        let batches = self.ensemble.advance(self.scene, steps, window);
        if window.is_some() {
            // Kept before it is shown, so that whatever is picked can be found.
            let normalization = self.ensemble.normalization(self.scene).b;
            let checkpoints = self.ensemble.take_checkpoints();
            let kernel = self.ensemble.shared_kernel();
            self.archive.put(Round::new(kernel, normalization, WINDOW.min(steps), checkpoints));
        }
        for batch in batches {
            self.hub.publish_paths(batch);
        }
        if self.reporter.is_due() {
            // Stored before viewers are told, for the same reason.
            self.archive.keep(self.ensemble.longest_stays());
        }
        self.reporter.report(self.scene, &self.ensemble, self.epoch, self.hub);
    }

    fn answer(&mut self, order: Envelope<ChainCommand>) {
        let Envelope { author, request, command } = order;
        let session = author.session;
        let error = match self.carry_out(command, &author) {
            Ok(change) => {
                info!(session, viewer = author.name, "{change}");
                self.change = (change, Some(author));
                self.is_change_unsent = true;
                None
            }
            Err(error) => Some(error),
        };
        self.unsent_reply = Some((session, OrderReply { request, error }));
        self.tell();
    }

    /// Does what is asked for, and says in a few words what that was.
    fn carry_out(&mut self, command: ChainCommand, author: &Author) -> Result<String, String> {
        match command {
            ChainCommand::Pause => {
                self.running = false;
                Ok("paused the chains".to_owned())
            }
            ChainCommand::Resume => {
                self.running = true;
                Ok("resumed the chains".to_owned())
            }
            ChainCommand::SetWeight { strategy, weight } => self.set_weight(strategy, weight),
            ChainCommand::SetPrecision(precision) => {
                // The pool there is tells how large the next one must be, and is thrown away.
                let Normalization { b, error } = self.ensemble.normalization(self.scene);
                let more = (error / b / precision).powi(2);
                let samples = self.settings.bootstrap_samples as f64 * more;
                self.precision = precision;
                self.settings.bootstrap_samples =
                    (samples as u64).clamp(LEAST_SAMPLES, MOST_SAMPLES);
                Ok(self.restart(
                    format!("restarted the chains, with b estimated to {precision}"),
                    author,
                ))
            }
            ChainCommand::Restart { seed } => {
                self.settings.seed = seed;
                Ok(self.restart(format!("restarted the chains with seed {seed}"), author))
            }
        }
    }

    fn set_weight(&mut self, strategy: StrategyId, weight: f64) -> Result<String, String> {
        let names = self.ensemble.mixture().names();
        let mut weights = self.ensemble.mixture().weights();
        let index = usize::from(strategy.0);
        let (Some(slot), Some(name)) = (weights.get_mut(index), names.get(index)) else {
            let all: Vec<_> = names.iter().enumerate().map(|(i, n)| format!("{i} {n}")).collect();
            return Err(format!(
                "there is no strategy number {index}; the strategies are {}",
                all.join(", ")
            ));
        };
        *slot = weight;
        if !weights.iter().any(|&weight| weight > 0.0) {
            return Err(
                "no strategy would be left; give another one a positive weight first".to_owned()
            );
        }
        self.epoch += 1;
        self.ensemble.begin_epoch(self.epoch, &weights);
        self.reporter.begin_epoch(self.ensemble.steps());
        Ok(format!("set the weight of {name} to {weight}"))
    }

    /// Restarts with the current settings. That takes a moment, and everyone is told why.
    fn restart(&mut self, change: String, author: &Author) -> String {
        let state = ChainState {
            running: false,
            change: "is restarting".to_owned(),
            by: Some(author.clone()),
            ..self.state()
        };
        if !self.hub.publish_chains(state) {
            warn!("viewers were not told that the chains are restarting");
        }
        self.ensemble = seeded(self.scene, &self.settings);
        self.epoch += 1;
        let weights = self.ensemble.mixture().weights();
        self.ensemble.begin_epoch(self.epoch, &weights);
        self.reporter.begin_epoch(0);
        change
    }

    fn state(&self) -> ChainState {
        let (change, by) = self.change.clone();
        ChainState {
            epoch: self.epoch,
            running: self.running,
            weights: self.ensemble.mixture().weights(),
            seed: self.settings.seed,
            precision: self.precision,
            change,
            by,
        }
    }

    /// Answers the last order and tells everybody of the last change; where the way is full, later.
    fn tell(&mut self) {
        if let Some((session, reply)) = &self.unsent_reply
            && self.hub.publish_reply(*session, reply.clone())
        {
            self.unsent_reply = None;
        }
        if self.is_change_unsent {
            self.is_change_unsent = !self.hub.publish_chains(self.state());
        }
    }
}

/// Chains of which every step is looked at.
fn seeded(scene: &Scene, settings: &EnsembleSettings) -> Ensemble {
    let mut ensemble = Ensemble::new(scene, settings, |_| ());
    ensemble.monitor();
    describe(scene, &ensemble);
    ensemble
}

/// Writes in the log what the seeds have shown of a scene.
fn describe(scene: &Scene, ensemble: &Ensemble) {
    if ensemble.chain_count() == 0 {
        warn!("no light reaches the film; the image stays black");
        return;
    }
    let Normalization { b, error } = ensemble.normalization(scene);
    info!("{} chains; mean luminance {b:.4} +- {error:.1e}", ensemble.chain_count());
    if error > 0.01 * b {
        warn!("the mean luminance is only known to within {:.1} %", 100.0 * error / b);
    }
    for prospect in ensemble.prospects() {
        info!("{prospect}");
    }
}
