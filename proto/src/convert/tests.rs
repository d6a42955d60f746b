//! Round trips, and what hostile peers may send.

use std::sync::Arc;

use common::{
    BatchBuilder, BatchOrigin, Camera, CameraPose, ChainId, ChainTotals, Diagnostics, Event,
    FailureCount, FilmTile, FilterCounts, FilterError, FilterObject, FilterReply, FilterText, Gap,
    MAX_FILTER_BYTES, MaterialInfo, NearestMiss, PathBatch, PathHeader, PathId, Queue, Rgb, Role,
    SceneFrame, SceneMesh, Shortfall, Statistics, StrategyId, StrategyStatistics, TexturePreview,
    TileGrid, TileMaps, TracerEvent, UNKNOWN, VertexKind, VertexRecord, Welcome,
};
use glam::DVec3;
use proptest::prelude::*;
use prost::Message as _;

use super::*;
use crate::{ProtocolVersion, v1};

fn camera() -> Camera {
    let pose = CameraPose {
        origin: DVec3::new(1.0, 2.0, 3.0),
        target: DVec3::ZERO,
        up: DVec3::Y,
        vertical_fov: 35.0,
    };
    Camera::new(&pose, 320, 200).expect("a valid pose")
}

fn frame() -> SceneFrame {
    SceneFrame { centre: DVec3::new(0.5, -1.0, 4.0), scale: 64.0, light: 0.5 }
}

fn welcome() -> Welcome {
    Welcome {
        session: 7,
        server_version: "0.1.0".to_owned(),
        scene_name: "cornell".to_owned(),
        scene_hash: "00ff".to_owned(),
        frame: frame(),
        camera: camera(),
        strategies: vec!["lens".to_owned(), "bidirectional".to_owned()],
        failure_reasons: vec!["occluded".to_owned()],
        chains: 4,
        max_edges: 9,
        role: Role::Observer,
        resume: "0a1b".to_owned(),
    }
}

fn statistics() -> Statistics {
    let failures = vec![FailureCount { reason: 0, count: 3 }];
    Statistics {
        epoch: 1,
        elapsed_seconds: 2.5,
        mutations_per_second: 1e6,
        threads: 2,
        totals: ChainTotals {
            steps: 10,
            rays: 20,
            shadow_rays: 30,
            not_finite: 0,
            longest_dwell: 4,
        },
        strategies: vec![StrategyStatistics {
            proposed: 10,
            generated: 7,
            accepted: 5,
            acceptance_sum: 4.5,
            failures,
        }],
        normalization: 0.7,
        normalization_error: 0.01,
        memory_bytes: 1 << 20,
        viewers: 3,
        paths_sent: 100,
        paths_dropped: 9,
        queued_bytes: 12,
        queues: vec![Queue { name: "paths".to_owned(), bytes: 12, limit: 99, own: true }],
        filter: FilterCounts {
            revision: 4,
            seen: 1000,
            matched: 10,
            seen_steps: 32_000.0,
            matched_steps: 400.0,
            energy_share: 0.0125,
            energy_error: 0.001,
            conditions: vec![500, 20],
            nearest: Some(NearestMiss {
                path: PathId { chain: ChainId(3), epoch: 1, step: 77 },
                asked: 2,
                failed: vec![
                    Shortfall { condition: 0, by: Some(0.2) },
                    Shortfall { condition: 1, by: None },
                ],
            }),
        },
        diagnostics: Some(Arc::new(diagnostics())),
    }
}

fn diagnostics() -> Diagnostics {
    let map = |value: f32| vec![value, UNKNOWN, 0.5, 0.25, 1.0, 0.0];
    Diagnostics {
        grid: TileGrid { side: 16, columns: 3, rows: 2 },
        maps: TileMaps {
            acceptance: map(0.4),
            dwell: map(12.0),
            visits: map(1.5),
            spread: map(0.02),
            r_hat: map(1.01),
        },
        autocorrelation: vec![0.9, 0.4, 0.01],
        correlation_steps: 37.5,
        effective_samples: 1e6,
        r_hat: 1.004,
        longest: None,
    }
}

fn tile() -> FilmTile {
    let rgb = (0..24).map(|i| i as f32).collect();
    FilmTile { sequence: 5, width: 4, height: 10, first_row: 8, steps: 99, rgb }
}

fn mesh(triangles: u32) -> SceneMesh {
    let count = triangles as usize;
    let material = |name: &str| MaterialInfo {
        name: name.to_owned(),
        model: "lambert".to_owned(),
        color: Rgb::grey(0.5),
        emission: Rgb::BLACK,
        transparent: false,
        texture: (name == "floor").then_some(1),
    };
    let texels = (0..6).map(|i| [i, 2 * i, 255 - i]).collect();
    let texture = TexturePreview { width: 3, height: 2, texels };
    SceneMesh {
        positions: (0..count + 2).map(|i| [i as f32, 0.0, 1.0]).collect(),
        normals: vec![[0.0, 0.0, 1.0]; count + 2],
        texcoords: (0..count + 2).map(|i| [0.5 * i as f32, -1.0]).collect(),
        triangles: (0..triangles).map(|i| [i, i + 1, i + 2]).collect(),
        triangle_materials: (0..count).map(|i| (i % 2) as u16).collect(),
        primitives: (0..triangles).collect(),
        materials: vec![material("wall"), material("floor")],
        objects: vec![FilterObject { name: "strip".to_owned(), primitives: 0..triangles }],
        textures: vec![TexturePreview { width: 1, height: 1, texels: vec![[9; 3]] }, texture],
        camera: Some(camera()),
    }
}

/// Sends an event through its bytes.
fn travel(event: &TracerEvent) -> Result<TracerEvent, WireError> {
    let bytes = v1::TracerMessage::from(event).encode_to_vec();
    v1::TracerMessage::decode(bytes.as_slice()).expect("our own bytes").try_into()
}

prop_compose! {
    fn any_vertex()(
        position in prop::array::uniform3(-1e6..1e6_f32),
        normal in prop::array::uniform2(any::<i16>()),
        kind in prop::sample::select(vec![VertexKind::Light, VertexKind::Diffuse, VertexKind::Eye]),
        event in prop::sample::select(vec![Event::End, Event::Diffuse, Event::Transmit]),
        material in any::<u16>(),
        primitive in any::<u32>(),
    ) -> VertexRecord {
        VertexRecord { position, normal, kind, event, material, primitive }
    }
}

prop_compose! {
    fn any_header()(
        chain in 0..3_u32,
        (epoch, step, strategy, dwell) in any::<(u32, u64, u8, u32)>(),
        (weight, acceptance, luminance) in (0.0..1e9_f32, 0.0..1.0_f32, 0.0..1e9_f32),
        film in prop::array::uniform2(0.0..1.0_f32),
        rgb in prop::array::uniform3(0.0..9.0_f32),
    ) -> PathHeader {
        let id = PathId { chain: ChainId(chain), epoch, step };
        let strategy = StrategyId(strategy);
        PathHeader { id, strategy, dwell, weight, acceptance, film, luminance, rgb }
    }
}

fn any_batch() -> impl Strategy<Value = PathBatch> {
    let record = (any_header(), prop::collection::vec(any_vertex(), 2..9));
    let counts = (any::<(u32, u32)>(), 0.0..1e9_f32, any::<(u32, u32)>(), 0.0..1e12_f64);
    let origin =
        counts.prop_map(|((revision, source_batches), decimation, (seen, more), steps)| {
            let (matched, seen) = (u64::from(seen), u64::from(seen) + u64::from(more));
            let (matched_steps, seen_steps) = (steps, 3.0 * steps);
            BatchOrigin {
                revision,
                source_batches,
                decimation,
                seen,
                matched,
                seen_steps,
                matched_steps,
            }
        });
    let records = (prop::collection::vec(record, 1..40), any::<u64>(), origin);
    records.prop_map(|(records, sequence, origin)| {
        let mut builder = BatchBuilder::default();
        for (header, vertices) in &records {
            let completed = builder.push(header, vertices, None);
            assert!(completed.is_none(), "forty paths fit into one batch");
        }
        let batch = builder.finish().expect("at least one path").with_sequence(sequence);
        batch.with_origin(origin).expect("possible")
    })
}

proptest! {
    #[test]
    fn any_batch_survives_the_wire(batch in any_batch()) {
        let sent = TracerEvent::Paths(Arc::new(batch));
        prop_assert_eq!(travel(&sent), Ok(sent));
    }

    #[test]
    fn random_bytes_never_panic(bytes in prop::collection::vec(any::<u8>(), 0..400)) {
        if let Ok(message) = v1::TracerMessage::decode(bytes.as_slice()) {
            drop(TracerEvent::try_from(message));
        }
        if let Ok(message) = v1::ViewerMessage::decode(bytes.as_slice()) {
            drop(ViewerEvent::try_from(message));
        }
    }

    /// Damaged batches reach the checks that random bytes seldom do.
    #[test]
    fn damaged_batches_never_panic(
        batch in any_batch(),
        damage in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..8),
    ) {
        let mut bytes = v1::TracerMessage::from(&TracerEvent::Paths(Arc::new(batch))).encode_to_vec();
        for (place, value) in damage {
            let place = place.index(bytes.len());
            bytes[place] = value;
        }
        let decoded = v1::TracerMessage::decode(bytes.as_slice()).map(TracerEvent::try_from);
        if let Ok(Ok(TracerEvent::Paths(batch))) = decoded {
            let mut reader = batch.reader();
            while let Some(path) = reader.next() {
                prop_assert!(path.vertices.len() >= 2, "accepted batches can be rebuilt");
            }
        }
    }
}

#[test]
fn every_tracer_event_survives_the_wire() {
    for event in [
        TracerEvent::Welcome(Box::new(welcome())),
        TracerEvent::Film(tile()),
        TracerEvent::Statistics(Arc::new(statistics())),
        TracerEvent::Gap(Gap { batches: 1, paths: 2, bytes: 3 }),
        TracerEvent::SnapshotEnd,
        TracerEvent::FilterReply(FilterReply {
            revision: 2,
            epoch: 1,
            text: "edges == 2".to_owned(),
            conditions: vec!["edges == 2".to_owned()],
            error: None,
        }),
        TracerEvent::FilterReply(FilterReply {
            revision: 3,
            error: Some(FilterError { span: 4..9, message: "expected more".to_owned() }),
            ..FilterReply::default()
        }),
        TracerEvent::Goodbye("over".to_owned()),
        TracerEvent::Unknown,
    ] {
        assert_eq!(travel(&event), Ok(event));
    }
}

#[test]
fn every_viewer_event_survives_the_wire() {
    let hello = Hello {
        version: ProtocolVersion::CURRENT,
        viewer_name: "a viewer".to_owned(),
        wanted_role: Role::Driver,
        data_budget: 1 << 20,
        filter: Some(WantedFilter { revision: 1, filter: FilterText::read("edges > 1") }),
        focus: true,
        resume: "0a1b".to_owned(),
    };
    for event in [
        ViewerEvent::Hello(hello),
        ViewerEvent::SetBudget(9),
        ViewerEvent::SetFilter(WantedFilter { revision: u32::MAX, filter: FilterText::default() }),
        ViewerEvent::Goodbye("over".to_owned()),
        ViewerEvent::Unknown,
    ] {
        assert_eq!(ViewerEvent::try_from(v1::ViewerMessage::from(event.clone())), Ok(event));
    }
}

#[test]
fn messages_of_a_later_version_are_unknown_and_harmless() {
    // Field 99, two bytes long: a case of the `oneof` that does not exist yet.
    let bytes: &[u8] = &[0x9a, 0x06, 0x02, 0x08, 0x01];
    let tracer = v1::TracerMessage::decode(bytes).expect("unknown fields are skipped");
    assert_eq!(TracerEvent::try_from(tracer), Ok(TracerEvent::Unknown));
    let viewer = v1::ViewerMessage::decode(bytes).expect("unknown fields are skipped");
    assert_eq!(ViewerEvent::try_from(viewer), Ok(ViewerEvent::Unknown));
}

#[test]
fn another_major_version_is_refused_and_both_are_named() {
    let version = Some(v1::ProtocolVersion { major: 9, minor: 4 });
    let hello = v1::Hello { version, ..v1::Hello::default() };
    let message = Hello::try_from(hello).expect_err("version 9 is not ours").to_string();
    let ours = ProtocolVersion::CURRENT.to_string();
    assert!(message.contains("9.4") && message.contains(&ours), "names both: {message}");
}

#[test]
fn hostile_filters_are_refused() {
    let filter = |revision, text: &str| {
        WantedFilter::try_from(v1::SetFilter { revision, text: text.to_owned() })
    };
    assert!(filter(1, &" ".repeat(MAX_FILTER_BYTES)).is_ok(), "as long as allowed");
    assert!(filter(1, &" ".repeat(MAX_FILTER_BYTES + 1)).is_err(), "too long");
    assert!(filter(0, "edges > 1").is_err(), "no number");
    let reply = |edit: fn(&mut v1::FilterReply)| {
        let mut wire = v1::FilterReply { revision: 1, ..v1::FilterReply::default() };
        edit(&mut wire);
        FilterReply::try_from(wire).is_err()
    };
    assert!(!reply(|_| {}), "an empty reply is good");
    assert!(reply(|r| r.conditions = vec![String::new(); 65]), "too many conditions");
    assert!(reply(|r| r.text = "x".repeat(1 << 20)), "a long text");
    let error = |start, end| v1::FilterError { start, end, message: String::new() };
    assert!(!reply(|r| r.error = Some(v1::FilterError::default())), "an error is good");
    let backwards = v1::FilterReply { error: Some(error(3, 2)), ..v1::FilterReply::default() };
    assert!(FilterReply::try_from(backwards).is_err(), "a span that ends before it starts");
    let counts = v1::FilterCounts { energy_error: f64::NAN, ..v1::FilterCounts::default() };
    assert!(FilterCounts::try_from(counts).is_err(), "NaN");
}

#[test]
fn hostile_origins_are_refused() {
    let empty = |edit: fn(&mut v1::PathBatch)| {
        let mut wire = v1::PathBatch::default();
        edit(&mut wire);
        PathBatch::try_from(wire)
    };
    assert!(empty(|_| {}).is_ok(), "a batch without records is good");
    assert!(empty(|b| b.decimation = f32::NAN).is_err(), "NaN");
    assert!(empty(|b| b.decimation = -1.0).is_err(), "negative");
    assert!(empty(|b| b.seen_steps = f64::INFINITY).is_err(), "infinite");
    assert!(empty(|b| b.matched = 1).is_err(), "more matches than paths");
}

#[test]
fn hostile_tiles_are_refused() {
    let good = v1::FilmTile::from(&tile());
    let refused = |edit: fn(&mut v1::FilmTile)| {
        let mut wire = good.clone();
        edit(&mut wire);
        FilmTile::try_from(wire).is_err()
    };
    assert!(!refused(|_| {}), "the tile itself is good");
    assert!(refused(|t| t.width = 0), "no width");
    assert!(refused(|t| t.width = u32::MAX), "absurd width");
    assert!(refused(|t| t.width = 5), "pixels that fill no row");
    assert!(refused(|t| t.first_row = 9), "rows below the film");
    assert!(refused(|t| t.height = 0), "no height");
    assert!(refused(|t| t.rgb = vec![0xff; 48].into()), "NaN");
    assert!(refused(|t| t.rgb = vec![].into()), "no rows");
}

#[test]
fn hostile_welcomes_are_refused() {
    let good = v1::Welcome::from(&welcome());
    let refused = |edit: fn(&mut v1::Welcome)| {
        let mut wire = good.clone();
        edit(&mut wire);
        Welcome::try_from(wire).is_err()
    };
    assert!(!refused(|_| {}), "the welcome itself is good");
    assert!(refused(|w| w.version = None), "no version");
    assert!(refused(|w| w.camera = None), "no camera");
    assert!(refused(|w| w.scene_name = "x".repeat(257)), "long name");
    assert!(refused(|w| w.strategies = vec![String::new(); 257]), "too many names");
    assert!(refused(|w| w.frame.as_mut().expect("set").scale = -1.0), "negative scale");
    let camera = |w: &mut v1::Welcome| *w.camera.as_mut().expect("set");
    assert!(refused_camera(camera(&mut good.clone()), |c| c.tan_x = f64::NAN), "NaN");
    assert!(refused_camera(camera(&mut good.clone()), |c| c.right = c.up), "skewed axes");
    assert!(refused_camera(camera(&mut good.clone()), |c| c.width = 0), "no film");
}

fn refused_camera(mut wire: v1::Camera, edit: fn(&mut v1::Camera)) -> bool {
    edit(&mut wire);
    Camera::try_from(wire).is_err()
}

fn assemble(
    chunks: impl IntoIterator<Item = v1::SceneChunk>,
) -> Result<Option<ReceivedScene>, WireError> {
    let mut assembler = SceneAssembler::default();
    for chunk in chunks {
        assembler.push(chunk)?;
    }
    assembler.finish()
}

#[test]
fn scenes_survive_being_cut() {
    let mesh = mesh(100_000);
    let chunks: Vec<_> = scene_chunks("00ff", frame(), &mesh).collect();
    let largest = chunks.iter().map(v1::SceneChunk::encoded_len).max();
    assert!(largest < Some(1 << 20), "chunks stay below 1 MiB, not {largest:?}");
    assert!(chunks.len() > 10, "a scene of this size takes many chunks");
    let scene = ReceivedScene { hash: "00ff".to_owned(), frame: frame(), mesh };
    assert_eq!(assemble(chunks), Ok(Some(scene)));
    assert_eq!(assemble([unchanged_scene("00ff")]), Ok(None));
}

#[test]
fn scenes_that_do_not_hold_together_are_refused() {
    let good = mesh(3);
    let chunks = |mesh: &SceneMesh| scene_chunks("00ff", frame(), mesh).collect::<Vec<_>>();
    let whole = chunks(&good);
    assert!(assemble(whole.clone()).is_ok(), "the scene itself is good");
    assert!(assemble([]).is_err(), "nothing at all");
    assert!(assemble(whole[1..].to_vec()).is_err(), "no header");
    assert!(assemble(whole[..3].to_vec()).is_err(), "triangles missing");
    assert!(assemble([whole.clone(), whole[3..].to_vec()].concat()).is_err(), "too many triangles");
    assert!(assemble([whole.clone(), whole].concat()).is_err(), "two headers");
    let stray = SceneMesh { triangles: vec![[0, 1, 99]; 3], ..good.clone() };
    assert!(assemble(chunks(&stray)).is_err(), "an index out of range");
    let unpainted = SceneMesh { triangle_materials: vec![2; 3], ..good.clone() };
    assert!(assemble(chunks(&unpainted)).is_err(), "a material out of range");
    let bare = SceneMesh { texcoords: vec![[0.0; 2]; 4], ..good.clone() };
    assert!(assemble(chunks(&bare)).is_err(), "vertices without texture coordinates");
    let odd = SceneMesh { texcoords: vec![[f32::INFINITY; 2]; 5], ..good.clone() };
    assert!(assemble(chunks(&odd)).is_err(), "infinite texture coordinates");
    let blank = SceneMesh { textures: vec![good.textures[0].clone()], ..good.clone() };
    assert!(assemble(chunks(&blank)).is_err(), "a texture out of range");
    for (width, height, texels) in [(3, 3, 6), (0, 2, 0), (513, 1, 513), (u32::MAX, u32::MAX, 1)] {
        let texture = TexturePreview { width, height, texels: vec![[0; 3]; texels] };
        let wrong = SceneMesh { textures: vec![texture; 2], ..good.clone() };
        assert!(assemble(chunks(&wrong)).is_err(), "{width} x {height} of {texels} texels");
    }
    let torn = SceneMesh { positions: vec![[f32::NAN; 3]; 5], ..good };
    assert!(assemble(chunks(&torn)).is_err(), "NaN");
}
