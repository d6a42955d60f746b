//! Strokes and dots on a canvas of few pixels, where their places are known.

use bytemuck::Zeroable as _;
use glam::{Mat4, Vec2, Vec4};
use rand_core::{Rng as _, SeedableRng as _};
use rand_xoshiro::Xoshiro256PlusPlus;
use shaders::{FrameUniforms, LinePoint, encode_radiance, role};

use super::*;

/// Neither side is a multiple of that of a tile.
const SIZE: [u32; 2] = [150, 117];

/// Scene units are pixels, and opaque colours of paths are drawn as they are.
fn frame() -> FrameUniforms {
    let [width, height] = SIZE.map(|n| n as f32);
    FrameUniforms {
        view_projection: Mat4::from_cols(
            Vec4::new(2.0 / width, 0.0, 0.0, 0.0),
            Vec4::new(0.0, -2.0 / height, 0.0, 0.0),
            Vec4::new(0.0, 0.0, -0.5, 0.0),
            Vec4::new(-1.0, 1.0, 0.5, 1.0),
        ),
        near: 0.01,
        size: Vec2::new(width, height),
        line_width: 1.0,
        line_opacity: 1.0,
        hidden_opacity: 0.5,
        lens_opacity: 1.0,
        fade_age: 1e9,
        faded: 1.0,
        // Every radiance is the brightest.
        darkest: -100.0,
        inverse_range: 1.0,
        logarithmic: 1,
        ..FrameUniforms::zeroed()
    }
}

fn point([x, y]: [f32; 2], roles: u8) -> LinePoint {
    let color = [255, 255, 255, encode_radiance(1.0)];
    LinePoint { position: [x, y, 0.0], color, ordinal: 0, info: [roles, 0, 0, 0] }
}

fn segment(a: [f32; 2], b: [f32; 2]) -> [LinePoint; 2] {
    [point(a, role::START), point(b, role::LAST)]
}

fn drawn(points: &[LinePoint], frame: &FrameUniforms, layer: Layer) -> Canvas {
    let mut canvas = Canvas::default();
    canvas.begin(SIZE, Crossing::Stacked, Vec::new());
    canvas.draw(points, frame, layer, Crossing::Stacked);
    canvas
}

/// How many pixels are covered in all.
fn covered(canvas: &Canvas) -> f32 {
    canvas.finished().iter().map(|pixel| pixel.w).sum()
}

fn random_paths(rng: &mut Xoshiro256PlusPlus, count: usize, reach: f32) -> Vec<LinePoint> {
    let mut unit = || (rng.next_u32() >> 8) as f32 / (1 << 24) as f32;
    let mut points = Vec::new();
    for _ in 0..count {
        for i in 0..4 {
            let roles = [role::START, 0, 0, role::LAST][i];
            let [x, y] = [unit(), unit()].map(|u| reach * (2.0 * u - 1.0) + 60.0);
            let mut point = point([x, y], roles);
            point.color = [unit(), unit(), unit(), 1.0].map(|u| (255.0 * u) as u8);
            points.push(point);
        }
    }
    points
}

#[test]
fn strokes_cover_their_width_times_their_length() {
    let mut frame = frame();
    for width in [1.0, 2.5, 9.0] {
        frame.line_width = width;
        for degrees in (0_u16..180).step_by(7) {
            let (sin, cos) = f32::from(degrees).to_radians().sin_cos();
            let [a, b] =
                [-1.0, 1.0].map(|side| [75.3 + side * 45.0 * cos, 58.6 + side * 45.0 * sin]);
            for points in [segment(a, b), segment(b, a)] {
                let area = covered(&drawn(&points, &frame, Layer::Visible));
                // They are drawn half a pixel beyond their ends, which are square and not smoothed.
                let wanted = 91.0 * width;
                let off = (area - wanted).abs();
                assert!(off < 0.02 * wanted, "{width} at {degrees} degrees: {area}, not {wanted}");
            }
        }
    }
}

#[test]
fn faint_strokes_below_a_pixel_are_fainter_instead() {
    let mut frame = frame();
    let points = segment([20.0, 30.5], [120.0, 30.5]);
    frame.line_width = 0.25;
    let area = covered(&drawn(&points, &frame, Layer::Visible));
    assert!((area - 0.25 * 101.0).abs() < 0.5, "{area}");
    let hidden = covered(&drawn(&points, &frame, Layer::Hidden));
    assert!(hidden.abs() < 1e-6, "without surfaces, nothing is hidden: {hidden}");
}

#[test]
fn dots_are_as_large_as_they_are_wanted() {
    let mut frame = frame();
    (frame.start_radius, frame.dot_radius) = (6.0, 3.0);
    let path =
        [point([40.2, 50.7], role::START), point([90.0, 50.0], 0), point([0.0; 2], role::LAST)];
    let area = covered(&drawn(&path, &frame, Layer::Dots));
    // The outermost half pixel fades: its integral is that of the disc and a little more.
    let disc = |r: f32| std::f32::consts::PI * (r * r + 1.0 / 12.0);
    let wanted = disc(6.0) + disc(3.0);
    assert!((area - wanted).abs() < 0.01 * wanted, "{area}, not {wanted}");
}

#[test]
fn ends_far_outside_leave_the_line_where_it_is() {
    let frame = frame();
    for far in [1e3, 1e5, 1e7_f32] {
        // Through the middle of pixel (40, 30), level and at 45 degrees.
        for [dx, dy] in [[1.0, 0.0], [1.0, 1.0], [-1.0, 1.0], [0.0, 1.0_f32]] {
            let end = |side: f32| [40.5 + side * far * dx, 30.5 + side * far * dy];
            let canvas = drawn(&segment(end(-1.0), end(1.0)), &frame, Layer::Visible);
            let pixel = canvas.finished()[30 * SIZE[0] as usize + 40];
            // A number of seven digits has no room for a tenth of a pixel.
            let most = if far < 1e6 { 0.05 } else { 1.0 };
            assert!(1.0 - pixel.w <= most, "{far} {dx} {dy}: {} of it is covered", pixel.w);
            assert!(covered(&canvas) > 100.0, "{far} {dx} {dy}: all of it is drawn");
        }
    }
}

#[test]
fn newer_paths_lie_on_top_and_nearer_surfaces_hide_them() {
    let frame = frame();
    let mut points = [segment([10.0, 20.5], [140.0, 20.5]), segment([70.5, 2.0], [70.5, 110.0])];
    for point in &mut points[1] {
        point.color = [255, 0, 0, point.color[3]];
    }
    let points = points.as_flattened();
    let crossing = 20 * SIZE[0] as usize + 70;
    let canvas = drawn(points, &frame, Layer::Visible);
    assert!(
        canvas.finished()[crossing].abs_diff_eq(Vec4::X + Vec4::W, 1e-3),
        "the red one is the newer"
    );
    for (surface, layer, seen) in [
        (0.4, Layer::Visible, true),
        (0.6, Layer::Visible, false),
        (0.4, Layer::Hidden, false),
        (0.6, Layer::Hidden, true),
    ] {
        let mut canvas = Canvas::default();
        canvas.begin(SIZE, Crossing::Stacked, vec![surface; (SIZE[0] * SIZE[1]) as usize]);
        canvas.draw(points, &frame, layer, Crossing::Stacked);
        assert_eq!(covered(&canvas) > 50.0, seen, "{layer:?} and a surface at {surface}");
    }
}

#[test]
fn neither_threads_nor_parts_change_a_pixel() {
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(7);
    let mut frame = frame();
    frame.line_opacity = 0.3;
    (frame.start_radius, frame.dot_radius) = (4.0, 2.0);
    let points = random_paths(&mut rng, 300, 120.0);
    for crossing in [Crossing::Stacked, Crossing::Weighed] {
        let picture = |threads: usize, parts: usize| {
            let mut canvas = Canvas::default();
            canvas.begin(SIZE, crossing, Vec::new());
            canvas.threads = threads;
            for layer in [Layer::Dots, Layer::Visible] {
                for part in points.chunks(points.len() / parts).rev() {
                    canvas.draw(part, &frame, layer, crossing);
                }
            }
            canvas.finished()
        };
        let one = picture(1, 1);
        assert!(one.iter().any(|pixel| pixel.w > 0.1), "something is drawn");
        for (threads, parts) in [(2, 1), (3, 1), (16, 1), (1, 5), (7, 25)] {
            assert!(
                picture(threads, parts) == one,
                "{crossing:?}: {threads} threads, {parts} parts"
            );
        }
    }
}

#[test]
fn pixels_that_are_full_stay_as_they_are() {
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(3);
    let mut frame = frame();
    frame.line_width = 3.0;
    let points = random_paths(&mut rng, 3000, 100.0);
    let canvas = drawn(&points, &frame, Layer::Visible);
    assert!(canvas.open.contains(&0), "some tiles are full");
    // The same in the other direction: each path over those before it.
    let mut whole = vec![Vec4::W; canvas.pixels.len()];
    for path in points.chunks(4) {
        let sheet = drawn(path, &frame, Layer::Visible);
        for (below, above) in whole.iter_mut().zip(&sheet.pixels) {
            *below = (above.truncate() + below.truncate() * above.w).extend(below.w * above.w);
        }
    }
    for (pixel, other) in canvas.pixels.iter().zip(&whole) {
        assert!(pixel.abs_diff_eq(*other, 1e-3), "{pixel} is {other}");
    }
    let shut = |tile: &u16| *tile == 0;
    let full = canvas.open.iter().filter(|tile| shut(tile)).count();
    let again = {
        let mut rest = canvas;
        rest.draw(&points, &frame, Layer::Visible, Crossing::Stacked);
        rest.open.iter().filter(|tile| shut(tile)).count()
    };
    assert!(again >= full, "what is full stays full");
}

#[test]
fn what_has_no_place_is_not_drawn() {
    let mut frame = frame();
    frame.line_width = 4.0;
    (frame.start_radius, frame.dot_radius) = (5.0, 5.0);
    let odd = [f32::NAN, f32::INFINITY, -f32::INFINITY, f32::MAX, -f32::MAX, 1e20, 0.0, 75.0];
    for a in odd {
        for b in odd {
            for layer in [Layer::Visible, Layer::Hidden, Layer::Dots] {
                for crossing in [Crossing::Stacked, Crossing::Weighed] {
                    let mut canvas = Canvas::default();
                    canvas.begin(SIZE, crossing, Vec::new());
                    canvas.draw(&segment([a, b], [b, 60.0]), &frame, layer, crossing);
                    let finite = canvas.finished().iter().all(|pixel| pixel.is_finite());
                    assert!(finite, "{layer:?} {crossing:?} from {a} {b}");
                }
            }
        }
    }
    let mut none = Canvas::default();
    none.begin([0, 0], Crossing::Stacked, Vec::new());
    none.draw(&segment([0.0; 2], [9.0; 2]), &frame, Layer::Visible, Crossing::Stacked);
    assert!(none.finished().is_empty(), "a picture of no pixels");
}
