//! Evenly spread numbers: Sobol's sequence, scrambled \[Owen 1995\] by a hash \[Burley 2020\].
//!
//! The crate behind it gives 23 bits of at most 2^16 points. Here every coordinate is shifted
//! digitally (exclusive or) by 53 random bits, which keeps points as evenly spread as they were and
//! makes each of them uniform by itself, whatever is thought of a hash as a random scramble.

use sobol_burley::sample_4d;

use super::rng::{Rng, Stream};

/// Points of a sequence at most.
pub const MOST_POINTS: u32 = 1 << 16;

/// Random sequences, one for each place: a place has four coordinates.
#[derive(Clone, Copy, Debug)]
pub struct Strata {
    key: u64,
}

/// A well mixed number: the finaliser of `SplitMix64`.
#[inline]
fn mix(mut x: u64) -> u64 {
    x = (x ^ x >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    x = (x ^ x >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ x >> 31
}

impl Strata {
    /// The sequences number `index` for a purpose.
    pub fn new(seed: u64, stream: Stream, index: u64) -> Self {
        Self { key: Rng::new(seed, stream, index).bits() }
    }

    /// The sequences that belong to one of many things, such as a pixel.
    #[must_use]
    #[inline]
    pub fn of(self, thing: u64) -> Self {
        Self { key: mix(self.key ^ mix(thing.wrapping_add(0x9e37_79b9_7f4a_7c15))) }
    }

    /// The point number `index`, below [`MOST_POINTS`], of the sequence of a place.
    #[inline]
    pub fn point(self, place: u64, index: u32) -> [f64; 4] {
        const SCALE: f64 = 1.0 / (1_u64 << 53) as f64;
        let key = self.of(place).key;
        let coarse = sample_4d(index & (MOST_POINTS - 1), 0, key as u32);
        std::array::from_fn(|axis| {
            let shift =
                mix(key.wrapping_add((axis as u64 + 1).wrapping_mul(0xd1b5_4a32_d192_ed03)));
            // 23 bits of the sequence above 30 of nothing.
            let word = ((f64::from(coarse[axis]) * f64::from(1 << 23)) as u64) << 30;
            (word ^ shift >> 11) as f64 * SCALE
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sixteen points: one in each sixteenth of every axis, and in each cell of four by four of the
    /// first two.
    #[test]
    fn points_are_evenly_spread() {
        let strata = Strata::new(3, Stream::Laboratory, 0);
        for place in 0..200 {
            let points: Vec<[f64; 4]> = (0..16).map(|i| strata.point(place, i)).collect();
            for axis in 0..4 {
                let mut cells: Vec<_> = points.iter().map(|p| (p[axis] * 16.0) as u32).collect();
                cells.sort_unstable();
                assert_eq!(cells, (0..16).collect::<Vec<_>>(), "axis {axis} of place {place}");
            }
            let mut cells: Vec<_> =
                points.iter().map(|p| (p[0] * 4.0) as u32 * 4 + (p[1] * 4.0) as u32).collect();
            cells.sort_unstable();
            assert_eq!(cells, (0..16).collect::<Vec<_>>(), "cells of place {place}");
        }
    }

    /// Each point is uniform by itself, and points of two places have nothing to do with each other.
    #[test]
    fn every_point_is_uniform() {
        const N: u64 = 20_000;
        for index in [0, 1, 5, 65_535] {
            let (mut mean, mut square, mut product, mut low) = ([0.0; 4], [0.0; 4], 0.0, 0_u64);
            for place in 0..N {
                let strata = Strata::new(4, Stream::Laboratory, 1).of(place);
                let (p, q) = (strata.point(0, index), strata.point(1, index));
                for axis in 0..4 {
                    assert!((0.0..1.0).contains(&p[axis]), "{p:?}");
                    mean[axis] += p[axis] - 0.5;
                    square[axis] += (p[axis] - 0.5).powi(2) - 1.0 / 12.0;
                }
                product += (p[0] - 0.5) * (q[0] - 0.5);
                low += (p[2] * (1_u64 << 53) as f64) as u64 & 1;
            }
            let root = (N as f64).sqrt();
            for axis in 0..4 {
                let z = mean[axis] / root * 12_f64.sqrt();
                assert!(z.abs() < 5.5, "mean of axis {axis}, point {index}: z = {z}");
                let z = square[axis] / root * 180_f64.sqrt();
                assert!(z.abs() < 5.5, "spread of axis {axis}, point {index}: z = {z}");
            }
            let z = product / root * 12.0;
            assert!(z.abs() < 5.5, "two places, point {index}: z = {z}");
            let z = (low as f64 - N as f64 / 2.0) / (root / 2.0);
            assert!(z.abs() < 5.5, "the last bit, point {index}: z = {z}");
        }
    }
}
