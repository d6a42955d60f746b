//! The connection to a daemon: a thread of its own that connects, listens, and connects again.
//!
//! The window never waits for the network: it takes in what lies in the [`Inbox`].

mod backlog;
mod backoff;
mod error;
mod inbox;
mod peer;
mod probe;
mod session;
mod tls;

pub use backoff::delay;
pub use error::SessionError;
pub use inbox::{Arrival, Inbox};
pub use peer::{Bearer, Peer, Trust};
pub use proto::Fingerprint;
pub use session::{Greeting, SceneFetcher, Session, own_name};

use std::fmt;
use std::sync::Arc;
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use common::{Appearance, FilterText, Order, PathId, Role, TracerEvent};
use proto::{NumberedOrder, ReceivedScene, ViewerEvent, WantedFilter};
use tokio::sync::{Notify, mpsc};
use tokio::task::JoinSet;
use tokio::time::MissedTickBehavior;
use tokio_util::sync::CancellationToken;

use crate::source::status::LinkState;

/// Messages to the daemon that may wait for the connection's thread.
const OUTBOX: usize = 64;
/// The daemon is asked this often how long it takes to answer.
const QUESTION: Duration = Duration::from_secs(2);

/// How soon something must be shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Urgency {
    /// Somebody waits for it.
    Now,
    /// More of what comes all the time: paths, the image, counts.
    Whenever,
}

impl Urgency {
    fn of(event: &TracerEvent) -> Self {
        match event {
            TracerEvent::Paths(_)
            | TracerEvent::Film(_)
            | TracerEvent::Statistics(_)
            | TracerEvent::Gap(_) => Self::Whenever,
            _ => Self::Now,
        }
    }
}

/// Called, from the connection's thread, whenever something has come.
pub type Waker = Box<dyn Fn(Urgency) + Send + Sync>;

/// A connection that mends itself. Dropping it says goodbye and waits for its thread.
pub struct Link {
    peer: Peer,
    inbox: Arc<Inbox>,
    retry_now: Arc<Notify>,
    outbox: mpsc::Sender<ViewerEvent>,
    shutdown: CancellationToken,
    thread: Option<JoinHandle<()>>,
}

impl fmt::Debug for Link {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Link").field("peer", &self.peer).finish_non_exhaustive()
    }
}

impl Link {
    /// Begins to connect to `peer`.
    pub fn start(peer: Peer, waker: Waker) -> std::io::Result<Self> {
        let inbox = Arc::new(Inbox::default());
        let retry_now = Arc::new(Notify::new());
        let shutdown = CancellationToken::new();
        let (outbox, orders) = mpsc::channel(OUTBOX);
        let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build()?;
        let connection = Connection {
            peer: peer.clone(),
            inbox: Arc::clone(&inbox),
            retry_now: Arc::clone(&retry_now),
            shutdown: shutdown.clone(),
            waker,
            held_hash: String::new(),
            orders,
            greeting: Greeting {
                name: own_name("Lvis viewer"),
                role: Role::Driver,
                focus: true,
                ..Greeting::default()
            },
        };
        let thread = std::thread::Builder::new()
            .name("connection".to_owned())
            .spawn(move || runtime.block_on(connection.run()))?;
        Ok(Self { peer, inbox, retry_now, outbox, shutdown, thread: Some(thread) })
    }

    /// Where the daemon should be.
    pub fn address(&self) -> &str {
        &self.peer.address
    }

    /// Where everything that comes waits to be taken in.
    pub fn inbox(&self) -> &Arc<Inbox> {
        &self.inbox
    }

    /// Sends an order; the daemon replies to it under the number `request`. False where it cannot be
    /// sent now.
    pub fn order(&self, request: u32, order: Order) -> bool {
        self.say(ViewerEvent::Order(NumberedOrder { request, order: Some(order) }))
    }

    /// Sets which paths come; blank for all. The daemon answers with a reply of the same `revision`,
    /// which must be at least 1 and grow. It must be set again when the connection is: a daemon that
    /// comes back may have a scene that cannot read it.
    pub fn set_filter(&self, revision: u32, filter: FilterText) -> bool {
        self.say(ViewerEvent::SetFilter(WantedFilter { revision, filter }))
    }

    /// Asks for every step of the explorer, or for no more of them; also when the connection is made
    /// anew.
    pub fn set_focus(&self, on: bool) -> bool {
        self.say(ViewerEvent::SetFocus(on))
    }

    /// Shows the others something of this viewer.
    pub fn show(&self, appearance: Appearance) -> bool {
        self.say(ViewerEvent::Appearance(appearance))
    }

    /// Asks for the numbers behind a path. False where too much waits to be sent.
    pub fn inspect(&self, path: PathId) -> bool {
        self.say(ViewerEvent::Inspect(path))
    }

    fn say(&self, event: ViewerEvent) -> bool {
        self.outbox.try_send(event).is_ok()
    }

    /// Ends the wait for the next attempt.
    pub fn retry_now(&self) {
        self.retry_now.notify_one();
    }
}

impl Drop for Link {
    fn drop(&mut self) {
        self.shutdown.cancel();
        if let Some(thread) = self.thread.take()
            && thread.join().is_err()
        {
            tracing::error!("the connection's thread panicked");
        }
    }
}

/// What the connection's thread owns.
struct Connection {
    peer: Peer,
    inbox: Arc<Inbox>,
    retry_now: Arc<Notify>,
    shutdown: CancellationToken,
    waker: Waker,
    /// The scene that was delivered last; it is not fetched again.
    held_hash: String,
    orders: mpsc::Receiver<ViewerEvent>,
    /// How the next session begins.
    greeting: Greeting,
}

impl Connection {
    async fn run(mut self) {
        let shutdown = self.shutdown.clone();
        let mut failures = 0;
        loop {
            self.set_state(LinkState::Connecting);
            let ended = tokio::select! {
                () = shutdown.cancelled() => return,
                opened = Session::open(&self.peer, self.greeting.clone()) => match opened {
                    Ok(session) => self.listen(session, &mut failures).await,
                    Err(error) => Some(error),
                },
            };
            let Some(error) = ended else { return };
            failures += 1;
            let wait = delay(failures);
            tracing::info!("{error}; next attempt in {:.1} s", wait.as_secs_f32());
            let retry_at = Instant::now() + wait;
            self.set_state(LinkState::Disconnected { reason: error.to_string(), retry_at });
            tokio::select! {
                () = shutdown.cancelled() => return,
                () = self.retry_now.notified() => {}
                () = tokio::time::sleep(wait) => {}
            }
            // What was wanted is in the greeting; orders to a daemon that was not there are void.
            while let Ok(event) = self.orders.try_recv() {
                self.remember(&event);
            }
        }
    }

    /// Keeps in mind what the next session begins with.
    fn remember(&mut self, event: &ViewerEvent) {
        if let ViewerEvent::SetFocus(on) = event {
            self.greeting.focus = *on;
        }
    }

    /// Listens until the session ends; `None` when this viewer ended it.
    async fn listen(&mut self, mut session: Session, failures: &mut u32) -> Option<SessionError> {
        let shutdown = self.shutdown.clone();
        let mut fetching: JoinSet<Result<Option<ReceivedScene>, SessionError>> = JoinSet::new();
        let mut asking: JoinSet<Result<Duration, SessionError>> = JoinSet::new();
        let mut question = tokio::time::interval(QUESTION);
        question.set_missed_tick_behavior(MissedTickBehavior::Delay);
        loop {
            tokio::select! {
                () = shutdown.cancelled() => {
                    session.leave().await;
                    return None;
                }
                Some(fetched) = fetching.join_next() => match fetched {
                    Ok(Ok(scene)) => self.deliver_scene(scene),
                    Ok(Err(error)) => return Some(error),
                    Err(error) => tracing::error!("fetching the scene failed: {error}"),
                },
                // A daemon that does not answer is asked nothing more; that it is silent is seen
                // elsewhere.
                _ = question.tick(), if asking.is_empty() && !self.held_hash.is_empty() => {
                    let question = session.scene_fetcher().fetch(self.held_hash.clone());
                    asking.spawn(async move {
                        let begun = Instant::now();
                        question.await.map(|_| begun.elapsed())
                    });
                }
                Some(answered) = asking.join_next() => {
                    // Shown with what comes next: not worth a picture of its own.
                    if let Ok(Ok(latency)) = answered {
                        self.inbox.push(Arrival::Latency(latency));
                    }
                }
                Some(event) = self.orders.recv() => {
                    self.remember(&event);
                    if !session.say(event) {
                        tracing::warn!("the daemon is not accepting messages; one was not sent");
                    }
                }
                event = session.next() => match event {
                    Ok(event) => {
                        if let TracerEvent::Welcome(welcome) = &event {
                            *failures = 0;
                            self.greeting.resume.clone_from(&welcome.resume);
                            let fetch = session.scene_fetcher().fetch(self.held_hash.clone());
                            fetching.spawn(fetch);
                            self.set_state(LinkState::Connected);
                        }
                        let haste = Urgency::of(&event);
                        if self.inbox.put(event) {
                            (self.waker)(haste);
                        }
                    }
                    Err(error) => return Some(error),
                },
            }
        }
    }

    fn deliver_scene(&mut self, scene: Option<ReceivedScene>) {
        let Some(scene) = scene else { return };
        self.held_hash.clone_from(&scene.hash);
        self.inbox.push(Arrival::Scene(Box::new(scene)));
        (self.waker)(Urgency::Now);
    }

    fn set_state(&self, state: LinkState) {
        self.inbox.push(Arrival::Link(state));
        (self.waker)(Urgency::Now);
    }
}
