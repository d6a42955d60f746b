//! Where chains and viewers meet, and the only place where they do.
//!
//! Producers hand over paths, film and statistics without ever waiting: they push into two bounded
//! queues, and what finds them full is counted as lost. The [`Pump`], a task, empties the queues and
//! lays everything into the lanes of each viewer. A viewer has two: the control lane is lossless,
//! goes first, and a viewer that lets it fill is disconnected; the data lane is lossy and bounded in
//! bytes, drops its oldest batch, and reports the loss as a [`common::Gap`].
//!
//! What a viewer's filter wants is picked out in the viewer's own task, from the data lane: batches
//! wait there as they are, shared by all viewers, until the viewer has room for more.
//!
//! The steps of the explorer go to those who ask for them, through a lane that is lossless within its
//! bound; who steers, and what was changed, goes through the control lane.
//!
//! No lock that a viewer can hold is ever taken by a chain.

mod backlog;
mod budget;
mod control;
mod film_queue;
mod focus;
mod lane;
mod population;
mod pump;
mod sampler;

use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use common::{
    ChainState, CompiledFilter, ExplorerState, FilmFrame, FilterReply, FocusPath, Gap,
    MAX_VERTICES, Notice, OrderReply, PathBatch, Presence, Queue, Statistics, TracerEvent,
};
use thiserror::Error;
use tokio::sync::mpsc;
use tokio::time::{Instant, timeout_at};

pub use focus::FocusNews;
pub use pump::Pump;

use lane::{Lane, Next};

/// What bounds the hub's queues.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct HubLimits {
    /// Most viewers at a time.
    pub viewers: usize,
    /// Most bytes of paths that wait for the pump.
    pub ingress_bytes: usize,
    /// Most bytes of films that wait for the pump.
    pub film_bytes: usize,
    /// Most bytes of paths that wait for one viewer.
    pub lane_bytes: usize,
    /// Most control messages that wait for one viewer; at two a second, half a minute of them.
    pub control_messages: usize,
    /// Most bytes of control messages that wait for one viewer.
    pub control_bytes: usize,
    /// Bytes of data a second for a viewer that names no budget.
    pub default_budget: u64,
}

impl Default for HubLimits {
    fn default() -> Self {
        Self {
            viewers: 32,
            ingress_bytes: 8 << 20,
            film_bytes: 32 << 20,
            lane_bytes: 4 << 20,
            control_messages: 64,
            control_bytes: 4 << 20,
            default_budget: 16 << 20,
        }
    }
}

/// Most path batches that wait for the pump, whatever their size.
const INGRESS_BATCHES: usize = 512;
/// Most snapshots of film and statistics, states and replies that wait for the pump.
const INGRESS_NEWS: usize = 64;
/// Most steps of the explorer that wait for the pump.
const INGRESS_FOCUS: usize = 1024;
/// Most bytes of one of them: no more vertices than a path may have on either side.
const FOCUS_STEP_BYTES: usize = 160 + 2 * 24 * MAX_VERTICES;

/// The refusal of one viewer too many.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error("{limit} viewers are connected, the most that this daemon serves; try again later")]
pub struct HubFull {
    /// Most viewers at a time.
    pub limit: usize,
}

/// A handle for producers and viewers; cheap to clone.
#[derive(Clone, Debug)]
pub struct Hub {
    shared: Arc<Shared>,
    paths: mpsc::Sender<PathBatch>,
    news: mpsc::Sender<News>,
    focus: mpsc::Sender<FocusNews>,
}

/// What producers and the pump share without locks, and viewers and the pump behind one.
#[derive(Debug)]
struct Shared {
    limits: HubLimits,
    viewers: AtomicUsize,
    focus_viewers: AtomicUsize,
    waiting_bytes: AtomicUsize,
    waiting_film_bytes: AtomicUsize,
    waiting_focus_bytes: AtomicUsize,
    lost: Lost,
    /// Never touched by producers.
    registry: Mutex<Registry>,
}

/// What did not fit into the queue to the pump.
#[derive(Debug, Default)]
struct Lost {
    batches: AtomicU64,
    paths: AtomicU64,
    bytes: AtomicU64,
}

/// What waits for the pump, other than paths.
#[derive(Debug)]
enum News {
    Film(Arc<FilmFrame>),
    Statistics(Arc<Statistics>),
    ExplorerFilm(Arc<FilmFrame>),
    Chains(ChainState),
    Reply(u64, OrderReply),
}

/// The viewers, and what a new one is shown at once.
#[derive(Debug, Default)]
struct Registry {
    sessions: u64,
    lanes: Vec<Arc<Lane>>,
    film: Option<NumberedFilm>,
    statistics: Option<Arc<Statistics>>,
    presence: Option<Presence>,
    chains: Option<ChainState>,
    explorer: Option<ExplorerState>,
    explorer_film: Option<NumberedFilm>,
    focus: Option<Arc<FocusPath>>,
}

/// A snapshot of the film under its sequence number.
#[derive(Clone, Debug)]
struct NumberedFilm {
    sequence: u64,
    frame: Arc<FilmFrame>,
}

impl Hub {
    /// A hub, and the pump that some task must [`Pump::run`] for anything to arrive.
    pub fn new(limits: HubLimits) -> (Self, Pump) {
        let (paths, path_queue) = mpsc::channel(INGRESS_BATCHES);
        let (news, news_queue) = mpsc::channel(INGRESS_NEWS);
        let (focus, focus_queue) = mpsc::channel(INGRESS_FOCUS);
        let shared = Arc::new(Shared {
            limits,
            viewers: AtomicUsize::new(0),
            focus_viewers: AtomicUsize::new(0),
            waiting_bytes: AtomicUsize::new(0),
            waiting_film_bytes: AtomicUsize::new(0),
            waiting_focus_bytes: AtomicUsize::new(0),
            lost: Lost::default(),
            registry: Mutex::default(),
        });
        let pump = Pump::new(Arc::clone(&shared), path_queue, news_queue, focus_queue);
        (Self { shared, paths, news, focus }, pump)
    }

    /// True while anyone would see published paths; producers need not make any otherwise.
    pub fn wants_paths(&self) -> bool {
        self.viewers() > 0
    }

    /// Viewers connected.
    pub fn viewers(&self) -> usize {
        self.shared.viewers.load(Ordering::Relaxed)
    }

    /// Hands over a batch, or counts it as lost where the pump is behind. Never waits.
    pub fn publish_paths(&self, batch: PathBatch) {
        if batch.is_empty() || !self.wants_paths() {
            return;
        }
        let size = Gap { batches: 1, paths: batch.len() as u64, bytes: batch.byte_len() as u64 };
        let waiting = self.shared.waiting_bytes.fetch_add(batch.byte_len(), Ordering::Relaxed);
        let fits = waiting == 0 || waiting + batch.byte_len() <= self.shared.limits.ingress_bytes;
        if !fits || self.paths.try_send(batch).is_err() {
            self.shared.waiting_bytes.fetch_sub(size.bytes as usize, Ordering::Relaxed);
            self.shared.lost.add(size);
        }
    }

    /// Hands over a snapshot of the film; the newest one replaces those not yet sent. Never waits.
    pub fn publish_film(&self, frame: Arc<FilmFrame>) {
        let area = frame.width as usize * frame.height as usize;
        debug_assert_eq!(frame.pixels.len(), area, "a film has as many pixels as it says");
        self.publish_frame(frame, News::Film);
    }

    /// Hands over statistics; viewers are sent the newest twice a second. Never waits.
    pub fn publish_statistics(&self, statistics: Arc<Statistics>) {
        self.publish_news(News::Statistics(statistics));
    }

    /// Hands over a snapshot of the explorer's film, for those who watch the explorer. Never waits.
    pub fn publish_explorer_film(&self, frame: Arc<FilmFrame>) {
        self.publish_frame(frame, News::ExplorerFilm);
    }

    fn publish_frame(&self, frame: Arc<FilmFrame>, news: impl Fn(Arc<FilmFrame>) -> News) {
        let (bytes, waiting) = (film_bytes(&frame), &self.shared.waiting_film_bytes);
        let before = waiting.fetch_add(bytes, Ordering::Relaxed);
        let fits = before == 0 || before + bytes <= self.shared.limits.film_bytes;
        if !fits || !self.publish_news(news(frame)) {
            waiting.fetch_sub(bytes, Ordering::Relaxed);
        }
    }

    /// Hands over what the chains are at. Never waits; false where it must be tried again.
    #[must_use]
    pub fn publish_chains(&self, state: ChainState) -> bool {
        self.news.try_send(News::Chains(state)).is_ok()
    }

    /// Hands over the answer to an order that the viewer of `session` has given. Never waits; false
    /// where it must be tried again.
    #[must_use]
    pub fn publish_reply(&self, session: u64, reply: OrderReply) -> bool {
        self.news.try_send(News::Reply(session, reply)).is_ok()
    }

    /// True while anyone sees what the explorer does.
    pub fn wants_focus(&self) -> bool {
        self.shared.focus_viewers.load(Ordering::Relaxed) > 0
    }

    /// Hands over a step of the explorer. Nothing is lost on the way to the lanes: where the pump is
    /// behind, this waits for it, so it is not for the chains.
    pub fn publish_focus(&self, news: FocusNews) {
        self.shared.waiting_focus_bytes.fetch_add(news.byte_len(), Ordering::Relaxed);
        let full = match self.focus.try_send(news) {
            Ok(()) | Err(mpsc::error::TrySendError::Closed(_)) => return,
            Err(mpsc::error::TrySendError::Full(news)) => news,
        };
        if self.focus.blocking_send(full).is_err() {
            tracing::debug!("a step of the explorer came after the end");
        }
    }

    /// Tells every viewer, and those who come later. Takes the lock of the viewers' list: not for the
    /// chains.
    pub fn announce(&self, notice: &Notice) {
        let mut registry = self.shared.registry();
        match notice {
            Notice::Presence(presence) => registry.presence = Some(presence.clone()),
            Notice::Chains(state) => registry.chains = Some(state.clone()),
            Notice::Explorer(state) => registry.explorer = Some(state.clone()),
            Notice::Lease(_) | Notice::Reply(_) | Notice::Detail(_) => {}
        }
        for lane in &registry.lanes {
            lane.push_notice(notice.clone());
        }
    }

    /// Tells one viewer, if it is still there. Not for the chains.
    pub fn tell(&self, session: u64, notice: Notice) {
        if let Some(lane) = self.shared.registry().lane(session) {
            lane.push_notice(notice);
        }
    }

    /// Ends the session of a viewer, if it is still there.
    pub fn dismiss(&self, session: u64, reason: &str) {
        if let Some(lane) = self.shared.registry().lane(session) {
            lane.dismiss(reason);
        }
    }

    fn publish_news(&self, news: News) -> bool {
        // Where the pump is that far behind, a later snapshot will do.
        let sent = self.news.try_send(news).is_ok();
        if !sent {
            tracing::trace!("a snapshot was skipped, because the pump is behind");
        }
        sent
    }

    /// Adds a viewer with a data budget in bytes a second (0 for the default). What it hears
    /// first is the snapshot.
    pub fn subscribe(&self, budget: u64) -> Result<Subscription, HubFull> {
        let limits = self.shared.limits;
        let mut registry = self.shared.registry();
        if registry.lanes.len() >= limits.viewers {
            return Err(HubFull { limit: limits.viewers });
        }
        registry.sessions += 1;
        let lane = Arc::new(Lane::new(registry.sessions, limits, budget, Instant::now()));
        let notices = registry.notices();
        lane.begin_snapshot(notices, registry.statistics.clone(), registry.film.clone());
        registry.lanes.push(Arc::clone(&lane));
        self.shared.count(&registry);
        drop(registry);
        Ok(Subscription { shared: Arc::clone(&self.shared), lane })
    }
}

impl Shared {
    fn registry(&self) -> MutexGuard<'_, Registry> {
        self.registry.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// What waits for the pump.
    fn queues(&self) -> [Queue; 3] {
        let shared = |name: &str, bytes: &AtomicUsize, limit: usize| Queue {
            name: name.to_owned(),
            bytes: bytes.load(Ordering::Relaxed) as u64,
            limit: limit as u64,
            own: false,
        };
        let (limits, steps) = (self.limits, INGRESS_FOCUS * FOCUS_STEP_BYTES);
        [
            shared("paths from the chains", &self.waiting_bytes, limits.ingress_bytes),
            shared("films from the chains", &self.waiting_film_bytes, limits.film_bytes),
            shared("steps from the explorer", &self.waiting_focus_bytes, steps),
        ]
    }

    /// Brings up to date what producers know of the viewers.
    fn count(&self, registry: &Registry) {
        let focus = registry.lanes.iter().filter(|lane| lane.has_focus()).count();
        self.viewers.store(registry.lanes.len(), Ordering::Relaxed);
        self.focus_viewers.store(focus, Ordering::Relaxed);
    }
}

/// Bytes of a film's pixels.
fn film_bytes(frame: &FilmFrame) -> usize {
    size_of_val(frame.pixels.as_slice())
}

impl Registry {
    fn lane(&self, session: u64) -> Option<&Arc<Lane>> {
        self.lanes.iter().find(|lane| lane.session() == session)
    }

    /// What a new viewer must hear of those who steer.
    fn notices(&self) -> impl Iterator<Item = Notice> {
        let presence = self.presence.clone().map(Notice::Presence);
        let chains = self.chains.clone().map(Notice::Chains);
        let explorer = self.explorer.clone().map(Notice::Explorer);
        [presence, chains, explorer].into_iter().flatten()
    }
}

impl Lost {
    fn add(&self, gap: Gap) {
        self.batches.fetch_add(gap.batches, Ordering::Relaxed);
        self.paths.fetch_add(gap.paths, Ordering::Relaxed);
        self.bytes.fetch_add(gap.bytes, Ordering::Relaxed);
    }

    fn drain(&self) -> Gap {
        Gap {
            batches: self.batches.swap(0, Ordering::Relaxed),
            paths: self.paths.swap(0, Ordering::Relaxed),
            bytes: self.bytes.swap(0, Ordering::Relaxed),
        }
    }
}

/// One viewer's end of the hub; leaving it unsubscribes.
#[derive(Debug)]
pub struct Subscription {
    shared: Arc<Shared>,
    lane: Arc<Lane>,
}

impl Subscription {
    /// A number for this viewer, unique while the hub lives.
    pub fn session(&self) -> u64 {
        self.lane.session()
    }

    /// Changes the data budget, in bytes a second; 0 for the default.
    pub fn set_budget(&self, budget: u64) {
        self.lane.set_budget(budget, Instant::now());
    }

    /// Opens the focus lane, which begins with the explorer's current path, or closes it.
    pub fn set_focus(&self, on: bool) {
        let registry = self.shared.registry();
        self.lane.set_focus(on, registry.focus.clone());
        if let Some(film) = registry.explorer_film.clone().filter(|_| on) {
            self.lane.push_explorer_film(film);
        }
        self.shared.count(&registry);
    }

    /// Tells this viewer.
    pub fn notice(&self, notice: Notice) {
        self.lane.push_notice(notice);
    }

    /// Puts a filter into force, for all paths that are looked at from now on, and replies to it. Each
    /// batch names its filter, and no path is lost or seen twice by the change.
    pub fn set_filter(&self, revision: u32, filter: Arc<CompiledFilter>) {
        let reply = FilterReply {
            revision,
            text: filter.text().to_owned(),
            conditions: filter.condition_texts().to_vec(),
            ..FilterReply::default()
        };
        self.lane.set_filter(revision, filter);
        self.reply(reply);
    }

    /// Answers a filter without putting it into force.
    pub fn reply(&self, reply: FilterReply) {
        let epoch = self.shared.registry().statistics.as_ref().map_or(0, |news| news.epoch);
        self.lane.push_reply(FilterReply { epoch, ..reply });
    }

    /// Waits until the hub ends the session, whether the viewer reads or not, and says why.
    pub async fn closed(&self) -> String {
        self.lane.closed().await
    }

    /// Waits for what goes to the viewer next. Nothing is lost when the wait is abandoned.
    pub async fn next(&self) -> TracerEvent {
        loop {
            // Holds a permit if the lane was filled since, so that no wake-up is missed.
            let filled = self.lane.filled();
            let viewers = self.shared.viewers.load(Ordering::Relaxed) as u32;
            match self.lane.next(viewers, || self.shared.queues(), Instant::now()) {
                Next::Send(event) => return event,
                Next::Film(order) => return TracerEvent::Film(order.tile()),
                Next::ExplorerFilm(order) => return TracerEvent::ExplorerFilm(order.tile()),
                Next::Later(None) => filled.await,
                // Whether time or news ended the wait, the lane is looked at again.
                Next::Later(Some(instant)) => drop(timeout_at(instant, filled).await),
            }
        }
    }
}

impl Drop for Subscription {
    fn drop(&mut self) {
        let mut registry = self.shared.registry();
        registry.lanes.retain(|lane| !Arc::ptr_eq(lane, &self.lane));
        self.shared.count(&registry);
    }
}

#[cfg(test)]
mod lanes;
#[cfg(test)]
mod selection;
#[cfg(test)]
mod tests;
