//! Diffuse paint under a smooth transparent coat.

use std::f64::consts::FRAC_1_PI;

use common::{Event, Rgb};
use glam::DVec3;

use crate::bsdf::conductor::facing;
#[cfg(test)]
use crate::bsdf::laws::Specimens;
use crate::bsdf::{Fresnel, Scatter, Scattering, reflect};
use crate::math::{Rng, below_one, cosine_hemisphere, invert_cosine_hemisphere};

/// A coat that mirrors by its Fresnel reflectance, and lets the rest pass to a diffuse base and
/// back: two lobes, a Dirac one and a diffuse one, each an event of its own.
///
/// The base is coupled so that the coat and a white base together lose nothing: the diffuse part is
/// `color (1 - F(l)) (1 - F(e)) / (pi (1 - mean F))` [Kelemen and Szirmay-Kalos 2001]. For a
/// dielectric coat this is the sum over all reflections between base and coat.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plastic {
    /// Colour of the base as seen through the coat, each channel in [0, 1].
    pub diffuse: Rgb,
    /// What the coat reflects.
    pub fresnel: Fresnel,
    /// The share that passes the coat from a hemisphere of uniform radiance.
    passed: f64,
}

impl Plastic {
    /// A base of that colour under that coat.
    pub fn new(diffuse: Rgb, fresnel: Fresnel) -> Self {
        Self { diffuse, fresnel, passed: 1.0 - untinted(fresnel).mean().max_channel() }
    }

    /// The same coat over a base of another colour.
    pub(super) fn painted(self, diffuse: Rgb) -> Self {
        Self { diffuse, ..self }
    }

    /// The share that passes the coat at an angle, the same for all colours so that none gains.
    #[inline]
    fn pass(&self, cosine: f64) -> f64 {
        1.0 - untinted(self.fresnel).at(cosine).max_channel()
    }

    /// The probability that a walk that arrives at an angle is mirrored.
    #[inline]
    fn mirrored(&self, cosine: f64) -> f64 {
        let coat = self.fresnel.at(cosine).luminance();
        let base = self.pass(cosine) * self.diffuse.luminance();
        if coat > 0.0 { coat / (coat + base) } else { 0.0 }
    }
}

/// The coat without its tint: a tint takes from the highlight, and gives nothing to the base.
#[inline]
pub(super) fn untinted(fresnel: Fresnel) -> Fresnel {
    match fresnel {
        Fresnel::Dielectric { eta, .. } => Fresnel::Dielectric { eta, tint: Rgb::WHITE },
        Fresnel::Constant(_) | Fresnel::Schlick(_) | Fresnel::Conductor { .. } => fresnel,
    }
}

impl Scatter for Plastic {
    const NAME: &'static str = "plastic";
    const HAS_DIRAC_LOBE: bool = true;

    fn sample(&self, n: DVec3, w: DVec3, [choice, u, v]: [f64; 3]) -> Option<(DVec3, Event)> {
        if choice < self.mirrored(n.dot(w).abs()) {
            return Some((reflect(n, w), Event::Reflect));
        }
        let base = || (facing(n, w).to_world(cosine_hemisphere(u, v)), Event::Diffuse);
        (!self.diffuse.is_black()).then(base)
    }

    fn invert(&self, n: DVec3, w: DVec3, w_out: DVec3, event: Event, rng: &mut Rng) -> [f64; 3] {
        let mirrored = self.mirrored(n.dot(w).abs());
        let [choice, u, v] = rng.array();
        if event == Event::Reflect {
            return [below_one(choice * mirrored), u, v];
        }
        let [u, v] = invert_cosine_hemisphere(facing(n, w).to_local(w_out));
        [below_one(mirrored + choice * (1.0 - mirrored)), u, v]
    }

    fn evaluate(&self, n: DVec3, w_l: DVec3, w_e: DVec3, event: Event) -> Option<Scattering> {
        let (cos_l, cos_e) = (n.dot(w_l), n.dot(w_e));
        if !(cos_l * cos_e > 0.0) {
            return None;
        }
        let (cos_l, cos_e) = (cos_l.abs(), cos_e.abs());
        let light = self.mirrored(cos_l);
        match event {
            Event::Reflect => {
                let color = self.fresnel.at(cos_l);
                (light > 0.0).then(|| Scattering {
                    color,
                    connection: 0.0,
                    light_weight: 1.0 / light,
                    eye_weight: 1.0 / light,
                    light_pdf: light,
                    eye_pdf: light,
                })
            }
            Event::Diffuse => {
                let eye = self.mirrored(cos_e);
                let through = self.pass(cos_l) * self.pass(cos_e) / self.passed;
                let lit = through > 0.0 && !self.diffuse.is_black();
                lit.then(|| Scattering {
                    color: self.diffuse,
                    connection: through * FRAC_1_PI,
                    light_weight: through / (1.0 - light),
                    eye_weight: through / (1.0 - eye),
                    light_pdf: (1.0 - light) * cos_e * FRAC_1_PI,
                    eye_pdf: (1.0 - eye) * cos_l * FRAC_1_PI,
                })
            }
            Event::End | Event::Glossy | Event::Transmit => None,
        }
    }

    fn specular_direction(&self, n: DVec3, w: DVec3, event: Event) -> Option<DVec3> {
        let reflects = event == Event::Reflect && self.mirrored(n.dot(w).abs()) > 0.0;
        reflects.then(|| reflect(n, w))
    }

    fn connectable(&self) -> Option<Event> {
        (!self.diffuse.is_black()).then_some(Event::Diffuse)
    }

    fn albedo(&self) -> f64 {
        let coat = self.fresnel.at(1.0);
        (coat + self.diffuse * self.pass(1.0)).max_channel()
    }

    fn preview_color(&self) -> Rgb {
        self.diffuse
    }
}

#[cfg(test)]
impl Specimens for Plastic {
    const MARGIN: f64 = 1e-3;

    fn specimens() -> Vec<(&'static str, Self)> {
        let tinted = Fresnel::Dielectric { eta: 1.3, tint: Rgb::new(0.5, 0.4, 0.9) };
        vec![
            ("plastic", Self::new(Rgb::new(0.8, 0.2, 0.05), Fresnel::COAT)),
            ("white plastic", Self::new(Rgb::WHITE, Fresnel::COAT)),
            ("tinted coat", Self::new(Rgb::new(0.8, 0.2, 0.05), tinted)),
            ("black glass", Self::new(Rgb::BLACK, Fresnel::COAT)),
        ]
    }

    fn samplers(event: Event) -> u32 {
        u32::from(event == Event::Diffuse)
    }

    fn scatters(&self, _: f64) -> Option<Rgb> {
        (self.diffuse == Rgb::WHITE).then_some(Rgb::WHITE)
    }
}
