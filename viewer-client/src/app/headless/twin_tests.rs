//! The processor draws what the graphics card draws.

use common::{
    BatchBuilder, BatchLimits, ChainId, Event, PathBatch, PathHeader, PathId, StrategyId,
    VertexKind, VertexRecord, encode_throughput,
};
use image::RgbaImage;
use rand_core::{Rng as _, SeedableRng as _};
use rand_xoshiro::Xoshiro256PlusPlus;

use super::tests::{SIZE, offscreen, picture_of};
use super::*;
use crate::synthetic::SyntheticSession;
use crate::synthetic::{camera, delivery};
use crate::value::ColorMode;

/// Paths of all kinds, some of which go behind the wall or past the eye.
fn batch() -> PathBatch {
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(11);
    let mut unit = || (rng.next_u32() >> 8) as f32 / (1 << 24) as f32;
    let mut builder = BatchBuilder::new(BatchLimits { bytes: usize::MAX });
    let lens = camera().origin.as_vec3().to_array();
    for step in 0..60_u32 {
        let edges = 2 + step as usize % 9;
        let mut vertices: Vec<_> = (0..edges)
            .map(|i| VertexRecord {
                position: [0.9, 0.9, 1.6].map(|reach| 512.0 * reach * (2.0 * unit() - 1.0)),
                normal: [0, 0],
                kind: [VertexKind::Light, VertexKind::Diffuse, VertexKind::Specular]
                    [i.min(step as usize % 3)],
                event: Event::Diffuse,
                material: 0,
                primitive: 0,
            })
            .collect();
        vertices.push(VertexRecord { position: lens, kind: VertexKind::Eye, ..vertices[0] });
        let codes: Vec<_> = vertices.iter().map(|_| encode_throughput(unit())).collect();
        let header = PathHeader {
            id: PathId { chain: ChainId(step % 16), epoch: 0, step: u64::from(step) },
            strategy: StrategyId((step % 6) as u8),
            luminance: (8.0 * unit()).exp2(),
            rgb: [unit(), unit(), unit()],
            acceptance: unit(),
            dwell: 1 << (step % 6),
            ..PathHeader::default()
        };
        let full = builder.push_with(&header, &vertices, &codes, None);
        assert!(full.is_none(), "the batch has no limit");
    }
    builder.finish().expect("a batch with paths")
}

fn of(batch: PathBatch) -> SyntheticSession {
    SyntheticSession { batches: vec![batch], ..delivery(&[&[[0.0; 3]]]) }
}

/// How much brighter one picture is than another.
///
/// In thousandths of a step of 255, in the channel where that is most, and how many pixels differ by a sixth of the range and more. Edges that are smoothed otherwise differ
/// in both directions; what is drawn in another colour or opacity does not.
fn difference(a: &RgbaImage, b: &RgbaImage) -> (i64, usize) {
    let mut sums = [0; 3];
    let mut far = 0;
    for (p, q) in a.pixels().zip(b.pixels()) {
        for (c, sum) in sums.iter_mut().enumerate() {
            *sum += i64::from(p[c]) - i64::from(q[c]);
        }
        far += usize::from((0..3).any(|c| p[c].abs_diff(q[c]) > 42));
    }
    let most = sums.iter().map(|sum| sum.abs()).max().unwrap_or(0);
    (1000 * most / i64::from(SIZE[0] * SIZE[1]), far)
}

#[test]
fn card_and_processor_draw_the_same_picture() {
    if offscreen().is_none() {
        return;
    }
    let mut card =
        OffscreenWindow::with(SIZE, |_| Quality::Plain).expect("a window like the other");
    let mut processor =
        OffscreenWindow::with(SIZE, |_| Quality::Fast).expect("a window like the other");
    let looks: [&[&str]; 16] = [
        &["cloud width 1"],
        &["cloud width 6", "cloud hidden 1"],
        &["cloud width 0.5", "scene shading off"],
        &["cloud width 3", "scene opacity 0.4", "cloud ends on"],
        &["cloud blend weighted", "cloud width 3"],
        &["cloud blend weighted", "scene shading off", "cloud hidden 0.3"],
        &["cloud blend add", "cloud width 2"],
        &["theme light", "cloud dots 5", "cloud ends on"],
        &["cloud marks vertices", "cloud dots 4"],
        &["cloud marks ends", "cloud dots 6", "cloud ends on"],
        &["scene clip -y", "scene cut 0.4", "cloud dots 4"],
        &["cloud cue 1", "cloud width 4", "cloud fade 20"],
        &["filter set edges > 5", "cloud dim 0.3", "cloud width 4"],
        &["cloud opacity 0.2", "cloud width 5", "scene shading wireframe"],
        &["camera orbit 60 25", "camera zoom 4 0.1 0", "cloud width 2"],
        &["camera view top", "cloud width 2"],
    ];
    // Three of the ramps have a linear scale, too.
    let ramps = [ColorMode::Length, ColorMode::Luminance, ColorMode::Throughput];
    let logarithmic = ColorMode::ALL.iter().map(|mode| (mode, "log"));
    let linear = ramps.iter().map(|mode| (mode, "linear"));
    let colors = logarithmic.chain(linear).map(|(mode, scale)| {
        let scene = "scene shading off".to_owned();
        vec![format!("cloud color {mode}"), format!("cloud scale {scale}"), scene]
    });
    let looks = looks.iter().map(|look| look.iter().map(|&c| c.to_owned()).collect());
    let mut seen = Vec::new();
    for look in looks.chain(colors) {
        let look: Vec<&str> = look.iter().map(String::as_str).collect();
        let one = picture_of(&mut card, of(batch()), &look);
        let other = picture_of(&mut processor, of(batch()), &look);
        let (bias, far) = difference(&one, &other);
        seen.push((look.join(", "), bias, far));
    }
    for (look, bias, far) in seen {
        assert!(
            bias <= 8 && far <= 20,
            "{look}: {bias}/1000 brighter or darker, {far} pixels far off"
        );
    }
}
