//! Where random walks take their numbers from.

use crate::math::Rng;

/// What numbers are for: each purpose has rows of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Strand {
    /// The walk from the light. Row 0 is the point on the light, row 1 the direction of emission,
    /// row `j + 1` the scattering at vertex `j` of the walk.
    Light,
    /// The walk from the lens. Row 0 is the film point and, after it, the lens point; row `j` is the
    /// scattering at vertex `j` of the walk.
    Eye,
    /// Light sampling at vertices of the walk from the lens: row `j` is that at vertex `j`.
    Connection,
}

impl Strand {
    /// The row of the scattering at vertex `j` of a walk, whose first vertex, on the light or the
    /// lens, is number zero.
    #[inline]
    pub fn scattering_row(self, j: usize) -> usize {
        match self {
            Self::Light => j + 1,
            Self::Eye | Self::Connection => j,
        }
    }
}

/// Number of strands.
pub const STRANDS: usize = Strand::Connection as usize + 1;

/// Most numbers of one row: an event, a direction and Russian roulette, or film and lens point.
pub const ROW: usize = 4;

/// A source of uniform numbers in [0, 1).
///
/// Numbers are asked for by place, so that what happens at one vertex never changes the meaning of
/// the numbers of another.
pub trait Numbers {
    /// The first `N` numbers, at most [`ROW`], of a row; each row is asked for at most once in a
    /// sample.
    fn row<const N: usize>(&mut self, strand: Strand, row: usize) -> [f64; N];
}

/// Fresh numbers, whatever the place.
impl Numbers for Rng {
    #[inline]
    fn row<const N: usize>(&mut self, _: Strand, _: usize) -> [f64; N] {
        self.array()
    }
}
