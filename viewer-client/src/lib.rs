//! The viewer: draws the scene, its light paths and the picture they make.
//!
//! Data comes in through [`connection`], is kept in [`store`] and [`film`], and is drawn by [`gpu`]
//! and [`panel`]. Everything the user does is a [`command`].

pub mod app;
mod backlog;
pub mod bench;
pub mod camera;
pub mod cli;
pub mod command;
pub mod value;
pub mod connection;
pub mod darkroom;
pub mod desk;
pub mod dump;
pub mod embedded;
pub mod errand;
pub mod film;
pub mod format;
pub mod gpu;
pub mod habits;
pub mod headless;
pub mod history;
pub mod imaging;
pub mod keys;
pub mod model;
pub mod pace;
pub mod panel;
pub mod pick;
pub mod playback;
pub mod raster;
pub mod rates;
pub mod region;
pub mod run;
pub mod script;
pub mod selection;
pub mod settings;
pub mod share;
pub mod status;
pub mod steering;
pub mod store;
#[cfg(test)]
mod synthetic;
pub mod theme;
pub mod tree;
pub mod trends;
pub mod units;
pub mod watch;
pub mod window;
pub mod world;
