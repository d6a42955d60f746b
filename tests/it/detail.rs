//! The numbers behind a path, asked of a real daemon over the network.

use common::{
    ChainId, DetailReply, Notice, PathDetail, PathHeader, PathId, Role, TracerEvent, VertexRecord,
};
use common::{ExplorerCommand, Order, Seed};
use proto::{NumberedOrder, ViewerEvent};
use tracer_server::daemon::Daemon;
use viewer_client::source::connection::{Greeting, Peer, Session};

use crate::daemon::{PATIENCE, start};

async fn join(daemon: &Daemon, role: Role) -> Session {
    let peer = Peer::open(daemon.address().to_string());
    let greeting = Greeting { role, focus: true, ..Greeting::default() };
    Session::open(&peer, greeting).await.expect("welcome")
}

/// The first event that `wanted` makes something of.
async fn until<T>(
    session: &mut Session,
    what: &str,
    wanted: impl Fn(TracerEvent) -> Option<T>,
) -> T {
    let hearing = async {
        loop {
            if let Some(found) = wanted(session.next().await.expect("still connected")) {
                return found;
            }
        }
    };
    tokio::time::timeout(PATIENCE, hearing).await.unwrap_or_else(|_| panic!("no {what}"))
}

/// Every path of one batch.
async fn paths(session: &mut Session) -> Vec<(PathHeader, Vec<VertexRecord>)> {
    until(session, "paths", |event| {
        let TracerEvent::Paths(batch) = event else { return None };
        let mut reader = batch.reader();
        let mut paths = Vec::new();
        while let Some(view) = reader.next() {
            paths.push((view.header, view.vertices.to_vec()));
        }
        Some(paths).filter(|paths| !paths.is_empty())
    })
    .await
}

async fn ask(session: &mut Session, path: PathId) -> Result<PathDetail, String> {
    assert!(session.say(ViewerEvent::Inspect(path)), "there is room");
    until(session, "answer", |event| match event {
        TracerEvent::Notice(Notice::Detail(reply)) => {
            let DetailReply { path: about, found } = *reply;
            (about == path).then_some(found)
        }
        _ => None,
    })
    .await
}

/// That the numbers are those of that very path: its luminance and its colour follow from them.
fn check(header: &PathHeader, vertices: &[VertexRecord], detail: &PathDetail) {
    assert_eq!(detail.vertices.len(), vertices.len(), "{}", header.id);
    assert_eq!(detail.luminance() as f32, header.luminance, "{}", header.id);
    let whole = (0..vertices.len()).filter(|&light| detail.reciprocals[light] > 0.0);
    let mut ways = 0;
    for light in whole {
        let contribution = detail.contribution(light).expect("a split");
        let error = contribution.luminance() * detail.reciprocals[light] - 1.0;
        assert!(error.abs() < 1e-9, "{}: split {light} is off by {error}", header.id);
        let unit = contribution / contribution.luminance();
        for (told, shown) in unit.to_f32().into_iter().zip(header.rgb) {
            assert!((told - shown).abs() <= 1e-6 * shown.abs().max(1.0), "{}: colour", header.id);
        }
        ways += 1;
    }
    assert!(ways > 0, "{}: some split must make it", header.id);
    for (j, geometry) in detail.geometry.iter().enumerate().take(vertices.len() - 2) {
        let place = |j: usize| vertices[j].position.map(f64::from);
        let (a, b) = (place(j), place(j + 1));
        let span = [b[0] - a[0], b[1] - a[1], b[2] - a[2]];
        let length2: f64 = span.iter().map(|x| x * x).sum();
        let cosine = |j: usize| {
            let n = common::decode_normal(vertices[j].normal).to_array();
            let dot: f64 = n.iter().zip(span).map(|(&n, x)| f64::from(n) * x).sum();
            dot.abs() / length2.sqrt()
        };
        let expected = cosine(j) * cosine(j + 1) / length2;
        // Positions and normals travel rounded.
        assert!((geometry - expected).abs() < 2e-3 * expected + 1e-10, "{}: G {j}", header.id);
    }
}

async fn stop(daemon: Daemon) {
    let stopping = tokio::task::spawn_blocking(move || daemon.stop());
    tokio::time::timeout(PATIENCE, stopping).await.expect("stops in time").expect("no panic");
}

#[tokio::test]
async fn the_numbers_behind_a_path_are_its_own_and_everyone_may_ask() {
    let daemon = start();
    let mut driver = join(&daemon, Role::Driver).await;
    let mut observer = join(&daemon, Role::Observer).await;
    let shown = paths(&mut observer).await;
    for (header, vertices) in shown.iter().step_by(shown.len().div_ceil(24)) {
        let detail = ask(&mut observer, header.id).await.expect("it was shown");
        check(header, vertices, &detail);
    }
    // Twice the same.
    let (header, vertices) = &shown[0];
    let detail = ask(&mut driver, header.id).await.expect("it was shown");
    check(header, vertices, &detail);

    // The explorer's paths have numbers, too.
    let order = Some(Order::Explorer(ExplorerCommand::Seed(Seed::Path(header.id))));
    assert!(driver.say(ViewerEvent::Order(NumberedOrder { request: 1, order })), "there is room");
    let seed = until(&mut driver, "seed", |event| match event {
        TracerEvent::FocusPath(path) => Some(path),
        _ => None,
    });
    let seed = seed.await;
    let own = seed.header.id;
    assert_eq!((own.chain, &seed.vertices), (ChainId::EXPLORER, vertices), "the seed");
    assert_eq!(ask(&mut observer, own).await, Ok(detail), "the same path by another name");
    stop(daemon).await;
}

#[tokio::test]
async fn a_path_that_is_gone_says_so_and_questions_do_not_pile_up() {
    let daemon = start();
    let mut session = join(&daemon, Role::Observer).await;
    let shown = paths(&mut session).await;
    let id = shown[0].0.id;
    let never = ask(&mut session, PathId { step: u64::MAX, ..id })
        .await
        .expect_err("that step was not shown");
    assert!(never.contains("there is no path"), "{never}");
    let lost = PathId { chain: ChainId::EXPLORER, epoch: 9, step: 1 };
    let lost = ask(&mut session, lost).await.expect_err("the explorer was nowhere");
    assert!(lost.contains("no longer stored"), "{lost}");
    // Somebody who asks without end is heard one question at a time, and the chains go on.
    let mut sent = 0;
    while session.say(ViewerEvent::Inspect(id)) {
        sent += 1;
    }
    assert!((1..=64).contains(&sent), "the outbox is bounded, not {sent}");
    for _ in 0..sent {
        let found = until(&mut session, "answer", |event| match event {
            TracerEvent::Notice(Notice::Detail(reply)) => Some(reply.found),
            _ => None,
        });
        assert!(found.await.is_ok(), "each is answered");
    }
    paths(&mut session).await;
    stop(daemon).await;
}
