//! How many mutations a second each strategy makes, and what share that is of what the rays alone
//! would allow: `cargo bench -p tracer-server`.
//!
//! One thread, CPU time. The limit is measured in the same run: rays like those of the scene's own
//! paths, cast with nothing else around them. Scenes can be named: `-- door scenes/room.toml`.

use std::hint::black_box;
use std::io::{self, Write as _};
use std::path::Path;
use std::time::Duration;

use comfy_table::Table;
use comfy_table::presets::UTF8_FULL_CONDENSED;
use cpu_time::ProcessTime;
use tracer_server::chain::{Ensemble, EnsembleSettings};
use tracer_server::math::{Rng, Stream};
use tracer_server::mutation::{KINDS, OptionError, StrategyOptions};
use tracer_server::path::{BidirectionalSampler, CameraSample, Vertex};
use tracer_server::scene::load::load;
use tracer_server::scene::{Scene, Tracer};

/// Each figure is the best of this many rounds.
const ROUNDS: usize = 5;
/// Steps of a chain in a round.
const STEPS: u64 = 4000;

fn main() -> anyhow::Result<()> {
    let named: Vec<String> = std::env::args().skip(1).filter(|a| !a.starts_with('-')).collect();
    let scenes = if named.is_empty() { usual_scenes() } else { named };
    let mut table = Table::new();
    table.load_style(UTF8_FULL_CONDENSED).set_header([
        "scene",
        "strategies",
        "mutations per CPU second",
        "rays, shadow rays",
        "rays alone",
        "share",
    ]);
    for name in &scenes {
        let scene = Scene::new(&load(name)?.description)?;
        let limits = ray_rates(&scene);
        for (strategies, options) in mixtures()? {
            table.add_row(measure(&scene, strategies, &options, limits));
        }
    }
    writeln!(io::stdout().lock(), "{}", table.trim_fmt())?;
    Ok(())
}

/// Built-in scenes, and others' where they are at hand: in the folder that the variable
/// `LVIS_SHARED` names.
fn usual_scenes() -> Vec<String> {
    let mut scenes = ["cornell", "caustic", "mirror-caustic", "door"].map(str::to_owned).to_vec();
    let usual = || Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared").into_os_string();
    let shared = std::env::var_os("LVIS_SHARED").unwrap_or_else(usual);
    for scene in [
        "peer-cornell/cornell_mlt.xml",
        "peer-caustic/caustic_mlt.xml",
        "veach-ajar",
        "veach-bidir",
    ] {
        let file = Path::new(&shared).join("scenes").join(scene);
        if file.exists() {
            scenes.push(file.display().to_string());
        }
    }
    scenes
}

/// The mixture as it is used, and each strategy nearly alone: the independent mutation stays in at
/// one per cent, so that no chain is confined to where it starts.
fn mixtures() -> Result<Vec<(&'static str, StrategyOptions)>, OptionError> {
    let mut mixtures = vec![("all", StrategyOptions::default())];
    for kind in KINDS {
        let mut alone = StrategyOptions::default();
        let list = [("independent".to_owned(), Some(0.01)), (kind.key(), Some(0.99))];
        alone.restrict(&list)?;
        mixtures.push((kind.name, alone));
    }
    Ok(mixtures)
}

fn measure(
    scene: &Scene,
    strategies: &str,
    options: &StrategyOptions,
    alone: RayRates,
) -> Vec<String> {
    let settings = EnsembleSettings {
        seed: 1,
        chains: 16,
        threads: 1,
        strategies: *options,
        bootstrap_samples: 1 << 16,
    };
    let mut ensemble = Ensemble::new(scene, &settings, |_| ());
    ensemble.advance(scene, STEPS, None);
    let before = ensemble.statistics();
    let best = best_time(|| drop(ensemble.advance(scene, STEPS, None)));
    let after = ensemble.statistics();
    let per_step = |a: u64, b: u64| (a - b) as f64 / (after.steps - before.steps) as f64;
    let rays = per_step(after.rays, before.rays);
    let shadows = per_step(after.shadow_rays, before.shadow_rays);
    let rate = (STEPS * u64::from(settings.chains)) as f64 / best.as_secs_f64();
    let limit = 1.0 / (rays / alone.closest + shadows / alone.shadow);
    vec![
        scene.name().to_owned(),
        strategies.to_owned(),
        format!("{:.2} M", rate / 1e6),
        format!("{rays:.2}, {shadows:.2}"),
        format!("{:.2} M", limit / 1e6),
        format!("{:.0} %", 100.0 * rate / limit),
    ]
}

/// Rays a second.
#[derive(Clone, Copy, Debug)]
struct RayRates {
    closest: f64,
    shadow: f64,
}

/// How fast rays alone are along the edges of the scene's own paths.
fn ray_rates(scene: &Scene) -> RayRates {
    let tracer = Tracer::new(scene);
    let mut sampler = BidirectionalSampler::new(&tracer);
    let mut rng = Rng::new(1, Stream::Laboratory, 0);
    let mut edges: Vec<(Vertex, Vertex)> = Vec::new();
    while edges.len() < 200_000 {
        let aim = CameraSample::from_numbers(&tracer, &mut rng);
        sampler.sample(&tracer, aim, &mut rng, |path, _| {
            // One edge of each path, so that successive rays have nothing in common.
            let j = rng_free_index(path.edge_count(), edges.len());
            edges.push((path.vertices()[j + 1], path.vertices()[j]));
        });
    }
    let count = edges.len() as f64;
    let closest = best_time(|| {
        for (from, to) in &edges {
            let direction = (to.position - from.position).normalize_or_zero();
            black_box(scene.closest(&from.anchor(), direction));
        }
    });
    let shadow = best_time(|| {
        for (from, to) in &edges {
            black_box(scene.visible(&from.anchor(), &to.anchor()));
        }
    });
    RayRates { closest: count / closest.as_secs_f64(), shadow: count / shadow.as_secs_f64() }
}

/// Spreads indices below `n` without drawing random numbers.
fn rng_free_index(n: usize, counter: usize) -> usize {
    counter.wrapping_mul(0x9e37_79b9_7f4a_7c15) % n
}

fn best_time(mut work: impl FnMut()) -> Duration {
    let time = |work: &mut dyn FnMut()| {
        let start = ProcessTime::now();
        work();
        start.elapsed()
    };
    (0..ROUNDS).map(|_| time(&mut work)).min().unwrap_or_default()
}
