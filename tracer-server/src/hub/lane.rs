//! The two lanes of one viewer: what it must get, and what it gets as far as it can.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use common::{
    CompiledFilter, FilterReply, FocusPath, Gap, Notice, PathBatch, Queue, Statistics, TracerEvent,
};
use tokio::sync::Notify;
use tokio::sync::futures::Notified;
use tokio::time::Instant;
use tokio_util::sync::CancellationToken;

use super::backlog::Backlog;
use super::budget::Budget;
use super::control::ControlQueue;
use super::film_queue::{FilmQueue, TileOrder};
use super::focus::{FOCUS_BYTES, FocusNews, FocusQueue};
use super::population::Population;
use super::{HubLimits, NumberedFilm};

/// The data lane holds what the budget sends in this many seconds, so that a slow viewer sees the
/// present and not the past.
const LANE_SECONDS: f64 = 0.5;
/// The data lane holds at least this many bytes, several batches.
const MIN_LANE_BYTES: usize = 256 << 10;

/// What a look into the lanes has found.
#[derive(Debug)]
pub(super) enum Next {
    /// Something to send.
    Send(TracerEvent),
    /// Rows to send, still to be converted: not under the lane's lock.
    Film(TileOrder),
    /// Rows of the explorer's film to send, still to be converted.
    ExplorerFilm(TileOrder),
    /// Nothing until the lane is filled, or until the instant when the budget or the open batch allows
    /// more.
    Later(Option<Instant>),
}

/// The lanes of one viewer.
#[derive(Debug)]
pub(super) struct Lane {
    session: u64,
    limits: HubLimits,
    state: Mutex<LaneState>,
    /// Touched by the viewer's own task only; locked before the state.
    population: Mutex<Population>,
    wake: Notify,
    /// Cancelled when the lanes are closed.
    ended: CancellationToken,
}

#[derive(Debug)]
struct LaneState {
    control: ControlQueue,
    closed: Option<String>,
    phase: Phase,

    backlog: Backlog,
    budget: Budget,
    /// Reports a gap even though no batch gets through.
    gap_is_due: bool,

    focus: FocusQueue,
    film: FilmQueue,
    explorer_film: FilmQueue,
    /// Whose turn it is when both film and paths wait.
    film_was_last: bool,
}

/// How far the viewer is into the session.
#[derive(Clone, Copy, Debug)]
enum Phase {
    /// It is being sent the film as it was when the viewer came.
    SnapshotFilm,
    /// Only the end of the snapshot is still to be announced.
    SnapshotEnd,
    /// It gets what is new.
    Live,
}

impl Lane {
    /// Empty lanes of viewer number `session`.
    pub(super) fn new(session: u64, limits: HubLimits, budget: u64, now: Instant) -> Self {
        let state = LaneState {
            control: ControlQueue::default(),
            closed: None,
            phase: Phase::Live,
            backlog: Backlog::default(),
            budget: Budget::new(or_default(budget, limits), now),
            gap_is_due: false,
            focus: FocusQueue::default(),
            film: FilmQueue::default(),
            explorer_film: FilmQueue::default(),
            film_was_last: false,
        };
        Self {
            session,
            limits,
            state: Mutex::new(state),
            population: Mutex::new(Population::new(session)),
            wake: Notify::new(),
            ended: CancellationToken::new(),
        }
    }

    /// The viewer's number.
    pub(super) fn session(&self) -> u64 {
        self.session
    }

    /// Resolves when something was put into the lanes since the last look.
    pub(super) fn filled(&self) -> Notified<'_> {
        self.wake.notified()
    }

    /// Lays out the snapshot that a new viewer gets before anything else.
    pub(super) fn begin_snapshot(
        &self,
        notices: impl Iterator<Item = Notice>,
        statistics: Option<Arc<Statistics>>,
        film: Option<NumberedFilm>,
    ) {
        let mut state = self.state();
        let statistics = statistics.map(TracerEvent::Statistics);
        for event in notices.map(TracerEvent::Notice).chain(statistics) {
            state.push_control(event, self.limits);
        }
        state.phase = if film.is_some() { Phase::SnapshotFilm } else { Phase::SnapshotEnd };
        if let Some(film) = film {
            state.film.push(film);
        }
    }

    /// Changes the data budget, in bytes a second.
    pub(super) fn set_budget(&self, budget: u64, now: Instant) {
        self.state().budget = Budget::new(or_default(budget, self.limits), now);
        self.wake.notify_one();
    }

    /// Marks half a second: an open gap is due, and so are statistics if there are any. Closes the
    /// lanes where the control lane is full.
    pub(super) fn tick(&self, statistics: Option<&Arc<Statistics>>) {
        let mut state = self.state();
        state.gap_is_due = true;
        if let Some(statistics) = statistics {
            state.push_control(TracerEvent::Statistics(Arc::clone(statistics)), self.limits);
        }
        self.wake(state);
    }

    /// Puts the answer to a filter into the control lane.
    pub(super) fn push_reply(&self, reply: FilterReply) {
        let mut state = self.state();
        state.push_control(TracerEvent::FilterReply(reply), self.limits);
        self.wake(state);
    }

    /// Puts in something of who steers. A state replaces the one before it that is not sent yet.
    pub(super) fn push_notice(&self, notice: Notice) {
        let mut state = self.state();
        state.push_control(TracerEvent::Notice(notice), self.limits);
        self.wake(state);
    }

    /// Ends the session from the daemon's side.
    pub(super) fn dismiss(&self, reason: &str) {
        let mut state = self.state();
        state.close(reason.to_owned());
        self.wake(state);
    }

    /// Waits until the lanes are closed, and says why they are. A viewer that does not read is told
    /// nothing else any more.
    pub(super) async fn closed(&self) -> String {
        self.ended.cancelled().await;
        self.state().closed.clone().unwrap_or_default()
    }

    fn wake(&self, state: MutexGuard<'_, LaneState>) {
        if state.closed.is_some() {
            self.ended.cancel();
        }
        drop(state);
        self.wake.notify_one();
    }

    /// Opens the focus lane with the explorer's `current` path, or closes it.
    pub(super) fn set_focus(&self, on: bool, current: Option<Arc<FocusPath>>) {
        self.state().focus.set(on, current);
        self.wake.notify_one();
    }

    /// True when the focus lane is open.
    pub(super) fn has_focus(&self) -> bool {
        self.state().focus.is_on()
    }

    /// Puts in what the explorer did.
    pub(super) fn push_focus(&self, news: &FocusNews) {
        self.state().focus.push(news);
        self.wake.notify_one();
    }

    /// Puts a snapshot of the explorer's film into the data lane.
    pub(super) fn push_explorer_film(&self, film: NumberedFilm) {
        let mut state = self.state();
        if state.focus.is_on() {
            state.explorer_film.push(film);
        }
        drop(state);
        self.wake.notify_one();
    }

    /// Puts a batch into the backlog, where the oldest make room for it.
    pub(super) fn push_paths(&self, batch: Arc<PathBatch>) {
        self.state().backlog.push(batch, self.limits.lane_bytes);
        self.wake.notify_one();
    }

    /// Puts a filter into force for all paths that are looked at from now on.
    pub(super) fn set_filter(&self, revision: u32, filter: Arc<CompiledFilter>) {
        let limit = self.filtered_limit();
        self.population().set_filter(revision, filter, limit);
    }

    /// Most bytes of paths that should wait after they were filtered.
    fn filtered_limit(&self) -> usize {
        let budgeted = self.state().budget.bytes_per_second() * LANE_SECONDS;
        (budgeted as usize).max(MIN_LANE_BYTES).min(self.limits.lane_bytes)
    }

    /// What goes to the viewer next, of whom there are `viewers`: filters, in the viewer's own task,
    /// what has come since. `shared` are the queues of all viewers.
    pub(super) fn next(
        &self,
        viewers: u32,
        shared: impl FnOnce() -> [Queue; 3],
        now: Instant,
    ) -> Next {
        let limit = self.filtered_limit();
        let mut population = self.population();
        // Not under the lane's lock: whoever fills it never waits for a filter.
        while let Some((gap, batch)) = self.pop_backlog() {
            population.miss(gap, limit);
            if let Some(batch) = batch {
                population.see(&batch, limit, now);
            }
        }
        population.tend(limit, now);
        let next = self.state().next(&mut population, now);
        match next {
            Next::Send(TracerEvent::Statistics(statistics)) => {
                let own = self.queues().into_iter().chain([population.queue(limit)]);
                let queues: Vec<_> = shared().into_iter().chain(own).collect();
                let (paths_sent, paths_dropped) = population.traffic();
                Next::Send(TracerEvent::Statistics(Arc::new(Statistics {
                    viewers,
                    paths_sent,
                    paths_dropped,
                    queued_bytes: queues.iter().filter(|q| q.own).map(|q| q.bytes).sum(),
                    queues,
                    filter: population.counts(),
                    ..Arc::unwrap_or_clone(statistics)
                })))
            }
            Next::Later(wait) => Next::Later(wait.into_iter().chain(population.deadline()).min()),
            next @ (Next::Send(_) | Next::Film(_) | Next::ExplorerFilm(_)) => next,
        }
    }

    /// Takes what came first from the backlog: what is missing, and the batch after it, if any.
    fn pop_backlog(&self) -> Option<(Gap, Option<Arc<PathBatch>>)> {
        self.state().backlog.pop()
    }

    /// What waits in the lanes.
    fn queues(&self) -> [Queue; 4] {
        let state = self.state();
        let (film, films) = state.film.byte_len();
        let (explorer_film, explorer_films) = state.explorer_film.byte_len();
        let own = |name: &str, bytes: usize, limit: usize| Queue {
            name: name.to_owned(),
            bytes: bytes as u64,
            limit: limit as u64,
            own: true,
        };
        [
            own("control messages", state.control.byte_len(), self.limits.control_bytes),
            own("paths to be filtered", state.backlog.byte_len(), self.limits.lane_bytes),
            own("steps of the explorer", state.focus.byte_len(), FOCUS_BYTES),
            own("films", film + explorer_film, films + explorer_films),
        ]
    }

    /// Notes what was lost before it reached the lanes.
    pub(super) fn push_lost(&self, lost: Gap) {
        self.state().backlog.push_lost(lost);
    }

    /// Puts a snapshot of the film into the data lane; the newest waits for the one on its way.
    pub(super) fn push_film(&self, film: NumberedFilm) {
        self.state().film.push(film);
        self.wake.notify_one();
    }

    pub(super) fn population(&self) -> MutexGuard<'_, Population> {
        self.population.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn state(&self) -> MutexGuard<'_, LaneState> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

fn or_default(budget: u64, limits: HubLimits) -> u64 {
    if budget == 0 { limits.default_budget } else { budget }
}

impl LaneState {
    /// Puts in what must not be lost, and closes the lanes where there is no more room for it.
    fn push_control(&mut self, event: TracerEvent, limits: HubLimits) {
        if self.closed.is_some() {
            return;
        }
        if !self.control.push(event, limits.control_messages, limits.control_bytes) {
            let (waiting, bytes) = (self.control.len(), self.control.byte_len());
            self.close(format!(
                "the viewer read too slowly: {waiting} control messages of {bytes} bytes wait for it"
            ));
        }
    }

    fn next(&mut self, population: &mut Population, now: Instant) -> Next {
        if let Some(reason) = &self.closed {
            return Next::Send(TracerEvent::Goodbye(reason.clone()));
        }
        if let Some(event) = self.control.pop() {
            return Next::Send(event);
        }
        if let Some(event) = self.focus.pop() {
            // Ahead of the other data, but not for free.
            self.budget.spend(event.byte_len());
            return Next::Send(event);
        }
        match self.phase {
            // The budget is ignored: a viewer is to have the snapshot within a second.
            Phase::SnapshotFilm => {
                let rows = self.film.take_rows();
                if self.film.is_between() {
                    self.phase = Phase::SnapshotEnd;
                }
                rows.map_or(Next::Later(None), Next::Film)
            }
            Phase::SnapshotEnd => {
                self.phase = Phase::Live;
                Next::Send(TracerEvent::SnapshotEnd)
            }
            Phase::Live => self.next_data(population, now),
        }
    }

    fn next_data(&mut self, population: &mut Population, now: Instant) -> Next {
        let wait = self.budget.wait(now);
        let has_batch = population.has_batch();
        if (wait.is_none() && has_batch || self.gap_is_due)
            && let Some(gap) = population.pop_gap()
        {
            self.gap_is_due = false;
            return Next::Send(TracerEvent::Gap(gap));
        }
        let films = self.film.is_waiting() || self.explorer_film.is_waiting();
        if wait.is_some() && (films || has_batch) {
            return Next::Later(wait);
        }
        let prefers_paths = self.film_was_last && has_batch;
        if !prefers_paths && let Some(order) = self.film.take_rows() {
            self.film_was_last = true;
            self.budget.spend(order.byte_len());
            return Next::Film(order);
        }
        if !prefers_paths && let Some(order) = self.explorer_film.take_rows() {
            self.film_was_last = true;
            self.budget.spend(order.byte_len());
            return Next::ExplorerFilm(order);
        }
        match population.pop_batch() {
            Some(batch) => {
                self.film_was_last = false;
                self.budget.spend(batch.byte_len());
                Next::Send(TracerEvent::Paths(batch))
            }
            None => Next::Later(None),
        }
    }

    /// Ends the session, and lets go of what will not be sent any more.
    fn close(&mut self, reason: String) {
        self.closed = Some(reason);
        self.control = ControlQueue::default();
        self.backlog = Backlog::default();
        self.focus = FocusQueue::default();
        self.film = FilmQueue::default();
        self.explorer_film = FilmQueue::default();
    }
}
