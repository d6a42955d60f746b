//! The explorer: one more chain, on a thread of its own, that people seed and step.
//!
//! It draws from its own random streams and splats on its own film; the image and the chains that
//! make it never notice. Its thread sleeps unless somebody gives it an order, or watches it play.

mod walker;

#[cfg(test)]
mod tests;

use std::io;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use common::{
    Author, DetailReply, ExplorerCommand, ExplorerState, FocusOutcome, FocusStep, Notice,
    OrderReply, Pace, PathId, SkipTo, StrategyId, StrategySet,
};
use tracing::warn;

use crate::chain::Archive;
use crate::hub::{FocusNews, Hub};
use crate::scene::Scene;
use crate::steering::{Envelope, ExplorerMail, Steering};
use walker::{Progress, Walker};

/// Steps of a burst while it skips, and the rest after it: at most twenty thousand steps a second, so
/// that those who watch can follow and the chains keep the processors.
const BURST: u32 = 20;
/// See [`BURST`].
const REST: Duration = Duration::from_millis(1);
/// A skip that has not reached its goal ends after this many steps.
const LONGEST_SKIP: u64 = 1_000_000;
/// Steps that are made up for after the thread was late.
const MOST_DUE: u32 = 64;
/// Time between two reports of state and film while it moves.
const REPORT_INTERVAL: Duration = Duration::from_secs(1);

/// A running explorer; dropping it stops it.
#[derive(Debug)]
pub struct Explorer {
    stop: Arc<AtomicBool>,
    steering: Steering,
    thread: Option<JoinHandle<()>>,
}

impl Explorer {
    /// Starts an explorer of `scene` that follows `orders` and takes its paths from the `archive`.
    /// `steering` is the other end of `orders`.
    pub fn start(
        scene: Arc<Scene>,
        seed: u64,
        archive: Arc<Archive>,
        hub: Hub,
        steering: Steering,
        orders: Receiver<ExplorerMail>,
    ) -> io::Result<Self> {
        let stop = Arc::new(AtomicBool::new(false));
        let explorer = ExplorerLoop {
            walker: Walker::new(scene, seed),
            archive,
            hub,
            pace: Motion::Paused,
            rate: 1.0,
            by: None,
            reported: Instant::now(),
        };
        let stopped = Arc::clone(&stop);
        let thread = thread::Builder::new()
            .name("lvis-explorer".to_owned())
            .spawn(move || explorer.run(&orders, &stopped))?;
        Ok(Self { stop, steering, thread: Some(thread) })
    }
}

impl Drop for Explorer {
    fn drop(&mut self) {
        self.stop.store(true, Ordering::Relaxed);
        self.steering.wake_explorer();
        if let Some(thread) = self.thread.take()
            && thread.join().is_err()
        {
            warn!("the explorer ended in a panic");
        }
    }
}

/// How the explorer moves.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Motion {
    Paused,
    /// The next step is due then.
    Playing(Instant),
    /// Until the goal is reached, or this many steps are taken.
    Skipping(Goal, u64),
}

/// What ends a skip.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Goal {
    /// Nothing but the number of steps.
    Steps,
    /// See [`SkipTo`].
    Event(SkipTo),
}

impl Goal {
    fn is_reached(self, step: &FocusStep) -> bool {
        match self {
            Self::Steps => false,
            Self::Event(SkipTo::Acceptance) => step.outcome == FocusOutcome::Accepted,
            Self::Event(SkipTo::Strategy(strategy)) => step.strategy == strategy,
        }
    }
}

/// The explorer's thread: it waits for orders, and takes steps while it plays.
#[derive(Debug)]
struct ExplorerLoop {
    walker: Walker,
    archive: Arc<Archive>,
    hub: Hub,
    pace: Motion,
    rate: f32,
    by: Option<Author>,
    reported: Instant,
}

impl ExplorerLoop {
    fn run(mut self, orders: &Receiver<ExplorerMail>, stop: &AtomicBool) {
        self.announce();
        while !stop.load(Ordering::Relaxed) {
            let wait = match self.pace {
                Motion::Skipping(..) => Some(REST),
                Motion::Playing(due) if self.hub.wants_focus() => {
                    Some(due.saturating_duration_since(Instant::now()))
                }
                // Nobody would see it.
                Motion::Playing(_) | Motion::Paused => None,
            };
            let mail = match wait {
                None => orders.recv().map_err(RecvTimeoutError::from),
                Some(wait) => orders.recv_timeout(wait),
            };
            match mail {
                Ok(ExplorerMail::Order(order)) => self.answer(order),
                Ok(ExplorerMail::Inspect(session, path)) => self.inspect(session, path),
                Ok(ExplorerMail::Wake) => self.wake(),
                Err(RecvTimeoutError::Timeout) => self.take_due_steps(),
                Err(RecvTimeoutError::Disconnected) => return,
            }
        }
    }

    /// What was due while nobody watched is not made up for.
    fn wake(&mut self) {
        if let Motion::Playing(due) = &mut self.pace {
            *due = (*due).max(Instant::now());
        }
    }

    fn answer(&mut self, order: Envelope<ExplorerCommand>) {
        let Envelope { author, request, command } = order;
        let session = author.session;
        let done = self.carry_out(command);
        if done.is_ok() {
            self.by = Some(author);
            self.report();
        }
        let reply = OrderReply { request, error: done.err() };
        self.hub.tell(session, Notice::Reply(reply));
    }

    fn inspect(&self, session: u64, path: PathId) {
        let found = self.walker.detail(path, &self.archive);
        self.hub.tell(session, Notice::Detail(Box::new(DetailReply { path, found })));
    }

    fn carry_out(&mut self, command: ExplorerCommand) -> Result<(), String> {
        if !self.walker.is_seeded() && !matches!(command, ExplorerCommand::Seed(_)) {
            return Err("the explorer has no path yet: seed it with one first".to_owned());
        }
        match command {
            ExplorerCommand::Seed(seed) => {
                let news = self.walker.seed(seed, &self.archive)?;
                self.hub.publish_focus(news);
                if matches!(self.pace, Motion::Skipping(..)) {
                    self.pace = Motion::Paused;
                }
            }
            ExplorerCommand::Play(rate) => {
                self.rate = rate;
                self.pace = Motion::Playing(Instant::now() + self.period());
            }
            ExplorerCommand::Pause => self.pace = Motion::Paused,
            ExplorerCommand::Step(count) => self.skip(Goal::Steps, count.into()),
            ExplorerCommand::Skip(to) => {
                if let SkipTo::Strategy(strategy) = to {
                    self.check(strategy)?;
                }
                self.skip(Goal::Event(to), LONGEST_SKIP);
            }
            ExplorerCommand::Allow(set) => {
                let news = self.walker.allow(set)?;
                self.hub.publish_focus(news);
            }
            ExplorerCommand::Fan { strategy, count } => {
                self.check(strategy)?;
                self.walker.open_fan();
                for _ in 0..count {
                    let news = self.walker.probe(strategy);
                    self.hub.publish_focus(news);
                }
            }
        }
        Ok(())
    }

    fn check(&self, strategy: StrategyId) -> Result<(), String> {
        let names = self.walker.strategies();
        if names.len() > usize::from(strategy.0) {
            return Ok(());
        }
        let numbered: Vec<_> = names.iter().enumerate().map(|(i, n)| format!("{i} {n}")).collect();
        Err(format!(
            "there is no strategy number {}; the strategies are {}",
            strategy.0,
            numbered.join(", ")
        ))
    }

    /// Begins a skip with its first burst, so that a single step is seen at once.
    fn skip(&mut self, goal: Goal, steps: u64) {
        self.pace = Motion::Skipping(goal, steps);
        self.take_due_steps();
    }

    /// Takes the steps that are due.
    fn take_due_steps(&mut self) {
        match self.pace {
            Motion::Paused => return,
            Motion::Playing(due) => self.play(due),
            Motion::Skipping(goal, left) => self.burst(goal, left),
        }
        if self.pace == Motion::Paused || self.reported.elapsed() >= REPORT_INTERVAL {
            self.report();
        }
    }

    fn play(&mut self, mut due: Instant) {
        let (now, period) = (Instant::now(), self.period());
        for _ in 0..MOST_DUE {
            if due > now {
                break;
            }
            self.step();
            due += period;
        }
        self.pace = Motion::Playing(due.max(now));
    }

    fn burst(&mut self, goal: Goal, left: u64) {
        let count = left.min(BURST.into());
        for _ in 0..count {
            if goal.is_reached(&self.step()) {
                self.pace = Motion::Paused;
                return;
            }
        }
        let left = left - count;
        self.pace = if left > 0 { Motion::Skipping(goal, left) } else { Motion::Paused };
    }

    fn step(&mut self) -> Arc<FocusStep> {
        let (step, after) = self.walker.step();
        self.hub.publish_focus(FocusNews { step: Some(Arc::clone(&step)), after });
        step
    }

    fn period(&self) -> Duration {
        // The rate was checked where it came in.
        Duration::try_from_secs_f32(1.0 / self.rate).unwrap_or(REPORT_INTERVAL)
    }

    /// Tells everybody where it is, and shows its film to those who watch it.
    fn report(&mut self) {
        self.reported = Instant::now();
        self.announce();
        if self.hub.wants_focus()
            && let Some(film) = self.walker.film()
        {
            self.hub.publish_explorer_film(Arc::new(film));
        }
    }

    fn announce(&self) {
        let Progress { steps, accepted } = self.walker.progress();
        let state = ExplorerState {
            pace: match self.pace {
                Motion::Paused => Pace::Paused,
                Motion::Playing(_) => Pace::Playing,
                Motion::Skipping(..) => Pace::Skipping,
            },
            rate: self.rate,
            allowed: if self.walker.is_seeded() { self.walker.allowed() } else { StrategySet::ALL },
            current: self.walker.current().map(|path| path.header.id),
            origin: self.walker.origin(),
            steps,
            accepted,
            next: self.walker.next(),
            by: self.by.clone(),
        };
        self.hub.announce(&Notice::Explorer(state));
    }
}
