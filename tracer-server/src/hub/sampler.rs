//! Thinning paths to a budget without bending their distribution.

use std::collections::BTreeMap;

/// Systematic sampling of each chain's steps [Cochran 1977, chapter 8].
///
/// Sample points lie at equal distances along the steps of every chain, from a start of its own. A
/// path on which points fall is kept and stands for as many distances, whatever its neighbours do:
/// the sum of the weights is right on average, every chain is shown in proportion to its steps,
/// and one that moves much crowds out no other, nor does one that dwells.
#[derive(Debug)]
pub(super) struct Sampler {
    key: u64,
    distance: f64,
    /// Steps to the next sample point of each chain.
    left: BTreeMap<u32, f64>,
}

impl Sampler {
    /// A sampler that keeps everything; `key` picks where the points of each chain start.
    pub(super) fn new(key: u64) -> Self {
        Self { key, distance: 0.0, left: BTreeMap::new() }
    }

    /// Steps from one sample to the next; 0 where everything is kept.
    pub(super) fn distance(&self) -> f64 {
        self.distance
    }

    /// Changes the distance.
    pub(super) fn set_distance(&mut self, distance: f64) {
        let ratio = if self.distance > 0.0 { distance / self.distance } else { 0.0 };
        if ratio > 0.0 {
            // Where the next point lies stays a uniform share of the distance.
            self.left.values_mut().for_each(|left| *left *= ratio);
        } else {
            self.left.clear();
        }
        self.distance = distance;
    }

    /// The weight to send a path with that stands for `weight` steps of `chain`; `None` to drop it.
    pub(super) fn draw(&mut self, chain: u32, weight: f32) -> Option<f32> {
        if self.distance == 0.0 {
            return Some(weight);
        }
        let (key, distance) = (self.key, self.distance);
        let left = self.left.entry(chain).or_insert_with(|| distance * uniform(key, chain));
        let beyond = f64::from(weight) - *left;
        if beyond < 0.0 {
            *left = -beyond;
            return None;
        }
        let points = 1.0 + (beyond / distance).floor();
        *left += points * distance - f64::from(weight);
        Some((points * distance) as f32)
    }
}

/// A number in (0, 1] for a chain, the same at every run [Steele et al. 2014].
fn uniform(key: u64, chain: u32) -> f64 {
    let mut z =
        key.wrapping_add(u64::from(chain).wrapping_add(1).wrapping_mul(0x9E37_79B9_7F4A_7C15));
    z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    z ^= z >> 31;
    ((z >> 11) + 1) as f64 / (1_u64 << 53) as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Chains that move at every step, seldom, and hardly ever are sent equally often for the steps
    /// they took, and the weights add up.
    #[test]
    fn a_chain_is_shown_by_its_steps_and_not_by_its_moves() {
        let mut sampler = Sampler::new(7);
        sampler.set_distance(10.0);
        for (chain, weight) in [(0, 1.0), (1, 3.0), (2, 25.0), (3, 999.0)] {
            let steps = 99_900.0;
            let (mut sent, mut total) = (0, 0.0);
            for _ in 0..(steps / weight) as usize {
                if let Some(weight) = sampler.draw(chain, weight as f32) {
                    sent += 1;
                    total += f64::from(weight);
                }
            }
            assert!((total - steps).abs() <= 10.0, "chain {chain}: {total} of {steps} steps");
            let expected = steps / weight.max(10.0);
            assert!(
                (f64::from(sent) - expected).abs() <= 1.0,
                "chain {chain} was sent {sent} times"
            );
        }
    }

    /// The weight that a path gets on average is its own, for paths below and above the distance and
    /// whatever comes before them.
    #[test]
    fn weights_are_right_on_average() {
        let runs = 200_000;
        for weight in [0.5_f32, 3.0, 10.0, 34.0] {
            let (mut sum, mut squares) = (0.0, 0.0);
            for key in 0..runs {
                let mut sampler = Sampler::new(key);
                sampler.set_distance(4.0);
                let before = sampler.draw(5, 1.7);
                assert!(before.is_none_or(|weight| weight == 4.0), "one sample at most");
                sampler.set_distance(10.0);
                let drawn = f64::from(sampler.draw(5, weight).unwrap_or(0.0));
                sum += drawn;
                squares += drawn * drawn;
            }
            let mean = sum / runs as f64;
            let error = ((squares / runs as f64 - mean * mean) / runs as f64).sqrt().max(1e-9);
            let z = (mean - f64::from(weight)) / error;
            assert!(z.abs() < 5.0, "{weight} became {mean}: {z} standard errors");
        }
    }

    #[test]
    fn without_a_distance_everything_is_kept() {
        let mut sampler = Sampler::new(0);
        assert_eq!(sampler.draw(0, 0.0), Some(0.0), "a path that was left at once");
        sampler.set_distance(1000.0);
        assert_eq!(sampler.draw(0, 0.0), None, "no point falls on no steps");
        sampler.set_distance(0.0);
        assert_eq!(sampler.draw(0, 0.25), Some(0.25), "kept as it is");
    }
}
