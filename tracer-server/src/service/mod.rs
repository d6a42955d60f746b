//! The daemon's door: gRPC services over the hub.
//!
//! A [`Server`] owns a thread with its own runtime, so that a program without one can embed it. This
//! module knows the hub and the wire, and nothing of how paths are made.

mod access;
mod connections;
mod outbound;
mod roster;
mod scene;
mod server;
mod session;
mod tls;

use std::pin::Pin;
use std::sync::Arc;
use std::time::Duration;

use common::{FilterScene, Role, SceneMesh, Welcome};
use proto::v1::tracer_server::{Tracer, TracerServer};
use proto::{FILE_DESCRIPTOR_SET, MAX_MESSAGE_BYTES, v1};
use thiserror::Error;
use tokio::net::TcpListener;
use tokio_stream::Stream;
use tokio_util::sync::CancellationToken;
use tokio_util::task::TaskTracker;
use tonic::service::interceptor::InterceptedService;
use tonic::{Request, Response, Status, Streaming};

pub use access::{Access, MAX_TOKEN_LENGTH, MIN_TOKEN_LENGTH, Token};
pub use server::{Server, StartError};
pub use tls::{Certificate, CertificateError};

use crate::hub::{Hub, Pump};
use crate::steering::Steering;
use access::Allowed;
use outbound::Outbound;
use roster::Roster;
use session::{Session, SharedState};

/// Viewers send small messages only.
const MAX_REQUEST_BYTES: usize = 64 << 10;
/// How long a viewer may take to say hello.
const HELLO_TIMEOUT: Duration = Duration::from_secs(5);
/// How long open streams may take to end on shutdown.
const GRACE: Duration = Duration::from_secs(2);
/// A peer that answers no ping for [`PING_TIMEOUT`] after this long is gone, and its lease is free. It
/// may have been suspended, and come back to what it had.
const PING_INTERVAL: Duration = Duration::from_secs(5);
/// See [`PING_INTERVAL`].
const PING_TIMEOUT: Duration = Duration::from_secs(10);
/// Streams that one connection may have open.
const STREAMS_PER_CONNECTION: u32 = 32;
/// A viewer's filters are read no faster than this: compiling one takes time, which a viewer that asks
/// for many takes from itself only.
const FILTER_INTERVAL: Duration = Duration::from_millis(15);
/// What viewers are told when the daemon ends.
const SHUTTING_DOWN: &str = "the daemon is shutting down";

/// What a daemon says of itself: the same for every viewer and for as long as it lives.
#[derive(Clone, Debug)]
pub struct SessionInfo {
    /// The welcome; session and role are filled in for each viewer.
    pub welcome: Welcome,
    /// The scene for drawing, with the names that filters may use.
    pub mesh: SceneMesh,
}

impl SessionInfo {
    /// What filters may name.
    fn filter_scene(&self) -> FilterScene {
        FilterScene::new(self.welcome.frame, &self.mesh, self.welcome.strategies.clone())
    }
}

/// Who may connect, and whether the connection is encrypted.
#[derive(Clone, Debug, Default)]
pub struct Security {
    /// The tokens that open the door.
    pub access: Access,
    /// What the daemon shows for itself; without it, nothing is encrypted.
    pub certificate: Option<Certificate>,
}

/// Why the service ended, if not on request.
#[derive(Debug, Error)]
pub enum ServeError {
    /// The schema that was compiled in cannot be offered for reflection.
    #[error("the protocol's schema cannot be provided for reflection")]
    Reflection(#[from] tonic_reflection::server::Error),
    /// The network failed.
    #[error("the network service failed")]
    Transport(#[from] tonic::transport::Error),
}

/// What a service shows, and whom it lets in.
#[derive(Debug)]
pub struct Backend {
    /// Where viewers meet the chains.
    pub hub: Hub,
    /// What empties the hub's queues.
    pub pump: Pump,
    /// What every viewer is told first.
    pub info: Arc<SessionInfo>,
    /// Where orders go.
    pub steering: Steering,
    /// Who may connect.
    pub security: Security,
}

/// Serves viewers on `listener` until `shutdown`, and returns when everything it started has ended.
///
/// Viewers that are connected at the end are told so. Those that do not read are left behind after
/// two seconds.
pub async fn serve(
    listener: TcpListener,
    backend: Backend,
    shutdown: CancellationToken,
) -> Result<(), ServeError> {
    let Backend { hub, pump, info, steering, security } = backend;
    let tasks = TaskTracker::new();
    tasks.spawn(pump.run(shutdown.clone()));

    let (health_reporter, health) = tonic_health::server::health_reporter();
    health_reporter.set_serving::<TracerServer<TracerService>>().await;
    let reflection = || {
        tonic_reflection::server::Builder::configure()
            .register_encoded_file_descriptor_set(FILE_DESCRIPTOR_SET)
            .register_encoded_file_descriptor_set(tonic_health::pb::FILE_DESCRIPTOR_SET)
    };
    // Many tools ask in the form that was there before the first version.
    let (reflection, early_reflection) = (reflection().build_v1()?, reflection().build_v1alpha()?);
    let filter_scene = Arc::new(info.filter_scene());
    let (task_list, token) = (tasks.clone(), shutdown.clone());
    let roster = Roster::new(hub.clone());
    let shared = Arc::new(SharedState { filter_scene, steering, roster });
    let service = TracerService { hub, info, shared, tasks: task_list, shutdown: token };
    let tracer = TracerServer::new(service)
        .max_decoding_message_size(MAX_REQUEST_BYTES)
        .max_encoding_message_size(MAX_MESSAGE_BYTES);

    let mut server = tonic::transport::Server::builder();
    if let Some(certificate) = &security.certificate {
        server = server.tls_config(certificate.server_config())?;
    }
    let server = server
        .http2_keepalive_interval(Some(PING_INTERVAL))
        .http2_keepalive_timeout(Some(PING_TIMEOUT))
        .max_concurrent_streams(Some(STREAMS_PER_CONNECTION))
        .add_service(health)
        .add_service(InterceptedService::new(reflection, security.access))
        .add_service(InterceptedService::new(early_reflection, security.access))
        .add_service(InterceptedService::new(tracer, security.access))
        .serve_with_incoming_shutdown(
            connections::accept(listener),
            shutdown.clone().cancelled_owned(),
        );
    let overdue = async {
        shutdown.cancelled().await;
        tokio::time::sleep(GRACE).await;
    };
    let result = tokio::select! {
        result = server => result,
        // A stream whose peer does not read would keep the server for ever.
        () = overdue => Ok(()),
    };
    shutdown.cancel();
    tasks.close();
    tasks.wait().await;
    Ok(result?)
}

/// The implementation of `lvis.v1.Tracer`.
#[derive(Debug)]
struct TracerService {
    hub: Hub,
    info: Arc<SessionInfo>,
    shared: Arc<SharedState>,
    tasks: TaskTracker,
    shutdown: CancellationToken,
}

/// The stream of a scene's chunks.
type SceneStream = Pin<Box<dyn Stream<Item = Result<v1::SceneChunk, Status>> + Send>>;

#[tonic::async_trait]
impl Tracer for TracerService {
    type WatchStream = Outbound;
    type GetSceneStream = SceneStream;

    async fn watch(
        &self,
        request: Request<Streaming<v1::ViewerMessage>>,
    ) -> Result<Response<Outbound>, Status> {
        // A request that did not pass through the interceptor may only watch.
        let allowed = request.extensions().get().map_or(Role::Observer, |&Allowed(role)| role);
        let mut inbound = request.into_inner();
        let hello = tokio::select! {
            hello = session::handshake(&mut inbound) => hello?,
            () = self.shutdown.cancelled() => return Err(Status::unavailable(SHUTTING_DOWN)),
        };
        session::check_filter(&hello, &self.shared.filter_scene)?;
        let subscription = self
            .hub
            .subscribe(hello.data_budget)
            .map_err(|full| Status::resource_exhausted(full.to_string()))?;
        let (sender, outbound) = outbound::channel();
        let shared = Arc::clone(&self.shared);
        let (session, entry) = Session::enter(hello, subscription, shared, allowed);
        let welcome = Welcome {
            session: session.number(),
            role: entry.role,
            resume: entry.resume,
            ..self.info.welcome.clone()
        };
        let shutdown = self.shutdown.clone();
        self.tasks.spawn(session.run(welcome, inbound, sender, shutdown));
        Ok(Response::new(outbound))
    }

    async fn get_scene(
        &self,
        request: Request<v1::SceneRequest>,
    ) -> Result<Response<SceneStream>, Status> {
        let known_hash = request.into_inner().known_hash;
        if known_hash == self.info.welcome.scene_hash {
            let chunk = proto::unchanged_scene(&known_hash);
            return Ok(Response::new(Box::pin(tokio_stream::once(Ok(chunk)))));
        }
        let (sender, chunks) = tokio::sync::mpsc::channel(1);
        let sending = scene::send(Arc::clone(&self.info), sender);
        let shutdown = self.shutdown.clone();
        self.tasks.spawn(async move { shutdown.run_until_cancelled_owned(sending).await });
        Ok(Response::new(Box::pin(tokio_stream::wrappers::ReceiverStream::new(chunks))))
    }
}
