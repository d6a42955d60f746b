//! The tracer: scenes, paths, mutations, chains, and the daemon that streams them.

// A new variant must be looked at wherever variants are told apart; tests may leave out what they do
// not mean.
#![cfg_attr(not(test), warn(clippy::wildcard_enum_match_arm))]

pub mod base;
pub mod bsdf;
pub mod chain;
pub mod cli;
pub mod daemon;
pub mod engine;
pub mod explorer;
pub mod film;
pub mod hub;
pub mod image_file;
pub mod integrator;
pub mod math;
pub mod mutation;
pub mod parallel;
pub mod path;
pub mod render;
pub mod replicate;
pub mod scene;
pub mod service;
pub mod steering;
pub mod target;
pub mod trade;
pub mod verify;

#[cfg(test)]
mod extremes;
