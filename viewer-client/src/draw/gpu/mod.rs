//! Drawing the scene and its paths with wgpu.
//!
//! A [`Renderer`] lives among egui's callback resources. It takes plain vertices and a [`Picture`];
//! it knows neither the store nor the settings they come from. The picture is drawn into textures of
//! its own, only when it changed, and copied into the window with every frame of the interface.

mod blend;
mod composite;
mod cover;
mod kit;
mod lines;
mod mesh;
mod pages;
mod pipeline;
mod progress;
mod read;
mod renderer;
mod software;
mod target;
mod textures;

pub use pages::{PageRange, Uploaded};
pub use progress::{Crossing, Picture};
pub use read::read_back;
pub use renderer::{Quality, Renderer, ViewportCallback};
