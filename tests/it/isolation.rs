//! What viewers cost the chains, and what they get: figures, measured on request.
//!
//! `cargo test -p tests --test it -- --ignored --nocapture isolation`

use std::io::{Write as _, stdout};
use std::sync::Arc;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::{Duration, Instant};

use common::{ExplorerCommand, Order, Role, Seed, Statistics, TracerEvent};
use proto::{NumberedOrder, ViewerEvent};
use tokio::task::JoinSet;
use tracer_server::chain::EnsembleSettings;
use tracer_server::daemon::{Daemon, DaemonOptions};
use tracer_server::scene::Scene;
use tracer_server::scene::load::load;
use viewer_client::source::connection::{Greeting, Peer, Session};

/// Viewers, and how many of them never read.
const CROWDS: [(usize, usize); 4] = [(0, 0), (1, 0), (4, 1), (16, 4)];
/// Every crowd is measured this often, in turns, so that what else the machine does hits all alike,
/// when `LVIS_ISOLATION_ROUNDS` says nothing else.
const ROUNDS: usize = 16;
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
async fn statistics_of(address: &str) -> (Arc<Statistics>, Duration) {
    let came = Instant::now();
    let mut session = join(address, Greeting::default()).await;
    let mut found = Arc::<Statistics>::default();
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

/// Processor time of the thread that runs the chains, over time: in seconds, by seconds of the clock.
#[derive(Default)]
struct Log {
    readings: Mutex<Vec<(f64, f64)>>,
    /// When the chains' clock began, by ours: no statistics are heard of before they are made.
    zero: Mutex<Option<f64>>,
}

impl Log {
    /// Reads every two milliseconds, until it is over; what the system does not tell stays unknown.
    fn keep(&self, began: Instant, over: &AtomicBool) {
        let tasks = std::fs::read_dir("/proc/self/task").into_iter().flatten().flatten();
        let chains = tasks.map(|task| task.path()).find(|task| {
            std::fs::read_to_string(task.join("comm"))
                .is_ok_and(|name| name.trim() == "lvis-engine")
        });
        let Some(file) = chains.map(|task| task.join("schedstat")) else { return };
        while !over.load(Ordering::Relaxed) {
            let text = std::fs::read_to_string(&file).unwrap_or_default();
            let nanoseconds = text.split(' ').next().and_then(|first| first.parse().ok());
            let seconds = nanoseconds.map_or(f64::NAN, |n: u64| n as f64 / 1e9);
            let mut readings = self.readings.lock().expect("no panic");
            readings.push((began.elapsed().as_secs_f64(), seconds));
            drop(readings);
            std::thread::sleep(Duration::from_millis(2));
        }
    }

    /// Statistics were heard of now.
    fn hear(&self, began: Instant, statistics: &Statistics) {
        let zero = began.elapsed().as_secs_f64() - statistics.elapsed_seconds;
        let mut least = self.zero.lock().expect("no panic");
        *least = Some(least.map_or(zero, |least| least.min(zero)));
    }

    /// The processor time that the chains had had when the statistics were made.
    fn at(&self, statistics: &Statistics) -> f64 {
        let readings = self.readings.lock().expect("no panic");
        let when = self.zero.lock().expect("no panic").unwrap_or(0.0) + statistics.elapsed_seconds;
        let after = readings.partition_point(|reading| reading.0 < when);
        match (after.checked_sub(1).and_then(|i| readings.get(i)), readings.get(after)) {
            (Some(a), Some(b)) => a.1 + (b.1 - a.1) * (when - a.0) / (b.0 - a.0),
            _ => f64::NAN,
        }
    }
}

/// What the chains had done before and after a crowd was there for a while.
async fn measure(
    address: &str,
    crowd: (usize, usize),
    received: &Arc<Received>,
) -> [Statistics; 2] {
    let over = Arc::new(AtomicBool::new(false));
    let mut stalled = Vec::new();
    for _ in 0..crowd.1 {
        stalled.push(join(address, Greeting { focus: true, ..Greeting::default() }).await);
    }
    let mut reading = JoinSet::new();
    for _ in crowd.1..crowd.0 {
        reading.spawn(read(address.to_owned(), Arc::clone(&over), Arc::clone(received)));
    }
    // Statistics are half a second and a round of the chains old at most: they are read once they are
    // from this time.
    tokio::time::sleep(Duration::from_secs(1)).await;
    let (before, _) = statistics_of(address).await;
    tokio::time::sleep(LASTS).await;
    let (after, _) = statistics_of(address).await;
    over.store(true, Ordering::Relaxed);
    reading.join_all().await;
    drop(stalled);
    [before, after].map(Arc::unwrap_or_clone)
}

/// Mutations a second of wall clock and of the chains' own processor time.
fn rates([before, after]: &[Statistics; 2], log: &Log) -> [f64; 2] {
    let steps = (after.totals.steps - before.totals.steps) as f64;
    let seconds = after.elapsed_seconds - before.elapsed_seconds;
    [steps / seconds, steps / (log.at(after) - log.at(before))]
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

/// Mean of what the rates with viewers are to those without, in percent more, and its standard error.
fn compare(with: &[f64], without: &[f64]) -> (f64, f64) {
    let gains: Vec<f64> = with.iter().zip(without).map(|(a, b)| 100.0 * (a / b - 1.0)).collect();
    let count = gains.len() as f64;
    let mean = gains.iter().sum::<f64>() / count;
    let squares: f64 = gains.iter().map(|gain| (gain - mean).powi(2)).sum();
    (mean, (squares / (count * (count - 1.0))).sqrt())
}

#[tokio::test(flavor = "multi_thread", worker_threads = 1)]
#[ignore = "takes minutes and wants a quiet machine"]
async fn viewers_cost_the_chains_little() {
    let daemon = start();
    let address = daemon.address().to_string();
    while statistics_of(&address).await.0.totals.steps == 0 {
        tokio::time::sleep(Duration::from_millis(100)).await;
    }
    let received: Vec<Arc<Received>> = CROWDS.iter().map(|_| Arc::default()).collect();
    let rounds = std::env::var("LVIS_ISOLATION_ROUNDS").ok().and_then(|text| text.parse().ok());
    let rounds: usize = rounds.unwrap_or(ROUNDS);
    let (log, over, began) =
        (Arc::<Log>::default(), Arc::new(AtomicBool::new(false)), Instant::now());
    let logging = {
        let (log, over) = (Arc::clone(&log), Arc::clone(&over));
        let keep = move || log.keep(began, &over);
        std::thread::Builder::new().name("log".to_owned()).spawn(keep).expect("a thread")
    };
    let mut seen: Vec<Vec<[Statistics; 2]>> = vec![Vec::new(); CROWDS.len()];
    for round in 0..rounds {
        for place in 0..CROWDS.len() {
            // There and back, so that what drifts hits all alike.
            let i = if round % 2 == 0 { place } else { CROWDS.len() - 1 - place };
            seen[i].push(measure(&address, CROWDS[i], &received[i]).await);
            log.hear(began, &statistics_of(&address).await.0);
        }
    }
    over.store(true, Ordering::Relaxed);
    logging.join().expect("no panic");
    let rates: Vec<[Vec<f64>; 2]> = seen
        .iter()
        .map(|seen| [0, 1].map(|kind| seen.iter().map(|pair| rates(pair, &log)[kind]).collect()))
        .collect();
    let mut out = stdout();
    let mut say = |line: String| writeln!(out, "{line}").expect("standard output");
    for ((crowd, rates_of), received) in CROWDS.iter().zip(&rates).zip(&received) {
        let [wall, cpu] = [0, 1].map(|kind| compare(&rates_of[kind], &rates[0][kind]));
        let paths = received.paths.load(Ordering::Relaxed) as f64;
        let each = (rounds * (crowd.0 - crowd.1).max(1)) as f64 * (LASTS.as_secs_f64() + 0.7);
        say(format!(
            "{:>2} viewers, {} stalled: {:.0} mutations/s; by the clock {:+.2} +- {:.2} %, by the \
             chains' processor time {:+.2} +- {:.2} %; {:.0} paths/s a viewer of {:.0} bytes, {:.0} \
             without differences",
            crowd.0,
            crowd.1,
            median(&rates_of[0]),
            wall.0,
            wall.1,
            cpu.0,
            cpu.1,
            paths / each,
            received.bytes.load(Ordering::Relaxed) as f64 / paths,
            received.full_bytes.load(Ordering::Relaxed) as f64 / paths,
        ));
    }
    let mut joins = Vec::new();
    for _ in 0..20 {
        joins.push(statistics_of(&address).await.1.as_secs_f64());
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
