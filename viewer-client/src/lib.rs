//! The viewer: draws the scene, its light paths and the picture they make.
//!
//! Data comes in through [`source`], is drawn by [`draw`] and [`panel`], and everything the user does
//! is a [`command`]. From the ground up: [`value`], [`command`], [`settings`], [`camera`],
//! [`imaging`], [`source`], [`draw`], [`world`], [`keys`], [`panel`], [`app`].

pub mod app;
pub mod camera;
pub mod command;
pub mod draw;
pub mod imaging;
pub mod keys;
pub mod panel;
pub mod settings;
pub mod source;
#[cfg(test)]
mod synthetic;
pub mod value;
pub mod world;
