//! The bidirectional mutation: delete a range of the path and make another in its place
//! [Veach and Guibas 1997, section 5.1].

use super::{MixtureBasis, Mutation, Tuning};
use crate::math::{Rng, pick, power_of_half};
use crate::path::{Cut, Draft, Failure, Kept, Path, Range, resample};
use crate::scene::Tracer;

/// Deletes the edges between two kept vertices and replaces them by walks from both sides.
#[derive(Clone, Copy, Debug)]
pub struct Bidirectional {
    /// Longest path it may make, in edges.
    pub max_edges: usize,
    /// The lens has an area: its point may be replaced too.
    pub aperture: bool,
}

/// The kept ends of a move: `l` and `m` of the literature, with `l + 1` vertices kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Ends {
    /// Vertices kept from the light end, `l + 1`.
    pub kept_light: usize,
    /// `m`: first vertex kept at the eye end, in the path that is left.
    pub from: usize,
    /// `m'`: the same vertex in the path that is made.
    pub to: usize,
    /// Vertices that the walk from the light side made.
    pub from_light: usize,
}

impl Ends {
    /// Edges deleted.
    pub fn deleted(self) -> usize {
        self.from + 1 - self.kept_light
    }

    /// Edges added.
    pub fn added(self) -> usize {
        self.to + 1 - self.kept_light
    }
}

/// Weight of deleting `edges` edges.
#[inline]
fn deletion_weight(edges: usize) -> f64 {
    match edges {
        1 => 0.25,
        2 => 0.5,
        _ => power_of_half(edges),
    }
}

/// Weight of adding `difference` edges more or fewer than were deleted.
#[inline]
fn addition_weight(difference: usize) -> f64 {
    match difference {
        0 => 0.5,
        1 => 0.15,
        _ => 0.2 * power_of_half(difference),
    }
}

/// The pairs of ends with `edges` edges between them: bit `p` is set when `l + 1 = p` is one.
///
/// In `mask` bit `j + 1` stands for vertex `j`, bit 0 for the virtual end "before the light", and
/// the bit after the lens for "behind the lens".
#[inline]
fn ranges(mask: u128, edges: usize, lens: usize) -> u128 {
    let pairs = mask & mask >> edges;
    // (before the light, light) and (lens, behind the lens) delete nothing.
    if edges == 1 { pairs & !(1 | 1 << (lens + 1)) } else { pairs }
}

/// True when `deleted` edges behind `kept_light` vertices reach behind the lens of a path of `edges`.
#[inline]
fn replaces_lens(edges: usize, kept_light: usize, deleted: usize) -> bool {
    kept_light + deleted == edges + 2
}

/// The ways to share the vertices of `added` edges between the two sides. A lens point is made from
/// the eye side.
#[inline]
fn sharings(added: usize, replaces_lens: bool) -> usize {
    added - usize::from(replaces_lens)
}

/// Position of the set bit number `rank` of `bits`, counted from the lowest.
#[inline]
fn nth_set_bit(mut bits: u128, rank: usize) -> usize {
    for _ in 0..rank {
        bits &= bits - 1;
    }
    bits.trailing_zeros() as usize
}

impl Bidirectional {
    /// Where a range may end; see [`ranges`].
    #[inline]
    fn end_mask(self, x: &Path) -> u128 {
        let behind_lens = u128::from(self.aperture) << (x.edge_count() + 2);
        x.connectable() << 1 | 1 | behind_lens
    }

    /// The most edges that can be deleted, virtual ones included.
    #[inline]
    fn most_deleted(self, x: &Path) -> usize {
        x.edge_count() + 1 + usize::from(self.aperture)
    }

    /// `N_d`: the sum of deletion weights over all feasible ranges.
    #[inline]
    fn deletion_total(self, x: &Path) -> f64 {
        let (mask, lens) = (self.end_mask(x), x.edge_count());
        let count = |edges: usize| f64::from(ranges(mask, edges, lens).count_ones());
        (1..=self.most_deleted(x)).map(|edges| deletion_weight(edges) * count(edges)).sum()
    }

    /// The numbers of edges that may replace `deleted` edges of a path of `edges`.
    #[inline]
    fn admissible(
        self,
        edges: usize,
        kept_light: usize,
        deleted: usize,
    ) -> std::ops::RangeInclusive<usize> {
        // A path that is replaced up to an end has a virtual edge there.
        let virtual_ends =
            usize::from(kept_light == 0) + usize::from(replaces_lens(edges, kept_light, deleted));
        let shortest = if deleted == 1 { 2 } else { 1 + virtual_ends };
        shortest..=(self.max_edges + deleted).saturating_sub(edges)
    }

    /// `N_a`: the sum of addition weights over the admissible numbers of edges.
    #[inline]
    fn addition_total(self, edges: usize, kept_light: usize, deleted: usize) -> f64 {
        self.admissible(edges, kept_light, deleted)
            .map(|added| addition_weight(added.abs_diff(deleted)))
            .sum()
    }

    /// `p_d p_a1 p_a2`: the probability of choosing just these ends and one way to make them.
    pub(super) fn selection(self, x: &Path, via: Ends) -> f64 {
        let (deleted, added) = (via.deleted(), via.added());
        let p_range = deletion_weight(deleted) / self.deletion_total(x);
        let p_length = addition_weight(added.abs_diff(deleted))
            / self.addition_total(x.edge_count(), via.kept_light, deleted);
        let replaces_lens = replaces_lens(x.edge_count(), via.kept_light, deleted);
        p_range * p_length / sharings(added, replaces_lens) as f64
    }

    fn choose_cut(self, x: &Path, rng: &mut Rng) -> Option<Cut> {
        let (mask, lens) = (self.end_mask(x), x.edge_count());
        let all = (1..=self.most_deleted(x)).map(|edges| (edges, ranges(mask, edges, lens)));
        let weighted = all.filter(|(_, pairs)| *pairs != 0).map(|(edges, pairs)| {
            ((edges, pairs), deletion_weight(edges) * f64::from(pairs.count_ones()))
        });
        let (edges, pairs) = pick(rng.uniform() * self.deletion_total(x), weighted)?;
        let light = nth_set_bit(pairs, rng.below(pairs.count_ones() as usize));
        Some(Cut { light, eye_from: light + edges - 1 })
    }

    fn choose_length(self, x: &Path, cut: Cut, rng: &mut Rng) -> Option<usize> {
        let deleted = cut.eye_from + 1 - cut.light;
        let admissible = self.admissible(x.edge_count(), cut.light, deleted);
        let u = rng.uniform() * self.addition_total(x.edge_count(), cut.light, deleted);
        pick(u, admissible.map(|added| (added, addition_weight(added.abs_diff(deleted)))))
    }
}

impl Mutation for Bidirectional {
    type Move = Ends;
    const NAME: &'static str = "bidirectional";
    const WEIGHT: f64 = 0.25;

    fn build(basis: &MixtureBasis<'_>, _tuning: &Tuning) -> Self {
        Self { max_edges: basis.max_edges, aperture: basis.camera.has_aperture() }
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
    ) -> Result<Ends, Failure> {
        let cut = self.choose_cut(x, rng).ok_or(Failure::NoSubpath)?;
        let added = self.choose_length(x, cut, rng).ok_or(Failure::LengthOutOfRange)?;
        let replaces_lens = cut.eye_from > x.edge_count();
        let from_light = rng.below(sharings(added, replaces_lens));
        let from_eye = added - 1 - from_light;
        resample(scene, x, Range { cut, from_light, from_eye }, rng, draft, y)?;
        let Cut { light: kept_light, eye_from: from } = cut;
        Ok(Ends { kept_light, from, to: kept_light + added - 1, from_light })
    }

    /// The number of new vertices from the light side has no unique partner in the reverse move,
    /// so it is summed over; the ends have one.
    fn transition(&self, x: &Path, y: &Path, via: Ends) -> f64 {
        let last = via.to.min(y.edge_count());
        self.selection(x, via) * y.reciprocal_sum(via.kept_light, last)
    }

    fn reverse(&self, via: Ends) -> Ends {
        Ends { from: via.to, to: via.from, ..via }
    }

    fn kept(&self, x: &Path, via: Ends) -> Kept {
        Cut { light: via.kept_light, eye_from: via.from }.kept(x.edge_count() + 1)
    }
}

#[cfg(test)]
mod tests {
    use ::tests::chi_square_test;

    use super::*;
    use crate::math::Stream;
    use crate::path::{BidirectionalSampler, CameraSample};
    use crate::scene::fixtures::specular_room;

    /// The worked example: `L D E` with a pinhole, an area light and at most seven edges.
    #[test]
    fn selection_probabilities_of_a_short_path() {
        let mask = 0b1111_u128; // before the light, L, D, E
        let count = |edges| ranges(mask, edges, 2).count_ones();
        assert_eq!([count(1), count(2), count(3)], [2, 2, 1], "(0,1)(1,2) (-1,1)(0,2) (-1,2)");
        let total: f64 = (1..=3).map(|e| deletion_weight(e) * f64::from(count(e))).sum();
        assert!((total - 1.625).abs() < 1e-15, "N_d is {total}");

        let b = Bidirectional { max_edges: 7, aperture: false };
        assert_eq!(b.admissible(2, 1, 2), 1..=7, "for (0,2)");
        assert!((b.addition_total(2, 1, 2) - 0.89375).abs() < 1e-15, "N_a of (0,2)");
        assert_eq!(b.admissible(2, 1, 1), 2..=6, "for (0,1)");
        assert!((b.addition_total(2, 1, 1) - 0.24375).abs() < 1e-15, "N_a of (0,1)");
        assert_eq!(b.admissible(2, 0, 3), 2..=8, "for (-1,2)");
        assert!((b.addition_total(2, 0, 3) - 0.89375).abs() < 1e-15, "N_a of (-1,2)");

        let speculars = 0b1011_u128; // L S E
        let count = |edges| ranges(speculars, edges, 2).count_ones();
        assert_eq!([count(1), count(2), count(3)], [0, 1, 1], "only (0,2) and (-1,2)");
    }

    /// Ends and lengths are drawn as often as their probabilities say, and these add up to one.
    #[test]
    fn choices_follow_their_probabilities() {
        const DRAWS: usize = 200_000;
        let scene = specular_room().build();
        let scene = Tracer::new(&scene);
        let mut rng = Rng::new(1, Stream::Laboratory, 0);
        let classes = ["LDE", "LDSE", "LDDDE"].into_iter();
        for (class, aperture) in classes.flat_map(|class| [(class, false), (class, true)]) {
            let b = Bidirectional { max_edges: scene.max_edges(), aperture };
            let x = a_path(&scene, class);
            let (mut observed, mut expected) = (Vec::new(), Vec::new());
            let mut cells = Vec::new();
            let starts = |edges: usize| {
                let pairs = ranges(b.end_mask(&x), edges, x.edge_count());
                (0..128).filter(move |p| pairs >> p & 1 == 1).map(move |p| (p, edges))
            };
            for (kept_light, edges) in (1..=b.most_deleted(&x)).flat_map(starts) {
                let from = kept_light + edges - 1;
                for added in b.admissible(x.edge_count(), kept_light, edges) {
                    let to = kept_light + added - 1;
                    let via = Ends { kept_light, from, to, from_light: 0 };
                    // All ways to share the new vertices between the two sides.
                    let ways = sharings(added, from > x.edge_count()) as f64;
                    expected.push(b.selection(&x, via) * ways * DRAWS as f64);
                    observed.push(0);
                    cells.push((kept_light, from, added));
                }
            }
            let total: f64 = expected.iter().sum();
            assert!((total / DRAWS as f64 - 1.0).abs() < 1e-12, "{class}: sums to {total}");
            for _ in 0..DRAWS {
                let cut = b.choose_cut(&x, &mut rng).expect("a range");
                let added = b.choose_length(&x, cut, &mut rng).expect("a length");
                let drawn = (cut.light, cut.eye_from, added);
                let cell = cells.iter().position(|&c| c == drawn).expect("a feasible choice");
                observed[cell] += 1;
            }
            let result = chi_square_test(&observed, &expected, 20.0).expect("valid counts");
            assert!(result.p_value > 1e-7, "{class}: p = {:e}", result.p_value);
        }
    }

    /// Some path of a class.
    fn a_path(scene: &Tracer<'_>, class: &str) -> Path {
        let mut rng = Rng::new(2, Stream::Laboratory, 0);
        let mut sampler = BidirectionalSampler::new(scene);
        let mut found = None;
        while found.is_none() {
            let aim = CameraSample::from_numbers(scene, &mut rng);
            sampler.sample(scene, aim, &mut rng, |path, _| {
                if path.class() == class {
                    found = Some(path.clone());
                }
            });
        }
        found.expect("the loop ends with a path")
    }

    #[test]
    fn set_bits_are_found_in_order() {
        let bits = 0b1010_0110_u128;
        let found: Vec<usize> = (0..4).map(|rank| nth_set_bit(bits, rank)).collect();
        assert_eq!(found, [1, 2, 5, 7], "positions of the set bits");
    }
}
