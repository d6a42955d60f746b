//! The independent mutation: a whole new path by bidirectional sampling with a random length and
//! split. It makes the chain able to go anywhere in one step.

use super::{MixtureBasis, Mutation, Tuning};
use crate::math::{Rng, pick};
use crate::path::{Draft, Failure, Kept, Path, Range, resample};
use crate::scene::Tracer;

/// Starts anew with lengths drawn from a fixed distribution.
#[derive(Clone, Debug)]
pub struct Independent {
    /// Entry `k` is the probability of a path of `k` edges; entry 0 is zero.
    lengths: Vec<f64>,
    /// The lens has an area, over which its point is drawn anew.
    aperture: bool,
}

impl Independent {
    /// Lengths in proportion to `energy[k]`, the light that paths of `k` edges carry; each length
    /// from 1 on gets at least one per cent of its uniform share.
    pub fn new(energy: &[f64], max_edges: usize, aperture: bool) -> Self {
        let total: f64 = energy.iter().skip(1).sum();
        let uniform = 1.0 / max_edges as f64;
        let share = |k: usize| {
            let energy = energy.get(k).copied().unwrap_or(0.0);
            let measured = if total > 0.0 { energy / total } else { uniform };
            measured.max(0.01 * uniform)
        };
        let floored: Vec<f64> = (1..=max_edges).map(share).collect();
        let sum: f64 = floored.iter().sum();
        let lengths = std::iter::once(0.0).chain(floored.iter().map(|p| p / sum)).collect();
        Self { lengths, aperture }
    }

    fn choose_length(&self, rng: &mut Rng) -> usize {
        let lengths = self.lengths.iter().copied().enumerate().skip(1);
        pick(rng.uniform(), lengths).unwrap_or(1)
    }

    fn probability(&self, edges: usize) -> f64 {
        self.lengths.get(edges).copied().unwrap_or(0.0)
    }
}

impl Mutation for Independent {
    /// Nothing of the old path matters.
    type Move = ();
    const NAME: &'static str = "independent";
    const WEIGHT: f64 = 0.03;

    fn build(basis: &MixtureBasis<'_>, _tuning: &Tuning) -> Self {
        Self::new(basis.energy, basis.max_edges, basis.camera.has_aperture())
    }

    fn applicable(&self, _: &Path) -> bool {
        true
    }

    fn propose(
        &self,
        scene: &Tracer<'_>,
        x: &Path,
        rng: &mut Rng,
        draft: &mut Draft,
        y: &mut Path,
    ) -> Result<(), Failure> {
        let edges = self.choose_length(rng);
        // `k + 1` splits: 0 to k vertices on the light side.
        let from_light = rng.below(edges + 1);
        let range = Range::whole(x.edge_count(), from_light, edges - from_light, self.aperture);
        resample(scene, x, range, rng, draft, y)
    }

    fn transition(&self, _: &Path, y: &Path, (): ()) -> f64 {
        let edges = y.edge_count();
        self.probability(edges) / (edges + 1) as f64 * y.density_sum()
    }

    fn reverse(&self, (): ()) {}

    fn kept(&self, _: &Path, (): ()) -> Kept {
        Kept { light: 0, eye: usize::from(!self.aperture) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Stream;

    #[test]
    fn every_length_has_a_chance() {
        let independent = Independent::new(&[0.0, 0.0, 1.0], 8, false);
        let mut rng = Rng::new(1, Stream::Laboratory, 0);
        let mut seen = [0_u32; 9];
        for _ in 0..100_000 {
            seen[independent.choose_length(&mut rng)] += 1;
        }
        assert_eq!(seen[0], 0, "no path has no edge");
        for (k, &n) in seen.iter().enumerate().skip(1) {
            let expected = independent.probability(k) * 1e5;
            let z = (f64::from(n) - expected) / expected.sqrt();
            assert!(expected > 0.0 && z.abs() < 5.5, "length {k}: {n} instead of {expected}");
        }
    }
}
