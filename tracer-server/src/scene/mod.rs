//! What paths may ask of the world: surfaces, materials, lights and the camera.
//!
//! A scene file is read by one of `toml`, `obj` and `mitsuba`, which share what is in `reading`;
//! each ends in a `description`, which is checked and becomes the `world` that is traced.

pub mod builtin;
mod description;
#[cfg(test)]
mod examples;
#[cfg(test)]
pub(crate) mod fixtures;
pub mod load;
#[cfg(test)]
mod malformed;
mod mitsuba;
mod obj;
mod reading;
mod toml;
mod world;

pub use description::{
    Coding, LightDescription, LightKind, MAX_EDGES, Material, Mesh, SceneDescription, SkyImage,
    Sphere, Texels, Texture, ThinLens,
};
pub use reading::{StrategySetting, Wish};
pub use world::{
    Anchor, Emission, Hit, LampInfo, LightSample, NO_PRIMITIVE, RayCounts, Scene, SceneError,
    SceneFeatures, Tracer,
};
