//! Laws of chains in primary-sample space: lazy coordinates are as good as eager ones, and a step
//! leaves the distribution that it should sample as it is.

use std::cell::RefCell;
use std::ops::Range;
use std::rc::Rc;

use common::Rgb;
use tests::Accumulator;

use super::{
    Balance, Draws, LazyPoint, Place, Point, PrimaryChain, PrimarySampler, Sample, Sampler,
    SceneSampler,
};
use crate::film::Film;
use crate::math::{Rng, Stream, TorusStep};
use crate::path::{Numbers, ROW, STRANDS, Strand};
use crate::scene::Scene;
use crate::scene::fixtures::{slab_over_floor, specular_room};

/// Which attempt each time stands for: the last proposal at that time is the one that was accepted.
#[derive(Clone, Debug, Default)]
struct Clock(Rc<RefCell<(Vec<u64>, u64)>>);

/// Random numbers that depend on place and attempt alone, whenever they are asked for.
impl Draws for Clock {
    fn draw(&mut self, place: Place, time: u64) -> f64 {
        let attempt = self.0.borrow().0.get(time as usize).copied().unwrap_or(0);
        let place = ((place.strand as u64) << 16) | ((place.row as u64) << 8) | place.index as u64;
        Rng::new(attempt, Stream::Laboratory, place).uniform()
    }
}

impl Clock {
    fn attempt(&self, time: u64) {
        let (attempts, last) = &mut *self.0.borrow_mut();
        attempts.resize(attempts.len().max(time as usize + 1), 0);
        *last += 1;
        attempts[time as usize] = *last;
    }
}

/// A point that tells the clock of every attempt.
struct Timed<P> {
    point: P,
    clock: Clock,
    time: u64,
}

impl<P: Point> Numbers for Timed<P> {
    fn row<const N: usize>(&mut self, strand: Strand, row: usize) -> [f64; N] {
        self.point.row(strand, row)
    }
}

impl<P: Point> Point for Timed<P> {
    fn propose(&mut self, large: bool) {
        self.clock.attempt(self.time);
        self.point.propose(large);
    }

    fn accept(&mut self) {
        self.time += 1;
        self.point.accept();
    }

    fn reject(&mut self) {
        self.point.reject();
    }
}

const ROWS: usize = 12;

/// All coordinates that a short path can ask for.
type Block = [[[f64; ROW]; ROWS]; STRANDS];

/// A point that moves every coordinate in every step.
struct EagerPoint {
    clock: Clock,
    time: u64,
    state: Block,
    proposal: Block,
}

impl EagerPoint {
    fn new(clock: Clock) -> Self {
        let empty: Block = Default::default();
        let mut point = Self { clock, time: 1, state: empty, proposal: empty };
        // Coordinates that the first sample does not ask for are uniform, too.
        point.propose(true);
        point.accept();
        point
    }
}

impl Numbers for EagerPoint {
    fn row<const N: usize>(&mut self, strand: Strand, row: usize) -> [f64; N] {
        std::array::from_fn(|i| self.proposal[strand as usize][row][i])
    }
}

impl Point for EagerPoint {
    fn propose(&mut self, large: bool) {
        let step = TorusStep::default();
        let strands = [Strand::Light, Strand::Eye, Strand::Connection];
        let rows = strands.into_iter().flat_map(|strand| (0..ROWS).map(move |row| (strand, row)));
        for (strand, row) in rows {
            let before = self.state[strand as usize][row];
            self.proposal[strand as usize][row] = std::array::from_fn(|index| {
                let draw = self.clock.draw(Place { strand, row, index }, self.time);
                if large { draw } else { step.apply(before[index], draw) }
            });
        }
    }

    fn accept(&mut self) {
        self.state = self.proposal;
        self.time += 1;
    }

    fn reject(&mut self) {}
}

/// The first sample of an eager point: fresh numbers that become its state.
struct EagerStart<'a>(&'a mut EagerPoint, Rng);

impl Numbers for EagerStart<'_> {
    fn row<const N: usize>(&mut self, strand: Strand, row: usize) -> [f64; N] {
        let values: [f64; N] = self.1.array();
        self.0.state[strand as usize][row][..N].copy_from_slice(&values);
        values
    }
}

/// Pixels and counts after some steps of a chain.
fn run<P: Point>(
    scene: &Scene,
    sampler: &mut SceneSampler<'_>,
    (point, start): (P, Sample),
    clock: Clock,
) -> (Film, crate::chain::ChainStatistics) {
    let balance = Balance { normalization: start.intensity(), large: 0.1 };
    let mut film = Film::new(scene.camera().width, scene.camera().height);
    let rng = Rng::new(4, Stream::Chain, 0);
    let timed = Timed { point, clock, time: 2 };
    let mut chain = PrimaryChain::new(rng, timed, start, balance.large);
    for _ in 0..2000 {
        chain.step(sampler, balance, &mut film);
    }
    chain.flush(balance, &mut film);
    (film, chain.statistics().clone())
}

#[test]
fn lazy_coordinates_are_as_good_as_eager_ones() {
    for (name, fixture) in [("room", specular_room()), ("slab", slab_over_floor(true))] {
        let scene = fixture.film(16, 16).build();
        for kind in [PrimarySampler::Bdpt, PrimarySampler::Path] {
            let mut sampler = SceneSampler::new(&scene, kind);
            let mut start = Sample::default();
            // A start with light on it.
            let number = (0..1000)
                .find(|&n| {
                    sampler.sample(&mut Rng::new(4, Stream::Bootstrap, n), &mut start);
                    start.intensity() > 0.0
                })
                .expect("some sample has light");
            let fresh = || Rng::new(4, Stream::Bootstrap, number);

            let clock = Clock::default();
            let mut lazy = LazyPoint::new(clock.clone(), TorusStep::default());
            sampler.sample(&mut lazy.start(fresh()), &mut start);
            let (film, counts) = run(&scene, &mut sampler, (lazy, start.clone()), clock);

            let clock = Clock::default();
            let mut eager = EagerPoint::new(clock.clone());
            sampler.sample(&mut EagerStart(&mut eager, fresh()), &mut start);
            let (expected, expected_counts) = run(&scene, &mut sampler, (eager, start), clock);

            assert_eq!(counts, expected_counts, "{name}, {kind:?}");
            assert_eq!(film, expected, "{name}, {kind:?}: another image");
            let accepted: Vec<u64> = counts.strategies.iter().map(|s| s.accepted).collect();
            assert!(accepted.iter().all(|&n| n > 10), "{name}, {kind:?}: {accepted:?}");
        }
    }
}

/// Half of the samples are dim and ask for no more; the other half ask for one more number, and a
/// tenth of them are bright: an integrand that looks at a coordinate now and then.
struct Toy;

const DIM: f64 = 1.0;
const BRIGHT: f64 = 10.0;
const DULL: f64 = 0.1;

impl Sampler for Toy {
    fn sample(&mut self, numbers: &mut impl Numbers, sample: &mut Sample) {
        let [half] = numbers.row(Strand::Eye, 0);
        *sample = Sample::default();
        if half < 0.5 {
            sample.add(0, Rgb::grey(DIM));
        } else {
            let [more] = numbers.row(Strand::Light, 0);
            sample.add(1, Rgb::grey(if more < 0.1 { BRIGHT } else { DULL }));
        }
    }
}

/// Chains of [`Toy`] with starts drawn in proportion to their intensity.
fn toy_chain<D: Draws>(draws: D, number: u64, large: f64) -> PrimaryChain<LazyPoint<D>> {
    // Long enough to change often between the halves, short for the bright tenth.
    let mut point = LazyPoint::new(draws, TorusStep::new(1.0 / 64.0, 1.0 / 8.0));
    let mut start = Sample::default();
    for attempt in 0.. {
        let mut choice = Rng::new(attempt, Stream::Bootstrap, number);
        let share = choice.uniform() * BRIGHT;
        Toy.sample(&mut choice.clone(), &mut start);
        if share < start.intensity() {
            Toy.sample(&mut point.start(choice), &mut start);
            break;
        }
    }
    PrimaryChain::new(Rng::new(1, Stream::Chain, number), point, start, large)
}

/// Deviation of the share of bright and dull samples after some steps from that at the start, in
/// standard errors: zero for a chain that leaves its target alone.
fn drift<D: Draws>(draws: impl Fn(u64) -> D) -> f64 {
    let balance = Balance { normalization: 1.0, large: 0.02 };
    let mut film = Film::new(2, 1);
    let drift: Accumulator = (0..50_000)
        .map(|number| {
            let mut chain = toy_chain(draws(number), number, balance.large);
            let place = |chain: &PrimaryChain<_>| {
                let pixel = chain.current().colors().next().map_or(0, |(pixel, _)| pixel);
                pixel as f64
            };
            let before = place(&chain);
            for _ in 0..100 {
                chain.step(&mut Toy, balance, &mut film);
            }
            place(&chain) - before
        })
        .collect();
    drift.mean() / drift.standard_error()
}

fn coordinates(number: u64) -> Rng {
    Rng::new(1, Stream::Coordinates, number)
}

#[test]
fn steps_leave_the_target_alone() {
    let z = drift(coordinates);
    assert!(z.abs() < 5.0, "the chains drift at z = {z:.2}");
}

/// All is dark, so that a chain stays where it began.
struct Dark;

impl Sampler for Dark {
    fn sample(&mut self, _: &mut impl Numbers, sample: &mut Sample) {
        *sample = Sample::default();
    }
}

#[test]
fn a_stay_counts_while_it_lasts() {
    let balance = Balance { normalization: 1.0, large: 0.02 };
    let (mut chain, mut film) = (toy_chain(coordinates(0), 0, balance.large), Film::new(2, 1));
    for _ in 0..70 {
        chain.step(&mut Dark, balance, &mut film);
    }
    assert_eq!(chain.stay(), 70, "the start is never left");
    assert_eq!(chain.statistics().longest_dwell, 0, "and no stay has ended");
}

/// Coordinates are born at zero.
struct BornAtZero(Rng);

impl Draws for BornAtZero {
    fn draw(&mut self, _: Place, _: u64) -> f64 {
        self.0.uniform()
    }

    fn fresh(&mut self, _: Place, _: u64) -> f64 {
        0.0
    }
}

/// Coordinates stay where they were last seen.
struct LeftBehind(Rng);

impl Draws for LeftBehind {
    fn draw(&mut self, _: Place, _: u64) -> f64 {
        self.0.uniform()
    }

    fn catch_up(&mut self, value: f64, _: Place, _: Range<u64>, _: TorusStep) -> f64 {
        value
    }
}

#[test]
fn wrong_coordinates_are_found() {
    let born = drift(|number| BornAtZero(coordinates(number)));
    assert!(born.abs() > 6.0, "coordinates born at zero: z = {born:.2}");
    let left = drift(|number| LeftBehind(coordinates(number)));
    assert!(left.abs() > 6.0, "coordinates left behind: z = {left:.2}");
}

/// Deviations of the toy's two pixels from their integrals, in standard errors.
fn estimates(balance: Balance) -> [f64; 2] {
    let mut pixels = [Accumulator::default(); 2];
    for number in 0..2000 {
        let mut film = Film::new(2, 1);
        let mut chain = toy_chain(coordinates(number), number, 0.3);
        for _ in 0..100 {
            chain.step(&mut Toy, balance, &mut film);
        }
        chain.flush(balance, &mut film);
        for (sum, pixel) in pixels.iter_mut().zip(film.pixels()) {
            sum.push(pixel.luminance() / 100.0);
        }
    }
    let expected = [0.5 * DIM, 0.5 * (0.1 * BRIGHT + 0.9 * DULL)];
    std::array::from_fn(|i| pixels[i].z_against(expected[i]).0)
}

#[test]
fn both_kinds_of_sample_are_weighed_against_each_other() {
    let normalization = 0.5 * DIM + 0.5 * (0.1 * BRIGHT + 0.9 * DULL);
    let right = Balance { normalization, large: 0.3 };
    let z = estimates(right);
    assert!(z.iter().all(|z| z.abs() < 5.0), "the estimate is biased: z = {z:.2?}");
    let z = estimates(Balance { large: 0.0, ..right });
    assert!(z.iter().any(|z| z.abs() > 6.0), "large steps without weight: z = {z:.2?}");
}
