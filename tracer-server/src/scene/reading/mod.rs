//! What all readers of scene files share: files and the places in them, images, simple shapes, and
//! what a reader hands on.

pub(crate) mod diagnostic;
pub(crate) mod image;
pub(crate) mod origin;
pub(crate) mod shape;
pub(crate) mod text;
pub(crate) mod viewpoint;

use crate::scene::description::SceneDescription;
use diagnostic::{Place, Warning};
use origin::Origins;

/// Longest path where a scene does not say, in edges.
pub(crate) const DEFAULT_MAX_EDGES: usize = 12;

/// A scene file's content, before it is validated.
#[derive(Debug)]
pub(crate) struct Read {
    /// The scene.
    pub(crate) description: SceneDescription,
    /// Where its parts were written.
    pub(crate) origins: Origins,
    /// What of it is not supported.
    pub(crate) warnings: Vec<Warning>,
    /// What it asks of the mutation strategies.
    pub(crate) strategies: Vec<StrategySetting>,
}

/// One setting of a strategy in a scene file.
#[derive(Clone, Debug, PartialEq)]
pub struct StrategySetting {
    /// Where it stands.
    pub place: Place,
    /// Name of the strategy.
    pub strategy: String,
    /// The setting.
    pub wish: Wish,
}

/// What a scene file sets of a strategy.
#[derive(Clone, Debug, PartialEq)]
pub enum Wish {
    /// A weight; zero switches the strategy off.
    Weight(f64),
    /// One number, or a smallest and a largest size, for a parameter.
    Parameter(String, Vec<f64>),
}
