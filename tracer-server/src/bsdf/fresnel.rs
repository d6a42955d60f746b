//! How much of the light a smooth boundary reflects.

use common::Rgb;

use super::model::{Range, Value};

/// Reflectance of a smooth boundary as a function of the angle of incidence.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Fresnel {
    /// The same at all angles.
    Constant(Rgb),
    /// Schlick's approximation, given the reflectance at normal incidence [Schlick 1994].
    Schlick(Rgb),
    /// A metal in air.
    Conductor {
        /// Index of refraction, one a channel.
        eta: Rgb,
        /// Extinction coefficient, one a channel.
        k: Rgb,
        /// What the reflectance is multiplied by, each channel in [0, 1].
        tint: Rgb,
    },
    /// A transparent medium, seen from outside.
    Dielectric {
        /// Index of refraction of the medium over that outside.
        eta: f64,
        /// What the reflectance is multiplied by, each channel in [0, 1].
        tint: Rgb,
    },
}

impl Fresnel {
    /// Reflectance of unpolarised light that arrives with the cosine `cos_i >= 0`.
    #[inline]
    pub fn at(&self, cos_i: f64) -> Rgb {
        match *self {
            Self::Constant(color) => color,
            Self::Schlick(normal) => {
                let grazing = (1.0 - cos_i).clamp(0.0, 1.0).powi(5);
                normal * (1.0 - grazing) + Rgb::grey(grazing)
            }
            Self::Conductor { eta, k, tint } => {
                let channel = |eta, k| conductor(cos_i, eta, k);
                Rgb::new(channel(eta.r, k.r), channel(eta.g, k.g), channel(eta.b, k.b)) * tint
            }
            Self::Dielectric { eta, tint } => tint * dielectric(cos_i, eta),
        }
    }

    /// Shows its numbers under the names that the project's own scene files have for them.
    pub(super) fn parameters(&mut self, see: &mut dyn FnMut(&'static str, Value<'_>)) {
        match self {
            Self::Constant(color) => see("reflectance", Value::Share(color)),
            Self::Schlick(normal) => see("specular", Value::Share(normal)),
            Self::Conductor { eta, k, tint } => {
                see("eta", Value::Indices(eta));
                see("k", Value::Indices(k));
                see("reflectance", Value::Share(tint));
            }
            Self::Dielectric { eta, tint } => {
                see("eta", Value::Number(eta, Range::INDEX));
                see("specular", Value::Share(tint));
            }
        }
    }

    /// The mean of the reflectance over a hemisphere of uniform radiance: `2 int F(c) c dc`.
    pub fn mean(&self) -> Rgb {
        // Squares of the sine are uniform under uniform radiance; so many midpoints see the steep
        // rise at grazing angles to one part in a million.
        const STEPS: u32 = 4096;
        let cosine = |i| (1.0 - (f64::from(i) + 0.5) / f64::from(STEPS)).sqrt();
        let sum = (0..STEPS).map(|i| self.at(cosine(i))).fold(Rgb::BLACK, |sum, f| sum + f);
        sum / f64::from(STEPS)
    }
}

/// Fresnel reflectance of unpolarised light that arrives at `cos_i > 0` on a boundary with relative
/// index `eta` (beyond over this side). One at grazing incidence and at total internal reflection.
#[inline]
pub(super) fn dielectric(cos_i: f64, eta: f64) -> f64 {
    if eta == 1.0 {
        return 0.0;
    }
    let cos_i = cos_i.min(1.0);
    let cos2_t = 1.0 - (1.0 - cos_i * cos_i) / (eta * eta);
    if !(cos2_t > 0.0) || !(cos_i > 0.0) {
        return 1.0;
    }
    let cos_t = cos2_t.sqrt();
    let parallel = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
    let perpendicular = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
    0.5 * (parallel * parallel + perpendicular * perpendicular)
}

/// Fresnel reflectance of a metal with the complex index `eta + i k` in air, for unpolarised light
/// [Born and Wolf 1999, section 14.2].
fn conductor(cos_i: f64, eta: f64, k: f64) -> f64 {
    let cos_i = cos_i.clamp(0.0, 1.0);
    let (cos2, sin2) = (cos_i * cos_i, 1.0 - cos_i * cos_i);
    let t = eta * eta - k * k - sin2;
    let length = (t * t + 4.0 * eta * eta * k * k).sqrt();
    let a = (0.5 * (length + t)).max(0.0).sqrt();
    let across = length + cos2;
    let perpendicular = (across - 2.0 * a * cos_i) / (across + 2.0 * a * cos_i);
    let along = cos2 * length + sin2 * sin2;
    let skew = 2.0 * a * cos_i * sin2;
    let parallel = perpendicular * (along - skew) / (along + skew);
    let reflectance = 0.5 * (parallel + perpendicular);
    if reflectance.is_finite() { reflectance.clamp(0.0, 1.0) } else { 1.0 }
}

#[cfg(test)]
impl Fresnel {
    pub(super) const GOLD: Self = Self::Conductor {
        eta: Rgb::new(0.18, 0.42, 1.37),
        k: Rgb::new(3.42, 2.35, 1.77),
        tint: Rgb::WHITE,
    };
    pub(super) const COAT: Self = Self::Dielectric { eta: 1.5, tint: Rgb::WHITE };
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Gold at 650 nm reflects 96 % (eta 0.1662, k 3.15), and a "metal" without absorption is a
    /// dielectric.
    #[test]
    fn metals_and_glass_agree_where_they_meet() {
        let normal =
            |eta: f64, k: f64| ((eta - 1.0).powi(2) + k * k) / ((eta + 1.0).powi(2) + k * k);
        assert!((conductor(1.0, 0.1662, 3.15) - normal(0.1662, 3.15)).abs() < 1e-12, "at normal");
        for i in 0..=20 {
            let cosine = f64::from(i) / 20.0;
            let error = (conductor(cosine, 1.5, 0.0) - dielectric(cosine, 1.5)).abs();
            assert!(error < 1e-12, "off by {error} at {cosine}");
        }
        assert_eq!(conductor(0.0, 0.2, 3.0), 1.0, "all at grazing incidence");
        assert_eq!(conductor(0.5, 0.0, 0.0), 1.0, "no index at all");
    }

    /// The diffuse reflectance of a smooth dielectric has a closed form [Egan et al. 1973]:
    /// 0.0918 for an index of 1.5.
    #[test]
    fn means_are_those_of_the_literature() {
        let glass = Fresnel::Dielectric { eta: 1.5, tint: Rgb::WHITE }.mean().g;
        assert!((glass - 0.091_8).abs() < 1e-4, "{glass}");
        let schlick = Fresnel::Schlick(Rgb::grey(0.3)).mean().g;
        assert!((schlick - (0.3 + 0.7 / 21.0)).abs() < 1e-6, "1/21 of the rest: {schlick}");
        assert_eq!(Fresnel::Constant(Rgb::grey(0.25)).mean(), Rgb::grey(0.25));
    }
}
