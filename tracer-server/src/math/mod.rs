//! Random numbers, bases, warps and sums. Knows nothing of light.

mod frame;
mod rng;
mod sum;
mod warp;

pub use frame::Frame;
pub use rng::{Rng, Stream};
pub use sum::Accumulator;
pub use warp::{cosine_hemisphere, log_uniform, uniform_sphere, uniform_triangle};
