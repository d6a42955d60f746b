//! What paths may ask of the world.

mod description;

pub use description::{BsdfDescription, Material, Mesh, SceneDescription, Sphere};
