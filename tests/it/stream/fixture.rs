//! A server to watch, a viewer to watch it with, and made-up paths to see.

use std::future::Future;
use std::time::Duration;

use common::{
    BatchBuilder, Camera, CameraPose, ChainId, Event, MaterialInfo, PathBatch, PathHeader, PathId,
    Rgb, Role, SceneFrame, SceneMesh, TracerEvent, VertexKind, VertexRecord, Welcome,
};
use glam::DVec3;
use proto::v1::tracer_client::TracerClient;
use proto::v1::viewer_message::Kind;
use proto::{Hello, ProtocolVersion, v1};
use tonic::transport::{Channel, Endpoint};
use tonic::{Status, Streaming};
use tracer_server::hub::HubLimits;
use tracer_server::service::{Security, Server, SessionInfo};
use tracer_server::steering::Orders;

/// Nothing here takes that long; what does hangs.
pub(super) const PATIENCE: Duration = Duration::from_secs(30);

/// Waits for what must happen.
pub(crate) async fn soon<F: Future>(what: &str, future: F) -> F::Output {
    tokio::time::timeout(PATIENCE, future)
        .await
        .unwrap_or_else(|_| panic!("waits for ever: {what}"))
}

pub(crate) fn session_info() -> SessionInfo {
    let pose = CameraPose {
        origin: DVec3::new(0.0, 0.0, 5.0),
        target: DVec3::ZERO,
        up: DVec3::Y,
        vertical_fov: 40.0,
    };
    let camera = Camera::new(&pose, 64, 48).expect("a valid pose");
    let welcome = Welcome {
        session: 0,
        server_version: "test".to_owned(),
        scene_name: "strip".to_owned(),
        scene_hash: "cafe".to_owned(),
        frame: SceneFrame { centre: DVec3::ZERO, scale: 2.0, light: 1.0 },
        camera,
        strategies: vec!["lens".to_owned()],
        failure_reasons: vec!["occluded".to_owned()],
        chains: 2,
        max_edges: 8,
        role: Role::Observer,
        resume: String::new(),
    };
    SessionInfo { welcome, mesh: strip(60_000, camera) }
}

/// A strip of triangles.
pub(crate) fn strip(triangles: u32, camera: Camera) -> SceneMesh {
    let count = triangles as usize;
    let white = MaterialInfo {
        name: "white".to_owned(),
        model: "lambert".to_owned(),
        color: Rgb::WHITE,
        emission: Rgb::BLACK,
        transparent: false,
        texture: None,
    };
    SceneMesh {
        positions: (0..count + 2).map(|i| [i as f32, (i % 2) as f32, 0.0]).collect(),
        texcoords: Vec::new(),
        normals: vec![[0.0, 0.0, 1.0]; count + 2],
        triangles: (0..triangles).map(|i| [i, i + 1, i + 2]).collect(),
        triangle_materials: vec![0; count],
        primitives: (0..triangles).collect(),
        materials: vec![white],
        objects: Vec::new(),
        textures: Vec::new(),
        camera: Some(camera),
    }
}

pub(super) fn start(limits: HubLimits) -> Server {
    start_guarded(limits, Security::default())
}

pub(crate) fn start_guarded(limits: HubLimits, security: Security) -> Server {
    start_steered(limits, security).0
}

/// A server whose orders arrive at the test.
pub(crate) fn start_steered(limits: HubLimits, security: Security) -> (Server, Orders) {
    let any_port = "127.0.0.1:0".parse().expect("an address");
    let (steering, orders) = tracer_server::steering::channel();
    let server = Server::start(any_port, session_info(), limits, steering, security);
    (server.expect("a free port"), orders)
}

/// Stops a server off the runtime, which goes on reading meanwhile.
pub(crate) async fn stop(server: Server) {
    let stopping = tokio::task::spawn_blocking(move || server.stop());
    soon("the server to stop", stopping).await.expect("stopping does not panic");
}

pub(super) async fn connect(server: &Server) -> Result<TracerClient<Channel>, Status> {
    let endpoint = Endpoint::from_shared(format!("http://{}", server.address())).expect("an URI");
    let channel = soon("a connection", endpoint.connect()).await;
    channel.map(TracerClient::new).map_err(|error| Status::unavailable(error.to_string()))
}

pub(super) fn hello() -> v1::Hello {
    v1::Hello::from(Hello {
        version: ProtocolVersion::CURRENT,
        viewer_name: "test".to_owned(),
        wanted_role: Role::Observer,
        data_budget: 1 << 30,
        filter: None,
        focus: false,
        resume: String::new(),
    })
}

/// Sends `messages`, then says no more but keeps listening.
pub(super) async fn watch(
    server: &Server,
    messages: Vec<v1::ViewerMessage>,
) -> Result<Streaming<v1::TracerMessage>, Status> {
    let mut client = connect(server).await?;
    let answer = soon("an answer", client.watch(tokio_stream::iter(messages))).await?;
    Ok(answer.into_inner())
}

/// A viewer that is welcome.
pub(super) struct Viewer {
    pub(super) welcome: Welcome,
    stream: Streaming<v1::TracerMessage>,
}

impl Viewer {
    pub(super) async fn join(server: &Server) -> Result<Self, Status> {
        let message = v1::ViewerMessage { kind: Some(Kind::Hello(hello())) };
        let mut stream = watch(server, vec![message]).await?;
        let first = soon("a welcome", stream.message()).await?.expect("the stream is open");
        match TracerEvent::try_from(first).expect("well-formed") {
            TracerEvent::Welcome(welcome) => Ok(Self { welcome: *welcome, stream }),
            other => panic!("not a welcome: {other:?}"),
        }
    }

    /// The next event; `None` when the stream has ended well.
    pub(super) async fn next(&mut self) -> Option<TracerEvent> {
        let message = soon("a message", self.stream.message()).await.expect("no error");
        message.map(|message| TracerEvent::try_from(message).expect("well-formed"))
    }

    /// The next event that is neither statistics nor a notice.
    pub(super) async fn next_data(&mut self) -> Option<TracerEvent> {
        loop {
            match self.next().await {
                Some(TracerEvent::Statistics(_) | TracerEvent::Notice(_)) => {}
                event => return event,
            }
        }
    }

    /// Everything but notices up to the end of the snapshot.
    pub(super) async fn snapshot(&mut self) -> Vec<TracerEvent> {
        let mut events = Vec::new();
        loop {
            match self.next().await.expect("the snapshot has an end") {
                TracerEvent::SnapshotEnd => return events,
                TracerEvent::Notice(_) => {}
                event => events.push(event),
            }
        }
    }
}

/// A path of `vertices`, told apart by `tag`.
pub(crate) fn path(tag: u32, vertices: u32) -> Vec<VertexRecord> {
    (0..vertices)
        .map(|i| VertexRecord {
            position: [tag as f32, i as f32, 0.5],
            normal: [1, -1],
            kind: VertexKind::Diffuse,
            event: Event::Diffuse,
            material: 0,
            primitive: tag,
        })
        .collect()
}

/// A batch of about `bytes` whose paths are keyframes and diffs of two chains, and those paths.
pub(crate) fn batch(bytes: usize) -> (PathBatch, Vec<Vec<VertexRecord>>) {
    let mut builder = BatchBuilder::default();
    let mut last = [path(0, 4), path(1, 4)];
    let mut paths = Vec::new();
    for step in 0..(bytes / 100) as u32 {
        let chain = step % 2;
        let current = &mut last[chain as usize];
        let known = step > 1;
        if known {
            // Replaces one inner vertex: one kept at the light, two at the lens.
            current[1] = path(step, 1)[0];
        }
        let id = PathId { chain: ChainId(chain), epoch: 0, step: step.into() };
        let header = PathHeader { id, weight: 1.0, ..PathHeader::default() };
        let completed =
            builder.push(&header, current, known.then_some(common::Kept { light: 1, eye: 2 }));
        assert!(completed.is_none(), "one batch holds them all");
        paths.push(current.clone());
    }
    (builder.finish().expect("there are paths"), paths)
}

pub(super) fn rebuild(batch: &PathBatch) -> Vec<Vec<VertexRecord>> {
    let mut reader = batch.reader();
    let mut paths = Vec::new();
    while let Some(path) = reader.next() {
        paths.push(path.vertices.to_vec());
    }
    paths
}
