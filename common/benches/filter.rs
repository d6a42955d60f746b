//! What filters cost: `cargo bench -p common`.
//!
//! Batches of paths of three to eight edges, as the daemon makes them; the time includes rebuilding
//! each path from its predecessor, which is also given alone.

use std::hint::black_box;
use std::io::{self, Write as _};
use std::time::Instant;

use common::{
    BatchBuilder, BatchLimits, ChainId, CompiledFilter, Event, Filter, FilterMaterial, FilterScene,
    Kept, PathBatch, PathHeader, PathId, SceneFrame, VertexKind, VertexRecord,
};
use glam::DVec3;

/// Each figure is the best of this many rounds.
const ROUNDS: usize = 20;
/// Paths in a round.
const PATHS: u32 = 50_000;

const FILTERS: [&str; 8] = [
    "edges >= 4",
    "start on material lamp",
    "any in sphere(0, 0, 0, 0.1)",
    "any through sphere(0, 0, 0, 0.1)",
    "any through box(-0.1, -0.1, -0.1, 0.1, 0.1, 0.1)",
    "lpe \"C.*'glass'.*L\"",
    "any in sphere(0, 0, 0, 0.1) and lpe \"CS+D.*L\" and edges >= 4",
    "any through sphere(1, 0, 0, 0.1) or any through sphere(0, 1, 0, 0.1) or \
     any through sphere(0, 0, 1, 0.1) or any through sphere(1, 1, 1, 0.1)",
];

fn main() -> io::Result<()> {
    let batch = paths();
    let scene = FilterScene {
        frame: SceneFrame { centre: DVec3::ZERO, scale: 1.0, light: 1.0 },
        materials: ["wall", "glass", "lamp"].map(FilterMaterial::from).to_vec(),
        strategies: Vec::new(),
        objects: Vec::new(),
    };
    let mut out = io::stdout().lock();
    let alone = best(|| {
        let mut reader = batch.reader();
        let mut vertices = 0;
        while let Some(path) = reader.next() {
            vertices += path.vertices.len();
        }
        vertices
    });
    writeln!(
        out,
        "{alone:7.1} ns a path to rebuild it ({} bytes a path)",
        batch.byte_len() / batch.len()
    )?;
    for text in FILTERS {
        let compiled = Filter::parse(text).and_then(|filter| filter.compile(&scene));
        let filter = compiled.map_err(|error| io::Error::other(error.pointed(text)))?;
        let lazy = best(|| count(&batch, &filter, false)) - alone;
        let all = best(|| count(&batch, &filter, true)) - alone;
        let share = 100.0 * count(&batch, &filter, false) as f64 / batch.len() as f64;
        writeln!(
            out,
            "{lazy:7.1} ns a path, {all:7.1} ns with every condition; {share:5.1} %  {text}"
        )?;
    }
    Ok(())
}

fn count(batch: &PathBatch, filter: &CompiledFilter, every_condition: bool) -> usize {
    let mut reader = batch.reader();
    let mut matching = 0;
    while let Some(path) = reader.next() {
        let matches = if every_condition {
            filter.wants(filter.conditions(&path.header, path.vertices))
        } else {
            filter.matches(&path.header, path.vertices)
        };
        matching += usize::from(matches);
    }
    matching
}

/// Nanoseconds a path.
fn best<T>(mut work: impl FnMut() -> T) -> f64 {
    let times = (0..ROUNDS).map(|_| {
        let start = Instant::now();
        black_box(work());
        start.elapsed().as_secs_f64()
    });
    times.fold(f64::INFINITY, f64::min) * 1e9 / f64::from(PATHS)
}

fn paths() -> PathBatch {
    let mut state = 1_u32;
    let mut random = move || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        state >> 8
    };
    let mut builder = BatchBuilder::new(BatchLimits { bytes: usize::MAX });
    let mut path: Vec<VertexRecord> = Vec::new();
    for step in 0..PATHS {
        let count = 4 + random() as usize % 6;
        let moved = random().is_multiple_of(3) || path.is_empty();
        if moved {
            path.clear();
            path.extend((0..count).map(|i| vertex(i, count, random())));
        } else {
            // A lens perturbation: two vertices before the camera move.
            for i in path.len() - 3..path.len() - 1 {
                path[i] = vertex(i, path.len(), random());
            }
        }
        let id = PathId { chain: ChainId(0), epoch: 0, step: step.into() };
        let header = PathHeader { id, weight: 1.0, ..PathHeader::default() };
        let kept = (!moved).then(|| Kept { light: path.len() - 3, eye: 1 });
        // The batch has no limit and is completed below.
        drop(builder.push(&header, &path, kept));
    }
    builder.finish().unwrap_or_default()
}

fn vertex(i: usize, count: usize, random: u32) -> VertexRecord {
    let coordinate = |shift: u32| ((random >> shift) & 255) as f32 / 128.0 - 1.0;
    let (kind, event) = match (i, random % 4) {
        (0, _) => (VertexKind::Light, Event::End),
        (i, _) if i + 1 == count => (VertexKind::Eye, Event::End),
        (_, 0) => (VertexKind::Specular, Event::Transmit),
        _ => (VertexKind::Diffuse, Event::Diffuse),
    };
    VertexRecord {
        position: [coordinate(0), coordinate(8), coordinate(16)],
        normal: [0, 0],
        kind,
        event,
        material: (random % 3) as u16,
        primitive: random,
    }
}
