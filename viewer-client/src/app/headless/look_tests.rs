//! What colours, blending, textures and the light do to the picture.

use common::{
    BatchBuilder, BatchLimits, Event, PathBatch, PathHeader, StrategyId, TexturePreview,
    VertexKind, VertexRecord, encode_throughput,
};
use image::RgbaImage;

use super::tests::{COLUMN, SIZE, offscreen, picture_of, rows_that_differ};
use crate::synthetic::SyntheticSession;
use crate::synthetic::{camera, delivery};
use crate::value::{Blend, ColorMode};

/// A level path before the wall, at this height, with its throughput on the light.
fn batch(paths: &[(PathHeader, f32, f32)]) -> PathBatch {
    let mut builder = BatchBuilder::new(BatchLimits { bytes: usize::MAX });
    for (header, height, throughput) in paths {
        let lens = camera().origin.as_vec3().to_array();
        let points = [[-400.0, *height, 0.0], [400.0, *height, 0.0], lens];
        let vertices = points.map(|position| VertexRecord {
            position,
            normal: [0, 0],
            kind: VertexKind::Diffuse,
            event: Event::Diffuse,
            material: 0,
            primitive: 0,
        });
        let codes = [encode_throughput(*throughput); 3];
        let full = builder.push_with(header, &vertices, &codes, None);
        assert!(full.is_none(), "the batch has no limit");
    }
    builder.finish().expect("a batch with paths")
}

fn of(batch: PathBatch) -> SyntheticSession {
    SyntheticSession { batches: vec![batch], ..delivery(&[&[[0.0; 3]]]) }
}

const LOOK: [&str; 4] =
    ["cloud width 12", "cloud opacity 1", "cloud fade 10000000", "scene shading off"];

fn with<'a>(more: &[&'a str]) -> Vec<&'a str> {
    LOOK.into_iter().chain(more.iter().copied()).collect()
}

/// The mean of a square of the picture.
fn mean(image: &RgbaImage, [x, y]: [u32; 2]) -> [f64; 3] {
    let places = (y - 4..y + 4).flat_map(|y| (x - 4..x + 4).map(move |x| (x, y)));
    let pixels: Vec<_> = places.map(|(x, y)| image.get_pixel(x, y)).collect();
    std::array::from_fn(|c| {
        pixels.iter().map(|p| f64::from(p[c])).sum::<f64>() / pixels.len() as f64
    })
}

#[test]
fn each_ramp_shows_its_own_number() {
    let Some(mut offscreen) = offscreen() else { return };
    let plain = PathHeader { luminance: 1.0, rgb: [1.0; 3], dwell: 1, ..PathHeader::default() };
    let mut row = None;
    for mode in
        [ColorMode::Constant, ColorMode::Throughput, ColorMode::Dwell, ColorMode::Acceptance]
    {
        let other = match mode {
            ColorMode::Dwell => PathHeader { dwell: 64, ..plain },
            ColorMode::Acceptance => PathHeader { acceptance: 1.0, ..plain },
            _ => plain,
        };
        let throughput = if mode == ColorMode::Throughput { 1.0 } else { 0.01 };
        let color = format!("cloud color {mode}");
        let look = with(&[&color, "cloud scale log"]);
        let low = picture_of(&mut offscreen, of(batch(&[(plain, 150.0, 0.01)])), &look);
        let high = picture_of(&mut offscreen, of(batch(&[(other, 150.0, throughput)])), &look);
        let differ = rows_that_differ(&low, &high);
        assert_eq!(differ.is_empty(), mode == ColorMode::Constant, "{mode}: {differ:?}");
        if mode == ColorMode::Throughput {
            row = differ.get(differ.len() / 2).copied();
            let linear = with(&[&color, "cloud scale linear"]);
            let low_linear =
                picture_of(&mut offscreen, of(batch(&[(plain, 150.0, 0.01)])), &linear);
            assert!(!rows_that_differ(&low, &low_linear).is_empty(), "the scale counts");
        }
    }
    assert!(row.is_some(), "a line was seen");
}

#[test]
fn some_blendings_ask_for_no_order() {
    let Some(mut offscreen) = offscreen() else { return };
    // Two strategies, so two colours, in one place.
    let path = |strategy, nearer: f32| {
        let header = PathHeader { strategy: StrategyId(strategy), ..PathHeader::default() };
        (header, 150.0 + nearer, 1.0)
    };
    let (a, b) = (path(0, 0.0), path(3, 2.0));
    for blend in Blend::ALL {
        let text = format!("cloud blend {blend}");
        // On dark ground the newest one glows, which leaves little of its order.
        let theme = if blend == Blend::Add { "theme dark" } else { "theme light" };
        let look = with(&[&text, "cloud color strategy", "cloud opacity 0.8", theme]);
        let one = picture_of(&mut offscreen, of(batch(&[a, b])), &look);
        let other = picture_of(&mut offscreen, of(batch(&[b, a])), &look);
        let differ = rows_that_differ(&one, &other);
        assert_eq!(differ.is_empty(), blend != Blend::Newest, "{blend}: {differ:?}");
        let none = picture_of(&mut offscreen, of(batch(&[a])), &with(&["cloud shown 0", theme]));
        assert!(!rows_that_differ(&one, &none).is_empty(), "{blend}: they are seen");
    }
}

#[test]
fn distance_filter_and_marks_thin_paths_out() {
    let Some(mut offscreen) = offscreen() else { return };
    let path = (PathHeader { luminance: 1.0, rgb: [1.0; 3], ..PathHeader::default() }, 150.0, 1.0);
    let mut brightness = |more: &[&str]| {
        let look = with(&["cloud color constant"]);
        let look: Vec<_> = look.into_iter().chain(more.iter().copied()).collect();
        let image = picture_of(&mut offscreen, of(batch(&[path])), &look);
        let column = 200..SIZE[1] / 2;
        column.map(|y| u32::from(image.get_pixel(COLUMN, y)[2])).max().unwrap_or(0)
    };
    let full = brightness(&[]);
    let cued = brightness(&["cloud cue 1"]);
    assert!(cued + 30 < full, "distance dims: {cued} of {full}");
    let dimmed = brightness(&["filter set edges > 9", "cloud dim 0.2"]);
    assert!(dimmed + 30 < full, "what the filter leaves out is dimmed: {dimmed} of {full}");
    let hidden = brightness(&["filter set edges > 9", "cloud dim 0"]);
    assert!(hidden < dimmed, "or hidden: {hidden} of {dimmed}");
    for marks in ["vertices", "ends"] {
        let text = format!("cloud marks {marks}");
        assert_eq!(brightness(&[&text]), hidden, "{marks}: no edge is drawn");
    }
}

/// The wall with a texture: red to the left, green to the right.
fn painted() -> SyntheticSession {
    let mut delivery = SyntheticSession { batches: Vec::new(), ..delivery(&[&[[0.0; 3]]]) };
    let mesh = &mut delivery.scene.mesh;
    mesh.texcoords = mesh.positions.iter().map(|p| [p[0] / 1024.0 + 0.5, 0.5]).collect();
    let texels = vec![[160, 0, 0], [160, 0, 0], [0, 160, 0], [0, 160, 0]];
    mesh.textures = vec![TexturePreview { width: 4, height: 1, texels }];
    mesh.materials[0].texture = Some(0);
    delivery
}

/// A column of the viewport, right of its middle.
const RIGHT: u32 = 660;

#[test]
fn textures_are_shaded_or_shown_as_they_are() {
    let Some(mut offscreen) = offscreen() else { return };
    let mut halves = |commands: &[&str]| {
        let image = picture_of(&mut offscreen, painted(), commands);
        [COLUMN, RIGHT].map(|x| mean(&image, [x, 300]))
    };
    let [left, right] = halves(&["scene shading texture"]);
    assert!((left[0] - 160.0).abs() < 3.0 && left[1] < 3.0, "red as it is: {left:?}");
    assert!((right[1] - 160.0).abs() < 3.0 && right[0] < 3.0, "green as it is: {right:?}");
    let [left, right] = halves(&["scene shading shaded"]);
    assert!(left[0] > 4.0 * left[1].max(4.0), "red in the light: {left:?}");
    assert!(right[1] > 4.0 * right[0].max(4.0), "green in the light: {right:?}");
    let [left, right] = halves(&["scene shading plain"]);
    assert!((left[0] - left[1]).abs() < 12.0, "grey without its texture: {left:?}");
    assert!((right[0] - right[1]).abs() < 12.0, "grey without its texture: {right:?}");
}

#[test]
fn the_light_shines_from_where_it_stands() {
    let Some(mut offscreen) = offscreen() else { return };
    for lighting in ["scene lighting soft", "scene lighting phong"] {
        let mut halves = |light: &str| {
            let look = ["scene shading plain", lighting, light];
            let image = picture_of(&mut offscreen, painted(), &look);
            [COLUMN, RIGHT].map(|x| mean(&image, [x, 330])[1])
        };
        let [left, right] = halves("scene light at -300 0 -450");
        assert!(left > right + 8.0, "{lighting}: brighter to the left: {left} {right}");
        let [left, right] = halves("scene light at 300 0 -450");
        assert!(right > left + 8.0, "{lighting}: brighter to the right: {left} {right}");
    }
}
