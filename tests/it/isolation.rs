//! What viewers cost the chains, and what they get: figures, measured on request.
//!
//! `cargo test -p tests --test it -- --ignored --nocapture isolation`

use std::io::{Write as _, stdout};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::{Duration, Instant};

use common::{ExplorerCommand, Order, Role, Seed, Statistics};
use proto::{NumberedOrder, TracerEvent, ViewerEvent};
use tokio::task::JoinSet;
use tracer_server::chain::EnsembleSettings;
use tracer_server::daemon::{Daemon, DaemonOptions};
use tracer_server::scene::Scene;
use tracer_server::scene::load::load;
use viewer_client::connection::{Greeting, Peer, Session};

/// Viewers, and how many of them never read.
const CROWDS: [(usize, usize); 4] = [(0, 0), (1, 0), (4, 1), (15, 4)];
/// Every crowd is measured this often, in turns, so that what else the machine does hits all alike.
const ROUNDS: usize = 8;
/// How long each time.
const LASTS: Duration = Duration::from_millis(2500);

fn start() -> Daemon {
    let description = load("caustic").expect("a built-in scene").description;
    let scene = Arc::new(Scene::new(&description).expect("a sound scene"));
    // One thread leaves a processor to the network.
    let ensemble = EnsembleSettings { threads: 1, ..EnsembleSettings::default() };
    let listen = "127.0.0.1:0".parse().expect("an address");
    let options = DaemonOptions { listen, ensemble, ..DaemonOptions::default() };
    Daemon::start(scene, &options).expect("a free port")
}

async fn join(address: &str, greeting: Greeting) -> Session {
    Session::open(&Peer::open(address.to_owned()), greeting).await.expect("welcome")
}

/// The newest statistics, and how long the whole snapshot took.
async fn look(address: &str) -> (Statistics, Duration) {
    let came = Instant::now();
    let mut session = join(address, Greeting::default()).await;
    let mut found = Statistics::default();
    loop {
        match session.next().await.expect("connected") {
            TracerEvent::Statistics(statistics) => found = statistics,
            TracerEvent::SnapshotEnd => return (found, came.elapsed()),
            _ => {}
        }
    }
}

/// What reading viewers got.
#[derive(Default)]
struct Received {
    paths: AtomicU64,
    bytes: AtomicU64,
    /// Bytes that the same paths would take without differences.
    full_bytes: AtomicU64,
}

async fn read(address: String, over: Arc<AtomicBool>, received: Arc<Received>) {
    let mut session = join(&address, Greeting::default()).await;
    while !over.load(Ordering::Relaxed) {
        let event = tokio::time::timeout(Duration::from_secs(5), session.next()).await;
        if let TracerEvent::Paths(batch) = event.expect("statistics come").expect("connected") {
            let mut reader = batch.reader();
            let mut full = 0;
            while let Some(path) = reader.next() {
                full += 60 + 24 * path.vertices.len() as u64;
            }
            received.paths.fetch_add(batch.len() as u64, Ordering::Relaxed);
            received.bytes.fetch_add(batch.byte_len() as u64, Ordering::Relaxed);
            received.full_bytes.fetch_add(full, Ordering::Relaxed);
        }
    }
}

/// Processor time of the thread that runs the chains, in nanoseconds, where the system tells.
fn chain_time() -> Option<u64> {
    for task in std::fs::read_dir("/proc/self/task").ok()?.flatten() {
        let file = |name| std::fs::read_to_string(task.path().join(name)).unwrap_or_default();
        if file("comm").trim() == "lvis-engine" {
            return file("schedstat").split(' ').next()?.parse().ok();
        }
    }
    None
}

/// Mutations a second of wall clock and of the chains' own processor time.
async fn measure(address: &str, crowd: (usize, usize), received: &Arc<Received>) -> [f64; 2] {
    let over = Arc::new(AtomicBool::new(false));
    let mut stalled = Vec::new();
    for _ in 0..crowd.1 {
        stalled.push(join(address, Greeting { focus: true, ..Greeting::default() }).await);
    }
    let mut reading = JoinSet::new();
    for _ in crowd.1..crowd.0 {
        reading.spawn(read(address.to_owned(), Arc::clone(&over), Arc::clone(received)));
    }
    // Statistics are half a second old at most: they are read once they are from this time.
    tokio::time::sleep(Duration::from_millis(600)).await;
    let (before, _) = look(address).await;
    let cpu = chain_time();
    tokio::time::sleep(LASTS).await;
    let (after, _) = look(address).await;
    let cpu = chain_time().zip(cpu).map_or(f64::NAN, |(after, before)| (after - before) as f64);
    over.store(true, Ordering::Relaxed);
    reading.join_all().await;
    drop(stalled);
    let steps = (after.totals.steps - before.totals.steps) as f64;
    let seconds = after.elapsed_seconds - before.elapsed_seconds;
    [steps / seconds, steps / (cpu / 1e9 * seconds / LASTS.as_secs_f64())]
}

/// Times from picking a path to its first proposal, in seconds.
async fn pick(address: &str, times: usize) -> Vec<f64> {
    let mut session =
        join(address, Greeting { role: Role::Driver, focus: true, ..Greeting::default() }).await;
    let mut took = Vec::new();
    while took.len() < times {
        let TracerEvent::Paths(batch) = session.next().await.expect("connected") else { continue };
        let Some(picked) = batch.headers().last() else { continue };
        let asked = Instant::now();
        for command in [ExplorerCommand::Seed(Seed::Path(picked.id)), ExplorerCommand::Step(1)] {
            let order = Some(Order::Explorer(command));
            assert!(session.say(ViewerEvent::Order(NumberedOrder { request: 1, order })), "room");
        }
        while !matches!(session.next().await.expect("connected"), TracerEvent::FocusStep(_)) {}
        took.push(asked.elapsed().as_secs_f64());
    }
    took
}

fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted.get(sorted.len() / 2).copied().unwrap_or(f64::NAN)
}

#[tokio::test(flavor = "multi_thread", worker_threads = 1)]
#[ignore = "takes a minute and wants a quiet machine"]
async fn viewers_cost_the_chains_little() {
    let daemon = start();
    let address = daemon.address().to_string();
    while look(&address).await.0.totals.steps == 0 {
        tokio::time::sleep(Duration::from_millis(100)).await;
    }
    let received: Vec<Arc<Received>> = CROWDS.iter().map(|_| Arc::default()).collect();
    let mut rates = vec![[Vec::new(), Vec::new()]; CROWDS.len()];
    for _ in 0..ROUNDS {
        for ((crowd, rates), received) in CROWDS.iter().zip(&mut rates).zip(&received) {
            let [wall, cpu] = measure(&address, *crowd, received).await;
            rates[0].push(wall);
            rates[1].push(cpu);
        }
    }
    let mut out = stdout();
    let mut say = |line: String| writeln!(out, "{line}").expect("standard output");
    for ((crowd, rates_of), received) in CROWDS.iter().zip(&rates).zip(&received) {
        let loss = |kind: usize| {
            let pairs = rates_of[kind].iter().zip(&rates[0][kind]);
            100.0 * (1.0 - median(&pairs.map(|(with, without)| with / without).collect::<Vec<_>>()))
        };
        let paths = received.paths.load(Ordering::Relaxed) as f64;
        let each = (ROUNDS * (crowd.0 - crowd.1).max(1)) as f64 * (LASTS.as_secs_f64() + 0.7);
        say(format!(
            "{:>2} viewers, {} stalled: {:.0} mutations/s, {:+.2} % of the wall clock's, {:+.2} % of \
             the chains' own; {:.0} paths/s a viewer of {:.0} bytes, {:.0} without differences",
            crowd.0,
            crowd.1,
            median(&rates_of[0]),
            -loss(0),
            -loss(1),
            paths / each,
            received.bytes.load(Ordering::Relaxed) as f64 / paths,
            received.full_bytes.load(Ordering::Relaxed) as f64 / paths,
        ));
    }
    let mut joins = Vec::new();
    for _ in 0..20 {
        joins.push(look(&address).await.1.as_secs_f64());
    }
    let picks = pick(&address, 20).await;
    say(format!("joining takes {:.1} ms (median of 20)", 1e3 * median(&joins)));
    say(format!(
        "a picked path's first proposal takes {:.1} ms (median of 20)",
        1e3 * median(&picks)
    ));
    assert!(median(&joins) < 1.0, "a snapshot within a second");
    let stopping = tokio::task::spawn_blocking(move || daemon.stop());
    stopping.await.expect("no panic");
}
