//! Laws of the errors that replicates tell: how often their intervals hold, where they are not to be
//! trusted, and what rare bright light makes of small pools.

use common::{Floor, Rgb, relative_errors, relative_mse};
use glam::DVec3;
use tests::{Accumulator, Suite, welch_z};

use super::laws::{made, plan, settings};
use super::{Dial, Plan, Row, prepare};
use crate::chain::{PoolKey, Source};
use crate::film::Film;
use crate::integrator::laws::{bidirectional, settings as chains};
use crate::integrator::pssmlt::PrimarySettings;
use crate::parallel::Stop;
use crate::render::{Budget, Integrator, RenderSettings, Wish, auto};
use crate::scene::fixtures::{
    Fixture, GLASS, coated_room, diffuse_room, every_light, open_room, slab_over_floor,
    specular_room,
};
use crate::scene::{LightKind, Scene, Tracer};
use crate::target::Target;

/// A ball of glass that throws all of the light of a point lamp on a floor: a path tracer finds none of
/// it, and few bidirectional samples have most of it.
fn caustic() -> Fixture {
    let position = DVec3::new(0.3, 0.7, 0.2);
    let point = LightKind::Point { position, intensity: Rgb::grey(3.0) };
    open_room().sphere(GLASS, Rgb::BLACK, [0.1, -0.2, 0.0], 0.5).light(point)
}

fn scenes() -> Vec<(&'static str, Fixture)> {
    let mut scenes = vec![
        ("diffuse", diffuse_room()),
        ("specular", specular_room()),
        ("coated", coated_room()),
        ("caustic", caustic()),
        ("slab", slab_over_floor(true)),
    ];
    scenes.extend(every_light().into_iter().filter(|(name, _)| *name == "image sky"));
    scenes
}

/// Replicates of a picture.
const REPLICATES: u64 = 32;
/// The middle 95 % of Student's t with 31 degrees of freedom reach so far to either side.
const QUANTILE: f64 = 2.0395;
/// Pictures that are looked at.
const PICTURES: u64 = 16;
/// A reference of so many times the work has a fifth of the error.
const TIMES: u64 = 25;

fn picture(scene: &Scene, plan: &Plan, first: u64, count: u64) -> super::Picture {
    made(scene, plan, &format!("{first}..{}", first + count), 2)
}

/// How often intervals hold what they should.
#[derive(Clone, Copy, Debug, Default)]
struct Coverage {
    pixels: u64,
    /// Pixels whose error bars are to be trusted.
    reliable: u64,
    /// Those of them whose interval of 95 % holds the right value.
    holding: u64,
    /// The same with intervals that are a fifth too short.
    holding_short: u64,
}

fn coverage(scene: &Scene) -> Coverage {
    let whole = prepare(scene, &settings(5, Dial::default()), &Stop::default());
    let plan = Plan { parts: whole.parts.min(4), ..whole };
    let reference = picture(scene, &plan, 1_000_000, TIMES * REPLICATES).image();
    let mut coverage = Coverage::default();
    for number in 0..PICTURES {
        let picture = picture(scene, &plan, number * REPLICATES, REPLICATES);
        let image = picture.image();
        let pairs = image.pixels().iter().zip(reference.pixels());
        let told = picture.ledger.standard_errors().into_iter().zip(picture.ledger.is_reliable());
        for ((here, right), (error, is_reliable)) in pairs.zip(told) {
            let off = (here.luminance() - right.luminance()).abs();
            let reach = QUANTILE * f64::from(error);
            coverage.pixels += 1;
            coverage.reliable += u64::from(is_reliable);
            coverage.holding += u64::from(is_reliable && off <= reach);
            coverage.holding_short += u64::from(is_reliable && off <= 0.8 * reach);
        }
    }
    coverage
}

/// Intervals of 95 % hold that often in the pixels declared reliable; shorter ones are found out.
///
/// Where few replicates carry rare bright light, behind glass and coats, the intervals of as few
/// replicates as here hold less often than they claim.
#[test]
fn intervals_hold_what_they_should() {
    for (name, fixture) in scenes() {
        let least = if ["specular", "coated"].contains(&name) { 0.88 } else { 0.93 };
        let coverage = coverage(&fixture.film(16, 12).build());
        let Coverage { pixels, reliable, holding, holding_short } = coverage;
        let share = |part: u64, whole: u64| part as f64 / whole as f64;
        let held = share(holding, reliable);
        assert!((least..0.97).contains(&held), "{name}: {held}, {coverage:?}");
        assert!(share(reliable, pixels) > 0.8, "{name}: {coverage:?}");
        assert!(share(holding_short, reliable) < 0.93, "{name}: short ones, {coverage:?}");
    }
}

/// A dot that a single replicate has made is not to be trusted, and no other pixel is suspected for it.
#[test]
fn dots_are_not_to_be_trusted() {
    let scene = diffuse_room().film(16, 12).build();
    let plan = plan(&scene, 9, Dial::default());
    let mut picture = picture(&scene, &plan, 0, 31);
    let before = picture.ledger.is_reliable();
    let mut film = picture.image();
    film.splat(77, film.pixels()[77] * 100.0);
    let row = Row { number: 31, mean: film.mean().luminance(), ..picture.ledger.rows()[0] };
    picture.ledger.add(row, &film);
    let after = picture.ledger.is_reliable();
    assert!(before[77] && !after[77], "the dot");
    let suspected =
        (0..before.len()).filter(|&pixel| pixel != 77 && before[pixel] && !after[pixel]);
    assert_eq!(suspected.count(), 0, "others are as they were");
    assert!(picture.ledger.mean().kurtosis > 12.0, "the mean luminance has a heavy tail");
}

/// The largest share that a single pixel has of the squared error of a picture.
fn worst_share(image: &Film, reference: &Film) -> f64 {
    let errors = relative_errors(image.pixels(), reference.pixels(), Floor::Relative);
    errors.iter().copied().fold(0.0, f64::max) / errors.iter().sum::<f64>()
}

/// No chain stays so long that its dot dominates the error of a picture.
///
/// In sixteen seeds no pixel has half of the error; a dot with a twentieth of the light would.
#[test]
fn no_dot_rules_a_picture() {
    for (name, fixture) in [("caustic", caustic()), ("slab", slab_over_floor(true))] {
        let scene = fixture.film(16, 12).build();
        let reference = bidirectional(&scene, 77, 3000);
        for seed in 0..16 {
            // All of the light is the chains'.
            let dial = Dial { base: None, tau: Some(0.0) };
            let plan = prepare(&scene, &settings(seed, dial), &Stop::default());
            let mut image = picture(&scene, &plan, 0, 16).image();
            image.scale(scene.radiance_scale());
            let share = worst_share(&image, &reference);
            assert!(share < 0.5, "{name}, seed {seed}: a pixel has {share} of the error");
            image.splat(77, image.mean() * (0.05 * image.pixels().len() as f64));
            let share = worst_share(&image, &reference);
            assert!(share > 0.5, "{name}, seed {seed}: a dot has {share} of the error");
        }
    }
}

/// `b` of a pool that is doubled until its own spread looks small.
fn grown(source: &mut Source<'_, '_>) -> f64 {
    let mut count = 32;
    loop {
        let pool = source.pool(count);
        let looks_good = pool.normalization_error() < 0.25 * pool.normalization();
        if looks_good || count >= 1024 {
            return pool.normalization();
        }
        count *= 2;
    }
}

/// Pools whose size nothing that is in them decides are right in the mean, however heavy the tail;
/// those that grow until they look good are too dark.
#[test]
fn no_sample_decides_whether_there_are_enough() {
    let scene = specular_room().film(16, 12).build();
    let tracer = Tracer::new(&scene);
    let pools =
        |seed: u64, count: u64, value: &dyn Fn(&mut Source<'_, '_>) -> f64| -> Accumulator {
            let source = |number| Source::new(&tracer, PoolKey { seed, number }, &Target::Whole);
            (0..count).map(|number| value(&mut source(number))).collect()
        };
    let all = Source::new(&tracer, PoolKey { seed: 4, number: 0 }, &Target::Whole).pool(8192);
    assert!(all.kurtosis() > 100.0, "the tail is heavy: {}", all.kurtosis());
    let right = pools(1, 60, &|source| source.pool(8192).normalization());
    let fixed = pools(2, 6000, &|source| source.pool(64).normalization());
    let grown = pools(3, 6000, &grown);
    let mut suite = Suite::new("pools");
    suite.record("of 64 samples", welch_z(&fixed, &right));
    assert!(suite.verdict().is_pass(), "{}", suite.verdict());
    assert!(welch_z(&grown, &right).0 < -6.0, "those that grow: {grown:?} and {right:?}");
}

/// Sixty-four seeds, each with a pilot of its own, on a scene whose light few samples have.
#[test]
fn the_mean_is_right_where_few_samples_have_the_light() {
    let mut suite = Suite::new("means over seeds");
    for (name, fixture) in [("caustic", caustic()), ("specular", specular_room())] {
        let scene = fixture.film(16, 12).build();
        let expected: Accumulator =
            (0..24).map(|seed| bidirectional(&scene, 300 + seed, 250).mean().luminance()).collect();
        let mean = |seed: u64| {
            let plan = plan(&scene, seed, Dial::default());
            picture(&scene, &plan, 0, 12).image().mean().luminance() * scene.radiance_scale()
        };
        let means: Accumulator = (0..64).map(mean).collect();
        suite.record(name, welch_z(&means, &expected));
    }
    assert!(suite.verdict().is_pass(), "{}", suite.verdict());
}

/// A picture that stops at a noise has about that noise.
///
/// Where few replicates carry rare bright light, it has up to a third more: it stops sooner where none
/// of them has met that light yet.
#[test]
fn a_picture_until_a_noise_has_that_noise() {
    const NOISE: f64 = 0.05;
    for (name, fixture, most) in
        [("diffuse", diffuse_room(), 1.0), ("specular", specular_room(), 4.0 / 3.0)]
    {
        let scene = fixture.film(16, 12).build();
        let made = |seed: u64, selection: Option<&str>| {
            let settings = RenderSettings {
                integrator: Integrator::Auto,
                budget: Budget::PerPixel(1 << 20),
                ensemble: chains(seed, 64),
                primary: PrimarySettings::default(),
                dial: Dial::default(),
            };
            let selection = selection.map(|text| text.parse().expect("a selection"));
            let until = selection.is_none().then_some(NOISE);
            let wish = Wish { selection, until, ..Wish::none() };
            auto::render(&scene, &settings, wish, &mut |_| ()).expect("a picture")
        };
        let reference = made(1000, Some("0..1600")).image;
        let mut told = Accumulator::default();
        let error = |seed: u64| {
            let made = made(seed, None);
            let noise = made.report.noise.expect("more than one replicate");
            assert!(noise <= NOISE, "{name}, seed {seed}: it says {noise}");
            told.push(noise * noise);
            relative_mse(made.image.pixels(), reference.pixels())
        };
        let errors: Accumulator = (0..16).map(error).collect();
        let (noise, said) = (errors.mean().sqrt(), told.mean().sqrt());
        assert!(noise < most * NOISE, "{name}: {noise} in the place of {NOISE}");
        assert!((0.95..1.4).contains(&(noise / said)), "{name}: {noise}, and it says {said}");
    }
}
