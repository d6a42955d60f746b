//! A smooth boundary between two transparent media.

use common::{Event, Rgb};
use glam::DVec3;

#[cfg(test)]
use crate::bsdf::laws::Specimens;
use crate::bsdf::{Scatter, Scattering, fresnel, reflect};
use crate::math::{Rng, below_one};

/// Reflects and refracts by Fresnel's equations; absorbs only through its tints.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dielectric {
    /// Index of refraction behind the surface over the one in front of it.
    pub eta: f64,
    /// Tint of reflected light, each channel in [0, 1].
    pub reflectance: Rgb,
    /// Tint of refracted light, each channel in [0, 1].
    pub transmittance: Rgb,
}

impl Dielectric {
    /// Index of refraction beyond the surface over the one on the side of `w`.
    #[inline]
    pub(super) fn relative_eta(&self, n: DVec3, w: DVec3) -> f64 {
        if n.dot(w) > 0.0 { self.eta } else { 1.0 / self.eta }
    }

    /// The direction of refraction of `w`, or `None` at total internal reflection.
    fn refract(&self, n: DVec3, w: DVec3) -> Option<DVec3> {
        let facing = if n.dot(w) > 0.0 { n } else { -n };
        refract(facing, w, self.relative_eta(n, w))
    }
}

/// The direction of refraction of `w` at a boundary with the normal `facing` on the side of `w`
/// and the relative index `eta` (beyond over this side); `None` at total internal reflection.
#[inline]
pub(super) fn refract(facing: DVec3, w: DVec3, eta: f64) -> Option<DVec3> {
    let cos_i = facing.dot(w);
    let cos2_t = 1.0 - (1.0 - cos_i * cos_i) / (eta * eta);
    (cos2_t > 0.0).then(|| ((cos_i / eta - cos2_t.sqrt()) * facing - w / eta).normalize())
}

impl Scatter for Dielectric {
    const NAME: &'static str = "dielectric";
    const HAS_DIRAC_LOBE: bool = true;
    const IS_TRANSPARENT: bool = true;

    fn sample(&self, n: DVec3, w: DVec3, [u, ..]: [f64; 3]) -> Option<(DVec3, Event)> {
        let reflected = fresnel::dielectric(n.dot(w).abs(), self.relative_eta(n, w));
        let event = if u < reflected { Event::Reflect } else { Event::Transmit };
        self.specular_direction(n, w, event).map(|direction| (direction, event))
    }

    fn invert(&self, n: DVec3, w: DVec3, _: DVec3, event: Event, rng: &mut Rng) -> [f64; 3] {
        let reflected = fresnel::dielectric(n.dot(w).abs(), self.relative_eta(n, w));
        let [u, rest @ ..] = rng.array::<3>();
        let choice =
            if event == Event::Reflect { u * reflected } else { reflected + u * (1.0 - reflected) };
        [below_one(choice), rest[0], rest[1]]
    }

    fn evaluate(&self, n: DVec3, w_l: DVec3, w_e: DVec3, event: Event) -> Option<Scattering> {
        let (cos_l, cos_e) = (n.dot(w_l), n.dot(w_e));
        let reflected = fresnel::dielectric(cos_l.abs(), self.relative_eta(n, w_l));
        let (color, probability, eye_weight) = match event {
            Event::Reflect if cos_l * cos_e > 0.0 => (self.reflectance, reflected, 1.0),
            Event::Transmit if cos_l * cos_e < 0.0 => {
                // Radiance is squeezed into the narrower cone of the denser medium: the eye side
                // carries (eta_eye / eta_light)^2 [Veach 1997, section 5.2].
                let eta = self.relative_eta(n, w_l);
                (self.transmittance, 1.0 - reflected, eta * eta)
            }
            Event::End | Event::Diffuse | Event::Glossy | Event::Reflect | Event::Transmit => {
                return None;
            }
        };
        (probability > 0.0 && !color.is_black()).then_some(Scattering {
            color,
            connection: 0.0,
            light_weight: 1.0,
            eye_weight,
            light_pdf: probability,
            eye_pdf: probability,
        })
    }

    fn specular_direction(&self, n: DVec3, w: DVec3, event: Event) -> Option<DVec3> {
        match event {
            Event::Reflect => (!self.reflectance.is_black()).then(|| reflect(n, w)),
            Event::Transmit if self.transmittance.is_black() => None,
            Event::Transmit => self.refract(n, w),
            Event::End | Event::Diffuse | Event::Glossy => None,
        }
    }

    fn connectable(&self) -> Option<Event> {
        None
    }

    fn albedo(&self) -> f64 {
        self.reflectance.max_channel().max(self.transmittance.max_channel())
    }

    fn preview_color(&self) -> Rgb {
        self.transmittance
    }
}

#[cfg(test)]
impl Dielectric {
    /// Without tints.
    pub(in crate::bsdf) const fn clear(eta: f64) -> Self {
        Self { eta, reflectance: Rgb::WHITE, transmittance: Rgb::WHITE }
    }
}

#[cfg(test)]
impl Specimens for Dielectric {
    fn specimens() -> Vec<(&'static str, Self)> {
        vec![
            ("glass", Self::clear(1.5)),
            ("bubble", Self::clear(1.0 / 1.33)),
            ("nothing", Self::clear(1.0)),
            ("nearly nothing", Self::clear(1.0 + 1e-7)),
        ]
    }

    fn samplers(_: Event) -> u32 {
        0
    }

    fn scatters(&self, _: f64) -> Option<Rgb> {
        Some(Rgb::WHITE)
    }

    fn index(&self) -> f64 {
        self.eta
    }
}
