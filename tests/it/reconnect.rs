//! The daemon dies; the viewer says so, and is there again as soon as the daemon is.

use std::net::SocketAddr;
use std::sync::Arc;
use std::time::{Duration, Instant};

use tracer_server::chain::EnsembleSettings;
use tracer_server::daemon::{Daemon, DaemonOptions};
use tracer_server::scene::Scene;
use tracer_server::scene::load::load;
use viewer_client::app::Viewer;
use viewer_client::command::{Command, SessionCommand};
use viewer_client::source::Source;
use viewer_client::source::connection::{Link, Peer};
use viewer_client::source::status::LinkState;

/// Nothing here takes that long; what does hangs.
const PATIENCE: Duration = Duration::from_mins(1);

fn daemon(listen: SocketAddr) -> Daemon {
    daemon_of("cornell", listen)
}

fn daemon_of(scene: &str, listen: SocketAddr) -> Daemon {
    let mut description = load(scene).expect("a built-in scene").description;
    (description.width, description.height) = (40, 30);
    let scene = Scene::new(&description).expect("a sound scene");
    let ensemble = EnsembleSettings {
        chains: 4,
        threads: 1,
        bootstrap_samples: 1 << 12,
        ..EnsembleSettings::default()
    };
    let options = DaemonOptions { listen, ensemble, ..DaemonOptions::default() };
    Daemon::start(Arc::new(scene), &options).expect("a free port")
}

/// Lets the viewer receive until `what` has happened.
fn until(what: &str, viewer: &mut Viewer, happened: impl Fn(&Viewer) -> bool) {
    let started = Instant::now();
    loop {
        viewer.receive();
        if happened(viewer) {
            return;
        }
        assert!(started.elapsed() < PATIENCE, "waits for ever: {what}");
        std::thread::sleep(Duration::from_millis(5));
    }
}

#[test]
fn a_viewer_survives_its_daemon() {
    let first = daemon(SocketAddr::from(([127, 0, 0, 1], 0)));
    let address = first.address();
    let mut viewer = Viewer::new(Source::daemon(address.to_string(), false));
    let link = Link::start(Peer::open(address.to_string()), Box::new(|_| {})).expect("a thread");
    viewer.set_link(link);
    until("scene, image and paths", &mut viewer, |v| v.is_settled() && v.paths_received() > 100);
    assert!(viewer.status().is_connected(), "what came, came over a connection");
    assert_eq!(viewer.status().reconnects, 0, "the first one");

    first.stop();
    until("the loss is noticed", &mut viewer, |v| !v.status().is_connected());
    until(
        "the loss is explained",
        &mut viewer,
        |v| matches!(&v.status().link, LinkState::Disconnected { reason, .. } if !reason.is_empty()),
    );
    assert!(viewer.bounds().is_some(), "the scene stays on screen");

    let second = daemon(address);
    let before = viewer.paths_received();
    viewer.apply(Command::Session(SessionCommand::Reconnect));
    until("the connection is back", &mut viewer, |v| v.status().is_connected());
    until("paths flow again", &mut viewer, |v| v.paths_received() > before + 100);
    assert_eq!(viewer.status().reconnects, 1, "it was made anew");
    assert!(viewer.bounds().is_some(), "the scene is the same one");
    drop(viewer);
    second.stop();
}

#[test]
fn another_scene_is_shown_at_once_whatever_the_filter_names() {
    let first = daemon(SocketAddr::from(([127, 0, 0, 1], 0)));
    let address = first.address();
    let mut viewer = Viewer::new(Source::daemon(address.to_string(), false));
    let link = Link::start(Peer::open(address.to_string()), Box::new(|_| {})).expect("a thread");
    viewer.set_link(link);
    viewer.apply("filter set any on material \"fern\"".parse().expect("a command"));
    let follows = |v: &Viewer, text: &str| {
        let reply = v.status().filter.as_ref();
        v.is_settled() && reply.is_some_and(|reply| reply.text == text && reply.error.is_none())
    };
    let wanted = "any on material \"fern\"";
    until("the filter is in force", &mut viewer, |v| follows(v, wanted));
    let room = viewer.triangles();

    first.stop();
    let second = daemon_of("furnace", address);
    viewer.apply(Command::Session(SessionCommand::Reconnect));
    let name = |v: &Viewer| v.status().welcome.as_ref().map(|w| w.scene_name.clone());
    until("the other scene", &mut viewer, |v| name(v).as_deref() == Some("furnace"));
    until("all of its paths", &mut viewer, |v| v.is_settled() && v.paths_received() > 100);
    assert_ne!(viewer.triangles(), room, "its surfaces are shown");
    let filter = &viewer.settings().filter;
    assert!(filter.complaint().is_some_and(|why| why.message.contains("fern")), "marked");
    assert_eq!((filter.text().text(), filter.whole().text()), (wanted, ""), "kept, and off");
    assert!(viewer.take_failures().is_empty(), "nobody refused anything");

    second.stop();
    let third = daemon(address);
    viewer.apply(Command::Session(SessionCommand::Reconnect));
    until("the filter is in force again", &mut viewer, |v| follows(v, wanted));
    assert_eq!(viewer.settings().filter.complaint(), None, "it can be read here");
    drop(viewer);
    third.stop();
}

#[test]
fn a_viewer_without_a_daemon_says_why_and_goes_on_trying() {
    let mut viewer = Viewer::new(Source::daemon("127.0.0.1:1".to_owned(), false));
    let link =
        Link::start(Peer::open("127.0.0.1:1".to_owned()), Box::new(|_| {})).expect("a thread");
    viewer.set_link(link);
    let failure = |v: &Viewer| match &v.status().link {
        LinkState::Disconnected { reason, retry_at } if reason.contains("127.0.0.1:1") => {
            Some(*retry_at)
        }
        _ => None,
    };
    until("the first attempt fails", &mut viewer, |v| failure(v).is_some());
    let first = failure(&viewer);
    viewer.apply(Command::Session(SessionCommand::Reconnect));
    until("a later attempt fails, too", &mut viewer, |v| failure(v) > first);
}
