//! What both programs ask of the machine they run on: a [`log`] that never waits for its reader,
//! files that are never half written ([`file`]), and the [`signal`]s that end them.
//!
//! Terminals close, disks fill up, readers of pipes go away. None of this may cost anyone the work
//! that is under way.

pub mod file;
pub mod log;
pub mod signal;
mod terminal;
mod writer;

pub use terminal::Screen;
pub use writer::Writer;
