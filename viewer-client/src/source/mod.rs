//! What is looked at: a daemon's session or a file of paths, and everything that came of it.

mod backlog;
pub mod connection;
pub mod dump;
pub mod embedded;
pub mod model;
pub mod playback;
pub mod selection;
pub mod status;
pub mod steering;
pub mod store;
pub mod units;

pub(crate) use backlog::Backlog;
