//! Laws that every mutation strategy must obey.
//!
//! The core law is exact: bidirectional samples represent the target distribution without bias, so
//! applying a strategy to them, rejections included, must leave the expectation of every function
//! of the path as it was. No burn-in, no reference image and no convergence is involved.

use common::VertexKind;
use glam::DVec2;
use tests::{Accumulator, Suite, ZScore, z_limit};

use super::mutants::{self, Mutant};
use super::{
    Bidirectional, CausticPerturbation, Independent, LensPerturbation, LensSubpath, MultiChain,
    Mutation, Primary, Proposal, Sizes, propose,
};
use crate::math::{Rng, Stream};
use crate::parallel;
use crate::path::{BidirectionalSampler, Draft, Failure, Path};
use crate::scene::fixtures::{
    Fixture, diffuse_room, floor_through_glass, saturated_room, slab_over_floor, specular_room,
    wall_and_lamp_in_a_pane, wall_in_a_pane,
};
use crate::scene::{Scene, Tracer};

/// Samples that one stream of random numbers serves.
const CHUNK: u64 = 1000;
/// A function is judged when at least this many proposals moved it each way.
const MIN_MOVES: u64 = 200;
/// Film bins along each side.
const BINS: usize = 6;

/// Draws a proposal: a strategy, or one that is wrong on purpose.
pub(super) type Propose<'a> = dyn Fn(&Tracer<'_>, &Path, &mut Rng, &mut Draft, &mut Path) -> Result<Proposal, Failure>
    + Sync
    + 'a;

/// How a law is put to the test.
#[derive(Clone, Copy, Debug)]
enum Test {
    /// Applies this many steps, coin included.
    Steps(usize),
    /// Draws this many proposals from every path and weighs them with their acceptance.
    Proposals(usize),
}

impl Test {
    fn repeats(self) -> usize {
        match self {
            Self::Steps(_) => 1,
            Self::Proposals(proposals) => proposals,
        }
    }

    fn steps(self) -> usize {
        match self {
            Self::Steps(steps) => steps,
            Self::Proposals(_) => 1,
        }
    }
}

/// The functions of a path whose expectations are watched, in a fixed order.
fn functionals(path: &Path, out: &mut Vec<f64>) {
    out.clear();
    let film = path.film();
    let bin = (film.y * BINS as f64) as usize * BINS + (film.x * BINS as f64) as usize;
    out.extend((0..BINS * BINS).map(|i| f64::from(u8::from(i == bin))));
    let off_centre = (film - DVec2::splat(0.5)).abs();
    out.extend([off_centre.x, off_centre.y, off_centre.max_element()]);
    let k = path.edge_count();
    out.extend((1..=6).map(|n| f64::from(u8::from(n == k))));
    let vertices = path.vertices();
    let speculars = vertices.iter().filter(|v| v.kind == VertexKind::Specular).count();
    out.push(speculars as f64);
    let unit = 1.0 / 1024.0;
    let d = path.first_diffuse_from_eye();
    out.extend((vertices[d].position * unit).to_array());
    out.extend((vertices[0].position * unit).to_array());
    let first = &path.edges()[0];
    out.push(vertices[0].normal.dot(first.direction));
    let lengths = vertices.windows(2).map(|v| (v[1].position - v[0].position).length() * unit);
    let shortest = lengths.fold(f64::INFINITY, f64::min);
    out.extend([0.05, 0.2, 0.5].map(|limit| f64::from(u8::from(shortest < limit))));
    out.push((1.0 / path.density_sum()).log10().floor());
    let behind_lens = &vertices[k - 1];
    out.push(behind_lens.normal.dot(path.edges()[k - 1].direction).abs());
    out.push(path.unit_color().r);
    // The same again for the classes that would drown among the rest.
    let seen_through_specular = k >= 2 && vertices[k - 1].kind == VertexKind::Specular;
    let caustic = k >= 3
        && vertices[k - 1].kind == VertexKind::Diffuse
        && vertices[k - 2].kind == VertexKind::Specular;
    let all = out.len();
    for indicator in [seen_through_specular, caustic] {
        let factor = f64::from(u8::from(indicator));
        out.push(factor);
        for i in 0..all {
            out.push(out[i] * factor);
        }
    }
}

/// What one worker has gathered of one function.
#[derive(Clone, Debug, Default)]
struct Watched {
    differences: Accumulator,
    up: u64,
    down: u64,
}

/// One worker's sampler and hand.
struct Bench<'s> {
    scene: Tracer<'s>,
    sampler: BidirectionalSampler,
    hand: Hand,
}

/// What a strategy works with.
struct Hand {
    rng: Rng,
    draft: Draft,
    x: Path,
    y: Path,
}

impl<'s> Bench<'s> {
    fn new(scene: &'s Scene) -> Self {
        let scene = Tracer::new(scene);
        let sampler = BidirectionalSampler::new(&scene);
        let rng = Rng::new(0, Stream::Laboratory, 0);
        let hand = Hand { rng, draft: Draft::default(), x: Path::default(), y: Path::default() };
        Self { scene, sampler, hand }
    }

    fn chunk(&mut self, propose: &Propose<'_>, test: Test, number: u64) -> Vec<Watched> {
        let mut rng = Rng::new(20, Stream::Laboratory, number);
        let mut watched: Vec<Watched> = Vec::new();
        let (mut before, mut after, mut sums) = (Vec::new(), Vec::new(), Vec::new());
        let Self { scene, sampler, hand } = self;
        for sample in 0..CHUNK {
            let film = DVec2::new(rng.uniform(), rng.uniform());
            hand.rng = Rng::new(21, Stream::Laboratory, number * CHUNK + sample);
            sums.fill(0.0);
            sampler.sample(scene, film, &mut rng, |path, weight| {
                functionals(path, &mut before);
                sums.resize(before.len(), 0.0);
                watched.resize(before.len(), Watched::default());
                for _ in 0..test.repeats() {
                    let weight = weight * hand.mutate(scene, path, propose, test);
                    functionals(&hand.x, &mut after);
                    tally(weight, (&before, &after), &mut sums, &mut watched);
                }
            });
            for (watched, &sum) in watched.iter_mut().zip(&sums) {
                watched.differences.push(sum);
            }
        }
        watched
    }
}

/// Adds the weighted change of every function to its sum, and counts which way it moved.
fn tally(
    weight: f64,
    (before, after): (&[f64], &[f64]),
    sums: &mut [f64],
    watched: &mut [Watched],
) {
    for (i, (a, b)) in after.iter().zip(before).enumerate() {
        sums[i] += weight * (a - b);
        watched[i].up += u64::from(a > b);
        watched[i].down += u64::from(a < b);
    }
}

impl Hand {
    /// Mutates `path` and leaves the result in `x`; returns the share of the path's weight that the
    /// result stands for.
    fn mutate(
        &mut self,
        scene: &Tracer<'_>,
        path: &Path,
        propose: &Propose<'_>,
        test: Test,
    ) -> f64 {
        let Self { rng, draft, x, y } = self;
        x.clone_from(path);
        let mut share = 1.0 / test.repeats() as f64;
        for _ in 0..test.steps() {
            let drawn = propose(scene, x, rng, draft, y);
            let a = drawn.map_or(0.0, |proposal| proposal.ratio.clamp(0.0, 1.0));
            let moves = match test {
                Test::Steps(_) => a > rng.uniform(),
                Test::Proposals(_) => {
                    share *= a;
                    a > 0.0
                }
            };
            if moves {
                std::mem::swap(x, y);
            }
        }
        share
    }
}

/// Puts a way of proposing to the test on `samples` bidirectional samples.
fn examine(name: &str, scene: &Scene, propose: &Propose<'_>, test: Test, samples: u64) -> Suite {
    let mut chunks: Vec<Option<Vec<Watched>>> = (0..samples / CHUNK).map(|_| None).collect();
    parallel::for_each(
        2,
        (0..).zip(chunks.iter_mut()),
        || Bench::new(scene),
        |bench, (number, slot)| *slot = Some(bench.chunk(propose, test, number)),
    );
    let mut total: Vec<Watched> = Vec::new();
    for chunk in chunks.into_iter().flatten() {
        total.resize(total.len().max(chunk.len()), Watched::default());
        for (sum, part) in total.iter_mut().zip(chunk) {
            sum.differences.merge(&part.differences);
            sum.up += part.up;
            sum.down += part.down;
        }
    }
    let mut suite = Suite::new(name);
    for (i, watched) in total.iter().enumerate() {
        if watched.up >= MIN_MOVES && watched.down >= MIN_MOVES {
            let z = watched.differences.mean() / watched.differences.standard_error();
            suite.record(format!("function {i}"), ZScore(z));
        }
    }
    suite
}

fn strategy<M: Mutation>(
    mutation: &M,
) -> impl Fn(&Tracer<'_>, &Path, &mut Rng, &mut Draft, &mut Path) -> Result<Proposal, Failure> + '_
{
    move |scene, x, rng, draft, y| {
        if mutation.applicable(x) {
            propose(mutation, scene, x, rng, draft, y)
        } else {
            Err(Failure::NoSubpath)
        }
    }
}

fn assert_lawful(name: &str, scene: &Scene, propose: &Propose<'_>) {
    for (test, samples) in [(Test::Steps(3), 60_000), (Test::Proposals(5), 20_000)] {
        let suite = examine(name, scene, propose, test, samples);
        assert!(suite.len() >= 15, "{name}: only {} functions were exercised", suite.len());
        let verdict = suite.verdict();
        assert!(verdict.is_pass(), "{test:?}: {verdict}");
    }
}

fn independent(scene: &Scene) -> Independent {
    Independent::new(&[0.0, 1.0, 4.0, 3.0, 2.0, 1.0, 1.0], scene.max_edges())
}

#[test]
fn bidirectional_leaves_the_target_alone() {
    for (name, fixture) in [("diffuse", diffuse_room()), ("specular", specular_room())] {
        let scene = fixture.build();
        let mutation = Bidirectional { max_edges: scene.max_edges() };
        assert_lawful(&format!("bidirectional, {name}"), &scene, &strategy(&mutation));
    }
}

#[test]
fn independent_leaves_the_target_alone() {
    for (name, fixture) in [("diffuse", diffuse_room()), ("specular", specular_room())] {
        let scene = fixture.build();
        let mutation = independent(&scene);
        assert_lawful(&format!("independent, {name}"), &scene, &strategy(&mutation));
    }
}

#[test]
fn lens_leaves_the_target_alone() {
    let scenes = [
        ("diffuse", diffuse_room()),
        ("specular", specular_room()),
        ("glass", floor_through_glass()),
        ("pane", wall_in_a_pane()),
    ];
    for (name, fixture) in scenes {
        let scene = fixture.build();
        let mutation = LensPerturbation::new(scene.camera());
        assert_lawful(&format!("lens, {name}"), &scene, &strategy(&mutation));
    }
}

#[test]
fn lens_subpath_leaves_the_target_alone() {
    let scenes =
        [("diffuse", diffuse_room()), ("specular", specular_room()), ("pane", wall_in_a_pane())];
    for (name, fixture) in scenes {
        let scene = fixture.build();
        let mutation = LensSubpath { max_edges: scene.max_edges() };
        assert_lawful(&format!("lens subpath, {name}"), &scene, &strategy(&mutation));
    }
}

#[test]
fn caustic_leaves_the_target_alone() {
    let scenes = [
        ("diffuse", diffuse_room()),
        ("specular", specular_room()),
        ("slab", slab_over_floor(false)),
    ];
    for (name, fixture) in scenes {
        let scene = fixture.build();
        let mutation = CausticPerturbation::new(scene.camera());
        assert_lawful(&format!("caustic, {name}"), &scene, &strategy(&mutation));
    }
}

#[test]
fn multi_chain_leaves_the_target_alone() {
    for (name, fixture) in [("specular", specular_room()), ("slab", slab_over_floor(true))] {
        let scene = fixture.build();
        let mutation = wide_multi_chain(&scene);
        assert_lawful(&format!("multi-chain, {name}"), &scene, &strategy(&mutation));
    }
}

#[test]
fn primary_leaves_the_target_alone() {
    let scenes = [
        ("diffuse", diffuse_room()),
        ("specular", specular_room()),
        ("glass", floor_through_glass()),
        ("slab", slab_over_floor(true)),
    ];
    for (name, fixture) in scenes {
        let scene = fixture.build();
        let mutation = Primary::default();
        assert_lawful(&format!("primary, {name}"), &scene, &strategy(&mutation));
    }
}

/// With angles wide enough to matter to a room.
fn wide_multi_chain(scene: &Scene) -> MultiChain {
    MultiChain { angle: Sizes { min: 1e-3, max: 0.5 }, ..MultiChain::new(scene.camera()) }
}

/// A wrong strategy must be found, by a margin.
fn assert_found(mutant: &Mutant<'_>, scene: &Scene, test: Test, samples: u64) {
    let suite = examine(mutant.name, scene, &mutant.propose, test, samples);
    let limit = z_limit(suite.len()).max(6.0);
    assert!(
        suite.worst() > limit,
        "{} was not found: worst |z| = {:.2} of {} functions",
        mutant.name,
        suite.worst(),
        suite.len()
    );
}

#[test]
fn wrong_bidirectional_mutations_are_found() {
    let scene = saturated_room().build();
    let right = Bidirectional { max_edges: scene.max_edges() };
    for mutant in mutants::of_bidirectional(right) {
        assert_found(&mutant, &scene, Test::Steps(3), 60_000);
    }
}

#[test]
fn wrong_independent_mutations_are_found() {
    let scene = specular_room().build();
    for mutant in mutants::of_independent(&independent(&scene)) {
        assert_found(&mutant, &scene, Test::Steps(3), 60_000);
    }
}

#[test]
fn wrong_lens_perturbations_are_found() {
    let on = |fixture: Fixture| fixture.build();
    let (room, pane) = (on(specular_room()), on(wall_in_a_pane()));
    // Large steps, so that many proposals meet the border of the film.
    let mut right = LensPerturbation::new(room.camera());
    right.radius.max = 16.0;
    for mutant in mutants::of_lens(right) {
        let scene = if mutant.needs_glass { &pane } else { &room };
        assert_found(&mutant, scene, Test::Proposals(10), 60_000);
    }
}

#[test]
fn wrong_lens_subpath_mutations_are_found() {
    let scene = wall_in_a_pane().build();
    for mutant in mutants::of_lens_subpath(LensSubpath { max_edges: scene.max_edges() }) {
        assert_found(&mutant, &scene, Test::Steps(3), 60_000);
    }
}

#[test]
fn wrong_caustic_perturbations_are_found() {
    let scene = slab_over_floor(false).build();
    let mut right = CausticPerturbation::new(scene.camera());
    right.radius.max = 16.0;
    for mutant in mutants::of_caustic(right) {
        assert_found(&mutant, &scene, Test::Proposals(10), 100_000);
    }
}

#[test]
fn wrong_multi_chain_perturbations_are_found() {
    let (slab, pane) = (slab_over_floor(true).build(), wall_and_lamp_in_a_pane().build());
    for mutant in mutants::of_multi_chain(wide_multi_chain(&slab)) {
        let scene = if mutant.needs_glass { &pane } else { &slab };
        assert_found(&mutant, scene, Test::Proposals(10), 300_000);
    }
}

#[test]
fn wrong_primary_mutations_are_found() {
    let (room, glass) = (specular_room().build(), floor_through_glass().build());
    for mutant in mutants::of_primary(Primary::default()) {
        let (scene, samples) = if mutant.needs_glass { (&glass, 240_000) } else { (&room, 60_000) };
        assert_found(&mutant, scene, Test::Steps(3), samples);
    }
}

/// The ratio of a move and of its reverse are reciprocal, and every cached value of a proposal is
/// what a path built from scratch would hold.
#[test]
fn proposals_are_reversible_and_their_caches_are_fresh() {
    let scene = specular_room().build();
    let b = Bidirectional { max_edges: scene.max_edges() };
    let (i, l) = (independent(&scene), LensPerturbation::new(scene.camera()));
    check_moves(&scene, &b);
    check_moves(&scene, &i);
    check_moves(&scene, &l);
    check_moves(&scene, &LensSubpath { max_edges: scene.max_edges() });
    check_moves(&scene, &CausticPerturbation::new(scene.camera()));
    check_moves(&scene, &Primary::default());
    check_moves(&slab_over_floor(true).build(), &MultiChain::new(scene.camera()));
}

fn check_moves<M: Mutation>(scene: &Scene, mutation: &M) {
    let mut bench = Bench::new(scene);
    let mut rng = Rng::new(3, Stream::Laboratory, 0);
    let mut checked = 0;
    for _ in 0..3000 {
        let film = DVec2::new(rng.uniform(), rng.uniform());
        let Bench { scene, sampler, hand: Hand { draft, x, y, .. } } = &mut bench;
        x.clone_from(&Path::default());
        sampler.sample(scene, film, &mut rng, |path, _| x.clone_from(path));
        if x.vertices().is_empty() || !mutation.applicable(x) {
            continue;
        }
        let Ok(via) = mutation.propose(scene, x, &mut rng, draft, y) else { continue };
        assert!(mutation.applicable(y), "{}: the way back is closed", M::NAME);
        let back = mutation.reverse(via);
        let forth = mutation.transition(y, x, back) / mutation.transition(x, y, via);
        if forth == 0.0 {
            // No split in the range makes `x`: the move could not be undone and is rejected.
            continue;
        }
        let there =
            mutation.transition(x, y, mutation.reverse(back)) / mutation.transition(y, x, back);
        assert!((forth * there - 1.0).abs() < 1e-9, "{}: {forth} and {there}", M::NAME);
        checked += 1;
        let (light, eye) = mutation.kept(x, via);
        let (xv, yv) = (x.vertices(), y.vertices());
        assert_eq!(xv[..light], yv[..light], "{}: kept at the light end", M::NAME);
        assert_eq!(xv[xv.len() - eye..], yv[yv.len() - eye..], "{}: kept at the lens", M::NAME);
        y.verify(scene);
    }
    assert!(checked > 200, "{}: only {checked} proposals came about", M::NAME);
}
