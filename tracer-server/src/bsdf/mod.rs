//! How light scatters at a point of a surface. Local: knows no scene and no path.
//!
//! To add a model: write its file with an `impl Scatter`, add a variant to [`Bsdf`] and one arm to
//! `model!`; the laws in `laws.rs` then hold it to account.

mod conductor;
mod dielectric;
mod fresnel;
mod ggx;
mod lambert;
mod local;
mod mirror;
mod plastic;
mod rough_dielectric;
mod rough_plastic;

#[cfg(test)]
mod laws;

use common::{Event, Rgb};
use glam::DVec3;

use crate::math::Rng;
pub use conductor::RoughConductor;
pub use dielectric::Dielectric;
pub use fresnel::Fresnel;
pub use ggx::{Ggx, SMOOTH};
pub use lambert::Lambert;
pub use local::Local;
pub use mirror::Mirror;
pub use plastic::{Plastic, deepened};
pub use rough_dielectric::RoughDielectric;
pub use rough_plastic::RoughPlastic;

/// Everything a path needs of one scattering vertex, given both neighbours and the event.
///
/// One colour and a few scalars: the vertex's contribution to the path is `color` times a scalar
/// that depends only on how the vertex was made. With `f` the scattering function and `w_l`, `w_e`
/// the directions to the neighbours on the light and on the eye side:
///
/// - `color * connection = f(w_l, w_e)` (zero for a Dirac event; [`Local`] adds a factor),
/// - `color * light_weight = f |cos w_e| / light_pdf`: made by a walk from the light,
/// - `color * eye_weight = f |cos w_l| / eye_pdf`: made by a walk from the eye.
///
/// For a Dirac event the pdfs are the event's probability and the quotients are taken with the
/// Dirac delta cancelled; only the eye side carries the squared ratio of refractive indices.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scattering {
    /// Reflectance or transmittance.
    pub color: Rgb,
    /// Scalar for an explicit connection, in 1/sr.
    pub connection: f64,
    /// Scalar for a walk from the light.
    pub light_weight: f64,
    /// Scalar for a walk from the eye.
    pub eye_weight: f64,
    /// Density of `w_e` given `w_l`: per solid angle, or a probability for a Dirac event.
    pub light_pdf: f64,
    /// Density of `w_l` given `w_e`: per solid angle, or a probability for a Dirac event.
    pub eye_pdf: f64,
}

/// What a scattering model must provide. All directions are unit vectors that point away from the
/// surface; `n` is the unit normal on the front side.
pub trait Scatter {
    /// Makes of uniform numbers an event (of the first) and the direction the walk goes on (of the
    /// other two), given the direction `w` it came from. `None` when the walk is absorbed.
    fn sample(&self, n: DVec3, w: DVec3, u: [f64; 3]) -> Option<(DVec3, Event)>;

    /// Numbers from which [`Scatter::sample`] would have made `w_out` and `event`.
    ///
    /// Where many numbers would have, as for a discrete choice, `rng` draws one of them uniformly:
    /// numbers that were uniform before they made a sample are uniform again.
    fn invert(&self, n: DVec3, w: DVec3, w_out: DVec3, event: Event, rng: &mut Rng) -> [f64; 3];

    /// All values of the vertex; `None` where they are zero.
    fn evaluate(&self, n: DVec3, w_l: DVec3, w_e: DVec3, event: Event) -> Option<Scattering>;

    /// The only direction in which the Dirac `event` continues from `w`; `None` when it cannot
    /// happen there (total internal reflection, or no such lobe).
    fn follow(&self, n: DVec3, w: DVec3, event: Event) -> Option<DVec3>;

    /// The event with which a vertex can be joined to any other by an explicit connection.
    fn connectable(&self) -> Option<Event>;

    /// About how much of the light is scattered, at most 1: for Russian roulette.
    fn albedo(&self) -> f64;
}

/// A scattering model with its parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Bsdf {
    /// Ideal diffuse.
    Lambert(Lambert),
    /// Ideal mirror.
    Mirror(Mirror),
    /// Smooth boundary of transparent media.
    Dielectric(Dielectric),
    /// Rough metal.
    RoughConductor(RoughConductor),
    /// Rough boundary of transparent media.
    RoughDielectric(RoughDielectric),
    /// Diffuse under a smooth coat.
    Plastic(Plastic),
    /// Diffuse under a rough coat.
    RoughPlastic(RoughPlastic),
}

impl Bsdf {
    /// True when some of its events are Dirac ones.
    pub fn has_dirac_lobe(&self) -> bool {
        matches!(self, Self::Mirror(_) | Self::Dielectric(_) | Self::Plastic(_))
    }

    /// The model with another colour of its diffuse part, or with other facets: what a texture
    /// tells at a point.
    #[must_use]
    pub fn painted(&self, color: Option<Rgb>, facets: Option<Ggx>) -> Self {
        let mut painted = *self;
        match (&mut painted, color, facets) {
            (Self::Lambert(m), Some(color), _) => m.reflectance = color,
            (Self::Plastic(m), Some(color), _) => m.diffuse = color,
            (Self::RoughPlastic(m), Some(color), _) => m.diffuse = color,
            (Self::RoughConductor(m), _, Some(facets)) => m.facets = facets,
            (Self::RoughDielectric(m), _, Some(facets)) => m.facets = facets,
            _ => {}
        }
        painted
    }

    /// A word or two for tables.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Lambert(_) => "lambert",
            Self::Mirror(_) => "mirror",
            Self::Dielectric(_) => "dielectric",
            Self::RoughConductor(_) => "rough conductor",
            Self::RoughDielectric(_) => "rough dielectric",
            Self::Plastic(_) => "plastic",
            Self::RoughPlastic(_) => "rough plastic",
        }
    }

    /// The colour by which people would know it.
    pub fn preview_color(&self) -> Rgb {
        match self {
            Self::Lambert(m) => m.reflectance,
            Self::Mirror(m) => m.fresnel.at(1.0),
            Self::Dielectric(m) => m.transmittance,
            Self::RoughConductor(m) => m.fresnel.at(1.0),
            Self::RoughDielectric(m) => m.facet.transmittance,
            Self::Plastic(m) => m.diffuse,
            Self::RoughPlastic(m) => m.diffuse,
        }
    }

    /// True when light passes through it.
    pub fn is_transparent(&self) -> bool {
        matches!(self, Self::Dielectric(_) | Self::RoughDielectric(_))
    }
}

/// Calls a method of the model behind the variant: the only match on [`Bsdf`].
macro_rules! model {
    ($bsdf:expr, $model:ident => $call:expr) => {
        match $bsdf {
            Bsdf::Lambert($model) => $call,
            Bsdf::Mirror($model) => $call,
            Bsdf::Dielectric($model) => $call,
            Bsdf::RoughConductor($model) => $call,
            Bsdf::RoughDielectric($model) => $call,
            Bsdf::Plastic($model) => $call,
            Bsdf::RoughPlastic($model) => $call,
        }
    };
}

impl Scatter for Bsdf {
    #[inline]
    fn sample(&self, n: DVec3, w: DVec3, u: [f64; 3]) -> Option<(DVec3, Event)> {
        model!(self, m => m.sample(n, w, u))
    }

    fn invert(&self, n: DVec3, w: DVec3, w_out: DVec3, event: Event, rng: &mut Rng) -> [f64; 3] {
        model!(self, m => m.invert(n, w, w_out, event, rng))
    }

    #[inline]
    fn evaluate(&self, n: DVec3, w_l: DVec3, w_e: DVec3, event: Event) -> Option<Scattering> {
        model!(self, m => m.evaluate(n, w_l, w_e, event))
    }

    #[inline]
    fn follow(&self, n: DVec3, w: DVec3, event: Event) -> Option<DVec3> {
        model!(self, m => m.follow(n, w, event))
    }

    #[inline]
    fn connectable(&self) -> Option<Event> {
        model!(self, m => m.connectable())
    }

    #[inline]
    fn albedo(&self) -> f64 {
        model!(self, m => m.albedo())
    }
}

/// Mirror image of `w` in the plane with normal `n`.
#[inline]
pub(crate) fn reflect(n: DVec3, w: DVec3) -> DVec3 {
    2.0 * n.dot(w) * n - w
}
