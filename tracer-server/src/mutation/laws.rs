//! Laws that every mutation strategy must obey.
//!
//! The core law is exact: bidirectional samples represent the target distribution without bias, so
//! applying a strategy to them, rejections included, must leave the expectation of every function
//! of the path as it was. No burn-in, no reference image and no convergence is involved.

use super::mutants::{self, Mutant};
use super::{
    Bidirectional, CausticPerturbation, Independent, KINDS, Kind, LensPerturbation, LensSubpath,
    Mixture, MixtureBasis, MultiChain, Mutation, Primary, Proposal, STRATEGY_COUNT, Sizes,
    Strategy, StrategyOptions, propose,
};
use crate::math::{Rng, Stream};
use crate::path::{BidirectionalSampler, CameraSample, Draft, Failure, Path};
use crate::scene::fixtures::{
    Fixture, bumpy_room, coated_room, diffuse_room, every_light, floor_through_glass,
    saturated_room, slab_over_floor, specular_room, wall_and_lamp_in_a_pane, wall_in_a_pane,
};
use crate::scene::{Scene, Tracer};
use crate::target::Target;
use crate::target::laws::targets;
use crate::verify::invariance::{Propose, Run, Test, Walk, by_itself};
use crate::verify::judge::{Finding, Law, Subject, Verdict, examine};

/// Findings among which the chance of a false alarm is shared.
const FAMILY: usize = 40;

/// Puts a way of proposing to the test on `samples` bidirectional samples, as `verify` does.
fn judged(name: &str, scene: &Scene, walk: Walk<'_>, test: Test, samples: u64) -> Vec<Finding> {
    let run = Run { test, samples, seed: 20, number: 0, threads: 2 };
    let subject = Subject { name, walk, family: FAMILY };
    let laws = [(Law::Invariance, "invariance"), (Law::Flow, "flow")];
    // Single steps carry no flow.
    let laws = if matches!(test, Test::Steps(_)) { &laws[..1] } else { &laws };
    examine(scene, &subject, &run, laws, &|_| ()).0
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
    assert_lawful_by(name, scene, whole(propose), 20_000, 15);
}

/// A way of proposing in a chain that visits all light as it is.
fn whole<'a>(propose: &'a Propose<'a>) -> Walk<'a> {
    Walk { propose, target: &Target::Whole }
}

/// With `samples` bidirectional samples for proposals, and three times as many for steps; at least
/// `least` functions must be exercised.
fn assert_lawful_by(name: &str, scene: &Scene, walk: Walk<'_>, samples: u64, least: usize) {
    let functions = judged_lawful(name, scene, walk, samples);
    assert!(functions >= least, "{name}: only {functions} functions were exercised");
}

/// That no law is broken; returns how many functions were judged by.
fn judged_lawful(name: &str, scene: &Scene, walk: Walk<'_>, samples: u64) -> usize {
    let mut functions = usize::MAX;
    for (test, samples) in [(Test::Steps(3), 3 * samples), (Test::Proposals(5), samples)] {
        let findings = judged(name, scene, walk, test, samples);
        functions = functions.min(findings[0].judged);
        for finding in findings {
            assert_ne!(finding.verdict, Verdict::Fail, "{test:?}: {finding:?}");
        }
    }
    functions
}

fn independent(scene: &Scene) -> Independent {
    let aperture = scene.camera().has_aperture();
    Independent::new(&ENERGY, scene.max_edges(), aperture)
}

fn bidirectional(scene: &Scene) -> Bidirectional {
    Bidirectional { max_edges: scene.max_edges(), aperture: scene.camera().has_aperture() }
}

fn lens_subpath(scene: &Scene) -> LensSubpath {
    LensSubpath { max_edges: scene.max_edges(), aperture: scene.camera().has_aperture() }
}

/// Every strategy that a scene may have, with sizes that matter to a room.
fn strategies(scene: &Scene) -> Mixture {
    let mut options = StrategyOptions::default();
    let angles = Sizes { min: 1e-3, max: 0.5 };
    options.set_parameter("multi-chain", "angle", &[angles.min, angles.max]).expect("it has one");
    Mixture::new(&options, &MixtureBasis::of(scene, &ENERGY))
}

/// What paths of so many edges carry, about.
const ENERGY: [f64; 7] = [0.0, 1.0, 4.0, 3.0, 2.0, 1.0, 1.0];

/// Every strategy with every light and lens. One that finds little to do in some of the scenes finds
/// enough in others.
#[test]
fn every_light_and_lens_is_lawful() {
    let mut exercised = [0; STRATEGY_COUNT];
    for (name, fixture) in every_light() {
        let scene = fixture.build();
        let mixture = strategies(&scene);
        for strategy in (0..mixture.len()).map(|index| mixture.get(index)) {
            let propose = by_itself(strategy);
            let title = format!("{}, {name}", strategy.name());
            let functions = judged_lawful(&title, &scene, whole(&propose), 6_000);
            if functions >= 5 && checked_moves(&scene, strategy) > 200 {
                exercised[kind_of(strategy)] += 1;
            }
        }
    }
    for (kind, exercised) in KINDS.iter().zip(exercised) {
        assert!(exercised >= 2, "{} was put to the test in {exercised} scenes", kind.name);
    }
}

/// The strategy's place in the table of kinds.
fn kind_of(strategy: &Strategy) -> usize {
    let of_kind = |kind: &Kind| kind.name == strategy.name();
    KINDS.iter().position(of_kind).expect("every strategy is of some kind")
}

#[test]
fn bidirectional_leaves_the_target_alone() {
    let rooms =
        [("diffuse", diffuse_room()), ("specular", specular_room()), ("coated", coated_room())];
    for (name, fixture) in rooms {
        let scene = fixture.build();
        let mutation = bidirectional(&scene);
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
        ("coated", coated_room()),
    ];
    for (name, fixture) in scenes {
        let scene = fixture.build();
        let mutation = LensPerturbation::new(scene.camera());
        assert_lawful(&format!("lens, {name}"), &scene, &strategy(&mutation));
    }
}

#[test]
fn lens_subpath_leaves_the_target_alone() {
    let scenes = [
        ("diffuse", diffuse_room()),
        ("specular", specular_room()),
        ("pane", wall_in_a_pane()),
        ("coated", coated_room()),
    ];
    for (name, fixture) in scenes {
        let scene = fixture.build();
        let mutation = lens_subpath(&scene);
        assert_lawful(&format!("lens subpath, {name}"), &scene, &strategy(&mutation));
    }
}

#[test]
fn caustic_leaves_the_target_alone() {
    let scenes = [
        ("diffuse", diffuse_room()),
        ("specular", specular_room()),
        ("slab", slab_over_floor(false)),
        ("coated", coated_room()),
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
        ("coated", coated_room()),
        ("bumpy", bumpy_room()),
    ];
    for (name, fixture) in scenes.into_iter().chain(every_light()) {
        let scene = fixture.build();
        let mutation = Primary::default();
        assert_lawful(&format!("primary, {name}"), &scene, &strategy(&mutation));
    }
}

/// With angles wide enough to matter to a room.
fn wide_multi_chain(scene: &Scene) -> MultiChain {
    MultiChain { angle: Sizes { min: 1e-3, max: 0.5 }, ..MultiChain::new(scene.camera()) }
}

/// Every strategy on everything that chains may visit.
#[test]
fn every_target_is_left_alone() {
    let scene = specular_room().build();
    let mixture = strategies(&scene);
    assert_eq!(mixture.len(), STRATEGY_COUNT, "the room has something for everyone");
    for strategy in (0..mixture.len()).map(|index| mixture.get(index)) {
        let propose = by_itself(strategy);
        for target in &targets(&scene) {
            let name = format!("{}, {}", strategy.name(), target.name());
            assert_lawful_by(&name, &scene, Walk { propose: &propose, target }, 8_000, 5);
        }
    }
}

/// A chain that forgets how much more often the proposal is to be visited.
#[test]
fn a_forgotten_target_is_found() {
    let scene = specular_room().build();
    for target in &targets(&scene) {
        let right = bidirectional(&scene);
        let wrong: Box<Propose<'_>> = Box::new(|scene, x, rng, draft, y| {
            let proposal = propose(&right, scene, x, rng, draft, y)?;
            // The test multiplies by this.
            let ratio = proposal.ratio / target.importance(y).rho;
            Ok(Proposal { ratio, ..proposal })
        });
        let name = format!("{}: rho of the proposal left out", target.name());
        assert_found_on(&name, &scene, Walk { propose: &wrong, target }, Test::Steps(3), 30_000);
    }
}

/// A wrong strategy must be found on every target, by a margin.
fn assert_found(mutant: &Mutant<'_>, scene: &Scene, test: Test, samples: u64) {
    for target in &[vec![Target::Whole], targets(scene)].concat() {
        let name = format!("{}, {}", mutant.name, target.name());
        let walk = Walk { propose: &mutant.propose, target };
        assert_found_on(&name, scene, walk, test, samples);
    }
}

#[expect(clippy::print_stdout, reason = "the table of what was found, with --nocapture")]
fn assert_found_on(name: &str, scene: &Scene, walk: Walk<'_>, test: Test, samples: u64) {
    let findings = judged(name, scene, walk, test, samples);
    let broken: Vec<_> = findings.iter().filter(|f| f.verdict == Verdict::Fail).collect();
    let worst = broken.iter().map(|f| f.worst).fold(0.0, f64::max);
    println!("{name:80} {worst:6.1} of {:4} at {}", findings[0].judged, findings[0].samples);
    assert!(worst > 6.0, "{name} was not found: {findings:?}");
}

#[test]
fn wrong_bidirectional_mutations_are_found() {
    let scene = saturated_room().build();
    let right = bidirectional(&scene);
    for mutant in mutants::of_bidirectional(right) {
        assert_found(&mutant, &scene, Test::Steps(3), 30_000);
    }
}

#[test]
fn wrong_independent_mutations_are_found() {
    let scene = specular_room().build();
    for mutant in mutants::of_independent(&independent(&scene)) {
        assert_found(&mutant, &scene, Test::Steps(3), 30_000);
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
        assert_found(&mutant, scene, Test::Proposals(10), 25_000);
    }
}

#[test]
fn wrong_lens_subpath_mutations_are_found() {
    let scene = wall_in_a_pane().build();
    for mutant in mutants::of_lens_subpath(lens_subpath(&scene)) {
        assert_found(&mutant, &scene, Test::Steps(3), 30_000);
    }
    let scene = coated_room().build();
    let right = lens_subpath(&scene);
    let mutant = mutants::of_lens_subpath_on_coats(right);
    assert_found(&mutant, &scene, Test::Steps(3), 60_000);
}

#[test]
fn wrong_caustic_perturbations_are_found() {
    let scene = slab_over_floor(false).build();
    let mut right = CausticPerturbation::new(scene.camera());
    right.radius.max = 16.0;
    for mutant in mutants::of_caustic(right) {
        assert_found(&mutant, &scene, Test::Proposals(10), 40_000);
    }
}

#[test]
fn wrong_multi_chain_perturbations_are_found() {
    let (slab, pane) = (slab_over_floor(true).build(), wall_and_lamp_in_a_pane().build());
    for mutant in mutants::of_multi_chain(wide_multi_chain(&slab)) {
        let scene = if mutant.needs_glass { &pane } else { &slab };
        assert_found(&mutant, scene, Test::Proposals(10), 200_000);
    }
}

#[test]
fn wrong_primary_mutations_are_found() {
    let (room, glass) = (specular_room().build(), floor_through_glass().build());
    for mutant in mutants::of_primary(Primary::default()) {
        let (scene, samples) = if mutant.needs_glass { (&glass, 100_000) } else { (&room, 60_000) };
        assert_found(&mutant, scene, Test::Steps(3), samples);
    }
}

/// The ratio of a move and of its reverse are reciprocal, and every cached value of a proposal is
/// what a path built from scratch would hold.
#[test]
fn proposals_are_reversible_and_their_caches_are_fresh() {
    let mut checked = [0; STRATEGY_COUNT];
    for fixture in [specular_room(), coated_room(), slab_over_floor(true)] {
        let scene = fixture.build();
        let mixture = strategies(&scene);
        for strategy in (0..mixture.len()).map(|index| mixture.get(index)) {
            checked[kind_of(strategy)] += checked_moves(&scene, strategy);
        }
    }
    for (kind, checked) in KINDS.iter().zip(checked) {
        assert!(checked > 300, "{}: only {checked} proposals came about", kind.name);
    }
}

/// Moves that are enough to look at in one scene, and paths that are tried for them: few paths of some
/// scenes have a chain of mirrors and glass before their last diffuse surface.
const MOVES: usize = 500;
/// See [`MOVES`].
const TRIES: usize = 12_000;

/// Looks closely at moves from many paths; returns how many there were, at most [`MOVES`].
fn checked_moves(scene: &Scene, strategy: &Strategy) -> usize {
    let scene = Tracer::new(scene);
    let mut sampler = BidirectionalSampler::new(&scene);
    let (mut draft, mut x, mut y) = (Draft::default(), Path::default(), Path::default());
    let mut rng = Rng::new(3, Stream::Laboratory, 0);
    let name = strategy.name();
    let mut checked = 0;
    for _ in 0..TRIES {
        if checked == MOVES {
            break;
        }
        let aim = CameraSample::from_numbers(&scene, &mut rng);
        x.clone_from(&Path::default());
        sampler.sample(&scene, aim, &mut rng, |path, _| x.clone_from(path));
        if x.vertices().is_empty() || !strategy.applicable(&x) {
            continue;
        }
        let Ok(seen) = strategy.inspect(&scene, &x, &mut rng, &mut draft, &mut y) else {
            continue;
        };
        assert!(seen.applies_back, "{name}: the way back is closed");
        assert_eq!(seen.flaw, None, "{name}: the proposal is sound");
        // A move that could not be undone has the ratio zero, and is rejected.
        if seen.forth != 0.0 {
            let product = seen.forth * seen.back;
            assert!((product - 1.0).abs() < 1e-9, "{name}: {seen:?}");
            checked += 1;
        }
    }
    checked
}
