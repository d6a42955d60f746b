//! Replicates on many threads.

use std::cell::Cell;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use super::{Ledger, Outcome, Plan, Replicate, Row, Selection, Share};
use crate::chain::ChainStatistics;
use crate::film::Film;
use crate::parallel::{self, Stop};
use crate::scene::{Scene, Tracer};

/// How long a part may still take when the work is to stop.
const PATIENCE: Duration = Duration::from_secs(1);

/// A picture of replicates, finished or not.
#[derive(Clone, Debug)]
pub struct Picture {
    /// Whole replicates.
    pub ledger: Ledger,
    /// Replicates that time has cut, by number: part of the picture, but of no spread.
    pub tails: Vec<Tail>,
    /// What the chains did.
    pub statistics: ChainStatistics,
}

/// A replicate that time has cut.
#[derive(Clone, Debug)]
pub struct Tail {
    /// How much of it is done.
    pub share: Share,
    /// What is told of it.
    pub row: Row,
    /// Its picture so far, in film units of the scene.
    pub film: Film,
}

/// How far the work has come.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Advance {
    /// Replicates that are done, those under way counted by their parts.
    pub replicates: f64,
    /// Seconds since the work began.
    pub seconds: f64,
}

/// What ends the work before the selection does.
#[derive(Debug)]
pub struct Limits<'a> {
    /// No part is begun that would end later than this by more than it would end earlier without.
    pub deadline: Option<Instant>,
    /// Somebody wants it to end now.
    pub stop: &'a Stop,
    /// Worker threads.
    pub threads: usize,
}

impl Picture {
    /// No replicate yet.
    pub fn new(scene: &Scene, plan: &Plan) -> Self {
        let camera = scene.camera();
        Self {
            ledger: Ledger::new(camera.width, camera.height, plan.quantum()),
            tails: Vec::new(),
            statistics: ChainStatistics::new(plan.kernel.mixture.len()),
        }
    }

    /// What is in it.
    pub fn selection(&self) -> Selection {
        let mut selection = Selection::of(self.ledger.rows().iter().map(|row| row.number));
        selection.tails.extend(self.tails.iter().map(|tail| (tail.row.number, tail.share.parts)));
        selection
    }

    /// The mean of its replicates, in which those that time has cut weigh by what was done of them; in
    /// film units of the scene. Black without any.
    pub fn image(&self) -> Film {
        let mut image = self.ledger.sum();
        let mut weight = self.ledger.count() as f64;
        for tail in &self.tails {
            let share = tail.share.get();
            image.add_scaled(&tail.film, share);
            weight += share;
        }
        image.scale(if weight > 0.0 { 1.0 / weight } else { 0.0 });
        image
    }

    /// What is told of all replicates, those that time has cut included.
    pub fn rows(&self) -> impl Iterator<Item = &Row> {
        self.ledger.rows().iter().chain(self.tails.iter().map(|tail| &tail.row))
    }

    fn take(&mut self, outcome: Outcome) -> Option<Film> {
        let Outcome { share, film, row, statistics } = outcome;
        self.statistics.add(&statistics);
        if share.is_whole() {
            self.ledger.add(row, &film);
            return Some(film);
        }
        self.tails.push(Tail { share, row, film });
        self.tails.sort_by_key(|tail| tail.row.number);
        None
    }

    /// Works on the replicates of `selection` that are not in yet. `on_advance` hears of every part,
    /// and sees the picture when a replicate is done.
    pub fn work(
        &mut self,
        scene: &Scene,
        plan: &Plan,
        selection: &Selection,
        limits: &Limits<'_>,
        on_advance: &mut (dyn FnMut(Advance, Option<&Self>) + Send),
    ) {
        let begun = Instant::now();
        let rows: Vec<u64> = self.ledger.rows().iter().map(|row| row.number).collect();
        let is_missing = |number: &u64| rows.binary_search(number).is_err();
        let whole = selection.numbers().filter(is_missing).map(|number| (number, plan.parts));
        let tails = selection.tails.iter().map(|&(number, parts)| (number, parts.min(plan.parts)));
        let done = self.ledger.count() as f64;
        let over = AtomicBool::new(false);
        let is_on = |_: &(u64, u32)| !over.load(Ordering::Relaxed);
        let order = |(place, (number, parts))| Order { place, number, parts };
        let shared = Mutex::new(Shared { picture: self, on_advance, done, begun });
        parallel::for_each(
            limits.threads,
            (0..).zip(whole.chain(tails).take_while(is_on)).map(order),
            || Worker::new(scene, limits, &over),
            |worker, order| worker.work(plan, order, &shared),
        );
    }
}

/// One replicate to be made.
#[derive(Clone, Copy, Debug)]
struct Order {
    /// Its place among those that are to be made.
    place: u64,
    number: u64,
    /// The parts that are wanted of it.
    parts: u32,
}

/// What the workers share.
struct Shared<'a> {
    picture: &'a mut Picture,
    on_advance: &'a mut (dyn FnMut(Advance, Option<&Picture>) + Send),
    done: f64,
    begun: Instant,
}

impl Shared<'_> {
    fn advance(&mut self, replicates: f64, is_whole: bool) {
        self.done += replicates;
        let advance =
            Advance { replicates: self.done, seconds: self.begun.elapsed().as_secs_f64() };
        (self.on_advance)(advance, is_whole.then_some(&*self.picture));
    }
}

/// One thread's hands.
struct Worker<'a, 's> {
    scene: Tracer<'s>,
    limits: &'a Limits<'a>,
    film: Option<Film>,
    /// How long the last pool and the last part took.
    pool: Duration,
    part: Duration,
    /// Time is over, or somebody has stopped the work: no other replicate is begun.
    over: &'a AtomicBool,
}

impl<'a, 's> Worker<'a, 's> {
    fn new(scene: &'s Scene, limits: &'a Limits<'a>, over: &'a AtomicBool) -> Self {
        let (pool, part) = (Duration::ZERO, Duration::ZERO);
        Self { scene: Tracer::new(scene), limits, film: None, pool, part, over }
    }

    /// True when what takes `time` would end later than the deadline by more than it would end earlier
    /// without.
    fn is_late(&self, time: Duration) -> bool {
        self.limits.deadline.is_some_and(|deadline| Instant::now() + time / 2 > deadline)
    }

    fn work(&mut self, plan: &Plan, order: Order, shared: &Mutex<Shared<'_>>) {
        let Order { place, number, parts } = order;
        // The first replicate is always begun: there is to be a picture.
        let late = place > 0 && self.is_late(self.pool + self.part);
        if self.limits.stop.is_set() || late {
            self.over.store(true, Ordering::Relaxed);
            return;
        }
        let camera = self.scene.camera();
        let film = self.film.take().unwrap_or_else(|| Film::new(camera.width, camera.height));
        let begun = Instant::now();
        let mut replicate = Replicate::begin(&self.scene, plan, number, film);
        let (pool, mut part) = (begun.elapsed(), self.part);
        // A part that is soon done is worth waiting for.
        let told = Cell::new(None::<Instant>);
        let stop = || {
            if self.limits.stop.is_set() && told.get().is_none() {
                told.set(Some(Instant::now()));
            }
            told.get().is_some_and(|at| at.elapsed() > PATIENCE)
        };
        while replicate.parts() < parts {
            let is_over = self.limits.stop.is_set() || self.is_late(part);
            if replicate.parts() > 0 && is_over {
                self.over.store(true, Ordering::Relaxed);
                break;
            }
            let begun = Instant::now();
            if !replicate.part(&stop) {
                self.over.store(true, Ordering::Relaxed);
                return;
            }
            part = begun.elapsed();
            lock(shared).advance(1.0 / f64::from(plan.parts), false);
        }
        let outcome = replicate.finish();
        let is_whole = outcome.share.is_whole();
        let mut shared = lock(shared);
        self.film = shared.picture.take(outcome);
        shared.advance(0.0, is_whole);
        drop(shared);
        (self.pool, self.part) = (pool, part);
    }
}

fn lock<'m, 'a>(shared: &'m Mutex<Shared<'a>>) -> std::sync::MutexGuard<'m, Shared<'a>> {
    shared.lock().unwrap_or_else(PoisonError::into_inner)
}
