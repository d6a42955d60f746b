//! The tracer: scenes, paths, mutations, chains, and the daemon that streams them.

pub mod scene;
