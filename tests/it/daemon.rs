//! The daemon as it ships, with its chains at work on a built-in scene.

use std::sync::Arc;
use std::time::Duration;

use common::{Event, PathBatch, Role, Statistics, TracerEvent, VertexKind};
use proto::v1::tracer_client::TracerClient;
use proto::{Hello, ProtocolVersion, SceneAssembler, ViewerEvent, v1};
use tonic::Streaming;
use tonic::transport::{Channel, Endpoint};
use tracer_server::chain::EnsembleSettings;
use tracer_server::daemon::{Daemon, DaemonOptions};
use tracer_server::scene::Scene;
use tracer_server::scene::load::load;

/// Nothing here takes that long; what does hangs.
pub(crate) const PATIENCE: Duration = Duration::from_mins(1);

pub(crate) fn start() -> Daemon {
    start_keeping(DaemonOptions::default().archive_bytes)
}

/// A daemon that keeps so much of what was shown.
pub(crate) fn start_keeping(archive_bytes: usize) -> Daemon {
    let mut description = load("cornell").expect("a built-in scene").description;
    (description.width, description.height) = (40, 30);
    let scene = Arc::new(Scene::new(&description).expect("a sound scene"));
    let ensemble = EnsembleSettings {
        chains: 4,
        threads: 1,
        bootstrap_samples: 4096,
        ..EnsembleSettings::default()
    };
    let listen = "127.0.0.1:0".parse().expect("an address");
    let options = DaemonOptions { listen, ensemble, archive_bytes, ..DaemonOptions::default() };
    Daemon::start(scene, &options).expect("a free port")
}

async fn watch(address: &str) -> (TracerClient<Channel>, Streaming<v1::TracerMessage>) {
    let endpoint = Endpoint::from_shared(format!("http://{address}")).expect("an URI");
    let mut client = TracerClient::connect(endpoint).await.expect("the daemon listens");
    let hello = Hello {
        version: ProtocolVersion::CURRENT,
        viewer_name: "test".to_owned(),
        wanted_role: Role::Observer,
        data_budget: 0,
        filter: None,
        focus: false,
        resume: String::new(),
    };
    let messages = tokio_stream::once(v1::ViewerMessage::from(ViewerEvent::Hello(hello)));
    let stream = client.watch(messages).await.expect("welcome").into_inner();
    (client, stream)
}

pub(crate) async fn next(stream: &mut Streaming<v1::TracerMessage>) -> Option<TracerEvent> {
    let message =
        tokio::time::timeout(PATIENCE, stream.message()).await.expect("a message in time");
    let message = message.expect("no error")?;
    Some(TracerEvent::try_from(message).expect("well-formed"))
}

/// That every path of a batch is one that cornell can have.
fn check_paths(batch: &PathBatch, materials: usize, max_edges: usize) {
    let mut reader = batch.reader();
    let weight: f32 = batch.paths().weight.iter().sum();
    assert!(weight > 0.0, "a batch stands for some steps");
    while let Some(path) = reader.next() {
        let (first, last) = (path.vertices[0], path.vertices[path.vertices.len() - 1]);
        assert_eq!((first.kind, first.event), (VertexKind::Light, Event::End), "starts at a light");
        assert_eq!((last.kind, last.event), (VertexKind::Eye, Event::End), "ends at the lens");
        assert!(path.vertices.len() <= max_edges + 1, "no longer than allowed");
        assert!(path.header.weight >= 0.0 && path.header.luminance > 0.0, "carries light");
        let [u, v] = path.header.film;
        assert!((0.0..1.0).contains(&u) && (0.0..1.0).contains(&v), "on the film");
        for vertex in &path.vertices[..path.vertices.len() - 1] {
            assert!(usize::from(vertex.material) < materials, "of a material of the scene");
            let reach = vertex.position.iter().fold(0.0_f32, |reach, x| reach.max(x.abs()));
            assert!(reach <= 2048.0, "within the scene's frame");
        }
    }
}

#[tokio::test]
async fn the_chains_of_a_scene_are_seen_at_work() {
    let daemon = start();
    let (mut client, mut stream) = watch(&daemon.address().to_string()).await;
    let Some(TracerEvent::Welcome(welcome)) = next(&mut stream).await else {
        panic!("the welcome comes first");
    };
    assert_eq!((welcome.scene_name.as_str(), welcome.chains), ("cornell", 4));

    let request = v1::SceneRequest { known_hash: String::new() };
    let mut chunks = client.get_scene(request).await.expect("a scene").into_inner();
    let mut assembler = SceneAssembler::default();
    while let Some(chunk) = chunks.message().await.expect("no error") {
        assembler.push(chunk).expect("well-formed");
    }
    let scene = assembler.finish().expect("whole").expect("new to us");
    assert_eq!((scene.hash, scene.frame), (welcome.scene_hash, welcome.frame));

    let (mut paths, mut films, mut statistics) = (0, 0, Arc::<Statistics>::default());
    while paths < 1000 || films < 2 || statistics.totals.steps == 0 {
        match next(&mut stream).await.expect("open") {
            TracerEvent::Paths(batch) => {
                check_paths(&batch, scene.mesh.materials.len(), welcome.max_edges as usize);
                paths += batch.len();
            }
            TracerEvent::Film(tile) => {
                assert_eq!((tile.width, tile.height), (40, 30));
                films += 1;
            }
            TracerEvent::Statistics(news) => statistics = news,
            _ => {}
        }
    }
    assert_eq!(statistics.strategies.len(), welcome.strategies.len());
    for strategy in &statistics.strategies {
        let failed: u64 = strategy.failures.iter().map(|failure| failure.count).sum();
        assert_eq!(failed, strategy.proposed - strategy.generated, "every failure has a reason");
        assert!(strategy.accepted <= strategy.generated, "only what exists is accepted");
    }
    assert!(statistics.normalization > 0.0 && statistics.memory_bytes > 0, "{statistics:?}");
    let stopping = tokio::task::spawn_blocking(move || daemon.stop());
    tokio::time::timeout(PATIENCE, stopping).await.expect("stops in time").expect("no panic");
}
