//! One session with a daemon, from the connection to the last message.

use std::time::Duration;

use common::Role;
use proto::v1::tracer_client::TracerClient;
use proto::{
    Hello, MAX_MESSAGE_BYTES, ProtocolVersion, ReceivedScene, SceneAssembler, TracerEvent,
    ViewerEvent, WantedFilter, WireError, v1,
};
use thiserror::Error;
use tokio::sync::mpsc;
use tokio_stream::wrappers::ReceiverStream;
use tonic::transport::{Channel, Endpoint};
use tonic::{Code, Status, Streaming};

/// Window of a stream and of a connection; a small one holds back batches of 64 KiB.
const WINDOW_BYTES: u32 = 4 << 20;
/// A daemon that takes longer to answer is not there.
const CONNECT_TIMEOUT: Duration = Duration::from_secs(5);
/// A silent daemon is asked this often whether it lives.
const PING_INTERVAL: Duration = Duration::from_secs(10);
/// And given up after this long without an answer.
const PING_TIMEOUT: Duration = Duration::from_secs(10);
/// How long to wait for the daemon to end the stream after a goodbye.
const FAREWELL: Duration = Duration::from_millis(300);
/// Messages from this viewer that may wait to be sent.
const OUTBOX: usize = 8;

/// Why a session could not begin or came to an end.
#[derive(Debug, Error)]
pub enum SessionError {
    /// The address is none.
    #[error("`{0}` is not an address; write HOST:PORT, such as 127.0.0.1:50061")]
    BadAddress(String),
    /// Nobody listens.
    #[error("no daemon answers at {0}")]
    Unreachable(String),
    /// The daemon refused or broke off.
    #[error("{0}")]
    Refused(String),
    /// The daemon said goodbye.
    #[error("the daemon said goodbye: {0}")]
    Goodbye(String),
    /// The stream ended without a goodbye.
    #[error("the connection was lost")]
    Lost,
    /// A message that makes no sense.
    #[error("the daemon sent something unreadable: {0}")]
    Unreadable(#[from] WireError),
}

impl From<Status> for SessionError {
    fn from(status: Status) -> Self {
        match status.code() {
            Code::Unavailable | Code::Cancelled | Code::Unknown => Self::Lost,
            _ => Self::Refused(format!("the daemon refused: {}", status.message())),
        }
    }
}

/// An open session.
#[derive(Debug)]
pub struct Session {
    client: TracerClient<Channel>,
    incoming: Streaming<v1::TracerMessage>,
    outgoing: mpsc::Sender<v1::ViewerMessage>,
}

impl Session {
    /// Connects to `address` (HOST:PORT) and says hello. With a `filter`, only paths that it wants
    /// come.
    pub async fn open(
        address: &str,
        viewer_name: &str,
        filter: Option<WantedFilter>,
    ) -> Result<Self, SessionError> {
        let bad = |_| SessionError::BadAddress(address.to_owned());
        let endpoint = Endpoint::from_shared(format!("http://{address}"))
            .map_err(bad)?
            .connect_timeout(CONNECT_TIMEOUT)
            .initial_stream_window_size(WINDOW_BYTES)
            .initial_connection_window_size(WINDOW_BYTES)
            .http2_keep_alive_interval(PING_INTERVAL)
            .keep_alive_timeout(PING_TIMEOUT);
        let unreachable = |_| SessionError::Unreachable(address.to_owned());
        let channel = endpoint.connect().await.map_err(unreachable)?;
        let mut client = TracerClient::new(channel).max_decoding_message_size(MAX_MESSAGE_BYTES);

        let (outgoing, outbox) = mpsc::channel(OUTBOX);
        let hello = ViewerEvent::Hello(Hello {
            version: ProtocolVersion::CURRENT,
            viewer_name: viewer_name.to_owned(),
            wanted_role: Role::Observer,
            data_budget: 0,
            filter,
        });
        // The outbox is empty and its other end is held here.
        let sent = outgoing.try_send(hello.into());
        debug_assert!(sent.is_ok(), "an empty outbox has room");
        let incoming = client.watch(ReceiverStream::new(outbox)).await?.into_inner();
        Ok(Self { client, incoming, outgoing })
    }

    /// The next thing the tracer says. Safe to drop while waiting.
    pub async fn next(&mut self) -> Result<TracerEvent, SessionError> {
        let message = self.incoming.message().await?.ok_or(SessionError::Lost)?;
        match TracerEvent::try_from(message)? {
            TracerEvent::Goodbye(reason) => Err(SessionError::Goodbye(reason)),
            event => Ok(event),
        }
    }

    /// A handle to fetch the scene with, while the session goes on.
    pub fn scene_fetcher(&self) -> SceneFetcher {
        SceneFetcher { client: self.client.clone() }
    }

    /// Tells the tracer that this viewer leaves, and gives it a moment to hear it.
    pub async fn leave(mut self) {
        let goodbye = ViewerEvent::Goodbye("the viewer was closed".to_owned());
        if self.outgoing.send(goodbye.into()).await.is_err() {
            return;
        }
        drop(self.outgoing);
        let ended = async { while let Ok(Some(_)) = self.incoming.message().await {} };
        if tokio::time::timeout(FAREWELL, ended).await.is_err() {
            tracing::debug!("the daemon did not answer the goodbye");
        }
    }
}

/// Fetches the scene beside a running session.
#[derive(Debug)]
pub struct SceneFetcher {
    client: TracerClient<Channel>,
}

impl SceneFetcher {
    /// The scene, or `None` where the one called `known_hash` is still the current one.
    pub async fn fetch(
        mut self,
        known_hash: String,
    ) -> Result<Option<ReceivedScene>, SessionError> {
        let mut chunks = self.client.get_scene(v1::SceneRequest { known_hash }).await?.into_inner();
        let mut assembler = SceneAssembler::default();
        while let Some(chunk) = chunks.message().await? {
            assembler.push(chunk)?;
        }
        Ok(assembler.finish()?)
    }
}
