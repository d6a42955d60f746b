//! What a base sampler leaves over: `h = rho = g`, with `g = 1 / (1 + (tau S_B)^2)`.
//!
//! A base sampler draws the splits B. It makes the path `x` with the weight `v = 1 / S_B(x)`, where
//! `S_B` is the sum of `1 / lum C_i` over B: small where it finds the path often, large where the path
//! is rare and bright to it.
//!
//! Proof: base samples carry `(1 - g) v`, so that their mean is `integral f (1 - g)`: the sum over the
//! splits in B of `p_i v (1 - g) = f (1 - g)` wherever `S_B > 0`, and `1 - g = 0` elsewhere. The chains
//! carry `f g`. The sum is `f`, whatever `tau` is and whatever splits B has.
//!
//! A light that is seen directly is the base sampler's whatever its brightness (as if `tau` were infinite
//! for such paths): every sample through a pixel sees it alike, so that it makes no noise.
//!
//! `tau` is a luminance, as `v` is. No other term of a base sample exceeds `tau / 2`, since
//! `v (1 - g) = v tau^2 / (v^2 + tau^2)` is largest at `v = tau`: what would be a bright dot is left to
//! the chains. At `tau = 0` the chains have all of the light; at infinity only what the base sampler
//! cannot find.

use super::{Importance, Weighing};
use crate::path::Path;

/// A base sampler, by the splits that it draws.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Base {
    /// Path tracing with light sampling: the walk from the lens hits a light, or is joined to a point
    /// on one.
    Path,
    /// All splits of two walks.
    Bidirectional,
}

impl Base {
    /// Both, in the order of tables.
    pub const ALL: [Self; 2] = [Self::Path, Self::Bidirectional];

    /// Its name in tables and options.
    pub fn name(self) -> &'static str {
        match self {
            Self::Path => "path",
            Self::Bidirectional => "bidirectional",
        }
    }

    /// `S_B(x)`: the sum of `1 / lum C_i` over the splits that the sampler draws; zero for a path that
    /// it cannot find.
    #[inline]
    pub fn density_sum(self, x: &Path) -> f64 {
        match self {
            // A light that is seen directly is hit, never joined to the lens.
            Self::Path => x.reciprocal_sum(0, 1.min(x.edge_count() - 1)),
            Self::Bidirectional => x.density_sum(),
        }
    }
}

/// What a base sampler leaves over.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Selective {
    /// The base sampler.
    pub base: Base,
    /// The dial, in film units of luminance, from 0 (all light for the chains) to infinity (only what the
    /// base sampler cannot find).
    pub tau: f64,
}

impl Selective {
    /// `g` of a path: the share of its light that is the chains'.
    #[inline]
    pub fn chains_share(self, x: &Path) -> f64 {
        let s = self.scaled(self.base.density_sum(x), x.edge_count());
        1.0 / (1.0 + s * s)
    }

    /// `1 - g` of a path of `edges` edges whose sum `S_B` is `density_sum`: the share of its light that
    /// is the base sampler's.
    #[inline]
    pub fn base_share(self, density_sum: f64, edges: usize) -> f64 {
        let s = self.scaled(density_sum, edges);
        1.0 / (1.0 + 1.0 / (s * s))
    }

    /// `tau S_B`: zero for what the base sampler cannot find, even where `tau` is infinite, and where it
    /// is zero; infinite for a light that is seen directly.
    #[inline]
    fn scaled(self, density_sum: f64, edges: usize) -> f64 {
        match (density_sum > 0.0 && self.tau > 0.0, edges) {
            (false, _) => 0.0,
            (true, 1) => f64::INFINITY,
            (true, _) => self.tau * density_sum,
        }
    }
}

impl Weighing for Selective {
    #[inline]
    fn importance(&self, x: &Path) -> Importance {
        let rho = self.chains_share(x);
        Importance { rho, share: if rho > 0.0 { 1.0 } else { 0.0 } }
    }
}
