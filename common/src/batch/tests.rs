//! What any batch must do, and what none may hold.

use glam::Vec3;
use proptest::prelude::*;

use super::*;

fn vertex(tag: u32) -> VertexRecord {
    VertexRecord {
        position: [tag as f32, 0.5, -1.0],
        normal: [0, 0],
        kind: VertexKind::Diffuse,
        event: Event::Diffuse,
        material: 0,
        primitive: tag,
    }
}

type Step = (u32, Vec<VertexRecord>, Option<Kept>);

/// A chain's history: each step keeps a random prefix and suffix and inserts fresh vertices.
fn history(steps: &[(u32, usize, usize, usize)]) -> Vec<Step> {
    let mut tag = 0;
    let mut paths: [Vec<VertexRecord>; 3] = Default::default();
    let mut out = Vec::new();
    for &(chain, light, eye, inserted) in steps {
        let path = &mut paths[chain as usize];
        let light = light.min(path.len());
        let eye = eye.min(path.len() - light);
        let known = !path.is_empty();
        let fresh: Vec<_> = (0..inserted.max(2)).map(|i| vertex(tag + i as u32)).collect();
        tag += fresh.len() as u32;
        let end = path.len() - eye;
        path.splice(light..end, fresh);
        out.push((chain, path.clone(), known.then_some(Kept { light, eye })));
    }
    out
}

proptest! {
    #[test]
    fn any_batch_alone_rebuilds_its_paths(
        steps in prop::collection::vec((0..3_u32, 0..5_usize, 0..5_usize, 2..6_usize), 1..60),
        bytes in 100..3000_usize,
    ) {
        let mut builder = BatchBuilder::new(BatchLimits { bytes });
        let mut batches = Vec::new();
        let history = history(&steps);
        for (i, (chain, path, kept)) in history.iter().enumerate() {
            let id = PathId { chain: ChainId(*chain), epoch: 0, step: i as u64 };
            let header = PathHeader { id, ..PathHeader::default() };
            // Some paths come without throughputs, some with too few.
            let known: Vec<u8> = (0..path.len() * (i % 3) / 2).map(|j| (i + j) as u8).collect();
            batches.extend(builder.push_with(&header, path, &known, *kept));
        }
        batches.extend(builder.finish());
        let mut seen = 0;
        for batch in batches {
            let checked = PathBatch::from_columns(7, batch.paths.clone(), batch.vertices.clone())
                .and_then(|checked| checked.with_throughput(batch.throughput.clone()));
            prop_assert!(checked.is_ok(), "{checked:?}");
            let mut reader = batch.reader();
            while let Some(view) = reader.next() {
                let expected = &history[view.header.id.step as usize].1;
                prop_assert_eq!(view.vertices, expected.as_slice());
                let i = view.header.id.step as usize;
                for j in 0..expected.len() * (i % 3) / 2 {
                    prop_assert_eq!(view.throughput.get(j), Some(&((i + j) as u8)), "{} {}", i, j);
                }
                prop_assert!([0, expected.len()].contains(&view.throughput.len()));
                seen += 1;
            }
        }
        prop_assert_eq!(seen, history.len());
    }

    #[test]
    fn normals_survive_packing(x in -1.0..1.0_f32, y in -1.0..1.0_f32, z in -1.0..1.0_f32) {
        prop_assume!(x * x + y * y + z * z > 1e-4);
        let n = Vec3::new(x, y, z).normalize_or_zero();
        let error = (decode_normal(encode_normal(n)) - n).length();
        prop_assert!(error < 1e-4, "{n} moved by {error}");
    }
}

fn batch_of_two() -> PathBatch {
    let mut builder = BatchBuilder::default();
    let header = PathHeader::default();
    let path = [vertex(0), vertex(1), vertex(2)];
    assert!(builder.push(&header, &path, None).is_none(), "the batch is far from full");
    assert!(
        builder.push(&header, &path, Some(Kept { light: 1, eye: 1 })).is_none(),
        "still far from full"
    );
    builder.finish().expect("two records")
}

#[test]
fn hostile_columns_are_refused() {
    let batch = batch_of_two();
    let check = |edit: fn(&mut PathColumns, &mut VertexColumns)| {
        let (mut paths, mut vertices) = (batch.paths.clone(), batch.vertices.clone());
        edit(&mut paths, &mut vertices);
        PathBatch::from_columns(0, paths, vertices).expect_err("must be refused")
    };
    assert!(matches!(check(|p, _| p.weight[1] = f32::NAN), BatchError::NotFinite { .. }));
    assert!(matches!(check(|p, _| p.kept_eye[1] = 9), BatchError::Splice { .. }));
    assert!(matches!(check(|p, _| p.kept_light[0] = 1), BatchError::NoKeyframe { .. }));
    assert!(matches!(check(|p, _| p.chain[1] = 9), BatchError::NoKeyframe { .. }));
    assert!(matches!(check(|p, _| p.inserted[1] = 200), BatchError::Length { .. }));
    let short = batch.clone().with_throughput(vec![7; 5]);
    assert!(matches!(short, Err(BatchError::Length { found: 5, expected: 6, .. })), "{short:?}");
    assert!(matches!(check(|_, v| v.kind[0] = 99), BatchError::UnknownCode { .. }));
    assert!(matches!(check(|_, v| v.position[2][1] = f32::INFINITY), BatchError::NotFinite { .. }));
}
