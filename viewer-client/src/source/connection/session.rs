//! One session with a daemon, from the connection to the last message.

use std::time::Duration;

use common::{Role, TracerEvent};
use proto::v1::tracer_client::TracerClient;
use proto::{
    Hello, MAX_MESSAGE_BYTES, ProtocolVersion, ReceivedScene, SceneAssembler, ViewerEvent,
    WantedFilter, v1,
};
use tokio::sync::mpsc;
use tokio_stream::wrappers::ReceiverStream;
use tonic::service::interceptor::InterceptedService;
use tonic::transport::{Channel, Endpoint};
use tonic::{Code, Streaming};

use super::error::{HandshakeError, SessionError};
use super::peer::{Bearer, Peer, Trust};
use super::probe::{self, Found};
use super::tls;

/// Window of a stream and of a connection; a small one holds back batches of 64 KiB.
const WINDOW_BYTES: u32 = 4 << 20;
/// A daemon that takes longer to answer is not there.
const CONNECT_TIMEOUT: Duration = Duration::from_secs(5);
/// A daemon answers a hello within moments.
const GREETING_TIMEOUT: Duration = Duration::from_secs(10);
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
        let greeted = tokio::time::timeout(GREETING_TIMEOUT, Self::greet(peer, greeting));
        match greeted.await {
            Ok(Ok(session)) => Ok(session),
            Ok(Err(HandshakeError::Told(error))) => Err(error),
            Ok(Err(HandshakeError::Off)) | Err(_) => Err(explain(peer, None).await),
            Ok(Err(HandshakeError::Untrusted(reason))) => Err(explain(peer, Some(reason)).await),
        }
    }

    async fn greet(peer: &Peer, greeting: Greeting) -> Result<Self, HandshakeError> {
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
                HandshakeError::Off
            }
            Code::Unimplemented => HandshakeError::Told(SessionError::Unreachable(format!(
                "the server at {} is not a Lvis daemon; check the address and port",
                peer.address
            ))),
            _ => HandshakeError::Told(SessionError::from(status)),
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

/// Why the greeting of `peer` broke off, by what is found at its address; `reason` is what the
/// encryption says.
async fn explain(peer: &Peer, reason: Option<String>) -> SessionError {
    let address = peer.address.clone();
    let wants_encryption = peer.trust != Trust::Plain;
    let text = match (probe::identify(&address).await, reason) {
        (Found::Encrypted, Some(reason)) => {
            return SessionError::Untrusted { address, reason };
        }
        (Found::NoWay(error), _) => {
            format!("cannot reach {address}: {error}; check the name and the network")
        }
        (Found::Nobody, _) => format!(
            "nobody listens at {address}: start a daemon with `tracer-server serve --listen \
             {address}`, or check the port that it printed"
        ),
        (Found::Silence, _) => {
            format!(
                "nothing answers at {address}: is the machine running, and is a firewall in \
                the way?"
            )
        }
        (Found::Plain, _) if wants_encryption => format!(
            "the daemon at {address} does not use encryption: connect without --fingerprint and \
            --ca-cert, or have it started with --tls-self-signed"
        ),
        (Found::Encrypted, None) => format!(
            "the daemon at {address} uses encryption: give the fingerprint that it printed when \
            it started (--fingerprint), or its certificate (--ca-cert)"
        ),
        (Found::Plain, _) => {
            format!("the daemon at {address} aborted the handshake; its log says why")
        }
        (Found::Other(what), _) => {
            format!("the server at {address} is {what}, not a Lvis daemon; check the port")
        }
        (Found::Closed, _) => format!(
            "{address} closes the connection at once: the daemon may have too many connections, \
            or it is something else"
        ),
    };
    SessionError::Unreachable(text)
}

/// Fetches the scene while a session is running.
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
