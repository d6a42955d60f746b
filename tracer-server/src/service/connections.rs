//! Connections, bounded in number: each one costs memory before it has said a word.

use std::io::{self, ErrorKind};
use std::net::SocketAddr;
use std::pin::Pin;
use std::sync::Arc;
use std::task::{Context, Poll, ready};
use std::time::Duration;

use tokio::io::{AsyncRead, AsyncWrite, ReadBuf};
use tokio::net::{TcpListener, TcpStream};
use tokio::sync::{OwnedSemaphorePermit, Semaphore};
use tokio::time::{Instant, Sleep, sleep};
use tokio_stream::Stream;
use tonic::transport::server::{Connected, TcpConnectInfo, TlsConnectInfo};
use tonic::{Extensions, Status};

/// Connections at a time: viewers, tools and those that are rejected.
pub(super) const MAX_CONNECTIONS: usize = 128;
/// Connections beyond the limit that are still told that the daemon is full; any others are just closed.
const MAX_SURPLUS: usize = 16;
/// How long a peer that is to be told that the daemon is full may take to ask.
const SURPLUS_TIME: Duration = Duration::from_secs(5);
/// How long to wait for what the system lacks.
const SHORTAGE: Duration = Duration::from_millis(100);
/// Minimum time between two such warnings.
const QUIET: Duration = Duration::from_mins(1);

/// What requests know of the connection that they came by.
#[derive(Clone, Debug)]
pub(super) struct Caller {
    tcp: TcpConnectInfo,
    is_surplus: bool,
}

impl Caller {
    /// Who made the request with these `extensions`, encrypted or not.
    pub(super) fn of(extensions: &Extensions) -> Option<&Self> {
        let encrypted = || extensions.get::<TlsConnectInfo<Self>>().map(TlsConnectInfo::get_ref);
        extensions.get::<Self>().or_else(encrypted)
    }

    /// Their address.
    pub(super) fn address(&self) -> Option<SocketAddr> {
        self.tcp.remote_addr()
    }

    /// Refuses those for whom there is no room.
    pub(super) fn check(&self) -> Result<(), Status> {
        if !self.is_surplus {
            return Ok(());
        }
        Err(Status::resource_exhausted(format!(
            "it is full: it accepts {MAX_CONNECTIONS} connections at a time; try again when \
            someone has left"
        )))
    }
}

/// An accepted connection, which keeps its place until it is dropped.
#[derive(Debug)]
pub(super) struct Connection {
    stream: TcpStream,
    /// The end of a connection for which there is no room.
    ends: Option<Pin<Box<Sleep>>>,
    _place: OwnedSemaphorePermit,
}

/// The connections that `listener` accepts, for as long as there are places.
pub(super) fn accept(listener: TcpListener) -> Incoming {
    Incoming {
        listener,
        places: Arc::new(Semaphore::new(MAX_CONNECTIONS)),
        surplus: Arc::new(Semaphore::new(MAX_SURPLUS)),
        shortage: None,
        told: None,
    }
}

/// See [`accept`].
#[derive(Debug)]
pub(super) struct Incoming {
    listener: TcpListener,
    places: Arc<Semaphore>,
    surplus: Arc<Semaphore>,
    /// The end of a wait for what the system lacks.
    shortage: Option<Pin<Box<Sleep>>>,
    /// When that was last told.
    told: Option<Instant>,
}

impl Incoming {
    /// Finds a place for a connection; `None` closes it.
    fn admit(&self, stream: TcpStream) -> Option<Connection> {
        if let Err(error) = stream.set_nodelay(true) {
            tracing::debug!("a connection broke immediately: {error}");
            return None;
        }
        if let Ok(place) = Arc::clone(&self.places).try_acquire_owned() {
            return Some(Connection { stream, ends: None, _place: place });
        }
        let place = Arc::clone(&self.surplus).try_acquire_owned().ok();
        let fate = if place.is_some() { "told that the daemon is full" } else { "closed" };
        tracing::warn!(limit = MAX_CONNECTIONS, "a connection beyond the limit was {fate}");
        place.map(|place| {
            let ends = Some(Box::pin(sleep(SURPLUS_TIME)));
            Connection { stream, ends, _place: place }
        })
    }

    /// Waits where the system lacks something, most likely file handles; says so once.
    fn pause(&mut self, error: &io::Error) {
        if self.told.is_none_or(|told| told.elapsed() > QUIET) {
            self.told = Some(Instant::now());
            tracing::warn!(
                "no connection can be accepted: {error}; waiting until the system has resources \
                again (is `ulimit -n` too low?)"
            );
        }
        self.shortage = Some(Box::pin(sleep(SHORTAGE)));
    }
}

impl Stream for Incoming {
    type Item = io::Result<Connection>;

    fn poll_next(mut self: Pin<&mut Self>, cx: &mut Context<'_>) -> Poll<Option<Self::Item>> {
        loop {
            if let Some(shortage) = &mut self.shortage {
                ready!(shortage.as_mut().poll(cx));
                self.shortage = None;
            }
            match ready!(self.listener.poll_accept(cx)) {
                Ok((stream, _)) => {
                    if let Some(connection) = self.admit(stream) {
                        return Poll::Ready(Some(Ok(connection)));
                    }
                }
                Err(error) if is_peers(&error) => {
                    tracing::debug!("a connection broke before it was accepted: {error}");
                }
                Err(error) => self.pause(&error),
            }
        }
    }
}

/// True where it is the peer who has hung up.
fn is_peers(error: &io::Error) -> bool {
    use ErrorKind::{ConnectionAborted, ConnectionRefused, ConnectionReset, Interrupted, TimedOut};
    matches!(
        error.kind(),
        ConnectionAborted | ConnectionRefused | ConnectionReset | Interrupted | TimedOut
    )
}

impl Connected for Connection {
    type ConnectInfo = Caller;

    fn connect_info(&self) -> Caller {
        Caller { tcp: self.stream.connect_info(), is_surplus: self.ends.is_some() }
    }
}

impl AsyncRead for Connection {
    fn poll_read(
        mut self: Pin<&mut Self>,
        cx: &mut Context<'_>,
        buffer: &mut ReadBuf<'_>,
    ) -> Poll<io::Result<()>> {
        if self.ends.as_mut().is_some_and(|ends| ends.as_mut().poll(cx).is_ready()) {
            // Nothing more to read: the connection is over.
            return Poll::Ready(Ok(()));
        }
        Pin::new(&mut self.stream).poll_read(cx, buffer)
    }
}

impl AsyncWrite for Connection {
    fn poll_write(
        mut self: Pin<&mut Self>,
        cx: &mut Context<'_>,
        bytes: &[u8],
    ) -> Poll<io::Result<usize>> {
        Pin::new(&mut self.stream).poll_write(cx, bytes)
    }

    fn poll_write_vectored(
        mut self: Pin<&mut Self>,
        cx: &mut Context<'_>,
        slices: &[io::IoSlice<'_>],
    ) -> Poll<io::Result<usize>> {
        Pin::new(&mut self.stream).poll_write_vectored(cx, slices)
    }

    fn is_write_vectored(&self) -> bool {
        self.stream.is_write_vectored()
    }

    fn poll_flush(mut self: Pin<&mut Self>, cx: &mut Context<'_>) -> Poll<io::Result<()>> {
        Pin::new(&mut self.stream).poll_flush(cx)
    }

    fn poll_shutdown(mut self: Pin<&mut Self>, cx: &mut Context<'_>) -> Poll<io::Result<()>> {
        Pin::new(&mut self.stream).poll_shutdown(cx)
    }
}
