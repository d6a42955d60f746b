//! Laws of base samplers: with what is left to the chains, they carry all of the light.

use tests::{Accumulator, Suite};

use super::{BaseSampler, Pass, path};
use crate::film::Film;
use crate::math::{Rng, Strata, Stream};
use crate::path::{BidirectionalSampler, CameraSample};
use crate::scene::fixtures::{Fixture, coated_room, diffuse_room, every_light, specular_room};
use crate::scene::{Scene, Tracer};
use crate::target::laws::middling;
use crate::target::{Base, Selective};

/// Side of the film in pixels.
const SIDE: u32 = 6;
/// Independent pictures by each way.
const RUNS: u64 = 32;
/// Passes of a picture.
const PASSES: u32 = 8;

/// What the base sampler makes of its share of the light: `share` is right, or a mutant.
fn by_base(scene: &Scene, selective: Selective, seed: u64) -> Film {
    let scene = Tracer::new(scene);
    let strata = Strata::new(seed, Stream::Base, 0);
    let mut film = Film::new(SIDE, SIDE);
    let mut sampler = BaseSampler::new(&scene, selective);
    for index in 0..PASSES {
        sampler.pass(&scene, Pass { strata, index }, 0..SIDE, &mut film);
    }
    film.scale(1.0 / f64::from(PASSES));
    film
}

/// The same, of bidirectional samples of whole paths: `1 - g` of each.
fn by_paths(scene: &Scene, selective: Selective, seed: u64) -> Film {
    let scene = Tracer::new(scene);
    let mut film = Film::new(SIDE, SIDE);
    let mut sampler = BidirectionalSampler::new(&scene);
    let mut rng = Rng::new(seed, Stream::Laboratory, 5);
    let samples = 20 * SIDE * SIDE;
    for _ in 0..samples {
        let aim = CameraSample::from_numbers(&scene, &mut rng);
        sampler.sample(&scene, aim, &mut rng, |path, weight| {
            let share = selective.base_share(selective.base.density_sum(path), path.edge_count());
            film.splat(path.pixel(), path.unit_color() * (share * weight));
        });
    }
    film.scale(f64::from(SIDE * SIDE) / f64::from(samples));
    film
}

/// Deviations of two ways to make a picture, pixel by pixel and channel by channel.
fn compare(name: &str, a: impl Fn(u64) -> Film, b: impl Fn(u64) -> Film) -> Suite {
    let gather = |make: &dyn Fn(u64) -> Film| -> Vec<[Accumulator; 4]> {
        let mut sums = vec![[Accumulator::default(); 4]; (SIDE * SIDE) as usize + 1];
        for seed in 0..RUNS {
            let film = make(seed);
            for (sum, pixel) in sums.iter_mut().zip(film.pixels().iter().chain([&film.mean()])) {
                let values = [pixel.r, pixel.g, pixel.b, pixel.luminance()];
                sum.iter_mut().zip(values).for_each(|(sum, value)| sum.push(value));
            }
        }
        sums
    };
    let mut suite = Suite::new(name);
    for (place, (x, y)) in gather(&a).iter().zip(gather(&b)).enumerate() {
        for (channel, (x, y)) in x.iter().zip(y).enumerate() {
            suite.record(format!("{place}, channel {channel}"), tests::welch_z(x, &y));
        }
    }
    suite
}

fn scenes() -> Vec<(&'static str, Fixture)> {
    let rooms =
        [("diffuse", diffuse_room()), ("specular", specular_room()), ("coated", coated_room())];
    rooms.into_iter().chain(every_light()).collect()
}

#[test]
fn base_samplers_carry_their_share() {
    for (name, fixture) in scenes() {
        let scene = fixture.film(SIDE, SIDE).build();
        for base in Base::ALL {
            let middle = middling(&scene, base);
            for tau in [0.1 * middle, middle, f64::INFINITY] {
                let selective = Selective { base, tau };
                let name = format!("{name}, {}, tau {tau}", base.name());
                let suite = compare(
                    &name,
                    |seed| by_base(&scene, selective, seed),
                    |seed| by_paths(&scene, selective, seed),
                );
                assert!(suite.verdict().is_pass(), "{}", suite.verdict());
            }
        }
    }
}

/// The share is a function of the path: a sampler that reads it off the weight of its sample, in which
/// the odds of roulette are, makes another picture.
#[test]
fn a_share_by_the_weight_of_a_sample_is_found() {
    let scene = diffuse_room().film(SIDE, SIDE).max_edges(12).build();
    let selective = Selective { base: Base::Path, tau: 0.3 * middling(&scene, Base::Path) };
    let wrong = |seed| {
        let scene = Tracer::new(&scene);
        let mut film = Film::new(SIDE, SIDE);
        let mut rng = Rng::new(seed, Stream::Laboratory, 6);
        let samples = 400 * SIDE * SIDE;
        for _ in 0..samples {
            let aim = CameraSample::from_numbers(&scene, &mut rng);
            let pixel = scene.camera().pixel(aim.film);
            path::terms(&scene, &aim, &mut rng, |term| {
                let counted = term.contribution * (1.0 / term.survival);
                let share = selective.base_share(1.0 / counted.luminance(), term.edges);
                film.splat(pixel, counted * share);
            });
        }
        film.scale(f64::from(SIDE * SIDE) / f64::from(samples));
        film
    };
    let suite = compare("share by the weight", wrong, |seed| by_paths(&scene, selective, seed));
    assert!(suite.worst() > 8.0, "not found: {}", suite.verdict());
}

/// Even numbers make less noise than random ones would: here at most half the variance.
#[test]
fn even_numbers_make_less_noise() {
    let scene = diffuse_room().film(SIDE, SIDE).build();
    let selective = Selective { base: Base::Path, tau: f64::INFINITY };
    let variance = |make: &dyn Fn(u64) -> Film| -> f64 {
        let mut sums = vec![Accumulator::default(); (SIDE * SIDE) as usize];
        for seed in 0..RUNS {
            let film = make(seed);
            sums.iter_mut().zip(film.pixels()).for_each(|(sum, p)| sum.push(p.luminance()));
        }
        sums.iter().map(Accumulator::variance).sum()
    };
    let even = variance(&|seed| by_base(&scene, selective, seed));
    let random = variance(&|seed| {
        let mut tracer = crate::integrator::PathTracer::new(&scene, seed);
        tracer.advance(&scene, u64::from(PASSES), 2);
        let mut film = tracer.image(&scene);
        film.scale(1.0 / scene.radiance_scale());
        film
    });
    assert!(even < 0.7 * random, "{even} against {random}");
}
