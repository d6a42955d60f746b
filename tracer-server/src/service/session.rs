//! One viewer, from hello to goodbye.

use std::error::Error as _;
use std::sync::Arc;

use common::{
    CompiledFilter, DetailReply, FilterError, FilterReply, FilterScene, FilterText, Notice, Order,
    OrderReply, PathId, Role, TracerEvent, Welcome,
};
use proto::v1::{TracerMessage, ViewerMessage};
use proto::{Hello, NumberedOrder, ViewerEvent, WantedFilter, WireError};
use tokio::sync::mpsc;
use tokio::time::{Instant, sleep_until};
use tokio_util::sync::CancellationToken;
use tonic::{Status, Streaming};

use super::outbound::Sender;
use super::roster::{Entry, Roster};
use super::{FILTER_INTERVAL, HELLO_TIMEOUT, SHUTTING_DOWN};
use crate::hub::Subscription;
use crate::steering::{Envelope, Steering};

/// Waits for the hello, which must come first and soon.
pub(super) async fn handshake(inbound: &mut Streaming<ViewerMessage>) -> Result<Hello, Status> {
    let first = tokio::time::timeout(HELLO_TIMEOUT, inbound.message()).await;
    let Ok(first) = first else {
        let seconds = HELLO_TIMEOUT.as_secs();
        let message = format!("the viewer did not say hello within {seconds} seconds");
        return Err(Status::deadline_exceeded(message));
    };
    let message = first.map_err(|status| unreadable(&status))?;
    let message = message.ok_or_else(|| Status::invalid_argument("the viewer sent nothing"))?;
    match ViewerEvent::try_from(message).map_err(|error| refusal(&error))? {
        ViewerEvent::Hello(hello) => Ok(hello),
        ViewerEvent::SetBudget(_)
        | ViewerEvent::SetFilter(_)
        | ViewerEvent::SetFocus(_)
        | ViewerEvent::Order(_)
        | ViewerEvent::Appearance(_)
        | ViewerEvent::Inspect(_)
        | ViewerEvent::Goodbye(_)
        | ViewerEvent::Unknown => {
            Err(Status::invalid_argument("the first message must be `hello`"))
        }
    }
}

/// Refuses a viewer whose hello asks for a filter that makes no sense.
pub(super) fn check_filter(hello: &Hello, scene: &FilterScene) -> Result<(), Status> {
    let Some(WantedFilter { filter, .. }) = &hello.filter else { return Ok(()) };
    understand(filter, scene).map(drop).map_err(|error| {
        Status::invalid_argument(format!("the filter:\n{}", error.pointed(filter.text())))
    })
}

fn understand(filter: &FilterText, scene: &FilterScene) -> Result<CompiledFilter, FilterError> {
    filter.tree().map_err(Clone::clone)?.compile(scene)
}

/// The status that a malformed message is answered with.
fn refusal(error: &WireError) -> Status {
    match error {
        WireError::Version { .. } => Status::failed_precondition(error.to_string()),
        WireError::Missing(_)
        | WireError::TooLong { .. }
        | WireError::OutOfRange { .. }
        | WireError::OutOfBounds { .. }
        | WireError::BadNumber { .. }
        | WireError::ColumnLength { .. }
        | WireError::Batch(_)
        | WireError::Camera(_)
        | WireError::Scene(_) => Status::invalid_argument(error.to_string()),
    }
}

/// The status for bytes that are no message at all.
fn unreadable(status: &Status) -> Status {
    Status::invalid_argument(format!("unreadable message: {}", status.message()))
}

/// How a session ends.
#[derive(Debug)]
enum End {
    /// The viewer is gone, or about to go.
    Left(String),
    /// The daemon ends it.
    Dismissed(String),
    /// The viewer broke the protocol.
    Refused(Status),
}

/// What a viewer's message asks for.
#[derive(Debug)]
enum Heard {
    /// Nothing that ends the session.
    Fine,
    /// Something that was done, but is too much work to be asked for without end.
    Work,
    /// It will say no more, but may go on reading.
    Silent,
    /// The session is over.
    Over(End),
}

/// What all sessions share.
#[derive(Debug)]
pub(super) struct SharedState {
    /// What filters may name.
    pub(super) filter_scene: Arc<FilterScene>,
    /// Where orders go.
    pub(super) steering: Steering,
    /// Who is there.
    pub(super) roster: Roster,
}

/// One viewer's conversation; ending it leaves the roster.
#[derive(Debug)]
pub(super) struct Session {
    hello: Hello,
    subscription: Subscription,
    shared: Arc<SharedState>,
}

impl Drop for Session {
    fn drop(&mut self) {
        self.shared.roster.leave(self.number());
    }
}

impl Session {
    /// The session of a viewer that said hello and may become at most `allowed`; what it asked for, or
    /// comes back to, is in force.
    pub(super) fn enter(
        hello: Hello,
        subscription: Subscription,
        shared: Arc<SharedState>,
        allowed: Role,
    ) -> (Self, Entry) {
        let entry = shared.roster.enter(subscription.session(), &hello, allowed);
        let session = Self { hello, subscription, shared };
        if let Some(filter) = session.hello.filter.clone().or_else(|| entry.filter.clone()) {
            session.set_filter(filter);
        }
        if entry.focus {
            session.set_focus(true);
        }
        (session, entry)
    }

    /// Its number.
    pub(super) fn number(&self) -> u64 {
        self.subscription.session()
    }

    /// Talks to the viewer until one of them leaves.
    pub(super) async fn run(
        self,
        welcome: Welcome,
        inbound: Streaming<ViewerMessage>,
        sender: Sender,
        shutdown: CancellationToken,
    ) {
        let (session, viewer) = (self.number(), self.hello.viewer_name.clone());
        tracing::info!(session, viewer, "a viewer connected");
        let Sender { messages, last } = sender;
        let end = tokio::select! {
            biased;
            () = shutdown.cancelled() => End::Dismissed(SHUTTING_DOWN.to_owned()),
            end = self.converse(welcome, inbound, &messages) => end,
        };
        drop(messages);
        let word = match end {
            End::Left(reason) => {
                tracing::info!(session, viewer, reason, "a viewer left");
                return;
            }
            End::Dismissed(reason) => {
                tracing::info!(session, viewer, reason, "a viewer was disconnected");
                Ok(TracerMessage::from(&TracerEvent::Goodbye(reason)))
            }
            End::Refused(status) => {
                tracing::warn!(session, viewer, reason = status.message(), "a viewer was rejected");
                Err(status)
            }
        };
        if last.send(word).is_err() {
            tracing::debug!(session, "the viewer did not wait for the last message");
        }
    }

    async fn converse(
        &self,
        welcome: Welcome,
        mut inbound: Streaming<ViewerMessage>,
        messages: &mpsc::Sender<TracerMessage>,
    ) -> End {
        let welcome = TracerMessage::from(&TracerEvent::Welcome(Box::new(welcome)));
        // The channel is empty: this does not wait.
        if messages.send(welcome).await.is_err() {
            return End::Left("it closed the connection".to_owned());
        }
        let mut listens = true;
        let mut listens_from = Instant::now();
        loop {
            let next_message = async {
                sleep_until(listens_from).await;
                inbound.message().await
            };
            tokio::select! {
                biased;
                () = messages.closed() => return End::Left("it closed the connection".to_owned()),
                reason = self.subscription.closed() => return End::Dismissed(reason),
                message = next_message, if listens => match self.hear(message) {
                    Heard::Fine => {}
                    Heard::Work => listens_from = Instant::now() + FILTER_INTERVAL,
                    Heard::Silent => listens = false,
                    Heard::Over(end) => return end,
                },
                end = self.speak(messages) => if let Some(end) = end { return end },
            }
        }
    }

    fn hear(&self, message: Result<Option<ViewerMessage>, Status>) -> Heard {
        let event = match message {
            Ok(Some(message)) => ViewerEvent::try_from(message).map_err(|error| refusal(&error)),
            Ok(None) => return Heard::Silent,
            // Bytes that are no message have no cause further down; a transport that breaks has one.
            Err(status) if status.source().is_some() => {
                return Heard::Over(End::Left("its connection broke".to_owned()));
            }
            Err(status) => Err(unreadable(&status)),
        };
        match event {
            Ok(ViewerEvent::SetBudget(budget)) => {
                self.subscription.set_budget(budget);
                Heard::Fine
            }
            Ok(ViewerEvent::SetFilter(wanted)) => {
                self.set_filter(wanted);
                Heard::Work
            }
            Ok(ViewerEvent::SetFocus(on)) => {
                self.set_focus(on);
                Heard::Work
            }
            Ok(ViewerEvent::Order(order)) => {
                self.order(order);
                Heard::Work
            }
            Ok(ViewerEvent::Appearance(appearance)) => {
                self.shared.roster.show(self.number(), appearance);
                Heard::Work
            }
            Ok(ViewerEvent::Inspect(path)) => {
                self.inspect(path);
                Heard::Work
            }
            Ok(ViewerEvent::Unknown) => Heard::Fine,
            Ok(ViewerEvent::Goodbye(reason)) => {
                let reason = reason.chars().filter(|c| !c.is_control()).collect();
                Heard::Over(End::Left(reason))
            }
            Ok(ViewerEvent::Hello(_)) => {
                let status = Status::invalid_argument("`hello` may only be sent once");
                Heard::Over(End::Refused(status))
            }
            Err(status) => Heard::Over(End::Refused(status)),
        }
    }

    fn set_focus(&self, on: bool) {
        self.shared.roster.keep_focus(self.number(), on);
        self.subscription.set_focus(on);
        self.shared.steering.wake_explorer();
    }

    /// Hands an order on. Those who carry it out reply; where it does not get that far, this does.
    fn order(&self, NumberedOrder { request, order }: NumberedOrder) {
        let done = match order {
            Some(Order::Lease(wish)) => {
                let reply = self.shared.roster.lease(self.number(), wish);
                self.reply(request, reply.err());
                return;
            }
            Some(order) => self.hand_on(request, order),
            None => {
                Err("this daemon does not know that order; it may be older than the viewer"
                    .to_owned())
            }
        };
        if let Err(error) = done {
            self.reply(request, Some(error));
        }
    }

    fn hand_on(&self, request: u32, order: Order) -> Result<(), String> {
        let author = self.shared.roster.driver(self.number())?;
        let steering = &self.shared.steering;
        let handed = match order {
            Order::Explorer(command) => steering.explore(Envelope { author, request, command }),
            Order::Chains(command) => steering.change(Envelope { author, request, command }),
            Order::Lease(_) => Ok(()),
        };
        handed.map_err(|error| error.to_string())
    }

    /// Asks for the numbers behind a path. Where the question does not get through, this answers.
    fn inspect(&self, path: PathId) {
        if let Err(error) = self.shared.steering.inspect(self.number(), path) {
            let found = Err(error.to_string());
            self.subscription.notice(Notice::Detail(Box::new(DetailReply { path, found })));
        }
    }

    fn reply(&self, request: u32, error: Option<String>) {
        self.subscription.notice(Notice::Reply(OrderReply { request, error }));
    }

    fn set_filter(&self, wanted: WantedFilter) {
        let revision = wanted.revision;
        match understand(&wanted.filter, &self.shared.filter_scene) {
            Ok(filter) => {
                self.shared.roster.keep_filter(self.number(), wanted);
                self.subscription.set_filter(revision, Arc::new(filter));
            }
            Err(error) => {
                let error = Some(error);
                self.subscription.reply(FilterReply { revision, error, ..FilterReply::default() });
            }
        }
    }

    /// Sends what is next, once there is room for it: only then it leaves the hub, which until then
    /// may still replace it by something newer.
    async fn speak(&self, messages: &mpsc::Sender<TracerMessage>) -> Option<End> {
        let Ok(room) = messages.reserve().await else {
            return Some(End::Left("it closed the connection".to_owned()));
        };
        let event = self.subscription.next().await;
        if let TracerEvent::Goodbye(reason) = event {
            return Some(End::Dismissed(reason));
        }
        room.send(TracerMessage::from(&event));
        None
    }
}
