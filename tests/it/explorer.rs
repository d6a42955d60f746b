//! The explorer of a real daemon, driven and watched over the network.

use std::sync::Arc;
use std::time::{Duration, Instant};

use common::{
    ChainCommand, ChainState, ExplorerCommand, ExplorerState, FocusOutcome, FocusPath, FocusStep,
    Notice, Order, OrderReply, Pace, PathHeader, PathId, Role, Seed, SkipTo, StrategyId,
    StrategySet, TracerEvent, VertexRecord,
};
use proto::{NumberedOrder, ViewerEvent};
use tracer_server::daemon::Daemon;
use viewer_client::source::connection::{Greeting, Peer, Session};

use crate::daemon::{PATIENCE, start};

/// A viewer with everything that it was told.
struct Visitor {
    session: Session,
    strategies: Vec<String>,
    role: Role,
    requests: u32,
    path: Option<FocusPath>,
    steps: Vec<FocusStep>,
    explorer: ExplorerState,
    chains: ChainState,
    picked: Option<(PathHeader, Vec<VertexRecord>)>,
}

impl Visitor {
    async fn join(daemon: &Daemon, role: Role) -> Self {
        let peer = Peer::open(daemon.address().to_string());
        let greeting = Greeting { role, focus: true, ..Greeting::default() };
        let mut session = Session::open(&peer, greeting).await.expect("welcome");
        let TracerEvent::Welcome(welcome) = session.next().await.expect("a welcome") else {
            panic!("the welcome comes first");
        };
        Self {
            session,
            strategies: welcome.strategies,
            role: welcome.role,
            requests: 0,
            path: None,
            steps: Vec::new(),
            explorer: ExplorerState::default(),
            chains: ChainState::default(),
            picked: None,
        }
    }

    /// Hears until `done`; returns the replies that came meanwhile.
    async fn until(&mut self, what: &str, done: impl Fn(&Self) -> bool) -> Vec<OrderReply> {
        let mut replies = Vec::new();
        let hearing = async {
            while !done(self) {
                let event = self.session.next().await.expect("still connected");
                replies.extend(self.hear(event));
            }
        };
        tokio::time::timeout(PATIENCE, hearing).await.unwrap_or_else(|_| panic!("no {what}"));
        replies
    }

    fn hear(&mut self, event: TracerEvent) -> Option<OrderReply> {
        match event {
            TracerEvent::FocusPath(path) => self.path = Some(Arc::unwrap_or_clone(path)),
            TracerEvent::FocusStep(step) => {
                let path = self.path.take().expect("a whole path comes first");
                self.path = Some(path.after(&step).expect("no step is missing"));
                self.steps.push(Arc::unwrap_or_clone(step));
            }
            TracerEvent::FocusGap(steps) => panic!("{steps} steps were dropped"),
            TracerEvent::Notice(Notice::Explorer(state)) => self.explorer = state,
            TracerEvent::Notice(Notice::Chains(state)) => self.chains = state,
            TracerEvent::Notice(Notice::Reply(reply)) => return Some(reply),
            TracerEvent::Paths(batch) => {
                let mut reader = batch.reader();
                while let Some(view) = reader.next() {
                    self.picked = Some((view.header, view.vertices.to_vec()));
                }
            }
            _ => {}
        }
        None
    }

    /// Gives an order, and waits for its reply and for all that it has led to.
    async fn order(&mut self, order: Order) -> Result<(), String> {
        self.requests += 1;
        let request = self.requests;
        let message = ViewerEvent::Order(NumberedOrder { request, order: Some(order) });
        assert!(self.session.say(message), "there is room");
        let reply = async {
            loop {
                let event = self.session.next().await.expect("still connected");
                if let Some(reply) = self.hear(event)
                    && reply.request == request
                {
                    break reply;
                }
            }
        };
        let reply = tokio::time::timeout(PATIENCE, reply).await.expect("a reply");
        let caught_up = |v: &Self| {
            let seen = v.path.as_ref().map_or(0, |path| path.next);
            v.explorer.current.is_none()
                || v.explorer.pace == Pace::Playing
                || (v.explorer.pace == Pace::Paused && seen >= v.explorer.next)
        };
        self.until("end of the order", caught_up).await;
        reply.error.map_or(Ok(()), Err)
    }

    async fn explore(&mut self, command: ExplorerCommand) -> Result<(), String> {
        self.order(Order::Explorer(command)).await
    }
}

async fn stop(daemon: Daemon) {
    let stopping = tokio::task::spawn_blocking(move || daemon.stop());
    tokio::time::timeout(PATIENCE, stopping).await.expect("stops in time").expect("no panic");
}

#[tokio::test]
async fn a_picked_path_is_explored_step_by_step_and_everyone_sees_it() {
    let daemon = start();
    let mut driver = Visitor::join(&daemon, Role::Driver).await;
    let mut observer = Visitor::join(&daemon, Role::Observer).await;
    assert_eq!((driver.role, observer.role), (Role::Driver, Role::Observer));
    let early = driver.explore(ExplorerCommand::Step(1)).await.expect_err("nothing to step from");
    assert!(early.contains("seed"), "says what to do: {early}");

    driver.until("paths", |v| v.picked.is_some()).await;
    let (header, vertices) = driver.picked.clone().expect("a path");
    driver.explore(ExplorerCommand::Seed(Seed::Path(header.id))).await.expect("it is kept");
    let path = driver.path.clone().expect("the path");
    assert_eq!(path.vertices, vertices, "the very path that was picked");
    assert_eq!(path.header.film, header.film);
    driver.explore(ExplorerCommand::Step(1)).await.expect("a step");
    assert_eq!(driver.steps.len(), 1, "a single step");

    driver.explore(ExplorerCommand::Step(400)).await.expect("steps");
    driver.explore(ExplorerCommand::Skip(SkipTo::Acceptance)).await.expect("a skip");
    let last = driver.steps.last().expect("a step");
    assert_eq!(last.outcome, FocusOutcome::Accepted, "it stands where it was accepted");
    let strategy = StrategyId(driver.strategies.len() as u8 - 1);
    driver.explore(ExplorerCommand::Skip(SkipTo::Strategy(strategy))).await.expect("a skip");
    assert_eq!(driver.steps.last().map(|step| step.strategy), Some(strategy));

    let (before, told) = (driver.path.clone().expect("a path"), driver.steps.len());
    driver.explore(ExplorerCommand::Fan { strategy, count: 50 }).await.expect("a fan");
    assert_eq!(driver.steps.len(), told + 50, "all proposals");
    assert!(driver.steps[told..].iter().all(|step| step.fan && step.strategy == strategy));
    let after = driver.path.clone().expect("a path");
    assert_eq!((after.vertices, after.header), (before.vertices, before.header), "it stands");

    // The observer has seen the same, and steers nothing.
    let next = driver.explorer.next;
    observer.until("the same steps", |v| v.path.as_ref().is_some_and(|p| p.next == next)).await;
    assert_eq!(observer.steps, driver.steps);
    assert_eq!(observer.path, driver.path);
    assert!(observer.explore(ExplorerCommand::Pause).await.is_err(), "it only looks");

    // A late one is shown where the explorer is.
    let came = Instant::now();
    let mut late = Visitor::join(&daemon, Role::Observer).await;
    late.until("the current path", |v| v.path.is_some() && v.explorer.current.is_some()).await;
    assert!(came.elapsed() < Duration::from_secs(1), "a snapshot took {:?}", came.elapsed());
    assert_eq!(late.path, driver.path);
    assert_eq!(late.explorer, driver.explorer);
    stop(daemon).await;
}

#[tokio::test]
async fn the_explorer_plays_rests_and_minds_its_limits() {
    let daemon = start();
    let mut driver = Visitor::join(&daemon, Role::Driver).await;
    driver.until("paths", |v| v.picked.is_some()).await;
    let gone = PathId { step: u64::MAX, ..PathId::default() };
    let refusal = driver.explore(ExplorerCommand::Seed(Seed::Path(gone))).await;
    assert!(refusal.is_err_and(|why| why.contains("there is no path")), "says so");
    driver.explore(ExplorerCommand::Seed(Seed::Newest)).await.expect("something was shown");
    let none = driver.explore(ExplorerCommand::Allow(StrategySet(0))).await;
    assert!(none.is_err(), "at least one must act");
    let strange = ExplorerCommand::Fan { strategy: StrategyId(60), count: 1 };
    assert!(driver.explore(strange).await.is_err_and(|why| why.contains("bidirectional")));

    driver.explore(ExplorerCommand::Allow(StrategySet(1))).await.expect("one may act");
    driver.explore(ExplorerCommand::Play(500.0)).await.expect("it plays");
    driver.until("two hundred steps", |v| v.steps.len() >= 200).await;
    driver.explore(ExplorerCommand::Pause).await.expect("it stands");
    assert!(driver.steps.iter().all(|step| step.strategy == StrategyId(0)), "one strategy only");
    assert_eq!(driver.explorer.pace, Pace::Paused);
    let (steps, next) = (driver.explorer.steps, driver.explorer.next);
    assert_eq!(steps, driver.steps.len() as u64, "every step was told");
    driver.order(Order::Chains(ChainCommand::Pause)).await.expect("an order in between");
    assert_eq!(driver.explorer.next, next, "it rests");
    stop(daemon).await;
}

#[tokio::test]
async fn the_driver_changes_the_chains_and_everyone_hears_it() {
    let daemon = start();
    let mut driver = Visitor::join(&daemon, Role::Driver).await;
    let mut observer = Visitor::join(&daemon, Role::Observer).await;
    observer.until("paths", |v| v.picked.is_some()).await;
    assert!(observer.chains.running && observer.chains.epoch == 0, "{:?}", observer.chains);

    let strategy = StrategyId(1);
    let change = ChainCommand::SetWeight { strategy, weight: 2.5 };
    driver.order(Order::Chains(change)).await.expect("a weight");
    observer.until("the new epoch", |v| v.chains.epoch == 1).await;
    assert_eq!(observer.chains.weights[1], 2.5);
    assert!(observer.chains.by.is_some() && observer.chains.change.contains("independent"));
    observer.until("its paths", |v| v.picked.as_ref().is_some_and(|p| p.0.id.epoch == 1)).await;
    let bad = ChainCommand::SetWeight { strategy: StrategyId(63), weight: 1.0 };
    assert!(driver.order(Order::Chains(bad)).await.is_err(), "no such strategy");

    driver.order(Order::Chains(ChainCommand::Restart { seed: 99 })).await.expect("a restart");
    observer.until("the restart", |v| v.chains.seed == 99 && v.chains.running).await;
    observer.until("its paths", |v| v.picked.as_ref().is_some_and(|p| p.0.id.epoch == 2)).await;
    driver.order(Order::Chains(ChainCommand::SetPrecision(0.05))).await.expect("a precision");
    observer.until("the precision", |v| v.chains.precision == 0.05 && v.chains.running).await;

    driver.order(Order::Chains(ChainCommand::Pause)).await.expect("a pause");
    observer.until("the pause", |v| !v.chains.running && v.chains.change.contains("pause")).await;
    let late = async {
        let mut late = Visitor::join(&daemon, Role::Observer).await;
        late.until("what is", |v| v.chains.epoch > 0).await;
        late.chains
    };
    assert_eq!(late.await, observer.chains, "who comes late knows too");
    driver.order(Order::Chains(ChainCommand::Resume)).await.expect("an end of it");
    observer.picked = None;
    observer.until("paths again", |v| v.chains.running && v.picked.is_some()).await;
    stop(daemon).await;
}
