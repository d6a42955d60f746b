//! The laboratory: the statistics with which Lvis is put to the test.
//!
//! A renderer is right when its random numbers have the right distribution, so most of its tests
//! are hypothesis tests. This library holds the few that are needed and makes them hard to misuse:
//! NaN never passes, a test without data never passes, and the chance of a false alarm is set for
//! a whole family of comparisons at once. What cannot be tested at all is skipped aloud.
//!
//! It knows nothing of light transport and depends on none of the other crates, so that each of
//! them can use it in its own tests.

mod accumulator;
mod chi_square;
mod image;
mod kolmogorov;
mod skip;
mod suite;
mod z_score;

pub use accumulator::Accumulator;
pub use chi_square::{ChiSquare, ChiSquareError, chi_square_test, pool_cells};
pub use image::{block_means, z_map};
pub use kolmogorov::{Kolmogorov, kolmogorov_test};
pub use skip::skip;
pub use suite::{Suite, Verdict};
pub use z_score::{ZScore, p_limit, welch_z, z_limit};

/// The chance of a false alarm that a whole suite of comparisons accepts.
///
/// Small enough that a thousand runs of everything never cry wolf, and still far from costing
/// power: the limit on |z| for 500 comparisons is only 6.0.
pub const FALSE_ALARM: f64 = 1e-6;
