//! The microfacet distribution of Trowbridge and Reitz, known as GGX, with visible normals and
//! height-correlated masking [Walter et al. 2007; Heitz 2014].
//!
//! Directions are in the frame of the macroscopic surface, whose normal is +z. Everything is written
//! with `S(w) = sqrt(cos^2 + alpha^2 sin^2)`, so that nothing divides by a cosine:
//! `G1(w) = 2 cos / (cos + S)` and `G2(a, b) = 2 cos_a cos_b / (cos_a S_b + cos_b S_a)`.

use std::f64::consts::{FRAC_1_PI, TAU};

use glam::DVec3;

use crate::math::turn;

/// The distribution of one roughness, the same in all azimuths.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ggx {
    alpha: f64,
}

/// Surfaces of less roughness are smooth: their models become Dirac ones. Highlights are then
/// narrower than a tenth of a degree, and their density exceeds 3e5 per steradian.
pub(super) const SMOOTH: f64 = 1e-3;

impl Ggx {
    /// Of the roughness `alpha`, the slope of the microfacets' root mean square; brought into
    /// `SMOOTH`..1.
    pub fn new(alpha: f64) -> Self {
        Self { alpha: alpha.clamp(SMOOTH, 1.0) }
    }

    /// Density of microfacet normals `h` per projected solid angle: `D(h)`.
    #[inline]
    pub(super) fn density(self, h: DVec3) -> f64 {
        // From the sine, which is exact where the distribution is steep.
        let sin2 = h.x * h.x + h.y * h.y;
        let cos2 = h.z * h.z;
        let a2 = self.alpha * self.alpha;
        let spread = cos2 * a2 + sin2;
        a2 * FRAC_1_PI / (spread * spread)
    }

    /// `S(w)`.
    #[inline]
    pub(super) fn stretch(self, w: DVec3) -> f64 {
        let sin2 = w.x * w.x + w.y * w.y;
        (w.z * w.z + self.alpha * self.alpha * sin2).sqrt()
    }

    /// `G2(a, b) / (4 cos_a cos_b)`, for positive cosines.
    #[inline]
    pub(super) fn visibility(self, a: DVec3, b: DVec3) -> f64 {
        0.5 / (a.z * self.stretch(b) + b.z * self.stretch(a))
    }

    /// `G2(a, b) / G1(a)`: the share of the facets that `a` sees which `b` sees, too.
    #[inline]
    pub(super) fn shadowing(self, a: DVec3, b: DVec3) -> f64 {
        let stretch = self.stretch(a);
        b.z * (a.z + stretch) / (a.z * self.stretch(b) + b.z * stretch)
    }

    /// A facet normal that `w`, above the surface, sees [Heitz 2018; Dupuy and Benyoub 2023]:
    /// stretched to a hemisphere, the mirror images of `w` fill a spherical cap evenly.
    #[inline]
    pub(super) fn sample_visible(self, w: DVec3, u: f64, v: f64) -> DVec3 {
        let stretched = self.stretched(w);
        let z = (1.0 - u) * (1.0 + stretched.z) - stretched.z;
        let radius = ((1.0 - z) * (1.0 + z)).max(0.0).sqrt();
        let (sin, cos) = (TAU * v).sin_cos();
        let half = DVec3::new(radius * cos, radius * sin, z) + stretched;
        DVec3::new(self.alpha * half.x, self.alpha * half.y, half.z.max(0.0)).normalize()
    }

    /// The numbers with which [`Self::sample_visible`] gives `h`.
    #[inline]
    pub(super) fn invert_visible(self, w: DVec3, h: DVec3) -> (f64, f64) {
        let stretched = self.stretched(w);
        let half = DVec3::new(h.x / self.alpha, h.y / self.alpha, h.z).normalize();
        let along = stretched.dot(half);
        let cap = 2.0 * along * half - stretched;
        let u = 1.0 - (cap.z + stretched.z) / (1.0 + stretched.z);
        (u, turn(cap.y, cap.x))
    }

    /// `w` in the configuration in which the distribution is a hemisphere.
    #[inline]
    fn stretched(self, w: DVec3) -> DVec3 {
        DVec3::new(self.alpha * w.x, self.alpha * w.y, w.z).normalize()
    }
}
