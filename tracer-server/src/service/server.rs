//! The service on a thread of its own.

use std::io;
use std::net::SocketAddr;
use std::sync::Arc;
use std::thread::JoinHandle;
use std::time::Duration;

use thiserror::Error;
use tokio::net::TcpListener;
use tokio::runtime::Runtime;
use tokio_util::sync::CancellationToken;

use super::{Backend, Security, SessionInfo, serve};
use crate::hub::{Hub, HubLimits};
use crate::steering::Steering;

/// Threads of the runtime; the cores belong to the chains.
const RUNTIME_THREADS: usize = 2;
/// How long connections may take to end after the service has.
const RUNTIME_GRACE: Duration = Duration::from_millis(500);

/// Why a server does not start.
#[derive(Debug, Error)]
pub enum StartError {
    /// The address is taken, or not ours.
    #[error("cannot listen on {address}: {source}")]
    Listen {
        /// The address.
        address: SocketAddr,
        /// What the system says.
        source: io::Error,
    },
    /// The system gives no thread or no event queue.
    #[error("cannot start the network threads: {0}")]
    Threads(#[source] io::Error),
}

/// A running service; dropping it stops it.
#[derive(Debug)]
pub struct Server {
    address: SocketAddr,
    hub: Hub,
    shutdown: CancellationToken,
    ended: CancellationToken,
    thread: Option<JoinHandle<()>>,
}

impl Server {
    /// Listens on `address` (port 0 for any that is free), serves viewers what the hub gets, and hands
    /// on what the driver orders.
    /// May be called from a program that has a runtime of its own.
    pub fn start(
        address: SocketAddr,
        info: SessionInfo,
        limits: HubLimits,
        steering: Steering,
        security: Security,
    ) -> Result<Self, StartError> {
        let listen = |source| StartError::Listen { address, source };
        let listener = std::net::TcpListener::bind(address).map_err(listen)?;
        listener.set_nonblocking(true).map_err(listen)?;
        let bound = listener.local_addr().map_err(listen)?;
        let runtime = tokio::runtime::Builder::new_multi_thread()
            .worker_threads(RUNTIME_THREADS)
            .thread_name("lvis-network")
            .enable_all()
            .build()
            .map_err(StartError::Threads)?;
        let listener = {
            let _context = runtime.enter();
            TcpListener::from_std(listener).map_err(listen)?
        };

        let (hub, pump) = Hub::new(limits);
        let (shutdown, ended) = (CancellationToken::new(), CancellationToken::new());
        let (info, shown) = (Arc::new(info), hub.clone());
        let backend = Backend { hub: shown, pump, info, steering, security };
        let service = serve(listener, backend, shutdown.clone());
        let ends = ended.clone().drop_guard();
        let run = move || {
            let _ends = ends;
            run(runtime, service);
        };
        let thread = std::thread::Builder::new()
            .name("lvis-server".to_owned())
            .spawn(run)
            .map_err(StartError::Threads)?;
        Ok(Self { address: bound, hub, shutdown, ended, thread: Some(thread) })
    }

    /// The address that it listens on.
    pub fn address(&self) -> SocketAddr {
        self.address
    }

    /// Where producers publish.
    pub fn hub(&self) -> &Hub {
        &self.hub
    }

    /// Cancelled when the service has ended, for whatever reason.
    pub fn ended(&self) -> &CancellationToken {
        &self.ended
    }

    /// Tells every viewer goodbye, and waits until everything has ended.
    pub fn stop(mut self) {
        self.join();
    }

    fn join(&mut self) {
        self.shutdown.cancel();
        if let Some(thread) = self.thread.take()
            && thread.join().is_err()
        {
            tracing::error!("the network thread panicked");
        }
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        self.join();
    }
}

fn run(runtime: Runtime, service: impl Future<Output = Result<(), super::ServeError>>) {
    if let Err(error) = runtime.block_on(service) {
        let error: &dyn std::error::Error = &error;
        tracing::error!(error, "the network service failed");
    }
    // What is left are connections of peers that do not read.
    runtime.shutdown_timeout(RUNTIME_GRACE);
}
