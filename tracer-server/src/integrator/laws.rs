//! Laws of images: closed forms, three integrators that must agree, and bits that must not change.

use common::Rgb;
use glam::DVec3;
use tests::{Accumulator, Suite, ZScore, block_means, z_map};

use super::pssmlt::{PrimaryEnsemble, PrimarySampler, PrimarySettings};
use super::{BidirectionalTracer, PathTracer};
use crate::bsdf::{BsdfDescription, DielectricDescription, MirrorDescription};
use crate::chain::{Ensemble, EnsembleSettings};
use crate::film::Film;
use crate::scene::fixtures::{
    Fixture, GLASS, bumpy_room, coated_room, diffuse_room, every_light, lambert, specular_room,
    wall_in_a_pane,
};
use crate::scene::load::load;
use crate::scene::{LightKind, Scene, builtin};

pub(crate) const BLACK: BsdfDescription = lambert(0.0, 0.0, 0.0);

pub(crate) fn settings(seed: u64, chains: u32) -> EnsembleSettings {
    EnsembleSettings {
        seed,
        chains,
        threads: 2,
        bootstrap_samples: 1 << 14,
        ..EnsembleSettings::default()
    }
}

pub(crate) fn path_traced(scene: &Scene, seed: u64, samples: u64) -> Film {
    let mut tracer = PathTracer::new(scene, seed);
    tracer.advance(scene, samples, 2);
    tracer.image(scene)
}

pub(crate) fn bidirectional(scene: &Scene, seed: u64, samples: u64) -> Film {
    let mut tracer = BidirectionalTracer::new(scene, seed);
    tracer.advance(scene, samples, 2);
    tracer.image(scene)
}

pub(crate) fn metropolis(scene: &Scene, seed: u64, steps: u64) -> Film {
    let mut ensemble = Ensemble::new(scene, &settings(seed, 64), |_| ());
    ensemble.advance(scene, steps, None);
    ensemble.image(scene)
}

fn primary_sample(scene: &Scene, sampler: PrimarySampler, seed: u64, steps: u64) -> Film {
    let primary = PrimarySettings { sampler, ..PrimarySettings::default() };
    let mut ensemble = PrimaryEnsemble::new(scene, &settings(seed, 64), primary, |_| ());
    ensemble.advance(scene, steps);
    ensemble.image(scene)
}

pub(crate) fn pixels(film: &Film) -> Vec<[f64; 3]> {
    film.pixels().iter().map(|&pixel| pixel.into()).collect()
}

/// Independent runs, each with its own seed and, for the chains, its own pool.
fn runs(render: impl Fn(u64) -> Film) -> Vec<Vec<[f64; 3]>> {
    (0..16).map(|seed| pixels(&render(seed))).collect()
}

/// Compares two sets of runs pixel by pixel, in blocks and as a whole.
fn compare(name: &str, a: &[Vec<[f64; 3]>], b: &[Vec<[f64; 3]>], width: usize) {
    let blocks = |runs: &[Vec<[f64; 3]>], size| -> Vec<_> {
        runs.iter().map(|run| block_means(run, width, size)).collect()
    };
    for (what, size) in [("pixels", 1), ("blocks", 4), ("the whole", width)] {
        let suite = z_map(&format!("{name}, {what}"), &blocks(a, size), &blocks(b, size));
        let verdict = suite.verdict();
        assert!(verdict.is_pass(), "{verdict}");
        if size == 1 {
            // The tiles of a chain's image err together: half as many degrees of freedom.
            let spread = 5.0 * (4.0 / suite.len() as f64).sqrt();
            assert!((suite.mean_square() - 1.0).abs() < spread, "{name}: {}", suite.mean_square());
        }
    }
}

fn assert_agreement(name: &str, fixture: Fixture) {
    let scene = fixture.film(16, 16).build();
    let by_bdpt = runs(|seed| bidirectional(&scene, seed + 100, 32));
    let by_mlt = runs(|seed| metropolis(&scene, seed + 200, 3000));
    let features = scene.features();
    // A path tracer cannot find the caustics of lights that nothing can hit.
    let path_finds_all = features.hittable || !features.specular;
    if path_finds_all {
        let by_path = runs(|seed| path_traced(&scene, seed, 128));
        compare(&format!("{name}: path and bdpt"), &by_path, &by_bdpt, 16);
    }
    compare(&format!("{name}: bdpt and mlt"), &by_bdpt, &by_mlt, 16);
    let samplers = [(PrimarySampler::Bdpt, 300, 1000), (PrimarySampler::Path, 400, 3000)];
    for (sampler, seed, steps) in samplers.into_iter().take(1 + usize::from(path_finds_all)) {
        let by_pssmlt = runs(|run| primary_sample(&scene, sampler, seed + run, steps));
        let what = format!("{name}: bdpt and pssmlt over {}", sampler.name());
        compare(&what, &by_bdpt, &by_pssmlt, 16);
    }
}

#[test]
fn integrators_agree_on_a_diffuse_room() {
    assert_agreement("diffuse", diffuse_room());
}

#[test]
fn integrators_agree_on_a_room_with_glass_and_mirror() {
    assert_agreement("specular", specular_room());
}

#[test]
fn integrators_agree_on_coats_and_rough_surfaces() {
    assert_agreement("coated", coated_room());
}

#[test]
fn integrators_agree_on_shading_normals() {
    assert_agreement("bumpy", bumpy_room());
}

#[test]
fn integrators_agree_on_a_wall_in_a_pane() {
    assert_agreement("pane", wall_in_a_pane());
}

#[test]
fn integrators_agree_on_every_light_and_lens() {
    for (name, fixture) in every_light() {
        assert_agreement(name, fixture);
    }
}

/// Radiance of a Lambert sphere of radius `radius` with a point light of intensity `i` in its
/// middle: `E = I / (R^2 (1 - rho))`, `L = rho E / pi`; here with at most `n` edges.
#[test]
fn a_point_light_fills_a_sphere() {
    let (rho, radius, i, n) = (0.6_f64, 0.8_f64, 2.0, 5_u16);
    // From outside one looks through the back of the near side, which is lit alike.
    let scene = Fixture::new(DVec3::new(0.1, 0.0, 0.3), DVec3::new(0.0, 0.1, -1.0), 60.0)
        .sphere(lambert(rho, rho, rho), Rgb::BLACK, [0.0; 3], radius)
        .light(LightKind::Point { position: DVec3::ZERO, intensity: Rgb::grey(i) })
        .film(8, 8)
        .max_edges(n.into())
        .build();
    let direct = rho * i / (radius * radius) / std::f64::consts::PI;
    let expected = direct * (1.0 - rho.powi(i32::from(n) - 1)) / (1.0 - rho);
    assert_mean_of_all("point light in a sphere", expected, &scene);
}

/// A plane under the sun: `L = rho E cos / pi`.
#[test]
fn the_sun_lights_a_plane() {
    let direction = DVec3::new(1.0, -2.0, 0.5);
    let scene = Fixture::new(DVec3::new(0.0, 1.0, 0.4), DVec3::ZERO, 10.0)
        .quad(lambert(0.6, 0.6, 0.6), Rgb::BLACK, [-9., 0., -9.], [0., 0., 18.], [18., 0., 0.])
        .light(LightKind::Directional { direction, irradiance: Rgb::grey(3.0) })
        .film(4, 4)
        .max_edges(2)
        .build();
    let cosine = -direction.normalize().y;
    assert_mean_of_all("sun", 0.6 * 3.0 * cosine / std::f64::consts::PI, &scene);
}

/// Glass under an even sky is invisible.
#[test]
fn glass_under_an_even_sky_is_invisible() {
    let clear = BsdfDescription::from(DielectricDescription::clear(1.5));
    let (radiance, rotation) = (Rgb::grey(2.0), glam::DMat3::IDENTITY);
    let scene = Fixture::new(DVec3::new(0.0, 0.0, 1.2), DVec3::ZERO, 50.0)
        .sphere(clear, Rgb::BLACK, [0.0; 3], 0.5)
        .light(LightKind::Environment { radiance, image: None, rotation })
        .film(8, 8)
        .max_edges(48)
        .build();
    assert_mean_of_all("glass under the sky", 2.0, &scene);
}

/// The largest error of a mean that escapes, relative to what it should be.
const BOUND: f64 = 0.01;
/// Independent runs, at most.
const MOST_RUNS: u64 = 2048;

/// Standard errors by which the mean of so many runs may be off, with a chance of less than 1e-6 for all
/// closed forms together: few runs make a Student's t with heavy tails.
fn margin(runs: u64) -> f64 {
    if runs < 64 { 9.0 } else { 6.5 }
}

/// Checks the mean of an image against a closed form, from as many independent runs as it takes to
/// find an error of [`BOUND`].
fn assert_mean(name: &str, expected: f64, render: impl Fn(u64) -> Film) {
    let mut mean = Accumulator::default();
    let mut tolerance = f64::INFINITY;
    for seed in 0..MOST_RUNS {
        mean.push(render(seed).mean().g);
        let runs = seed + 1;
        tolerance = margin(runs) * mean.standard_error();
        if runs >= 16 && tolerance <= BOUND * expected {
            break;
        }
    }
    assert!(tolerance <= BOUND * expected, "{name}: too noisy to bound the error by {BOUND}");
    let difference = mean.mean() - expected;
    let is_right = difference.abs() < tolerance + 1e-5 * expected;
    assert!(is_right, "{name}: {} instead of {expected}", mean.mean());
}

fn assert_mean_of_all(name: &str, expected: f64, scene: &Scene) {
    assert_mean(&format!("{name}, path"), expected, |seed| path_traced(scene, seed, 1024));
    assert_mean(&format!("{name}, bdpt"), expected, |seed| bidirectional(scene, seed, 256));
    assert_mean(&format!("{name}, mlt"), expected, |seed| metropolis(scene, seed, 500));
}

/// A closed room whose walls emit 1 and reflect `rho`.
pub(crate) fn furnace(rho: f64, max_edges: usize) -> Fixture {
    Fixture::new(DVec3::new(0.2, 0.1, 0.3), DVec3::new(-0.5, 0.2, -1.0), 70.0)
        .room(&[lambert(rho, rho, rho); 6], Rgb::WHITE)
        .film(8, 8)
        .max_edges(max_edges)
}

#[test]
fn a_furnace_glows_evenly() {
    let (rho, n) = (0.5_f64, 6);
    let expected = (1.0 - rho.powi(n)) / (1.0 - rho);
    assert_mean_of_all("furnace", expected, &furnace(rho, 6).build());
}

/// The energy of paths of `k` edges falls by the albedo from one `k` to the next: the chains must
/// visit them in that proportion. Needs no image.
#[test]
fn a_furnace_holds_every_path_length() {
    let rho = 0.5_f64;
    let scene = furnace(rho, 6).build();
    let mut counts = [Accumulator::default(); 7];
    for seed in 0..16 {
        let mut ensemble = Ensemble::new(&scene, &settings(seed, 64), |_| ());
        let mut visits = [0.0; 7];
        for _ in 0..100 {
            ensemble.advance(&scene, 20, None);
            ensemble.chains().for_each(|chain| visits[chain.current().edge_count()] += 1.0);
        }
        let total: f64 = visits.iter().sum();
        for (count, visits) in counts.iter_mut().zip(visits) {
            count.push(visits / total);
        }
    }
    let norm: f64 = (0..6).map(|k| rho.powi(k)).sum();
    let mut suite = Suite::new("path lengths");
    for (k, count) in counts.iter().enumerate().skip(1) {
        let expected = rho.powf(k as f64 - 1.0) / norm;
        suite.record(format!("k = {k}"), count.z_against(expected));
    }
    // Sixteen runs make a Student's t with heavier tails than the normal distribution.
    assert!(suite.worst() < 9.0, "{}", suite.verdict());
}

/// Glass that absorbs nothing is invisible among black walls that all emit the same.
#[test]
fn glass_in_an_even_glow_is_invisible() {
    let clear = BsdfDescription::from(DielectricDescription::clear(1.5));
    let scene = Fixture::new(DVec3::new(0.0, 0.0, 0.9), DVec3::ZERO, 50.0)
        .room(&[BLACK; 6], Rgb::WHITE)
        .sphere(clear, Rgb::BLACK, [0.0, 0.0, 0.0], 0.5)
        .film(8, 8)
        .max_edges(48)
        .build();
    assert_mean_of_all("glass", 1.0, &scene);
}

/// Radiance that a plane with albedo 0.6 at the origin reflects of a sphere at `(0, height, aside)`
/// that emits 5: the irradiance is `pi L (R / d)^2 cos`.
pub(crate) fn lit_by_sphere(radius: f64, height: f64, aside: f64) -> f64 {
    let distance = height.hypot(aside);
    0.6 * 5.0 * (radius / distance).powi(2) * height / distance
}

/// A plane lit by a sphere, and a narrow view of the origin from the side.
pub(crate) fn sphere_over_plane(radius: f64, height: f64, aside: f64) -> Fixture {
    Fixture::new(DVec3::new(3.0, 2.0, 0.0), DVec3::ZERO, 0.05)
        .quad(lambert(0.6, 0.6, 0.6), Rgb::BLACK, [-9., 0., -9.], [0., 0., 18.], [18., 0., 0.])
        .sphere(BLACK, Rgb::grey(5.0), [0.0, height, aside], radius)
        .film(4, 4)
        .max_edges(2)
}

#[test]
fn a_sphere_lights_a_plane() {
    for radius in [0.5, 1e-3] {
        let scene = sphere_over_plane(radius, 2.0, 1.0).build();
        let expected = lit_by_sphere(radius, 2.0, 1.0);
        assert_mean_of_all(&format!("sphere of {radius}"), expected, &scene);
    }
}

/// Under a mirror the plane is also lit by the lamp's virtual image: a caustic in closed form.
#[test]
fn a_mirrored_lamp_lights_a_plane() {
    // So large that walks hit it now and then, so small that it hides nothing of its image.
    let (radius, height, aside, ceiling) = (0.75, 1.0, 2.0, 2.5);
    let perfect = BsdfDescription::Mirror(MirrorDescription { reflectance: Rgb::WHITE });
    let scene = sphere_over_plane(radius, height, aside)
        .quad(perfect, Rgb::BLACK, [-9., ceiling, -9.], [18., 0., 0.], [0., 0., 18.])
        .max_edges(3)
        .build();
    let caustic = lit_by_sphere(radius, 2.0 * ceiling - height, aside);
    let expected = lit_by_sphere(radius, height, aside) + caustic;
    assert!(caustic > 0.3 * expected, "the caustic must matter");
    assert_mean_of_all("mirrored lamp", expected, &scene);
}

/// Light through a slab at normal incidence, all internal reflections together: `(1-F)/(1+F)`.
#[test]
fn a_slab_dims_what_lies_behind() {
    let clear = |eta| BsdfDescription::from(DielectricDescription::clear(eta));
    let scene = Fixture::new(DVec3::new(0.0, 0.0, 5.0), DVec3::ZERO, 0.1)
        .quad(clear(1.5), Rgb::BLACK, [-1., -1., 1.], [2., 0., 0.], [0., 2., 0.])
        .quad(clear(1.5), Rgb::BLACK, [-1., -1., 0.5], [0., 2., 0.], [2., 0., 0.])
        .quad(BLACK, Rgb::WHITE, [-1., -1., -1.], [2., 0., 0.], [0., 2., 0.])
        .film(4, 4)
        .max_edges(24)
        .build();
    let f = 0.04;
    assert_mean_of_all("slab", (1.0 - f) / (1.0 + f), &scene);
}

fn bits(film: &Film) -> Vec<u64> {
    film.pixels().iter().flat_map(|p| [p.r.to_bits(), p.g.to_bits(), p.b.to_bits()]).collect()
}

#[test]
fn the_number_of_threads_changes_no_bit() {
    let scene = specular_room().build();
    let render = |threads| {
        let settings = EnsembleSettings { threads, ..settings(4, 24) };
        let mut ensemble = Ensemble::new(&scene, &settings, |_| ());
        ensemble.advance(&scene, 500, None);
        ensemble.advance(&scene, 500, None);
        bits(&ensemble.image(&scene))
    };
    let alone = render(1);
    assert_eq!(alone, render(2), "mlt on two threads");
    assert_eq!(alone, render(5), "mlt on five threads");
    for sampler in [PrimarySampler::Bdpt, PrimarySampler::Path] {
        let by_pssmlt = |threads| {
            let chains = EnsembleSettings { threads, ..settings(4, 24) };
            let primary = PrimarySettings { sampler, ..PrimarySettings::default() };
            let mut ensemble = PrimaryEnsemble::new(&scene, &chains, primary, |_| ());
            ensemble.advance(&scene, 200);
            ensemble.advance(&scene, 200);
            bits(&ensemble.image(&scene))
        };
        assert_eq!(by_pssmlt(1), by_pssmlt(2), "pssmlt on two threads");
        assert_eq!(by_pssmlt(1), by_pssmlt(5), "pssmlt on five threads");
    }
    let by_path = |threads| {
        let mut tracer = PathTracer::new(&scene, 4);
        tracer.advance(&scene, 2, threads);
        bits(&tracer.image(&scene))
    };
    assert_eq!(by_path(1), by_path(2), "path tracing on two threads");
    let by_bdpt = |threads| {
        let mut tracer = BidirectionalTracer::new(&scene, 4);
        tracer.advance(&scene, 2, threads);
        bits(&tracer.image(&scene))
    };
    assert_eq!(by_bdpt(1), by_bdpt(2), "bidirectional tracing on two threads");
}

/// Correlation of what two images err by, over the pixels, in units of each pixel's own spread.
fn correlation(runs: &[Vec<[f64; 3]>], a: usize, b: usize) -> f64 {
    let others: Vec<_> = (0..runs.len()).filter(|&run| run != a && run != b).collect();
    let green = |run: usize, pixel: usize| runs[run][pixel][1];
    let mut sums = [0.0; 3];
    for pixel in 0..runs[0].len() {
        let values: Accumulator = others.iter().map(|&run| green(run, pixel)).collect();
        let err = |run| (green(run, pixel) - values.mean()) / values.variance().sqrt();
        let (x, y) = (err(a), err(b));
        sums = [sums[0] + x * y, sums[1] + x * x, sums[2] + y * y];
    }
    sums[0] / (sums[1] * sums[2]).sqrt()
}

/// Neighbouring seeds share no random numbers: what one image errs by tells nothing of the other.
#[test]
fn seeds_are_independent() {
    let scene = diffuse_room().film(16, 16).build();
    // Neighbouring pixels of a chain's image err together, so that fewer of them count.
    let by_path = (runs(|seed| path_traced(&scene, seed, 16)), 256.0);
    let by_bdpt = (runs(|seed| bidirectional(&scene, seed, 4)), 256.0);
    let by_mlt = (runs(|seed| metropolis(&scene, seed, 500)), 128.0);
    for (name, (runs, count)) in [("path", by_path), ("bdpt", by_bdpt), ("mlt", by_mlt)] {
        // The mean of fourteen others is subtracted from both, which correlates them by 1 / 15.
        for seed in 0..8 {
            let rho = correlation(&runs, 2 * seed, 2 * seed + 1) - 1.0 / 15.0;
            assert!(rho.abs() < 5.0 / f64::sqrt(count), "{name}, seeds {seed}: {rho}");
        }
        let twice = [runs[0].clone(), runs[0].clone()].into_iter().chain(runs[2..].to_vec());
        let rho = correlation(&twice.collect::<Vec<_>>(), 0, 1);
        assert!(rho > 0.99, "{name}: the same image twice is found out, at {rho}");
    }
}

#[test]
fn watching_a_chain_changes_no_bit() {
    let scene = specular_room().build();
    let render = |window| {
        let mut ensemble = Ensemble::new(&scene, &settings(4, 24), |_| ());
        let batches = ensemble.advance(&scene, 500, window);
        (batches, bits(&ensemble.image(&scene)))
    };
    let (nothing, unwatched) = render(None);
    let (batches, watched) = render(Some(50));
    assert_eq!(unwatched, watched, "watching must not disturb");
    assert!(nothing.is_empty() && !batches.is_empty(), "only a watched chain is shown");
    let weight: f64 = batches.iter().flat_map(|b| &b.paths().weight).map(|&w| f64::from(w)).sum();
    let z = ZScore(weight / (24.0 * 500.0) - 1.0);
    assert!(z.is_within(1e-5), "the records stand for {weight} steps instead of 12000");
}

/// Scaling a scene by a power of two, or its lights, changes no bit of the image.
#[test]
fn powers_of_two_change_no_bit() {
    let base = specular_room();
    let render = |fixture: &Fixture| {
        let scene = fixture.build();
        let image = metropolis(&scene, 9, 200);
        (bits(&image), bits(&path_traced(&scene, 9, 2)), bits(&bidirectional(&scene, 9, 2)))
    };
    let expected = render(&base);
    for exponent in [-20, 20] {
        let mut scaled = base.clone();
        scaled.scale(2_f64.powi(exponent));
        assert_eq!(render(&scaled), expected, "lengths times 2^{exponent}");
    }
    for exponent in [-90, 90] {
        let mut brighter = base.clone();
        let factor = 2_f64.powi(exponent);
        for material in &mut brighter.description.materials {
            material.emission = material.emission * factor;
        }
        let rescaled = |values: &[u64]| -> Vec<u64> {
            values.iter().map(|&v| (f64::from_bits(v) * factor).to_bits()).collect()
        };
        let (mlt, path, bdpt) = render(&brighter);
        assert_eq!(mlt, rescaled(&expected.0), "light times 2^{exponent}, mlt");
        assert_eq!(path, rescaled(&expected.1), "light times 2^{exponent}, path");
        assert_eq!(bdpt, rescaled(&expected.2), "light times 2^{exponent}, bdpt");
    }
}

#[test]
fn every_step_is_on_the_film() {
    let scene = specular_room().build();
    let mut ensemble = Ensemble::new(&scene, &settings(1, 32), |_| ());
    ensemble.advance(&scene, 2000, None);
    let splats = ensemble.splats().total_luminance();
    assert!((splats / 64_000.0 - 1.0).abs() < 1e-9, "{splats} instead of 64000");
    assert_eq!(ensemble.statistics().not_finite(), 0, "a proposal was no number");
}

#[test]
fn built_in_scenes_give_numbers() {
    for name in builtin::names() {
        let mut description = load(name).expect("a built-in scene").description;
        (description.width, description.height) = (16, 12);
        let scene = Scene::new(&description).expect("a sound scene");
        let mut ensemble = Ensemble::new(&scene, &settings(2, 32), |_| ());
        ensemble.advance(&scene, 2000, None);
        assert_eq!(ensemble.statistics().not_finite(), 0, "{name}: a proposal was no number");
        for image in
            [ensemble.image(&scene), path_traced(&scene, 2, 32), bidirectional(&scene, 2, 16)]
        {
            assert!(image.pixels().iter().all(|p| p.is_physical()), "{name}: not a number");
            assert!(image.mean().luminance() > 0.0, "{name}: black");
        }
    }
}

#[test]
fn a_scene_without_light_on_the_film_stays_black() {
    // The lamp shines away from everything.
    let scene = Fixture::new(DVec3::new(0.0, 0.0, 3.0), DVec3::ZERO, 40.0)
        .quad(lambert(0.5, 0.5, 0.5), Rgb::BLACK, [-1., -1., 0.], [2., 0., 0.], [0., 2., 0.])
        .quad(GLASS, Rgb::WHITE, [-1., 5., -1.], [0., 0., 2.], [2., 0., 0.])
        .build();
    let mut ensemble = Ensemble::new(&scene, &settings(0, 8), |_| ());
    ensemble.advance(&scene, 100, None);
    assert_eq!(ensemble.chain_count(), 0, "there is nothing to start from");
    assert!(ensemble.image(&scene).pixels().iter().all(|p| p.is_black()), "black, not NaN");
    let image = primary_sample(&scene, PrimarySampler::Bdpt, 0, 100);
    assert!(image.pixels().iter().all(|p| p.is_black()), "black, not NaN");
}
