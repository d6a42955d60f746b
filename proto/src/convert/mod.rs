//! Conversions between wire types and the vocabulary: total one way, checked the other.
//!
//! Everything that comes from a peer is hostile until checked here: sizes before anything is
//! allocated for them, counts, finite numbers, the length of texts.

mod camera;
mod check;
mod column;
mod detail;
mod diagnostics;
mod error;
mod film;
mod filter;
mod focus;
mod path;
mod role;
mod scene;
mod session;
mod statistics;
mod steering;

#[cfg(test)]
mod steering_tests;
#[cfg(test)]
mod tests;

pub use error::WireError;
pub use filter::WantedFilter;
pub use scene::{ReceivedScene, SceneAssembler, scene_chunks, unchanged_scene};
pub use session::{Hello, ViewerEvent};
pub use steering::NumberedOrder;

/// No message of the protocol is larger: what a receiver should set its decoding limit to.
pub const MAX_MESSAGE_BYTES: usize = 4 << 20;
