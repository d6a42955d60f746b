//! The scene as vertices: its surfaces, the model of the render camera, the grid.

mod aids;
mod surfaces;

pub use aids::drawing_aids;
pub use surfaces::corners;

use common::SceneMesh;

use crate::value::Bounds;

/// A scene that has arrived.
#[derive(Clone, Debug)]
pub struct Model {
    /// Its surfaces.
    pub mesh: SceneMesh,
    /// The box round them.
    pub bounds: Bounds,
}

impl Model {
    /// A scene with at least one point, or `None`.
    pub fn new(mesh: SceneMesh) -> Option<Self> {
        let bounds = Bounds::of(&mesh.positions)?;
        Some(Self { mesh, bounds })
    }
}
