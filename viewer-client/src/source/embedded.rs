//! The daemon inside this program, for whoever gave no address.

use std::net::{Ipv4Addr, SocketAddr};
use std::sync::Arc;
use std::thread;

use anyhow::Context as _;
use common::{SceneFrame, SceneMesh};
use tracer_server::chain::EnsembleSettings;
use tracer_server::cli::chains::of_scene;
use tracer_server::daemon::{Daemon, DaemonOptions};
use tracer_server::scene::Scene;
use tracer_server::scene::load::load;

/// The scene that is shown when none is named.
pub const DEFAULT_SCENE: &str = "cornell";

/// Worker threads: one core is left for drawing, or the mouse would lag behind the chains.
fn threads() -> usize {
    thread::available_parallelism().map_or(1, |cores| (cores.get() - 1).max(1))
}

/// The surfaces of a scene, and how their coordinates relate to those of its file.
pub fn surfaces(scene: &str) -> anyhow::Result<(SceneFrame, SceneMesh)> {
    let scene = Scene::new(&load(scene)?.description)?;
    Ok((scene.frame(), scene.preview_mesh()))
}

/// Starts a daemon on a free port of this machine. It stops when it is dropped.
pub fn start(scene: &str) -> anyhow::Result<Daemon> {
    let loaded = load(scene)?;
    for warning in &loaded.warnings {
        tracing::warn!("{warning}");
    }
    let scene = Scene::new(&loaded.description)?;
    for warning in scene.warnings() {
        tracing::warn!("{warning}");
    }
    let options = DaemonOptions {
        listen: SocketAddr::from((Ipv4Addr::LOCALHOST, 0)),
        ensemble: EnsembleSettings {
            strategies: of_scene(&loaded.strategies)?,
            threads: threads(),
            ..EnsembleSettings::default()
        },
        ..DaemonOptions::default()
    };
    Daemon::start(Arc::new(scene), &options).context("cannot start a daemon in this program")
}
