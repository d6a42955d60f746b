//! Ideal diffuse reflection on both sides of a surface.

use std::f64::consts::FRAC_1_PI;

use common::{Event, Rgb};
use glam::DVec3;

#[cfg(test)]
use super::laws::Specimens;
use super::mitsuba;
use super::model::{ColorInput, Given, Inputs, Model, Parameter, Value};
use super::{Bsdf, Scatter, Scattering};
use crate::math::{Frame, Rng, cosine_hemisphere, invert_cosine_hemisphere};

/// Reflects the same radiance in all directions: `f = reflectance / pi`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lambert {
    /// Albedo, each channel in [0, 1].
    pub reflectance: Rgb,
}

impl Scatter for Lambert {
    const NAME: &'static str = "lambert";

    #[inline]
    fn sample(&self, n: DVec3, w: DVec3, [_, u, v]: [f64; 3]) -> Option<(DVec3, Event)> {
        if self.reflectance.is_black() {
            return None;
        }
        let facing = if n.dot(w) > 0.0 { n } else { -n };
        let local = cosine_hemisphere(u, v);
        Some((Frame::new(facing).to_world(local), Event::Diffuse))
    }

    fn invert(&self, n: DVec3, w: DVec3, w_out: DVec3, _: Event, rng: &mut Rng) -> [f64; 3] {
        let facing = if n.dot(w) > 0.0 { n } else { -n };
        let [u, v] = invert_cosine_hemisphere(Frame::new(facing).to_local(w_out));
        [rng.uniform(), u, v]
    }

    #[inline]
    fn evaluate(&self, n: DVec3, w_l: DVec3, w_e: DVec3, event: Event) -> Option<Scattering> {
        let (cos_l, cos_e) = (n.dot(w_l), n.dot(w_e));
        let lit = cos_l * cos_e > 0.0 && event == Event::Diffuse && !self.reflectance.is_black();
        // The weights are the albedo in closed form: f cos / pdf would be 0/0 at grazing angles.
        lit.then(|| Scattering {
            color: self.reflectance,
            connection: FRAC_1_PI,
            light_weight: 1.0,
            eye_weight: 1.0,
            light_pdf: cos_e.abs() * FRAC_1_PI,
            eye_pdf: cos_l.abs() * FRAC_1_PI,
        })
    }

    fn specular_direction(&self, _: DVec3, _: DVec3, _: Event) -> Option<DVec3> {
        None
    }

    #[inline]
    fn connectable(&self) -> Option<Event> {
        Some(Event::Diffuse)
    }

    fn albedo(&self) -> f64 {
        self.reflectance.max_channel()
    }

    fn preview_color(&self) -> Rgb {
        self.reflectance
    }
}

/// A [`Lambert`] surface as its author describes it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LambertDescription {
    /// Albedo, each channel in [0, 1].
    pub reflectance: ColorInput,
}

impl Model for LambertDescription {
    const NAME: &'static str = "lambert";
    const ABOUT: &'static str = "ideal diffuse reflection";
    const PARAMETERS: &'static [Parameter] = &[Parameter {
        name: "reflectance",
        about: "share of light reflected, in [0, 1]: a number, [r, g, b] or a texture; required",
    }];
    const PLUGINS: &'static [&'static str] = &["diffuse", "roughdiffuse"];

    fn read<G: Given>(given: &mut G) -> Result<Self, G::Error> {
        Ok(Self { reflectance: given.needed_color_input("reflectance")? })
    }

    fn read_plugin<G: Given>(_: &str, given: &mut G) -> Result<Self, G::Error> {
        let reflectance = given.color_input("reflectance")?.unwrap_or(mitsuba::REFLECTANCE);
        Ok(Self { reflectance })
    }

    fn parameters(&mut self, see: &mut dyn FnMut(&'static str, Value<'_>)) {
        see("reflectance", Value::ShareInput(&mut self.reflectance));
    }

    fn build(&self, inputs: &impl Inputs) -> Bsdf {
        Bsdf::Lambert(Lambert { reflectance: inputs.color(self.reflectance) })
    }
}

#[cfg(test)]
impl Specimens for Lambert {
    fn specimens() -> Vec<(&'static str, Self)> {
        vec![
            ("lambert", Self { reflectance: Rgb::new(0.9, 0.5, 0.1) }),
            ("white lambert", Self { reflectance: Rgb::WHITE }),
        ]
    }

    fn samplers(_: Event) -> u32 {
        1
    }

    fn scatters(&self, _: f64) -> Option<Rgb> {
        Some(self.reflectance)
    }
}
