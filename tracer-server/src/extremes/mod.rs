//! Scenes at the edge of what numbers can hold, each against what is known of it.
//!
//! The cases are tables of [`Extreme`]s; `docs/NUMERICS.md` tells what came out. Powers of two,
//! which must change no bit, are among the laws of images.

mod cases;
mod edges;

use std::fmt::Write as _;

use tests::{Accumulator, block_means, z_map};

use crate::chain::{Ensemble, EnsembleSettings};
use crate::film::Film;
use crate::integrator::laws::{bidirectional, path_traced, pixels, settings};
use crate::scene::Scene;
use crate::scene::fixtures::Fixture;

/// Independent runs on either side of a comparison, but for scenes of very long paths.
const RUNS: u64 = 16;
/// Side of the film of images that are compared in quarters.
const SIDE: u32 = 8;

/// What an image must be.
enum Expected {
    /// That of another scene times a factor, in quarters and as a whole.
    Like(Box<Fixture>, f64),
    /// This mean, up to a relative error that the scene itself has.
    Mean(f64, f64),
    /// The same from chains and from bidirectional path tracing, in quarters and as a whole.
    Agreement,
    /// The same from path tracing too.
    AgreementOfThree,
}

/// One row.
struct Extreme {
    name: &'static str,
    scene: Fixture,
    expected: Expected,
}

fn row(name: &'static str, scene: Fixture, expected: Expected) -> Extreme {
    Extreme { name, scene, expected }
}

fn like(base: Fixture, factor: f64) -> Expected {
    Expected::Like(Box::new(base), factor)
}

type Image = Vec<[f64; 3]>;

/// Whether paths can be split in so many places that a few of them make up for their price.
fn is_long(scene: &Scene) -> bool {
    scene.max_edges() > 8
}

/// The image of chains, none of which may have proposed what is no number.
fn metropolis(name: &str, scene: &Scene, seed: u64) -> Film {
    let (chains, bootstrap_samples) = if is_long(scene) { (8, 1 << 6) } else { (64, 1 << 14) };
    let settings = EnsembleSettings { bootstrap_samples, ..settings(seed, chains) };
    let mut ensemble = Ensemble::new(scene, &settings, |_| ());
    ensemble.advance(scene, if is_long(scene) { 50 } else { 400 }, None);
    let statistics = ensemble.statistics();
    assert_eq!(statistics.not_finite(), 0, "{name}: a proposal was no number");
    assert!(ensemble.chain_count() > 0, "{name}: nothing to start from");
    ensemble.image(scene)
}

fn runs(name: &str, count: u64, render: impl Fn(u64) -> Film) -> Vec<Image> {
    let run = |seed| {
        let film = render(seed);
        assert!(film.pixels().iter().all(|p| p.is_physical()), "{name}: a pixel is no radiance");
        pixels(&film)
    };
    (0..count).map(run).collect()
}

/// Compares quarters and the whole; returns the largest deviation.
fn compare(name: &str, a: &[Image], b: &[Image], width: usize) -> f64 {
    let mut worst = 0.0_f64;
    for size in [width / 2, width] {
        let blocks = |runs: &[Image]| -> Vec<_> {
            runs.iter().map(|r| block_means(r, width, size)).collect()
        };
        let suite = z_map(&format!("{name}, blocks of {size}"), &blocks(a), &blocks(b));
        let verdict = suite.verdict();
        assert!(verdict.is_pass(), "{verdict}");
        worst = worst.max(suite.worst());
    }
    worst
}

/// Compares the green mean with a figure; returns the deviation in standard errors.
fn compare_mean(name: &str, images: &[Image], (expected, slack): (f64, f64)) -> f64 {
    let mean = |image: &Image| image.iter().map(|p| p[1]).sum::<f64>() / image.len() as f64;
    let means: Accumulator = images.iter().map(mean).collect();
    let (error, difference) = (means.standard_error(), means.mean() - expected);
    let tolerance = 5.0 * error + (slack + 1e-5) * expected;
    let found = format!("{name}: {} +- {error} instead of {expected}", means.mean());
    assert!(difference.abs() < tolerance, "{found}");
    assert!(error < 0.04 * expected, "{found}: too noisy to tell anything");
    difference / expected
}

impl Extreme {
    /// Checks the row; returns one line on how near it came.
    fn check(&self) -> String {
        let scene = self.scene.build();
        let film = |what: &str| format!("{}, {what}", self.name);
        let count = if is_long(&scene) { 4 } else { RUNS };
        let chains = runs(&film("mlt"), count, |seed| metropolis(self.name, &scene, seed + 300));
        let many = is_long(&scene) || scene.camera().pixel_count() > 4096;
        let samples = if many { 1 } else { 24 };
        let direct = runs(&film("bdpt"), count, |seed| bidirectional(&scene, seed + 100, samples));
        let width = scene.camera().width as usize;
        let mut line = String::new();
        match &self.expected {
            Expected::Mean(value, slack) => {
                let value = (*value, *slack);
                let a = compare_mean(&film("mlt"), &chains, value);
                let b = compare_mean(&film("bdpt"), &direct, value);
                write!(line, "relative difference mlt {a:.1e}, bdpt {b:.1e}")
            }
            Expected::Like(base, factor) => {
                let base = base.build();
                let scaled = |seed| {
                    let mut film = bidirectional(&base, seed + 200, 24);
                    film.scale(*factor);
                    film
                };
                let wanted = runs(&film("base"), count, scaled);
                let a = compare(&film("mlt"), &chains, &wanted, width);
                let b = compare(&film("bdpt"), &direct, &wanted, width);
                write!(line, "largest |z| mlt {a:.1}, bdpt {b:.1}")
            }
            Expected::Agreement => {
                let a = compare(&film("mlt and bdpt"), &chains, &direct, width);
                write!(line, "largest |z| {a:.1}")
            }
            Expected::AgreementOfThree => {
                let traced = runs(&film("path"), count, |seed| path_traced(&scene, seed + 500, 96));
                let a = compare(&film("mlt and bdpt"), &chains, &direct, width);
                let b = compare(&film("path and bdpt"), &traced, &direct, width);
                write!(line, "largest |z| mlt {a:.1}, path {b:.1}")
            }
        }
        .expect("a string takes any text");
        line
    }
}

/// Checks a table, and prints what it found for those who ask with `--nocapture`.
#[expect(clippy::print_stdout, reason = "the figures that the documentation quotes")]
fn check_all(rows: &[Extreme]) {
    for extreme in rows {
        let start = std::time::Instant::now();
        let line = extreme.check();
        println!("{}: {line} ({:.1} s)", extreme.name, start.elapsed().as_secs_f64());
    }
}
