//! A real daemon service on a free port, watched by real viewers; only the paths are made up.

pub(crate) mod fixture;

use std::io::{Read as _, Write as _};
use std::net::TcpStream;
use std::sync::Arc;
use std::time::Duration;

use common::{FilmFrame, Gap, Rgb, Statistics, TracerEvent, Welcome};
use proto::v1::tracer_client::TracerClient;
use proto::v1::viewer_message::Kind;
use proto::{ProtocolVersion, SceneAssembler, ViewerEvent, v1};
use tokio::sync::mpsc;
use tokio_stream::wrappers::ReceiverStream;
use tonic::transport::{Channel, Endpoint};
use tonic::{Code, Status};
use tracer_server::hub::HubLimits;
use tracer_server::service::Server;

use fixture::{Viewer, batch, connect, hello, rebuild, session_info, soon, start, stop, watch};

#[tokio::test]
async fn a_viewer_is_welcomed_and_shown_the_present() {
    let server = start(HubLimits::default());
    let pixels = (0..300 * 200).map(|i| Rgb::grey(f64::from(i))).collect();
    let film = FilmFrame { width: 300, height: 200, steps: 77, pixels };
    server.hub().publish_film(Arc::new(film.clone()));
    server.hub().publish_statistics(Arc::new(Statistics { threads: 3, ..Statistics::default() }));
    // Once the first viewer has seen both, a second one finds them in its snapshot.
    let mut first = Viewer::join(&server).await.expect("welcome");
    let (mut saw_film, mut saw_statistics) = (false, false);
    while !(saw_film && saw_statistics) {
        match first.next().await.expect("open") {
            TracerEvent::Film(_) => saw_film = true,
            TracerEvent::Statistics(_) => saw_statistics = true,
            _ => {}
        }
    }
    let mut viewer = Viewer::join(&server).await.expect("welcome");
    let expected = session_info().welcome;
    assert_ne!(viewer.welcome.session, first.welcome.session, "each session has its number");
    let (session, resume) = (viewer.welcome.session, viewer.welcome.resume.clone());
    assert!(resume.len() >= 32 && resume != first.welcome.resume, "a secret of its own");
    assert_eq!(viewer.welcome, Welcome { session, resume, ..expected });

    let mut rows = vec![None; film.pixels.len()];
    let mut threads = None;
    for event in viewer.snapshot().await {
        match event {
            TracerEvent::Statistics(s) => threads = Some((s.threads, s.viewers)),
            TracerEvent::Film(tile) => {
                assert_eq!((tile.width, tile.height, tile.steps), (300, 200, 77));
                let start = tile.first_row as usize * 300;
                for (i, pixel) in tile.rgb.chunks_exact(3).enumerate() {
                    rows[start + i] = Some(pixel[0]);
                }
            }
            other => panic!("not part of a snapshot: {other:?}"),
        }
    }
    assert_eq!(threads, Some((3, 2)), "statistics are there and count both viewers");
    let whole = rows.iter().enumerate().all(|(i, pixel)| *pixel == Some(i as f32));
    assert!(whole, "the film is whole");
    stop(server).await;
}

#[tokio::test]
async fn paths_arrive_as_they_were_published() {
    let server = start(HubLimits::default());
    let mut viewer = Viewer::join(&server).await.expect("welcome");
    assert_eq!(viewer.snapshot().await, [], "nothing was published yet");
    let (sent, paths) = batch(20_000);
    for sequence in 0..20 {
        server.hub().publish_paths(sent.clone());
        let Some(TracerEvent::Paths(got)) = viewer.next_data().await else {
            panic!("not paths");
        };
        assert_eq!(got.sequence(), sequence);
        assert_eq!(rebuild(&got), paths, "each batch alone rebuilds its paths");
    }
    stop(server).await;
}

#[tokio::test]
async fn a_stalled_viewer_is_told_of_its_gap_and_harms_nobody() {
    const BATCHES: u64 = 200;
    let server = start(HubLimits { lane_bytes: 1 << 20, ..HubLimits::default() });
    let mut stalled = Viewer::join(&server).await.expect("welcome");
    let mut reading = Viewer::join(&server).await.expect("welcome");
    assert_eq!(reading.snapshot().await, [], "nothing was published yet");
    let (sent, paths) = batch(60_000);
    for sequence in 0..BATCHES {
        server.hub().publish_paths(sent.clone());
        match reading.next_data().await {
            Some(TracerEvent::Paths(got)) => assert_eq!(got.sequence(), sequence),
            other => panic!("a reading viewer gets every batch, not {other:?}"),
        }
    }
    // Now the other one reads: what it missed and what it got are all there was.
    let (mut got, mut missed, mut last) = (0, Gap::default(), None);
    while last != Some(BATCHES - 1) {
        match stalled.next_data().await.expect("still connected") {
            TracerEvent::Paths(batch) => {
                assert!(last < Some(batch.sequence()), "in order");
                assert_eq!(rebuild(&batch), paths, "batches after a gap are whole");
                last = Some(batch.sequence());
                got += 1;
            }
            TracerEvent::Gap(gap) => {
                missed.batches += gap.batches;
                missed.paths += gap.paths;
                missed.bytes += gap.bytes;
            }
            TracerEvent::SnapshotEnd => {}
            other => panic!("unexpected {other:?}"),
        }
    }
    assert!(missed.batches > 0, "twelve megabytes do not fit into a lane of one");
    assert_eq!(got + missed.batches, BATCHES);
    assert_eq!(missed.paths, missed.batches * sent.len() as u64);
    assert_eq!(missed.bytes, missed.batches * sent.byte_len() as u64);
    stop(server).await;
}

#[tokio::test]
async fn a_viewer_that_lets_its_control_lane_fill_is_sent_away_with_a_reason() {
    let server = start(HubLimits { control_messages: 4, ..HubLimits::default() });
    let mut deaf = Viewer::join(&server).await.expect("welcome");
    let mut reading = Viewer::join(&server).await.expect("welcome");
    server.hub().publish_statistics(Arc::new(Statistics::default()));
    let (sent, _) = batch(60_000);
    // What fills the connection first; then statistics pile up, twice a second.
    let gone = async {
        while server.hub().viewers() > 1 {
            server.hub().publish_paths(sent.clone());
            let event = reading.next().await.expect("whoever reads stays");
            assert!(!matches!(event, TracerEvent::Goodbye(_)), "whoever reads stays: {event:?}");
        }
    };
    soon("its place is free, although it never reads", gone).await;
    let mut last = None;
    while let Some(event) = deaf.next().await {
        last = Some(event);
    }
    match last {
        Some(TracerEvent::Goodbye(reason)) => assert!(reason.contains("too slowly"), "{reason}"),
        other => panic!("the reason comes last, not {other:?}"),
    }
    stop(server).await;
}

#[tokio::test]
async fn another_protocol_version_is_refused_and_both_are_named() {
    let server = start(HubLimits::default());
    let version = Some(v1::ProtocolVersion { major: 9, minor: 3 });
    let message = Kind::Hello(v1::Hello { version, ..hello() });
    let status = watch(&server, vec![v1::ViewerMessage { kind: Some(message) }]).await;
    let status = status.expect_err("version 9 is not ours");
    assert_eq!(status.code(), Code::FailedPrecondition);
    let ours = ProtocolVersion::CURRENT.to_string();
    let named = status.message().contains("9.3") && status.message().contains(&ours);
    assert!(named, "{status}");
    // A later minor of the same major, with a message that does not exist yet, is welcome.
    let current = ProtocolVersion::CURRENT;
    let version = Some(v1::ProtocolVersion { major: current.major, minor: 99 });
    let later = Kind::Hello(v1::Hello { version, ..hello() });
    let messages = vec![
        v1::ViewerMessage { kind: Some(later) },
        v1::ViewerMessage { kind: None },
        v1::ViewerMessage::from(ViewerEvent::SetBudget(0)),
    ];
    let mut stream = watch(&server, messages).await.expect("welcome");
    let first = soon("a welcome", stream.message()).await.expect("no error").expect("open");
    assert!(matches!(TracerEvent::try_from(first), Ok(TracerEvent::Welcome(_))), "a welcome");
    let second = soon("the snapshot", stream.message()).await.expect("no error");
    assert!(second.is_some(), "the unknown message did no harm");
    stop(server).await;
}

/// Sends bytes as the content of a `Hello`, which they are not.
async fn send_garbage(server: &Server, content: Vec<u8>) -> Status {
    let endpoint = Endpoint::from_shared(format!("http://{}", server.address())).expect("an URI");
    let channel = endpoint.connect().await.expect("the server listens");
    let mut client = tonic::client::Grpc::new(channel);
    client.ready().await.expect("connected");
    // As a message, a byte vector is field 1 of that content.
    let codec = tonic_prost::ProstCodec::<Vec<u8>, v1::TracerMessage>::default();
    let path = tonic::codegen::http::uri::PathAndQuery::from_static("/lvis.v1.Tracer/Watch");
    let request = tonic::Request::new(tokio_stream::once(content));
    let answer = soon("an answer", client.streaming(request, path, codec)).await;
    answer.map(drop).expect_err("garbage is no hello")
}

#[tokio::test]
async fn garbage_is_refused_and_harms_nobody() {
    let server = start(HubLimits::default());
    let mut witness = Viewer::join(&server).await.expect("welcome");
    assert_eq!(witness.snapshot().await, [], "nothing was published yet");

    for content in [vec![0xff; 40], vec![0x0a, 0xff, 0xff, 0xff, 0xff, 0x0f], vec![7; 100_000]] {
        let status = send_garbage(&server, content).await;
        assert_eq!(status.code(), Code::InvalidArgument, "{status}");
    }
    let long_name = v1::Hello { viewer_name: "x".repeat(300), ..hello() };
    let no_version = v1::Hello { version: None, ..hello() };
    let twice = v1::ViewerMessage { kind: Some(Kind::Hello(hello())) };
    for messages in [
        vec![],
        vec![ViewerEvent::SetBudget(1).into()],
        vec![v1::ViewerMessage { kind: Some(Kind::Hello(long_name)) }],
        vec![v1::ViewerMessage { kind: Some(Kind::Hello(no_version)) }],
    ] {
        let status = watch(&server, messages).await.expect_err("no proper hello");
        assert_eq!(status.code(), Code::InvalidArgument, "{status}");
    }
    let mut stream = watch(&server, vec![twice.clone(), twice]).await.expect("welcome at first");
    let status = loop {
        match soon("the refusal", stream.message()).await {
            Ok(message) => assert!(message.is_some(), "it must end with an error"),
            Err(status) => break status,
        }
    };
    assert_eq!(status.code(), Code::InvalidArgument, "{status}");
    let mut socket = TcpStream::connect(server.address()).expect("the server listens");
    socket.write_all(&[0x16; 4096]).expect("bytes that are no HTTP");

    let (sent, paths) = batch(1000);
    server.hub().publish_paths(sent);
    match witness.next_data().await {
        Some(TracerEvent::Paths(got)) => assert_eq!(rebuild(&got), paths),
        other => panic!("the witness must not notice, but got {other:?}"),
    }
    stop(server).await;
}

#[tokio::test]
async fn a_viewer_that_says_nothing_is_sent_away() {
    let server = start(HubLimits::default());
    let (_silent, messages) = mpsc::channel::<v1::ViewerMessage>(1);
    let mut client = connect(&server).await.expect("the server listens");
    let answer = soon("a refusal", client.watch(ReceiverStream::new(messages))).await;
    let status = answer.map(drop).expect_err("silence is no hello");
    assert_eq!(status.code(), Code::DeadlineExceeded, "{status}");
    assert_eq!(server.hub().viewers(), 0, "it never counted as a viewer");
    stop(server).await;
}

#[tokio::test]
async fn one_viewer_too_many_is_refused_until_another_leaves() {
    let server = start(HubLimits { viewers: 2, ..HubLimits::default() });
    let first = Viewer::join(&server).await.expect("welcome");
    let _second = Viewer::join(&server).await.expect("welcome");
    let status = Viewer::join(&server).await.map(drop).expect_err("one too many");
    assert_eq!(status.code(), Code::ResourceExhausted, "{status}");
    assert!(status.message().contains('2'), "says how many: {status}");
    drop(first);
    let joined = async {
        while Viewer::join(&server).await.is_err() {
            tokio::time::sleep(Duration::from_millis(20)).await;
        }
    };
    soon("a free place", joined).await;
    stop(server).await;
}

#[tokio::test]
async fn a_flood_of_connections_is_cut_off_and_survived() {
    let server = start(HubLimits::default());
    let mut witness = Viewer::join(&server).await.expect("welcome");
    assert_eq!(witness.snapshot().await, [], "nothing was published yet");
    let address = server.address();
    let flood = tokio::task::spawn_blocking(move || {
        let idle: Vec<_> = (0..300).map(|_| TcpStream::connect(address)).collect();
        let refused = idle.iter().flatten().filter(|socket| is_closed(socket)).count();
        (idle, refused)
    });
    let (idle, refused) = soon("the flood", flood).await.expect("no panic");
    assert!(refused > 0, "three hundred connections are too many");
    let told = async {
        // Those who were told before make room for the next to be told.
        loop {
            match Viewer::join(&server).await {
                Err(status) if status.code() == Code::ResourceExhausted => return status,
                Err(_) => tokio::time::sleep(Duration::from_millis(50)).await,
                Ok(_) => panic!("there is no room"),
            }
        }
    };
    let status = soon("somebody who is told why", told).await;
    assert!(status.message().contains("full"), "{status}");
    let (sent, paths) = batch(1000);
    server.hub().publish_paths(sent);
    match witness.next_data().await {
        Some(TracerEvent::Paths(got)) => assert_eq!(rebuild(&got), paths),
        other => panic!("the witness must not notice, but got {other:?}"),
    }
    drop(idle);
    let joined = async {
        while Viewer::join(&server).await.is_err() {
            tokio::time::sleep(Duration::from_millis(20)).await;
        }
    };
    soon("a free place", joined).await;
    stop(server).await;
}

/// True when the peer has closed the connection; a server that keeps it greets with its settings.
fn is_closed(mut socket: &TcpStream) -> bool {
    !matches!(socket.read(&mut [0; 1]), Ok(1))
}

#[tokio::test]
async fn health_and_reflection_answer() {
    use tonic_health::pb::HealthCheckRequest;
    use tonic_health::pb::health_check_response::ServingStatus;
    use tonic_health::pb::health_client::HealthClient;
    use tonic_reflection::pb::v1::server_reflection_client::ServerReflectionClient;
    use tonic_reflection::pb::v1::server_reflection_request::MessageRequest;
    use tonic_reflection::pb::v1::{ServerReflectionRequest, server_reflection_response};
    use tonic_reflection::pb::v1alpha as early;

    let server = start(HubLimits::default());
    let endpoint = Endpoint::from_shared(format!("http://{}", server.address())).expect("an URI");
    let channel = endpoint.connect().await.expect("the server listens");
    let request = HealthCheckRequest { service: "lvis.v1.Tracer".to_owned() };
    let health = HealthClient::new(channel.clone()).check(request).await.expect("an answer");
    assert_eq!(health.into_inner().status(), ServingStatus::Serving);

    let list = MessageRequest::ListServices(String::new());
    let request = ServerReflectionRequest { host: String::new(), message_request: Some(list) };
    let mut answers = ServerReflectionClient::new(channel.clone())
        .server_reflection_info(tokio_stream::once(request))
        .await
        .expect("an answer")
        .into_inner();
    let answer = answers.message().await.expect("no error").expect("one answer");
    let Some(server_reflection_response::MessageResponse::ListServicesResponse(list)) =
        answer.message_response
    else {
        panic!("not a list of services");
    };
    let names: Vec<_> = list.service.iter().map(|service| service.name.as_str()).collect();
    assert!(names.contains(&"lvis.v1.Tracer"), "{names:?}");
    assert!(names.contains(&"grpc.health.v1.Health"), "{names:?}");

    // What most tools still ask, word for word the same but for the version.
    let list = early::server_reflection_request::MessageRequest::ListServices(String::new());
    let request =
        early::ServerReflectionRequest { host: String::new(), message_request: Some(list) };
    let mut answers = early::server_reflection_client::ServerReflectionClient::new(channel)
        .server_reflection_info(tokio_stream::once(request))
        .await
        .expect("an answer")
        .into_inner();
    let answer = answers.message().await.expect("no error").expect("one answer");
    let Some(early::server_reflection_response::MessageResponse::ListServicesResponse(early)) =
        answer.message_response
    else {
        panic!("not a list of services");
    };
    let early: Vec<_> = early.service.iter().map(|service| service.name.as_str()).collect();
    assert!(early.contains(&"lvis.v1.Tracer"), "{early:?}");
    stop(server).await;
}

#[tokio::test]
async fn the_daemon_stops_with_viewers_connected() {
    let server = start(HubLimits::default());
    let mut reading = Viewer::join(&server).await.expect("welcome");
    let _stalled = Viewer::join(&server).await.expect("welcome");
    assert_eq!(reading.snapshot().await, [], "nothing was published yet");
    let (sent, _) = batch(60_000);
    for _ in 0..150 {
        server.hub().publish_paths(sent.clone());
        let got = reading.next_data().await;
        assert!(matches!(got, Some(TracerEvent::Paths(_))), "each fills the stalled one's window");
    }
    let last_word = async {
        let mut last = None;
        while let Some(event) = reading.next().await {
            last = Some(event);
        }
        last
    };
    let ((), last) = tokio::join!(stop(server), last_word);
    match last {
        Some(TracerEvent::Goodbye(reason)) => assert!(reason.contains("shutting down"), "{reason}"),
        other => panic!("the stream must end with a goodbye, not {other:?}"),
    }
}

#[tokio::test]
async fn the_scene_arrives_whole_or_not_at_all() {
    let server = start(HubLimits::default());
    let mut client = connect(&server).await.expect("the server listens");
    let info = session_info();
    let fetch = async |client: &mut TracerClient<Channel>, known_hash: &str| {
        let request = v1::SceneRequest { known_hash: known_hash.to_owned() };
        let mut chunks = client.get_scene(request).await.expect("a scene").into_inner();
        let mut assembler = SceneAssembler::default();
        let mut count = 0;
        while let Some(chunk) = chunks.message().await.expect("no error") {
            assembler.push(chunk).expect("well-formed");
            count += 1;
        }
        (assembler.finish().expect("whole"), count)
    };
    let (scene, chunks) = fetch(&mut client, "an older scene").await;
    let scene = scene.expect("it has changed");
    assert!(chunks > 3, "cut in {chunks} pieces");
    assert_eq!(scene.mesh, info.mesh);
    assert_eq!((scene.hash, scene.frame), (info.welcome.scene_hash, info.welcome.frame));
    let (unchanged, chunks) = fetch(&mut client, "cafe").await;
    assert_eq!((unchanged, chunks), (None, 1));
    stop(server).await;
}
