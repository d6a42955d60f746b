//! Mirror reflection on both sides of a smooth opaque surface.

use common::{Event, Rgb};
use glam::DVec3;

#[cfg(test)]
use super::laws::Specimens;
use super::model::{Given, Inputs, Model, Parameter, Value};
use super::{Bsdf, Fresnel, Scatter, Scattering, reflect};
use crate::math::Rng;

/// Reflects into the one mirrored direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mirror {
    /// How much.
    pub fresnel: Fresnel,
}

impl Mirror {
    /// Of the same reflectance at every angle, each channel in [0, 1].
    pub const fn new(reflectance: Rgb) -> Self {
        Self { fresnel: Fresnel::Constant(reflectance) }
    }
}

impl Scatter for Mirror {
    const NAME: &'static str = "mirror";
    const HAS_DIRAC_LOBE: bool = true;

    fn sample(&self, n: DVec3, w: DVec3, _: [f64; 3]) -> Option<(DVec3, Event)> {
        self.specular_direction(n, w, Event::Reflect).map(|direction| (direction, Event::Reflect))
    }

    fn invert(&self, _: DVec3, _: DVec3, _: DVec3, _: Event, rng: &mut Rng) -> [f64; 3] {
        rng.array()
    }

    fn evaluate(&self, n: DVec3, w_l: DVec3, w_e: DVec3, event: Event) -> Option<Scattering> {
        let cos_l = n.dot(w_l);
        let color = self.fresnel.at(cos_l.abs());
        let lit = cos_l * n.dot(w_e) > 0.0 && event == Event::Reflect && !color.is_black();
        lit.then_some(Scattering {
            color,
            connection: 0.0,
            light_weight: 1.0,
            eye_weight: 1.0,
            light_pdf: 1.0,
            eye_pdf: 1.0,
        })
    }

    fn specular_direction(&self, n: DVec3, w: DVec3, event: Event) -> Option<DVec3> {
        let reflects = event == Event::Reflect && !self.fresnel.at(n.dot(w).abs()).is_black();
        reflects.then(|| reflect(n, w))
    }

    fn connectable(&self) -> Option<Event> {
        None
    }

    fn albedo(&self) -> f64 {
        self.fresnel.at(1.0).max_channel()
    }

    fn preview_color(&self) -> Rgb {
        self.fresnel.at(1.0)
    }
}

/// A [`Mirror`] as its author describes it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MirrorDescription {
    /// Reflectance at every angle, each channel in [0, 1].
    pub reflectance: Rgb,
}

impl Model for MirrorDescription {
    const NAME: &'static str = "mirror";
    const ABOUT: &'static str = "ideal mirror";
    const PARAMETERS: &'static [Parameter] = &[Parameter {
        name: "reflectance",
        about: "share of light reflected at every angle, in [0, 1]: a number or [r, g, b]; \
            required",
    }];

    fn read<G: Given>(given: &mut G) -> Result<Self, G::Error> {
        Ok(Self { reflectance: given.needed_color("reflectance")? })
    }

    fn parameters(&mut self, see: &mut dyn FnMut(&'static str, Value<'_>)) {
        see("reflectance", Value::Share(&mut self.reflectance));
    }

    fn build(&self, _: &impl Inputs) -> Bsdf {
        Bsdf::Mirror(Mirror::new(self.reflectance))
    }
}

#[cfg(test)]
impl Specimens for Mirror {
    fn specimens() -> Vec<(&'static str, Self)> {
        vec![
            ("mirror", Self::new(Rgb::new(0.9, 0.8, 0.7))),
            ("smooth gold", Self { fresnel: Fresnel::GOLD }),
        ]
    }

    fn samplers(_: Event) -> u32 {
        0
    }

    fn scatters(&self, cosine: f64) -> Option<Rgb> {
        Some(self.fresnel.at(cosine))
    }
}
