//! A daemon in daily use, in short: viewers that drive, watch, stall, are cut off and come back.
//!
//! `LVIS_SOAK_SECONDS` makes it last longer than `./check` has time for.

use std::io::Write as _;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::{Duration, Instant};

use common::{
    ChainCommand, ExplorerCommand, FilterText, FocusOutcome, FocusPath, Notice, Order, Role, Seed,
    SkipTo, StrategyId, TracerEvent,
};
use proto::{NumberedOrder, ViewerEvent, WantedFilter};
use tokio::task::JoinSet;
use tokio_util::task::TaskTracker;
use viewer_client::source::connection::{Greeting, Peer, Session};

use crate::daemon::{PATIENCE, start_keeping};

/// How long it lasts when nobody says otherwise.
const SECONDS: u64 = 8;
/// Growth of resident memory from one half to the other that is none: the allocator's own ways.
const FLAT: u64 = 24 << 20;
/// What the daemon may keep of what was shown, in bytes.
///
/// So little that it is full early in the first half, and that filling it is no growth. With a daemon's
/// usual budget, which takes minutes to fill, nobody could tell.
const ARCHIVE: usize = 1 << 20;

/// A viewer that follows the explorer, and what it has seen.
#[derive(Default)]
struct Follower {
    path: Option<FocusPath>,
    steps: u64,
    accepted: u64,
    /// Steps and acceptances of the explorer's present epoch.
    of_epoch: (u32, u64, u64),
    told: (u64, u64),
}

impl Follower {
    fn hear(&mut self, event: &TracerEvent) {
        match event {
            TracerEvent::FocusPath(path) => {
                self.of_epoch = (path.header.id.epoch, 0, 0);
                self.path = Some(FocusPath::clone(path));
            }
            TracerEvent::FocusStep(step) => {
                let path = self.path.take().expect("a whole path comes first");
                self.path = Some(path.after(step).expect("no step is missing"));
                self.steps += 1;
                if !step.fan {
                    let accepted = u64::from(step.outcome == FocusOutcome::Accepted);
                    self.accepted += accepted;
                    let (epoch, steps, before) = self.of_epoch;
                    self.of_epoch = (epoch, steps + 1, before + accepted);
                }
            }
            TracerEvent::FocusGap(steps) => panic!("a viewer that reads misses {steps} steps"),
            TracerEvent::Notice(Notice::Explorer(state)) => {
                self.told = (state.steps, state.accepted);
            }
            _ => {}
        }
    }
}

async fn join(address: &str, name: &str, role: Role, focus: bool, resume: String) -> Session {
    let peer = Peer::open(address.to_owned());
    let greeting = Greeting { name: name.to_owned(), role, focus, resume, filter: None };
    let opened = tokio::time::timeout(PATIENCE, Session::open(&peer, greeting)).await;
    opened.expect("an answer").expect("welcome")
}

/// Drives: seeds, steps, skips, fans, plays, and now and then changes the chains.
async fn drive(address: String, until: Instant) -> Follower {
    let mut session = join(&address, "driver", Role::Driver, true, String::new()).await;
    let mut seen = Follower::default();
    let mut seeded = false;
    for round in 0_u32.. {
        let command = match round % 8 {
            0 | 5 if seeded && round % 3 > 0 => ExplorerCommand::Skip(SkipTo::Acceptance),
            0 => ExplorerCommand::Seed(Seed::Newest),
            1 => ExplorerCommand::Step(500),
            2 => ExplorerCommand::Fan { strategy: StrategyId((round % 3) as u8), count: 200 },
            3 => ExplorerCommand::Play(2000.0),
            4 => ExplorerCommand::Pause,
            _ => ExplorerCommand::Play(300.0),
        };
        let weight = 0.1 + f64::from(round % 5);
        let order = match round % 11 {
            10 => Order::Chains(ChainCommand::SetWeight { strategy: StrategyId(0), weight }),
            7 => Order::Chains(ChainCommand::Pause),
            8 => Order::Chains(ChainCommand::Resume),
            _ => Order::Explorer(command),
        };
        let order = ViewerEvent::Order(NumberedOrder { request: round, order: Some(order) });
        assert!(session.say(order), "the daemon listens");
        let pause = Instant::now() + Duration::from_millis(40);
        while Instant::now() < pause {
            let Ok(event) = tokio::time::timeout_at(pause.into(), session.next()).await else {
                break;
            };
            let event = event.expect("the driver is never cut off");
            seen.hear(&event);
            seeded = seen.path.is_some();
        }
        if Instant::now() >= until {
            break;
        }
    }
    let pause = Order::Explorer(ExplorerCommand::Pause);
    let pause = ViewerEvent::Order(NumberedOrder { request: u32::MAX, order: Some(pause) });
    assert!(session.say(pause), "the daemon listens");
    settle(&mut session, &mut seen).await;
    seen
}

/// Hears until nothing of the explorer has come for a while.
async fn settle(session: &mut Session, seen: &mut Follower) {
    let quiet = Duration::from_millis(1500);
    let mut last = Instant::now();
    while last.elapsed() < quiet {
        let event = tokio::time::timeout(PATIENCE, session.next()).await.expect("statistics come");
        let event = event.expect("still connected");
        let concerns = matches!(event, TracerEvent::FocusStep(_) | TracerEvent::FocusPath(_));
        seen.hear(&event);
        if concerns {
            last = Instant::now();
        }
    }
}

async fn follow_explorer(address: String, over: Arc<AtomicBool>) -> Follower {
    let mut session = join(&address, "follower", Role::Observer, true, String::new()).await;
    let mut seen = Follower::default();
    while !over.load(Ordering::Relaxed) {
        seen.hear(&session.next().await.expect("a reading viewer is never cut off"));
    }
    settle(&mut session, &mut seen).await;
    seen
}

/// Comes, changes its filter, reads a little, is cut off without a word, and comes back to what it had.
async fn churn(address: String, over: Arc<AtomicBool>, number: u32) -> u64 {
    let mut resume = String::new();
    let mut returns = 0;
    let texts = ["edges >= 3", "any is specular", "false", "film in rect(0, 0, 0.5, 0.5)"];
    for round in number.. {
        if over.load(Ordering::Relaxed) {
            break;
        }
        let focus = round % 2 == 0;
        let came_back = !resume.is_empty();
        let mut session = join(&address, "churner", Role::Observer, focus, resume.clone()).await;
        let text = texts[round as usize % texts.len()].to_owned();
        let mut filtered = false;
        let leaves = Instant::now() + Duration::from_millis(400);
        while let Ok(event) = tokio::time::timeout_at(leaves.into(), session.next()).await {
            match event.expect("a reading viewer is not cut off") {
                TracerEvent::Welcome(welcome) => resume = welcome.resume,
                TracerEvent::FilterReply(reply) => {
                    assert!(reply.error.is_none(), "{reply:?}");
                    filtered = true;
                }
                TracerEvent::SnapshotEnd => {
                    assert!(filtered || !came_back, "it comes back to its filter");
                    returns += u64::from(came_back);
                    let filter = WantedFilter {
                        revision: round + 1,
                        filter: FilterText::read(text.as_str()),
                    };
                    assert!(session.say(ViewerEvent::SetFilter(filter)), "the daemon listens");
                }
                _ => {}
            }
        }
        if round % 3 == 0 {
            // It stalls for a while before it is cut off.
            tokio::time::sleep(Duration::from_millis(150)).await;
        }
        drop(session);
    }
    returns
}

/// Comes and never reads.
async fn stall(address: String, over: Arc<AtomicBool>) {
    while !over.load(Ordering::Relaxed) {
        let session = join(&address, "stalled", Role::Observer, true, String::new()).await;
        let leaves = Instant::now() + Duration::from_secs(3);
        while Instant::now() < leaves && !over.load(Ordering::Relaxed) {
            tokio::time::sleep(Duration::from_millis(50)).await;
        }
        drop(session);
    }
}

/// The largest resident memory that was reported in each half.
async fn weigh(address: String, over: Arc<AtomicBool>, half: Instant) -> (u64, u64) {
    let mut session = join(&address, "scales", Role::Observer, false, String::new()).await;
    let (first, second) = (AtomicU64::new(0), AtomicU64::new(0));
    while !over.load(Ordering::Relaxed) {
        if let TracerEvent::Statistics(statistics) = session.next().await.expect("connected") {
            let place = if Instant::now() < half { &first } else { &second };
            place.fetch_max(statistics.memory_bytes, Ordering::Relaxed);
        }
    }
    (first.into_inner(), second.into_inner())
}

#[tokio::test(flavor = "multi_thread", worker_threads = 2)]
async fn a_daemon_in_daily_use_loses_nothing_and_does_not_grow() {
    let seconds = std::env::var("LVIS_SOAK_SECONDS").ok().and_then(|text| text.parse().ok());
    let lasts = Duration::from_secs(seconds.unwrap_or(SECONDS));
    let daemon = start_keeping(ARCHIVE);
    let address = daemon.address().to_string();
    let over = Arc::new(AtomicBool::new(false));
    let began = Instant::now();
    let (half, end) = (began + lasts / 2, began + lasts);

    let tasks = TaskTracker::new();
    let scales = tasks.spawn(weigh(address.clone(), Arc::clone(&over), half));
    let driving = tasks.spawn(drive(address.clone(), end));
    let following = tasks.spawn(follow_explorer(address.clone(), Arc::clone(&over)));
    let (mut stalled, mut churning) = (JoinSet::new(), JoinSet::new());
    for number in 0..4 {
        stalled.spawn(stall(address.clone(), Arc::clone(&over)));
        churning.spawn(churn(address.clone(), Arc::clone(&over), number));
    }
    let driver = driving.await.expect("the driver sees no wrong");
    over.store(true, Ordering::Relaxed);
    let follower = following.await.expect("the follower sees no wrong");
    let returns: u64 = churning.join_all().await.into_iter().sum();
    stalled.join_all().await;
    let (first, second) = scales.await.expect("no panic");

    let summary = format!(
        "{} steps of the explorer, {} accepted; {returns} returns; {} MiB, then {} MiB\n",
        driver.steps,
        driver.accepted,
        first >> 20,
        second >> 20
    );
    std::io::stdout().write_all(summary.as_bytes()).expect("standard output");
    assert!(driver.steps > 500 && driver.accepted > 50, "{} steps were seen", driver.steps);
    assert_eq!(follower.path, driver.path, "both stand where the explorer stands");
    let (_, steps, accepted) = driver.of_epoch;
    assert_eq!(
        (steps, accepted),
        driver.told,
        "every step of the last epoch, by the daemon's count"
    );
    assert!(returns > 4, "viewers came back {returns} times");
    assert!(first > 0 && second > 0, "memory is reported in both halves");
    assert!(second < first + FLAT, "{first} bytes grew to {second}");
    let stopping = tokio::task::spawn_blocking(move || daemon.stop());
    tokio::time::timeout(PATIENCE, stopping).await.expect("stops in time").expect("no panic");
}
