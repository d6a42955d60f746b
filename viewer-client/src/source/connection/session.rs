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
use tonic::service::interceptor::InterceptedService;
use tonic::transport::{Channel, Endpoint};
use tonic::{Code, Status, Streaming};

use super::peer::{Bearer, Peer};
use super::tls;

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
/// Longest name of a viewer, in bytes.
const MAX_NAME: usize = 256;
/// Messages from this viewer that may wait to be sent.
const OUTBOX: usize = 32;

/// Why a session could not begin or came to an end.
#[derive(Debug, Error)]
pub enum SessionError {
    /// The address is none.
    #[error("`{0}` is not an address; write HOST:PORT, such as 127.0.0.1:50061")]
    BadAddress(String),
    /// The certificate is not the right one, or there is no TLS.
    #[error("no trusted connection to {address}: {reason}")]
    Untrusted {
        /// HOST:PORT.
        address: String,
        /// What is wrong.
        reason: String,
    },
    /// A token must not be seen by others.
    #[error(
        "{0} is another machine, and the token would travel unencrypted: trust the daemon's \
         certificate with --fingerprint or --ca-cert"
    )]
    ExposedToken(String),
    /// Something listens, but does not speak as expected.
    #[error(
        "{0} broke off the greeting: if the daemon encrypts, trust its certificate with \
         --fingerprint or --ca-cert"
    )]
    NoGreeting(String),
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

/// A client that shows its token.
type Client = TracerClient<InterceptedService<Channel, Bearer>>;

/// How a viewer introduces itself.
#[derive(Clone, Debug, Default)]
pub struct Greeting {
    /// A name that the others see.
    pub name: String,
    /// The role that it would like.
    pub role: Role,
    /// With one, only paths that it wants come.
    pub filter: Option<WantedFilter>,
    /// Every step of the explorer is wanted.
    pub focus: bool,
    /// What the welcome of a session gave that was lost; blank for none.
    pub resume: String,
}

/// The name that others see: what the variable `LVIS_NAME` says, or else `usual`.
pub fn own_name(usual: &str) -> String {
    let named = std::env::var("LVIS_NAME").ok().filter(|name| !name.trim().is_empty());
    let name = named.unwrap_or_else(|| usual.to_owned());
    name[..name.floor_char_boundary(MAX_NAME)].to_owned()
}

/// An open session.
#[derive(Debug)]
pub struct Session {
    client: Client,
    incoming: Streaming<v1::TracerMessage>,
    outgoing: mpsc::Sender<v1::ViewerMessage>,
}

impl Session {
    /// Connects to `peer` and says hello.
    pub async fn open(peer: &Peer, greeting: Greeting) -> Result<Self, SessionError> {
        if peer.exposes_token() {
            return Err(SessionError::ExposedToken(peer.address.clone()));
        }
        let tune = |endpoint: Endpoint| {
            endpoint
                .connect_timeout(CONNECT_TIMEOUT)
                .initial_stream_window_size(WINDOW_BYTES)
                .initial_connection_window_size(WINDOW_BYTES)
                .http2_keep_alive_interval(PING_INTERVAL)
                .keep_alive_timeout(PING_TIMEOUT)
        };
        let channel = tls::connect(peer, tune).await?;
        let mut client = TracerClient::with_interceptor(channel, peer.token.clone())
            .max_decoding_message_size(MAX_MESSAGE_BYTES);

        let (outgoing, outbox) = mpsc::channel(OUTBOX);
        let hello = ViewerEvent::Hello(Hello {
            version: ProtocolVersion::CURRENT,
            viewer_name: greeting.name,
            wanted_role: greeting.role,
            data_budget: 0,
            filter: greeting.filter,
            focus: greeting.focus,
            resume: greeting.resume,
        });
        // The outbox is empty and its other end is held here.
        let sent = outgoing.try_send(hello.into());
        debug_assert!(sent.is_ok(), "an empty outbox has room");
        let answer = client.watch(ReceiverStream::new(outbox)).await;
        let incoming = answer.map_err(|status| match status.code() {
            // What a peer that speaks TLS, or anything but gRPC, makes of a greeting.
            Code::Internal | Code::Unavailable | Code::Cancelled | Code::Unknown => {
                SessionError::NoGreeting(peer.address.clone())
            }
            _ => SessionError::from(status),
        })?;
        let incoming = incoming.into_inner();
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

    /// Says something. False where too much waits to be sent; the daemon then does not read.
    pub fn say(&self, event: ViewerEvent) -> bool {
        self.outgoing.try_send(event.into()).is_ok()
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
    client: Client,
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
