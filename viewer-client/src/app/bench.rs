//! `viewer-client bench`: how fast paths are drawn, and what they cost in memory.

//!
//! "CPU side" is the time until all commands are recorded, without what draws them.

use std::io::{self, Write as _};
use std::sync::Arc;
use std::time::{Duration, Instant};

use anyhow::Context as _;
use common::{
    BatchBuilder, BatchLimits, ChainId, Event, PathBatch, PathHeader, PathId, StrategyId,
    TracerEvent, VertexKind, VertexRecord,
};
use cpu_time::ProcessTime;
use rand_core::{Rng as _, SeedableRng as _};
use rand_xoshiro::Xoshiro256PlusPlus;
use serde_json::json;

use crate::app::Viewer;
use crate::app::cli::BenchArgs;
use crate::app::headless::OffscreenWindow;
use crate::command::Command;
use crate::source::Source;
use crate::value::Bounds;
use crate::value::format;

/// Half the side of the box that the paths fill, in scene units.
const REACH: f32 = 512.0;
/// Paths that come in one batch.
const BATCH: u32 = 1000;
/// Frames whose median is reported.
const FRAMES: usize = 7;
/// How long nothing happens.
const REST: Duration = Duration::from_secs(2);
/// The view while it is measured; all paths are drawn, as opaque as they are by default.
const LOOK: [&str; 5] = [
    "cloud budget 8192",
    "cloud shown 10000000",
    "cloud fade 10000000",
    "scene shading off",
    "camera frame",
];

/// Measures each number of paths and prints a line for it.
pub fn run(args: &BenchArgs) -> anyhow::Result<()> {
    let mut out = io::stdout();
    if !args.json {
        writeln!(out, "{}", Figures::HEADER)?;
    }
    for paths in &args.paths {
        let figures = measure(*paths, args)?;
        let line = if args.json { figures.json().to_string() } else { figures.line() };
        writeln!(out, "{line}").context("cannot write to the standard output")?;
    }
    Ok(())
}

/// What was measured with some number of paths.
#[derive(Clone, Copy, Debug)]
struct Figures {
    paths: u32,
    /// From the first path on: until some of them are seen.
    first: Duration,
    /// From the first path on: until all of them are seen.
    whole: Duration,
    /// A frame while the view moves: what the window shows then.
    moving: Duration,
    moving_cpu: Duration,
    /// From a change of the view until the whole picture is there again.
    refined: Duration,
    /// Processor time of a second in which nothing changes, and the frames drawn in it.
    rest: Duration,
    rest_frames: u32,
    /// A click on a path, until it is found.
    pick: Duration,
    /// Resident memory before the first path.
    empty: usize,
    /// Resident memory of the process in bytes; 0 where the system does not tell.
    memory: usize,
}

impl Figures {
    const HEADER: &str = "     paths  first picture  whole picture  moving: wall   CPU side  \
        refined  a second's rest    picking      empty     memory";

    fn line(&self) -> String {
        let ms = |d: Duration| format!("{:.2} ms", 1e3 * d.as_secs_f64());
        let s = |d: Duration| format!("{:.2} s", d.as_secs_f64());
        format!(
            "{:>10} {:>14} {:>14} {:>13} {:>10} {:>8} {:>16} {:>10} {:>10} {:>10}",
            self.paths,
            s(self.first),
            s(self.whole),
            ms(self.moving),
            ms(self.moving_cpu),
            s(self.refined),
            ms(self.rest),
            ms(self.pick),
            format::bytes(self.empty as u64),
            format::bytes(self.memory as u64),
        )
    }

    fn json(&self) -> serde_json::Value {
        json!({
            "paths": self.paths,
            "first_picture_s": self.first.as_secs_f64(),
            "whole_picture_s": self.whole.as_secs_f64(),
            "moving_wall_s": self.moving.as_secs_f64(),
            "moving_cpu_s": self.moving_cpu.as_secs_f64(),
            "refined_s": self.refined.as_secs_f64(),
            "rest_cpu_s_per_s": self.rest.as_secs_f64(),
            "rest_frames": self.rest_frames,
            "pick_s": self.pick.as_secs_f64(),
            "empty_bytes": self.empty,
            "memory_bytes": self.memory,
        })
    }
}

fn measure(paths: u32, args: &BenchArgs) -> anyhow::Result<Figures> {
    let mut offscreen = OffscreenWindow::like_a_window(args.size)?;
    let mut viewer = Viewer::new(Source::daemon("nowhere".to_owned(), true));
    let corners = [[-REACH; 3], [REACH; 3]];
    viewer.show_bounds(Bounds::of(&corners).context("the box is empty")?);
    for command in LOOK {
        viewer.apply(command.parse()?);
    }
    // Whatever is made once is made before.
    offscreen.frame(&mut viewer)?;
    let empty = resident();

    let taken = fill(&mut viewer, paths, usize::from(args.vertices));
    let first = taken + offscreen.frame(&mut viewer)?.wall;
    let mut whole = first;
    while offscreen.is_refining() {
        whole += offscreen.frame(&mut viewer)?.wall;
    }
    let mut turned = || {
        viewer.apply("camera orbit 1 0".parse::<Command>()?);
        offscreen.frame(&mut viewer)
    };
    let moving = (0..FRAMES).map(|_| turned()).collect::<anyhow::Result<Vec<_>>>()?;
    let mut refined = moving.last().map_or(Duration::ZERO, |cost| cost.wall);
    while offscreen.is_refining() {
        refined += offscreen.frame(&mut viewer)?.wall;
    }
    // The interface comes to rest.
    offscreen.rest(&mut viewer, REST)?;
    let before = ProcessTime::now();
    let rest_frames = offscreen.rest(&mut viewer, REST)?;
    let rest = before.elapsed().div_f64(REST.as_secs_f64());
    let memory = resident();
    let picks = (0..FRAMES).map(|i| picked(&mut viewer, i)).collect::<anyhow::Result<Vec<_>>>()?;
    Ok(Figures {
        paths,
        first,
        whole,
        moving: median(moving.iter().map(|cost| cost.wall)),
        moving_cpu: median(moving.iter().map(|cost| cost.cpu)),
        refined,
        rest,
        rest_frames,
        pick: median(picks.into_iter()),
        empty,
        memory,
    })
}

/// How long click number `i` takes, each at another place.
fn picked(viewer: &mut Viewer, i: usize) -> anyhow::Result<Duration> {
    let at = 0.05 * i as f32 - 0.15;
    let command: Command = format!("path pick {at} {} 0.008", 0.5 * at).parse()?;
    let started = Instant::now();
    viewer.apply(command);
    Ok(started.elapsed())
}

/// Resident memory of the process in bytes; 0 where the system does not tell.
fn resident() -> usize {
    memory_stats::memory_stats().map_or(0, |stats| stats.physical_mem)
}

fn median(times: impl Iterator<Item = Duration>) -> Duration {
    let mut times: Vec<_> = times.collect();
    times.sort_unstable();
    times.get(times.len() / 2).copied().unwrap_or_default()
}

/// Hands `paths` random paths to the viewer, and answers how long it took to take them in.
fn fill(viewer: &mut Viewer, paths: u32, vertices: usize) -> Duration {
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(1);
    let mut taken = Duration::ZERO;
    for first in (0..paths).step_by(BATCH as usize) {
        let Some(batch) = random_batch(&mut rng, first..paths.min(first + BATCH), vertices) else {
            continue;
        };
        let started = Instant::now();
        if let Some(inbox) = viewer.inbox() {
            inbox.put(TracerEvent::Paths(Arc::new(batch)));
        }
        viewer.receive();
        taken += started.elapsed();
    }
    taken
}

fn random_batch(
    rng: &mut Xoshiro256PlusPlus,
    steps: std::ops::Range<u32>,
    vertices: usize,
) -> Option<PathBatch> {
    let mut unit = || (rng.next_u32() >> 8) as f32 / (1 << 24) as f32;
    let mut builder = BatchBuilder::new(BatchLimits { bytes: usize::MAX });
    for step in steps {
        let path: Vec<_> = (0..vertices)
            .map(|i| VertexRecord {
                position: std::array::from_fn(|_| REACH * (2.0 * unit() - 1.0)),
                normal: [0, 0],
                kind: match i {
                    0 => VertexKind::Light,
                    i if i + 1 == vertices => VertexKind::Eye,
                    _ => VertexKind::Diffuse,
                },
                event: Event::Diffuse,
                material: 0,
                primitive: 0,
            })
            .collect();
        let id = PathId { chain: ChainId(step % 128), epoch: 0, step: u64::from(step) };
        let header = PathHeader {
            id,
            strategy: StrategyId((step % 6) as u8),
            luminance: (6.0 * unit()).exp2(),
            rgb: [unit(), unit(), unit()],
            ..PathHeader::default()
        };
        // The batch has no limit, so none is complete before its time.
        drop(builder.push(&header, &path, None));
    }
    builder.finish()
}
