//! The scattering at one point: a model in the frame that the point's shading normal gives it.

use std::borrow::Cow;

use common::Event;
use glam::DVec3;

use super::{Bsdf, Scattering};
use crate::math::Rng;

/// A scattering model at a point of a surface.
///
/// Models know one normal. Where the shading normal is another than the geometric one, the cosines
/// of a walk from the light and those of a walk from the eye are no longer the same, and the
/// scattering function is not symmetric [Veach 1997, section 5.3]. With the geometric normal
/// `n_g` and the shading normal `n_s`:
///
/// - a walk from the eye carries `f |n_s . w_l|`, as the models have it,
/// - a walk from the light carries `f |n_g . w_e|` onwards, and has brought the factor
///   `|n_s . w_l| / |n_g . w_l|` when it arrived,
/// - that factor of arrival belongs to a connection, too: the geometry of an edge has only
///   geometric cosines, while its eye end is lit by `|n_s . w|`. At the light end it stands for
///   the arrival of the edge before.
///
/// A direction that lies above the one normal and below the other carries nothing.
#[derive(Clone, Debug)]
pub struct Local<'a> {
    bsdf: Cow<'a, Bsdf>,
    normal: DVec3,
    shading: DVec3,
    /// Neither one-sided nor with another shading normal: the model alone says everything.
    plain: bool,
    one_sided: bool,
}

impl<'a> Local<'a> {
    /// A two-sided model on a surface that is as flat as it is shaded.
    #[inline]
    pub fn flat(bsdf: Cow<'a, Bsdf>, normal: DVec3) -> Self {
        Self { bsdf, normal, shading: normal, plain: true, one_sided: false }
    }

    /// With the unit normal that it is shaded by, on the side of the geometric one.
    #[must_use]
    pub fn shaded(self, shading: DVec3) -> Self {
        Self { shading, plain: false, ..self }
    }

    /// Black on its back.
    #[must_use]
    pub fn one_sided(self) -> Self {
        Self { one_sided: true, plain: false, ..self }
    }

    /// The model.
    #[inline]
    pub fn bsdf(&self) -> &Bsdf {
        &self.bsdf
    }

    /// The unit normal that it is shaded by.
    pub fn shading(&self) -> DVec3 {
        self.shading
    }

    /// True when the direction sees the same side by both normals, and a side that is not black.
    fn sees(&self, w: DVec3) -> bool {
        let cosine = self.normal.dot(w);
        cosine * self.shading.dot(w) > 0.0 && !(self.one_sided && cosine < 0.0)
    }

    /// As [`super::Scatter::sample`].
    #[inline]
    pub fn sample(&self, w: DVec3, u: [f64; 3]) -> Option<(DVec3, Event)> {
        let drawn = self.bsdf.sample(self.shading, w, u);
        if self.plain {
            return drawn;
        }
        drawn.filter(|(onward, _)| self.sees(w) && self.sees(*onward))
    }

    /// As [`super::Scatter::invert`].
    pub fn invert(&self, w: DVec3, w_out: DVec3, event: Event, rng: &mut Rng) -> [f64; 3] {
        self.bsdf.invert(self.shading, w, w_out, event, rng)
    }

    /// As [`super::Scatter::evaluate`], with the factors of the shading normal.
    #[inline]
    pub fn evaluate(&self, w_l: DVec3, w_e: DVec3, event: Event) -> Option<Scattering> {
        let scattering = self.bsdf.evaluate(self.shading, w_l, w_e, event);
        if self.plain {
            return scattering;
        }
        if !(self.sees(w_l) && self.sees(w_e)) {
            return None;
        }
        // Not clamped: at grazing incidence it is large, and must be.
        let arrival = self.shading.dot(w_l) / self.normal.dot(w_l);
        let departure = self.normal.dot(w_e) / self.shading.dot(w_e);
        scattering.map(|s| Scattering {
            connection: s.connection * arrival,
            light_weight: s.light_weight * arrival * departure,
            ..s
        })
    }

    /// As [`super::Scatter::specular_direction`].
    #[inline]
    pub fn specular_direction(&self, w: DVec3, event: Event) -> Option<DVec3> {
        let onward = self.bsdf.specular_direction(self.shading, w, event);
        if self.plain {
            return onward;
        }
        onward.filter(|onward| self.sees(w) && self.sees(*onward))
    }
}

#[cfg(test)]
mod tests {
    use common::Rgb;

    use super::*;
    use crate::bsdf::Lambert;

    #[test]
    fn a_one_sided_surface_is_black_behind() {
        let paint = Bsdf::Lambert(Lambert { reflectance: Rgb::grey(0.5) });
        let front = DVec3::new(0.6, 0.0, 0.8);
        let numbers = [0.3, 0.6, 0.9];
        for side in [1.0, -1.0] {
            let both = Local::flat(Cow::Borrowed(&paint), DVec3::Z);
            let (w, onward) = (side * front, side * DVec3::Z);
            let lit = |local: &Local<'_>| {
                let drawn = local.sample(w, numbers).is_some();
                let seen = local.evaluate(w, onward, Event::Diffuse).is_some();
                assert_eq!(drawn, seen, "sampling and evaluation agree");
                seen
            };
            assert!(lit(&both), "two-sided");
            assert_eq!(lit(&both.one_sided()), side > 0.0, "one-sided");
        }
    }

    #[test]
    fn what_the_two_normals_see_differently_is_black() {
        let paint = Bsdf::Lambert(Lambert { reflectance: Rgb::WHITE });
        let shading = DVec3::new(0.6, 0.0, 0.8);
        let local = Local::flat(Cow::Borrowed(&paint), DVec3::Z).shaded(shading);
        // Above the surface, but below the plane that it is shaded by.
        let hidden = DVec3::new(-0.9, 0.0, 0.1).normalize();
        assert!(local.evaluate(hidden, DVec3::Z, Event::Diffuse).is_none(), "from the light");
        assert!(local.evaluate(DVec3::Z, hidden, Event::Diffuse).is_none(), "to the eye");
        let s = local.evaluate(DVec3::Z, shading, Event::Diffuse).expect("both see it");
        let arrival = 0.8 / 1.0;
        let departure = 0.8 / 1.0;
        assert!((s.light_weight - arrival * departure).abs() < 1e-12, "{s:?}");
        assert!((s.eye_weight - 1.0).abs() < 1e-12, "{s:?}");
    }
}
