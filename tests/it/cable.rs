//! A cable that is pulled, between two network namespaces: no end, no error, just silence. Both sides
//! must notice, and the viewer must come back to what it had.
//!
//! It takes Linux and the right to make namespaces; elsewhere it says that it was skipped.

use std::io::{BufRead as _, BufReader, Write as _, stdout};
use std::process::{Child, Command, Stdio};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, RecvTimeoutError, sync_channel};
use std::time::{Duration, Instant};

use common::{FilterText, LeaseRequest, Notice, Order, Presence, Role, TracerEvent};
use tracer_server::chain::EnsembleSettings;
use tracer_server::daemon::{Daemon, DaemonOptions};
use tracer_server::scene::Scene;
use tracer_server::scene::load::load;
use viewer_client::app::Viewer;
use viewer_client::source::Source;
use viewer_client::source::connection::{Greeting, Link, Peer, Session};

/// Nothing here takes that long; what does hangs.
const PATIENCE: Duration = Duration::from_mins(1);
/// Tells the other process where the daemon is.
const ADDRESS: &str = "LVIS_CABLE_ADDRESS";
/// What the viewer at the far end wants to see.
const FILTER: &str = "edges >= 3";

/// A namespace at the end of a cable; both go when it is dropped.
struct Cable {
    name: String,
    /// Addresses of the near and the far end.
    near: String,
}

fn ip(arguments: &str) -> bool {
    let ip = Command::new("ip").args(arguments.split(' ')).stderr(Stdio::null()).status();
    ip.is_ok_and(|status| status.success())
}

impl Cable {
    /// Lays a cable; `None` where that is not allowed.
    fn lay() -> Option<Self> {
        let id = std::process::id();
        let (name, subnet) =
            (format!("lvis{id}"), format!("10.{}.{}", 64 + id / 256 % 64, id % 256));
        if !ip(&format!("netns add {name}")) {
            return None;
        }
        let cable = Self { near: format!("{subnet}.1"), name };
        let Self { name, near } = &cable;
        let laid = [
            format!("link add n{id} type veth peer name f{id} netns {name}"),
            format!("addr add {near}/30 dev n{id}"),
            format!("link set n{id} up"),
            format!("-n {name} addr add {subnet}.2/30 dev f{id}"),
            format!("-n {name} link set f{id} up"),
        ];
        laid.iter().all(|step| ip(step)).then_some(cable)
    }

    /// Pulls the plug at the far end, or puts it in again.
    fn plug(&self, is_in: bool) {
        let to = if is_in { "up" } else { "down" };
        let end = self.name.replace("lvis", "f");
        assert!(ip(&format!("-n {} link set {end} {to}", self.name)), "the cable is there");
    }

    /// This program at the far end, as a viewer.
    fn viewer(&self, address: &str) -> Far {
        let program = std::env::current_exe().expect("this program");
        let child = Command::new("ip")
            .args(["netns", "exec", &self.name])
            .arg(program)
            .args(["--exact", "cable::the_far_end", "--ignored", "--nocapture"])
            .env(ADDRESS, address)
            .env("LVIS_NAME", "far")
            .stdout(Stdio::piped())
            .spawn()
            .expect("a process");
        Far(child)
    }
}

impl Drop for Cable {
    fn drop(&mut self) {
        ip(&format!("netns del {}", self.name));
    }
}

/// The viewer at the far end: says in a line how it is, whenever that changes.
#[test]
#[ignore = "the other half of `a_pulled_cable_is_noticed_and_mended`"]
fn the_far_end() {
    let Ok(address) = std::env::var(ADDRESS) else { return };
    let mut viewer = Viewer::new(Source::daemon(address.clone(), false));
    let link = Link::start(Peer::open(address), Box::new(|_| {})).expect("a thread");
    link.set_filter(1, FilterText::read(FILTER));
    viewer.set_link(link);
    let mut last = String::new();
    // No longer than the other half may take, whatever becomes of that.
    let end = Instant::now() + 5 * PATIENCE;
    while Instant::now() < end {
        viewer.receive();
        let status = viewer.status();
        let filter = status.filter.as_ref().map_or("", |reply| reply.text.as_str());
        let role = status.role();
        let line = if status.is_connected() {
            format!("connected as {role:?} with {filter}")
        } else {
            "disconnected".to_owned()
        };
        if line != last {
            writeln!(stdout(), "far: {line}").expect("a reader");
            last = line;
        }
        std::thread::sleep(Duration::from_millis(20));
    }
}

/// The process at the far end, which ends with the test.
struct Far(Child);

impl Drop for Far {
    fn drop(&mut self) {
        // It may have ended already.
        drop(self.0.kill().and_then(|()| self.0.wait()));
    }
}

/// What the viewer at the far end says.
fn listen(child: &mut Child) -> Receiver<String> {
    let (sender, lines) = sync_channel(64);
    let output = BufReader::new(child.stdout.take().expect("piped"));
    let listen = move || {
        for line in output.lines().map_while(Result::ok) {
            if let Some((_, line)) = line.split_once("far: ")
                && sender.send(line.to_owned()).is_err()
            {
                return;
            }
        }
    };
    std::thread::Builder::new().name("far".to_owned()).spawn(listen).expect("a thread");
    lines
}

fn hear(lines: &Receiver<String>, wanted: &str) {
    let end = Instant::now() + PATIENCE;
    loop {
        match lines.recv_timeout(end.saturating_duration_since(Instant::now())) {
            Ok(line) if line == wanted => return,
            Ok(_) => {}
            Err(RecvTimeoutError::Timeout) => panic!("the far end never said: {wanted}"),
            Err(RecvTimeoutError::Disconnected) => panic!("the far end ended before: {wanted}"),
        }
    }
}

/// Waits until those who are there are as wanted.
async fn see(witness: &mut Session, wanted: impl Fn(&Presence) -> bool) {
    let looking = async {
        loop {
            let event = witness.next().await.expect("still connected");
            if let TracerEvent::Notice(Notice::Presence(presence)) = event
                && wanted(&presence)
            {
                return;
            }
        }
    };
    tokio::time::timeout(PATIENCE, looking).await.expect("they come and go in time");
}

fn start(address: &str) -> Daemon {
    let mut description = load("cornell").expect("a built-in scene").description;
    (description.width, description.height) = (40, 30);
    let scene = Arc::new(Scene::new(&description).expect("a sound scene"));
    let ensemble = EnsembleSettings {
        chains: 4,
        threads: 1,
        bootstrap_samples: 4096,
        ..EnsembleSettings::default()
    };
    let listen = format!("{address}:0").parse().expect("an address");
    let options = DaemonOptions { listen, ensemble, ..DaemonOptions::default() };
    Daemon::start(scene, &options).expect("a free port")
}

#[tokio::test(flavor = "multi_thread", worker_threads = 1)]
async fn a_pulled_cable_is_noticed_and_mended() {
    let Some(cable) = Cable::lay() else {
        tests::skip("network namespaces cannot be made here");
        return;
    };
    let daemon = start(&cable.near);
    let address = daemon.address().to_string();
    let mut far = cable.viewer(&address);
    let lines = listen(&mut far.0);
    let drives = format!("connected as {:?} with {FILTER}", Role::Driver);
    hear(&lines, &drives);

    let greeting = Greeting { name: "witness".to_owned(), ..Greeting::default() };
    let mut witness = Session::open(&Peer::open(address), greeting).await.expect("welcome");
    let is_driver =
        |presence: &Presence| presence.driver().is_some_and(|driver| driver.author.name == "far");
    see(&mut witness, is_driver).await;

    cable.plug(false);
    let pulled = Instant::now();
    // The lease of whoever is gone is free for others.
    see(&mut witness, |presence| presence.viewers.len() == 1).await;
    let noticed = pulled.elapsed();
    hear(&lines, "disconnected");
    let line = format!("a pulled cable was noticed after {:.1} s", noticed.as_secs_f64());
    writeln!(stdout(), "{line}").expect("standard output");

    cable.plug(true);
    see(&mut witness, is_driver).await;
    hear(&lines, &drives);
    drop(far);
    see(&mut witness, |presence| presence.viewers.len() == 1).await;
    let ask = proto::NumberedOrder { request: 1, order: Some(Order::Lease(LeaseRequest::Ask)) };
    assert!(witness.say(proto::ViewerEvent::Order(ask)), "there is room");
    see(&mut witness, |presence| presence.driver().is_some()).await;
    let stopping = tokio::task::spawn_blocking(move || daemon.stop());
    tokio::time::timeout(PATIENCE, stopping).await.expect("stops in time").expect("no panic");
}
