//! Laws of replicates: their mean is the picture, however small they are, and their sums are the same
//! bits whatever the order and the grouping.

use std::sync::Arc;

use common::ChainId;
use glam::DVec3;
use tests::{Accumulator, Suite, welch_z};

use super::{
    Dial, Ledger, Limits, Origin, Part, PartError, Picture, Plan, PlanSettings, Replicate,
    Selection, prepare,
};
use crate::chain::{Chain, Kernel, Pool, PoolKey, Source};
use crate::film::Film;
use crate::integrator::laws::bidirectional;
use crate::math::{Rng, Stream};
use crate::mutation::{Mixture, MixtureBasis, StrategyOptions};
use crate::parallel::Stop;
use crate::path::{BidirectionalSampler, CameraSample, Path};
use crate::scene::fixtures::{Fixture, GLASS, coated_room, diffuse_room, open_room, specular_room};
use crate::scene::{LightKind, Scene, Tracer};
use crate::target::laws::targets;
use crate::target::{Base, Target};

pub(super) fn settings(seed: u64, dial: Dial) -> PlanSettings {
    PlanSettings { seed, threads: 2, strategies: StrategyOptions::default(), dial }
}

/// A plan for small pictures, with small pools and short chains.
pub(super) fn plan(scene: &Scene, seed: u64, dial: Dial) -> Plan {
    let plan = prepare(scene, &settings(seed, dial), &Stop::default());
    let chains = plan.chains.min(8);
    Plan { parts: 2, pool: plan.pool.min(64), chains, steps: 40, ..plan }
}

pub(super) fn made(scene: &Scene, plan: &Plan, selection: &str, threads: usize) -> Picture {
    let mut picture = Picture::new(scene, plan);
    let stop = Stop::default();
    let limits = Limits { deadline: None, stop: &stop, threads };
    let selection: Selection = selection.parse().expect("a selection");
    picture.work(scene, plan, &selection, &limits, &mut |_, _| ());
    picture
}

fn origin(settings: &str) -> Origin {
    Origin {
        version: "1".to_owned(),
        scene: "room".to_owned(),
        scene_hash: "2".to_owned(),
        settings_hash: settings.to_owned(),
        settings: settings.to_owned(),
        size: [16, 12],
        radiance_scale: 1_f64.to_bits(),
    }
}

/// A part that went through a file.
fn filed(ledger: Ledger, settings: &str) -> Part {
    let part = Part { origin: origin(settings), ledger };
    let mut bytes = Vec::new();
    part.write(&mut bytes).expect("in memory");
    let read = Part::read(&bytes[..]).expect("what was written");
    assert_eq!(read, part, "a file holds every bit");
    let place = bytes.len() / 2;
    bytes[place] ^= 1;
    assert!(matches!(Part::read(&bytes[..]), Err(PartError::Damaged)), "one bit is wrong");
    assert!(matches!(Part::read(&bytes[..place]), Err(PartError::Damaged)), "half is missing");
    assert!(matches!(Part::read(&b"a picture of something"[..]), Err(PartError::Foreign)));
    read
}

#[test]
fn parts_add_up_to_the_bits_of_one_run() {
    let scene = specular_room().film(16, 12).build();
    let plan = plan(&scene, 3, Dial::default());
    assert!(plan.chains > 0 && plan.base.is_some(), "both do something: {plan:?}");
    let whole = made(&scene, &plan, "0..8", 1);
    assert!(whole.image().mean().luminance() > 0.0, "there is light");
    for threads in [2, 5] {
        let other = made(&scene, &plan, "0..8", threads);
        assert!(other.ledger == whole.ledger, "{threads} threads");
        assert_eq!(other.statistics.steps, whole.statistics.steps, "{threads} threads");
    }
    for groups in [&["0..3", "3..8"][..], &["5..8", "0..3,4..5", "3..4"], &["6..8", "0..6"]] {
        let mut parts = groups.iter().map(|g| filed(made(&scene, &plan, g, 2).ledger, "a"));
        let mut sum = parts.next().expect("a part");
        for part in parts {
            sum.merge(&part).expect("they belong together");
        }
        assert!(sum.ledger == whole.ledger, "{groups:?}");
    }
    // Going on from a part.
    let mut resumed = made(&scene, &plan, "2..5", 2);
    let stop = Stop::default();
    let limits = Limits { deadline: None, stop: &stop, threads: 2 };
    resumed.work(&scene, &plan, &Selection::first(8), &limits, &mut |_, _| ());
    assert!(resumed.ledger == whole.ledger, "resumed");
    // What does not belong together.
    let mut part = filed(made(&scene, &plan, "0..3", 2).ledger, "a");
    let again = filed(made(&scene, &plan, "2..4", 2).ledger, "a");
    assert!(matches!(part.merge(&again), Err(PartError::Twice(2))), "twice");
    let other = filed(made(&scene, &plan, "3..4", 2).ledger, "b");
    assert!(matches!(part.merge(&other), Err(PartError::Differs { .. })), "other settings");
}

#[test]
fn a_picture_that_time_has_cut_can_be_made_again() {
    let scene = specular_room().film(16, 12).build();
    let plan = plan(&scene, 4, Dial::default());
    let cut = made(&scene, &plan, "0..2,2:1,5:1", 1);
    let again = made(&scene, &plan, &cut.selection().to_string(), 3);
    assert!(cut.image() == again.image(), "the same bits");
    assert_eq!(cut.selection().to_string(), "0..2,2:1,5:1");
    assert_eq!(cut.ledger.count(), 2, "the spread is of whole replicates");
    // The picture is the mean, weighted by the work.
    let mut expected = made(&scene, &plan, "0..2", 1).ledger.sum();
    for number in [2, 5] {
        let tracer = Tracer::new(&scene);
        let mut replicate = Replicate::begin(&tracer, &plan, number, Film::new(16, 12));
        assert!(replicate.part(&|| false), "nobody stops it");
        expected.add_scaled(&replicate.finish().film, 0.5);
    }
    expected.scale(1.0 / 3.0);
    assert!(cut.image() == expected, "a half counts half");
}

/// Compares means over many small pictures pixel by pixel, and as a whole.
fn compare(name: &str, a: &[Film], b: &[Film]) -> Suite {
    let sums = |films: &[Film]| -> Vec<[Accumulator; 3]> {
        let mut sums = vec![[Accumulator::default(); 3]; films[0].pixels().len() + 1];
        for film in films {
            let pixels = film.pixels().iter().copied().chain([film.mean()]);
            for (sum, pixel) in sums.iter_mut().zip(pixels) {
                let values: [f64; 3] = pixel.into();
                sum.iter_mut().zip(values).for_each(|(sum, value)| sum.push(value));
            }
        }
        sums
    };
    let mut suite = Suite::new(name);
    for (place, (a, b)) in sums(a).iter().zip(sums(b)).enumerate() {
        for (channel, (a, b)) in a.iter().zip(b).enumerate() {
            suite.record(format!("{place}, channel {channel}"), welch_z(a, &b));
        }
    }
    suite
}

fn references(scene: &Scene) -> Vec<Film> {
    (0..24).map(|seed| bidirectional(scene, 900 + seed, 160)).collect()
}

fn scenes() -> [(&'static str, Fixture); 4] {
    let position = DVec3::new(0.3, 0.7, 0.2);
    let point = LightKind::Point { position, intensity: common::Rgb::new(3.0, 2.5, 2.0) };
    [
        ("diffuse", diffuse_room()),
        ("specular", specular_room()),
        ("coated", coated_room()),
        ("point light", open_room().light(point)),
    ]
}

/// Whatever the dial, base samples and chains make the same picture: none of the light for the chains,
/// all of it, and what lies between.
#[test]
fn every_dial_makes_the_same_picture() {
    for (name, fixture) in scenes() {
        let scene = fixture.film(6, 6).build();
        let expected = references(&scene);
        let dials = [Some(0.0), Some(0.05), None, Some(4.0), Some(f64::INFINITY)];
        for (number, tau) in (0_u64..).zip(dials) {
            for base in [None, Some(Base::Path), Some(Base::Bidirectional)] {
                if base.is_some() == (tau.is_none() || tau == Some(0.0)) {
                    continue;
                }
                let plan = plan(&scene, 60 + number, Dial { base, tau });
                let made = |run: u64| {
                    let range = format!("{}..{}", 12 * run, 12 * run + 12);
                    let mut image = made(&scene, &plan, &range, 2).image();
                    image.scale(scene.radiance_scale());
                    image
                };
                let images: Vec<Film> = (0..24).map(made).collect();
                let suite = compare(&format!("{name}, {tau:?}, {base:?}"), &images, &expected);
                assert!(suite.verdict().is_pass(), "{}", suite.verdict());
            }
        }
    }
}

/// What may be wrong with a small replicate of chains.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Flaw {
    None,
    /// Splats without `h / rho`.
    ShareForgotten,
    /// Seeds from samples that a path tracer could draw.
    PathTracedPool,
    /// The mean `b` of all replicates in the place of their own.
    PooledB,
}

const POOL: u64 = 2;
const CHAINS: u32 = 1;
const STEPS: usize = 4;

/// Pools whose samples a flaw may have thinned.
fn pool(source: &mut Source<'_, '_>, tracer: &Tracer<'_>, key: PoolKey, flaw: Flaw) -> Pool {
    if flaw != Flaw::PathTracedPool {
        return source.pool(POOL);
    }
    let mut sampler = BidirectionalSampler::new(tracer);
    let weight = |number| {
        let mut rng = Rng::new(key.seed, Stream::Bootstrap, key.number << 32 | number);
        let aim = CameraSample::from_numbers(tracer, &mut rng);
        let mut sum = 0.0;
        sampler.sample(tracer, aim, &mut rng, |path, weight| {
            if Base::Path.density_sum(path) > 0.0 {
                sum += weight;
            }
        });
        sum
    };
    Pool::of((0..POOL).map(weight).collect())
}

/// Seeds in proportion to the weights of a pool that may be thinned.
fn seeds(
    source: &mut Source<'_, '_>,
    (tracer, key): (&Tracer<'_>, PoolKey),
    pool: &Pool,
    flaw: Flaw,
) -> Vec<Path> {
    if flaw != Flaw::PathTracedPool {
        return source.seeds(pool, CHAINS);
    }
    let mut choice = Rng::new(key.seed, Stream::Resampling, key.number);
    let mut sampler = BidirectionalSampler::new(tracer);
    let numbers = pool.resample(CHAINS, &mut choice);
    let pick = |(number, _): (u64, f64)| {
        let mut rng = Rng::new(key.seed, Stream::Bootstrap, key.number << 32 | number);
        let aim = CameraSample::from_numbers(tracer, &mut rng);
        let (mut chosen, mut sum) = (None, 0.0);
        sampler.sample(tracer, aim, &mut rng, |path, weight| {
            if Base::Path.density_sum(path) > 0.0 {
                sum += weight;
                if choice.uniform() * sum < weight {
                    chosen = Some(path.clone());
                }
            }
        });
        chosen
    };
    numbers.into_iter().filter_map(pick).collect()
}

/// The pictures of `count` small replicates that visit `target` and show all of the light: their own
/// code, which counts the state after every step.
fn small(scene: &Scene, target: &Target, count: u64, flaw: Flaw) -> Vec<Film> {
    let tracer = Tracer::new(scene);
    let basis = MixtureBasis::of(scene, &[]);
    let mixture = Mixture::new(&StrategyOptions::default(), &basis);
    let kernel = Arc::new(Kernel { mixture, target: target.clone() });
    let camera = scene.camera();
    let (mut films, mut normalizations) = (Vec::new(), Accumulator::default());
    let mut scratch = Film::new(camera.width, camera.height);
    for number in 0..count {
        let key = PoolKey { seed: 8, number };
        let mut source = Source::new(&tracer, key, target);
        let pool = pool(&mut source, &tracer, key, flaw);
        let b = pool.normalization();
        normalizations.push(b);
        let mut film = Film::new(camera.width, camera.height);
        let seeds = seeds(&mut source, (&tracer, key), &pool, flaw);
        for (id, seed) in (0_u64..).zip(seeds) {
            let rng = Rng::new(8, Stream::Chain, number << 8 | id);
            let mut chain = Chain::with_stream(ChainId(0), rng, seed, &kernel);
            for _ in 0..STEPS {
                chain.step(&tracer, &kernel, &mut scratch);
                let x = chain.current();
                let share =
                    if flaw == Flaw::ShareForgotten { 1.0 } else { target.importance(x).share };
                film.splat(x.pixel(), x.unit_color() * share);
            }
        }
        let steps = f64::from(CHAINS) * STEPS as f64;
        let b = if flaw == Flaw::PooledB { 1.0 } else { b };
        film.scale(b * camera.pixel_count() as f64 / steps * scene.radiance_scale());
        films.push(film);
    }
    if flaw == Flaw::PooledB {
        for film in &mut films {
            film.scale(normalizations.mean());
        }
    }
    films
}

/// Groups of a hundred replicates, whose means are as good as normally distributed.
fn grouped(films: &[Film]) -> Vec<Film> {
    let mean = |group: &[Film]| {
        let mut sum = Film::sum(group);
        sum.scale(1.0 / group.len() as f64);
        sum
    };
    films.chunks(100).map(mean).collect()
}

/// Replicates of two samples and a chain of four steps have the right mean on targets that
/// show all of the light; and each of the errors that are easily made is found.
#[test]
fn small_replicates_have_the_right_mean() {
    let position = DVec3::new(0.3, 0.7, 0.2);
    let point = LightKind::Point { position, intensity: common::Rgb::grey(3.0) };
    // All of the light that the ball throws on the floor is out of a path tracer's reach.
    let glass = open_room().sphere(GLASS, common::Rgb::BLACK, [0.1, -0.2, 0.0], 0.5);
    let glass = glass.light(point).film(4, 4).build();
    let room = specular_room().film(4, 4).build();
    let equalised = targets(&room).swap_remove(1);
    let made = |scene: &Scene, target: &Target, flaw| {
        // Its error is small where pools are not.
        let count = if flaw == Flaw::PooledB { 48_000 } else { 12_000 };
        grouped(&small(scene, target, count, flaw))
    };
    let whole = Target::Whole;
    for (name, scene, target) in [("room", &room, &equalised), ("glass", &glass, &whole)] {
        let suite = compare(name, &made(scene, target, Flaw::None), &references(scene));
        assert!(suite.verdict().is_pass(), "{}", suite.verdict());
    }
    for (name, scene, target, flaw) in [
        ("h / rho forgotten", &room, &equalised, Flaw::ShareForgotten),
        ("seeds of a path tracer", &glass, &whole, Flaw::PathTracedPool),
        // A pool of two often has one bright sample, and shows the light of both in its place.
        ("b of all replicates", &glass, &whole, Flaw::PooledB),
    ] {
        let suite = compare(name, &made(scene, target, flaw), &references(scene));
        assert!(suite.worst() > 6.0, "{name} was not found: {}", suite.verdict());
    }
}

/// The first part of a replicate is an unbiased picture; counted as a whole one it would be too dark.
#[test]
fn a_cut_replicate_is_found_when_counted_whole() {
    let scene = specular_room().film(4, 4).build();
    let plan = plan(&scene, 5, Dial::default());
    let cut = |number: u64, factor: f64| {
        let tracer = Tracer::new(&scene);
        let mut replicate = Replicate::begin(&tracer, &plan, number, Film::new(4, 4));
        replicate.part(&|| false);
        let mut film = replicate.finish().film;
        film.scale(factor * scene.radiance_scale());
        film
    };
    let made = |factor| grouped(&(0..3000).map(|n| cut(n, factor)).collect::<Vec<_>>());
    let expected = references(&scene);
    let suite = compare("cut", &made(1.0), &expected);
    assert!(suite.verdict().is_pass(), "{}", suite.verdict());
    let suite = compare("counted whole", &made(0.5), &expected);
    assert!(suite.worst() > 6.0, "not found: {}", suite.verdict());
}

/// Light that is brighter by a power of two makes the same bits.
#[test]
fn powers_of_two_of_light_change_no_bit() {
    let base = specular_room().film(12, 8);
    let render = |factor: f64| {
        let mut fixture = base.clone();
        for material in &mut fixture.description.materials {
            material.emission = material.emission * factor;
        }
        let scene = fixture.build();
        let plan = prepare(&scene, &settings(6, Dial::default()), &Stop::default());
        let mut image = made(&scene, &plan, "0..3", 2).image();
        image.scale(scene.radiance_scale());
        image
    };
    let expected = render(1.0);
    for exponent in [-90, 90] {
        let factor = 2_f64.powi(exponent);
        let mut image = render(factor);
        image.scale(1.0 / factor);
        assert!(image == expected, "light times 2^{exponent}");
    }
}

/// What the spread of replicates says of a picture is how far pictures are apart.
#[test]
fn the_spread_tells_the_error() {
    let scene = diffuse_room().film(8, 8).build();
    let plan = plan(&scene, 7, Dial::default());
    let mut pixels = vec![Accumulator::default(); 64];
    let (mut told, mut noises) = (vec![0.0; 64], Accumulator::default());
    const RUNS: u64 = 60;
    let mut images = Vec::new();
    for run in 0..RUNS {
        let picture = made(&scene, &plan, &format!("{}..{}", 16 * run, 16 * run + 16), 2);
        let image = picture.image();
        pixels.iter_mut().zip(image.pixels()).for_each(|(sum, p)| sum.push(p.luminance()));
        let errors = picture.ledger.standard_errors();
        told.iter_mut().zip(&errors).for_each(|(sum, e)| *sum += f64::from(*e).powi(2));
        noises.push(picture.ledger.noise().powi(2));
        images.push(image);
    }
    let seen: f64 = pixels.iter().map(Accumulator::variance).sum();
    let said: f64 = told.iter().sum::<f64>() / RUNS as f64;
    assert!((said / seen - 1.0).abs() < 0.12, "variance {said} instead of {seen}");
    let mut mean = Film::sum(&images);
    mean.scale(1.0 / RUNS as f64);
    let errors: Accumulator = images
        .iter()
        .map(|image| common::relative_mse(image.pixels(), mean.pixels()) * 60.0 / 59.0)
        .collect();
    let ratio = noises.mean() / errors.mean();
    assert!((ratio - 1.0).abs() < 0.12, "relMSE {} instead of {}", noises.mean(), errors.mean());
}
