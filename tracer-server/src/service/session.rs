//! One viewer, from hello to goodbye.

use std::sync::Arc;

use common::{CompiledFilter, Filter, FilterError, FilterReply, FilterScene, Welcome};
use proto::v1::{self, TracerMessage, ViewerMessage, tracer_message::Kind};
use proto::{Hello, TracerEvent, ViewerEvent, WantedFilter, WireError};
use tokio::sync::mpsc;
use tokio::time::{Instant, sleep_until};
use tokio_util::sync::CancellationToken;
use tonic::{Status, Streaming};

use super::outbound::Sender;
use super::{FILTER_INTERVAL, HELLO_TIMEOUT, SHUTTING_DOWN};
use crate::hub::{Delivery, Subscription};

/// Waits for the hello, which must come first and soon.
pub(super) async fn handshake(inbound: &mut Streaming<ViewerMessage>) -> Result<Hello, Status> {
    let first = tokio::time::timeout(HELLO_TIMEOUT, inbound.message()).await;
    let Ok(first) = first else {
        let seconds = HELLO_TIMEOUT.as_secs();
        let message = format!("the viewer did not say hello within {seconds} seconds");
        return Err(Status::deadline_exceeded(message));
    };
    let message = first.map_err(|status| unreadable(&status))?;
    let message = message.ok_or_else(|| Status::invalid_argument("the viewer said nothing"))?;
    match ViewerEvent::try_from(message).map_err(|error| refusal(&error))? {
        ViewerEvent::Hello(hello) => Ok(hello),
        _ => Err(Status::invalid_argument("the first message must be `hello`")),
    }
}

/// The filter that a viewer asks for in its hello, with its number.
pub(super) fn first_filter(
    hello: &Hello,
    scene: &FilterScene,
) -> Result<Option<(u32, Arc<CompiledFilter>)>, Status> {
    let Some(WantedFilter { revision, text }) = &hello.filter else { return Ok(None) };
    match understand(text, scene) {
        Ok(filter) => Ok(Some((*revision, Arc::new(filter)))),
        Err(error) => {
            Err(Status::invalid_argument(format!("the filter:\n{}", error.pointed(text))))
        }
    }
}

fn understand(text: &str, scene: &FilterScene) -> Result<CompiledFilter, FilterError> {
    Filter::parse(text)?.compile(scene)
}

/// The status that a malformed message is answered with.
fn refusal(error: &WireError) -> Status {
    match error {
        WireError::Version { .. } => Status::failed_precondition(error.to_string()),
        _ => Status::invalid_argument(error.to_string()),
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

/// One viewer's conversation.
#[derive(Debug)]
pub(super) struct Session {
    hello: Hello,
    subscription: Subscription,
    filter_scene: Arc<FilterScene>,
    shutdown: CancellationToken,
}

impl Session {
    /// The session of a viewer that said hello.
    pub(super) fn new(
        hello: Hello,
        subscription: Subscription,
        filter_scene: Arc<FilterScene>,
        shutdown: CancellationToken,
    ) -> Self {
        Self { hello, subscription, filter_scene, shutdown }
    }

    /// Talks to the viewer until one of them leaves.
    pub(super) async fn run(
        self,
        welcome: Welcome,
        inbound: Streaming<ViewerMessage>,
        sender: Sender,
    ) {
        let (session, viewer) = (self.subscription.session(), self.hello.viewer_name.clone());
        tracing::info!(session, viewer, "a viewer came");
        let Sender { messages, last } = sender;
        let end = self.converse(welcome, inbound, &messages).await;
        drop(messages);
        let word = match end {
            End::Left(reason) => {
                tracing::info!(session, viewer, reason, "a viewer left");
                return;
            }
            End::Dismissed(reason) => {
                tracing::info!(session, viewer, reason, "a viewer was dismissed");
                Ok(TracerMessage::from(&TracerEvent::Goodbye(reason)))
            }
            End::Refused(status) => {
                tracing::warn!(session, viewer, reason = status.message(), "a viewer was refused");
                Err(status)
            }
        };
        if last.send(word).is_err() {
            tracing::debug!(session, "the viewer did not wait for the last word");
        }
    }

    async fn converse(
        &self,
        welcome: Welcome,
        mut inbound: Streaming<ViewerMessage>,
        messages: &mpsc::Sender<TracerMessage>,
    ) -> End {
        let welcome = TracerMessage::from(&TracerEvent::Welcome(welcome));
        // The channel is empty: this does not wait.
        if messages.send(welcome).await.is_err() {
            return End::Left("it hung up".to_owned());
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
                () = self.shutdown.cancelled() => return End::Dismissed(SHUTTING_DOWN.to_owned()),
                () = messages.closed() => return End::Left("it hung up".to_owned()),
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
            Ok(ViewerEvent::Unknown) => Heard::Fine,
            Ok(ViewerEvent::Goodbye(reason)) => {
                let reason = reason.chars().filter(|c| !c.is_control()).collect();
                Heard::Over(End::Left(reason))
            }
            Ok(ViewerEvent::Hello(_)) => {
                let status = Status::invalid_argument("`hello` comes once");
                Heard::Over(End::Refused(status))
            }
            Err(status) => Heard::Over(End::Refused(status)),
        }
    }

    fn set_filter(&self, wanted: WantedFilter) {
        let WantedFilter { revision, text } = wanted;
        match understand(&text, &self.filter_scene) {
            Ok(filter) => self.subscription.set_filter(revision, Arc::new(filter)),
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
            return Some(End::Left("it hung up".to_owned()));
        };
        let kind = match self.subscription.next().await {
            Delivery::Closed(reason) => return Some(End::Dismissed(reason)),
            Delivery::Paths(batch) => Kind::PathBatch((&*batch).into()),
            Delivery::Film(tile) => Kind::FilmTile((&tile).into()),
            Delivery::Statistics(statistics) => Kind::Statistics((&statistics).into()),
            Delivery::Gap(gap) => Kind::Gap(gap.into()),
            Delivery::FilterReply(reply) => Kind::FilterReply((&reply).into()),
            Delivery::SnapshotEnd => Kind::SnapshotEnd(v1::SnapshotEnd {}),
        };
        room.send(TracerMessage { kind: Some(kind) });
        None
    }
}
