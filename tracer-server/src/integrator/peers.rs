//! The pictures of two scenes that other renderers computed too, at great length.

use tests::{Accumulator, Suite, block_means, welch_z};

use super::BidirectionalTracer;
use crate::image_file::read_exr;
use crate::scene::Scene;
use crate::scene::fixtures::shared_scenes;
use crate::scene::load::load;

/// Side of the film in pixels: every pixel is the mean of a square of the reference, which has
/// pixels of the same box filter.
const SIDE: usize = 32;
/// Independent pictures, whose spread tells how far their mean may be off.
const RUNS: u64 = 16;
/// Samples through every pixel of a picture.
const SAMPLES: u64 = 48;

type Image = Vec<[f64; 3]>;
/// Where a pixel of a turned picture comes from: column and row.
type Turn = fn(usize, usize) -> (usize, usize);

/// The reference in blocks, and independent pictures of the same size.
fn pictures(name: &str) -> Option<(Image, Vec<Image>)> {
    let folder = shared_scenes()?.join(format!("peer-{name}"));
    let reference = read_exr(&folder.join("reference.exr")).expect("an image");
    let pixels: Image = reference.pixels().iter().map(|&pixel| pixel.into()).collect();
    let width = reference.width() as usize;
    let reference = block_means(&pixels, width, width / SIDE);

    let file = folder.join(format!("{name}_bdpt.xml"));
    let loaded = load(file.to_str().expect("UTF-8")).unwrap_or_else(|error| panic!("{error}"));
    assert!(loaded.warnings.is_empty(), "{:?}", loaded.warnings);
    let mut description = loaded.description;
    (description.width, description.height) = (SIDE as u32, SIDE as u32);
    let scene = Scene::new(&description).expect("a sound scene");
    let picture = |seed| {
        let mut tracer = BidirectionalTracer::new(&scene, seed);
        tracer.advance(&scene, SAMPLES, 2);
        tracer.image(&scene).pixels().iter().map(|&pixel| pixel.into()).collect()
    };
    Some((reference, (0..RUNS).map(picture).collect()))
}

/// How far the runs are from the reference, pixel by pixel and channel by channel.
fn z_scores(name: &str, reference: &[[f64; 3]], runs: &[Image]) -> Suite {
    let mut suite = Suite::new(name);
    for (i, expected) in reference.iter().enumerate() {
        for (channel, &expected) in expected.iter().enumerate() {
            let measured: Accumulator = runs.iter().map(|run| run[i][channel]).collect();
            let exact: Accumulator = [expected; 2].into_iter().collect();
            suite.record(format!("pixel {i}, channel {channel}"), welch_z(&measured, &exact));
        }
    }
    suite
}

fn mean(image: &[[f64; 3]]) -> f64 {
    image.iter().flatten().sum::<f64>() / (3 * image.len()) as f64
}

/// Pearson's correlation of two pictures.
fn correlation(a: &[[f64; 3]], b: &[[f64; 3]]) -> f64 {
    let (mean_a, mean_b) = (mean(a), mean(b));
    let pairs = || a.iter().flatten().zip(b.iter().flatten());
    let product =
        |f: fn(f64, f64) -> f64| pairs().map(|(x, y)| f(x - mean_a, y - mean_b)).sum::<f64>();
    product(|x, y| x * y) / (product(|x, _| x * x) * product(|_, y| y * y)).sqrt()
}

/// The picture with the pixel that `source` tells in the place of each.
fn rearranged(image: &[[f64; 3]], source: Turn) -> Image {
    let at = |i: usize| {
        let (x, y) = source(i % SIDE, i / SIDE);
        image[y * SIDE + x]
    };
    (0..image.len()).map(at).collect()
}

fn assert_match(name: &str, known_mean: f64) {
    let Some((reference, runs)) = pictures(name) else { return };
    assert!((mean(&reference) - known_mean).abs() < 5e-5, "{}", mean(&reference));

    let means: Accumulator = runs.iter().map(|run| mean(run)).collect();
    let difference = means.mean() - known_mean;
    let error = means.standard_error();
    // The two renderers behind the reference differ by 4e-4 of its mean.
    let tolerance = 5.0 * error + 4e-4 * known_mean;
    assert!(difference.abs() < tolerance, "{name}: {} +- {error}", means.mean());
    assert!(error < 0.01 * known_mean, "{name}: too noisy to tell anything: {error}");

    let verdict = z_scores(name, &reference, &runs).verdict();
    assert!(verdict.is_pass(), "{verdict}");

    let average: Image = (0..reference.len())
        .map(|i| [0, 1, 2].map(|c| runs.iter().map(|run| run[i][c]).sum::<f64>() / RUNS as f64))
        .collect();
    let upright = correlation(&average, &reference);
    assert!(upright > 0.99, "{name}: {upright}");
    let wrong: [Turn; 4] = [
        |x, y| (SIDE - 1 - x, y),
        |x, y| (x, SIDE - 1 - y),
        |x, y| (y, x),
        |x, y| (SIDE - 1 - x, SIDE - 1 - y),
    ];
    for turn in wrong {
        let turned = rearranged(&reference, turn);
        let worse = correlation(&average, &turned);
        assert!(worse < upright - 1e-4, "{name}: {worse} against {upright}");
        assert!(z_scores(name, &turned, &runs).worst() > 6.0, "a turned picture is found");
    }
    let dimmer: Image = reference.iter().map(|pixel| pixel.map(|c| 0.9 * c)).collect();
    assert!(z_scores(name, &dimmer, &runs).worst() > 6.0, "a dimmer picture is found");
}

#[test]
fn the_cornell_box_is_as_others_render_it() {
    assert_match("cornell", 0.11976);
}

#[test]
fn the_caustic_is_as_others_render_it() {
    assert_match("caustic", 0.16813);
}
