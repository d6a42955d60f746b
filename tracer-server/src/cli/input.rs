//! What several subcommands read.

use clap::Args;

use crate::scene::load::load;
use crate::scene::{Scene, StrategySetting};

/// Largest side of a film that may be asked for, in pixels.
const MAX_SIDE: i64 = 16_384;

/// Another size of the film than the scene says.
#[derive(Args, Clone, Copy, Debug)]
pub struct FilmSize {
    /// Width of the film in pixels [default: the scene's own].
    #[arg(long, requires = "height", value_name = "PIXELS")]
    #[arg(value_parser = clap::value_parser!(u32).range(1..=MAX_SIDE))]
    pub width: Option<u32>,
    /// Height of the film in pixels [default: the scene's own].
    #[arg(long, requires = "width", value_name = "PIXELS")]
    #[arg(value_parser = clap::value_parser!(u32).range(1..=MAX_SIDE))]
    pub height: Option<u32>,
}

/// Loads what the user named, and logs what is not supported; also returns what its file asks of
/// the mutation strategies.
pub(super) fn scene(spec: &str, size: FilmSize) -> anyhow::Result<(Scene, Vec<StrategySetting>)> {
    scene_with_depth(spec, size, None)
}

/// As [`scene`], with another limit on the length of paths than the scene says.
pub(super) fn scene_with_depth(
    spec: &str,
    size: FilmSize,
    max_edges: Option<usize>,
) -> anyhow::Result<(Scene, Vec<StrategySetting>)> {
    let mut loaded = load(spec)?;
    for warning in &loaded.warnings {
        tracing::warn!("{warning}");
    }
    if let (Some(width), Some(height)) = (size.width, size.height) {
        (loaded.description.width, loaded.description.height) = (width, height);
    }
    if let Some(max_edges) = max_edges {
        loaded.description.max_edges = max_edges;
    }
    let scene = Scene::new(&loaded.description)?;
    for warning in scene.warnings() {
        tracing::warn!("{warning}");
    }
    Ok((scene, loaded.strategies))
}
