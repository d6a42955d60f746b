//! A point of primary-sample space, of which only the coordinates that were asked for exist.
//!
//! Every coordinate moves in every step, but most are not looked at in most steps: a coordinate
//! remembers when it was last brought up to date, and catches up when it is asked for
//! [Kelemen et al. 2002, section 3.3].

use std::ops::Range;

use crate::math::{Rng, TorusStep};
use crate::path::{Numbers, ROW, STRANDS, Strand};

/// Where a number belongs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Place {
    /// What it is for.
    pub strand: Strand,
    /// Its row.
    pub row: usize,
    /// Its index in the row.
    pub index: usize,
}

/// Where the random numbers behind the coordinates come from.
///
/// Times count the accepted steps: time 1 is the start of the chain.
pub trait Draws {
    /// A uniform number for what happens to a coordinate at a time.
    fn draw(&mut self, place: Place, time: u64) -> f64;

    /// The value of a coordinate that has not been looked at since the large step at `time`. It
    /// must be uniform: zero, say, would be a bias.
    #[inline]
    fn fresh(&mut self, place: Place, time: u64) -> f64 {
        self.draw(place, time)
    }

    /// The value of a coordinate that was `value`, after the small steps of the given times.
    #[inline]
    fn catch_up(&mut self, value: f64, place: Place, times: Range<u64>, step: TorusStep) -> f64 {
        times.fold(value, |value, time| step.apply(value, self.draw(place, time)))
    }
}

impl Draws for Rng {
    #[inline]
    fn draw(&mut self, _: Place, _: u64) -> f64 {
        self.uniform()
    }
}

/// A point of primary-sample space that a chain can change and change back.
pub trait Point: Numbers {
    /// Begins a step: every number asked for from now on is that of the proposal.
    fn propose(&mut self, large: bool);

    /// The proposal is the new state.
    fn accept(&mut self);

    /// The state is what it was before the proposal.
    fn reject(&mut self);
}

/// The time at which a chain starts.
const START: u64 = 1;

/// A number and the time it belongs to; time zero stands for a number that was never made.
#[derive(Clone, Copy, Debug, Default)]
struct Coordinate {
    value: f64,
    time: u64,
}

/// A point whose coordinates are made and moved when they are asked for.
#[derive(Clone, Debug)]
pub struct LazyPoint<D> {
    draws: D,
    step: TorusStep,
    rows: [Vec<[Coordinate; ROW]>; STRANDS],
    /// Rows that the proposal has touched, as they were before.
    undo: Vec<(Strand, usize, [Coordinate; ROW])>,
    /// Of the proposal.
    time: u64,
    /// Of the last large step that was accepted.
    last_large: u64,
    large: bool,
}

impl<D: Draws> LazyPoint<D> {
    /// A point without coordinates.
    pub fn new(draws: D, step: TorusStep) -> Self {
        Self {
            draws,
            step,
            rows: Default::default(),
            undo: Vec::new(),
            time: START + 1,
            last_large: START,
            large: false,
        }
    }

    /// Lets a sample be drawn with fresh numbers of `rng`, which become the chain's start.
    pub fn start(&mut self, rng: Rng) -> Start<'_, D> {
        Start { point: self, rng }
    }

    fn row_mut(&mut self, strand: Strand, row: usize) -> &mut [Coordinate; ROW] {
        let rows = &mut self.rows[strand as usize];
        if rows.len() <= row {
            rows.resize(row + 1, Default::default());
        }
        &mut rows[row]
    }

    /// Brings a coordinate to where the accepted steps have moved it.
    #[inline]
    fn catch_up(&mut self, at: &mut Coordinate, place: Place) {
        if at.time < self.last_large {
            *at = Coordinate {
                value: self.draws.fresh(place, self.last_large),
                time: self.last_large,
            };
        }
        let missed = at.time + 1..self.time;
        if !missed.is_empty() {
            at.value = self.draws.catch_up(at.value, place, missed, self.step);
            at.time = self.time - 1;
        }
    }
}

impl<D: Draws> Numbers for LazyPoint<D> {
    #[inline]
    fn row<const N: usize>(&mut self, strand: Strand, row: usize) -> [f64; N] {
        let mut coordinates = *self.row_mut(strand, row);
        let (time, large, step) = (self.time, self.large, self.step);
        let places = |index| Place { strand, row, index };
        if !large {
            for (index, at) in coordinates.iter_mut().take(N).enumerate() {
                self.catch_up(at, places(index));
            }
        }
        self.undo.push((strand, row, coordinates));
        let mut values = [0.0; N];
        for (index, (at, value)) in coordinates.iter_mut().zip(&mut values).enumerate() {
            let draw = self.draws.draw(places(index), time);
            *value = if large { draw } else { step.apply(at.value, draw) };
            *at = Coordinate { value: *value, time };
        }
        *self.row_mut(strand, row) = coordinates;
        values
    }
}

impl<D: Draws> Point for LazyPoint<D> {
    fn propose(&mut self, large: bool) {
        self.large = large;
    }

    fn accept(&mut self) {
        self.undo.clear();
        if self.large {
            self.last_large = self.time;
        }
        self.time += 1;
    }

    fn reject(&mut self) {
        while let Some((strand, row, coordinates)) = self.undo.pop() {
            *self.row_mut(strand, row) = coordinates;
        }
    }
}

/// Fresh numbers that are kept as the first coordinates of a point.
#[derive(Debug)]
pub struct Start<'a, D> {
    point: &'a mut LazyPoint<D>,
    rng: Rng,
}

impl<D: Draws> Numbers for Start<'_, D> {
    fn row<const N: usize>(&mut self, strand: Strand, row: usize) -> [f64; N] {
        let values: [f64; N] = self.rng.array();
        for (at, value) in self.point.row_mut(strand, row).iter_mut().zip(values) {
            *at = Coordinate { value, time: START };
        }
        values
    }
}
