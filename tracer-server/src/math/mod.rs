//! Random numbers, bases, warps and sums. Knows nothing of light.

mod frame;
mod rng;
mod sobol;
mod sum;
mod torus;
mod warp;

pub use frame::Frame;
pub use rng::{Rng, Stream};
pub use sobol::{MOST_POINTS, Strata};
pub use sum::Accumulator;
pub use torus::TorusStep;
pub use warp::{
    below_one, cosine_hemisphere, invert_cosine_hemisphere, invert_uniform_sphere,
    invert_uniform_triangle, log_uniform, pick, power_of_half, turn, uniform_sphere,
    uniform_triangle,
};
