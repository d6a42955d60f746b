//! What both programs ask of the machine they run on: a [`log`] that never waits for its reader,
//! files that are never half written ([`mod@file`]), [`picture`]s as other programs write them, and the
//! [`signal`]s that end a program.
//!
//! Terminals close, disks fill up, readers of pipes go away. None of this may cost anyone the work
//! that is under way.

pub mod file;
pub mod log;
pub mod picture;
mod quiet;
pub mod signal;
mod terminal;
mod writer;

pub use quiet::Quiet;
pub use terminal::Screen;
pub use writer::Writer;
