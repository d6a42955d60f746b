//! The whole daemon: chains on their threads, the service on its own, and the hub between them.

use std::io;
use std::net::{Ipv4Addr, SocketAddr};
use std::sync::Arc;

use common::{Role, Welcome};
use thiserror::Error;
use tokio_util::sync::CancellationToken;

use crate::chain::{Archive, EnsembleSettings};
use crate::engine::Engine;
use crate::explorer::Explorer;
use crate::hub::HubLimits;
use crate::mutation::Mixture;
use crate::path::Failure;
use crate::scene::Scene;
use crate::service::{Security, Server, SessionInfo, StartError};
use crate::steering;

/// Where a daemon listens by default.
pub const DEFAULT_ADDRESS: SocketAddr =
    SocketAddr::new(std::net::IpAddr::V4(Ipv4Addr::LOCALHOST), 50061);

/// Kept of what was shown, by default: a minute or two of it.
const ARCHIVE_BYTES: usize = 64 << 20;

/// How a daemon runs.
#[derive(Clone, Debug)]
pub struct DaemonOptions {
    /// Where it listens; port 0 takes any that is free.
    pub listen: SocketAddr,
    /// Its chains.
    pub ensemble: EnsembleSettings,
    /// Bounds of its queues.
    pub limits: HubLimits,
    /// Bytes of what was shown lately that are kept, so that viewers can pick from it.
    pub archive_bytes: usize,
    /// Who may connect, and whether the connection is encrypted.
    pub security: Security,
}

impl Default for DaemonOptions {
    fn default() -> Self {
        Self {
            listen: DEFAULT_ADDRESS,
            ensemble: EnsembleSettings::default(),
            limits: HubLimits::default(),
            archive_bytes: ARCHIVE_BYTES,
            security: Security::default(),
        }
    }
}

/// Why a daemon does not start.
#[derive(Debug, Error)]
pub enum DaemonError {
    /// The service does not start.
    #[error(transparent)]
    Service(#[from] StartError),
    /// The system gives no thread.
    #[error("cannot start the thread of the chains, or that of the explorer")]
    Engine(#[source] io::Error),
}

/// A running daemon; dropping it stops it.
///
/// It may be embedded in any program: it owns its threads and its runtime. The service is stopped
/// before the engine, so that viewers hear of it at once.
#[derive(Debug)]
pub struct Daemon {
    server: Server,
    _explorer: Explorer,
    _engine: Engine,
}

impl Daemon {
    /// Starts the chains of `scene`, and shows them to the viewers that connect.
    pub fn start(scene: Arc<Scene>, options: &DaemonOptions) -> Result<Self, DaemonError> {
        let info = session_info(&scene, &options.ensemble);
        let (steering, orders) = steering::channel();
        let security = options.security.clone();
        let server =
            Server::start(options.listen, info, options.limits, steering.clone(), security)?;
        let (hub, archive) = (server.hub(), Arc::new(Archive::new(options.archive_bytes)));
        let explorer = Explorer::start(
            Arc::clone(&scene),
            options.ensemble.seed,
            Arc::clone(&archive),
            hub.clone(),
            steering,
            orders.explorer,
        )
        .map_err(DaemonError::Engine)?;
        let engine = Engine::start(scene, &options.ensemble, hub.clone(), archive, orders.chains)
            .map_err(DaemonError::Engine)?;
        Ok(Self { server, _explorer: explorer, _engine: engine })
    }

    /// The address that it listens on.
    pub fn address(&self) -> SocketAddr {
        self.server.address()
    }

    /// Cancelled when the service has ended, for whatever reason.
    pub fn ended(&self) -> &CancellationToken {
        self.server.ended()
    }

    /// Tells every viewer goodbye, and waits until all threads have ended.
    pub fn stop(self) {
        drop(self);
    }
}

fn session_info(scene: &Scene, ensemble: &EnsembleSettings) -> SessionInfo {
    let welcome = Welcome {
        session: 0,
        server_version: env!("CARGO_PKG_VERSION").to_owned(),
        scene_name: scene.name().to_owned(),
        scene_hash: scene.hash().to_owned(),
        frame: scene.frame(),
        camera: *scene.camera(),
        strategies: Mixture::names_for(&ensemble.strategies, scene.camera(), scene.features()),
        failure_reasons: Failure::ALL.iter().map(|reason| reason.name().to_owned()).collect(),
        chains: ensemble.chains,
        max_edges: scene.max_edges() as u32,
        role: Role::Observer,
        resume: String::new(),
    };
    SessionInfo { welcome, mesh: scene.preview_mesh() }
}
