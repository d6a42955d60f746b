//! A smooth boundary between two transparent media.

use common::{Event, Rgb};
use glam::DVec3;

#[cfg(test)]
use super::laws::Specimens;
use super::mitsuba;
use super::model::{Given, Inputs, Model, NumberInput, Parameter, Range, Value};
use super::{Bsdf, Ggx, RoughDielectric, Scatter, Scattering, fresnel, reflect};
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

/// A boundary between two transparent media as its author describes it: a [`Dielectric`], or a
/// [`RoughDielectric`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DielectricDescription {
    /// Index of refraction behind the surface over the one in front of it.
    pub eta: f64,
    /// Tint of reflected light, each channel in [0, 1].
    pub reflectance: Rgb,
    /// Tint of refracted light, each channel in [0, 1].
    pub transmittance: Rgb,
    /// Roughness of the facets: alpha of GGX, in [0, 1]; 0 is smooth.
    pub roughness: NumberInput,
}

/// A rough boundary between media whose indices differ by less is smooth: it hardly turns light,
/// and a facet could no longer be told from the two directions that it joins.
const EQUAL_MEDIA: f64 = 1e-3;

impl DielectricDescription {
    /// A smooth boundary without tints.
    pub const fn clear(eta: f64) -> Self {
        let roughness = NumberInput::Constant(0.0);
        Self { eta, reflectance: Rgb::WHITE, transmittance: Rgb::WHITE, roughness }
    }
}

impl Model for DielectricDescription {
    const NAME: &'static str = "dielectric";
    const ABOUT: &'static str = "a boundary between two transparent media";
    const PARAMETERS: &'static [Parameter] = &[
        Parameter {
            name: "eta",
            about: "index of refraction behind the surface over that in front of it; needed",
        },
        Parameter {
            name: "reflectance",
            about: "tint of what is reflected, in [0, 1]: a number or [r, g, b]; default 1",
        },
        Parameter {
            name: "transmittance",
            about: "tint of what is refracted at each crossing, in [0, 1]; default 1",
        },
        Parameter {
            name: "roughness",
            about: "alpha of GGX in [0, 1], a number or a texture; default 0, smooth",
        },
    ];
    const PLUGINS: &'static [&'static str] = &["dielectric", "thindielectric", "roughdielectric"];

    fn read<G: Given>(given: &mut G) -> Result<Self, G::Error> {
        let missing = "the model `dielectric` needs it (glass is 1.5)";
        Ok(Self {
            eta: given.number("eta")?.ok_or_else(|| given.error("eta", missing))?,
            reflectance: given.color("reflectance")?.unwrap_or(Rgb::WHITE),
            transmittance: given.color("transmittance")?.unwrap_or(Rgb::WHITE),
            roughness: given.number_input("roughness")?.unwrap_or(NumberInput::Constant(0.0)),
        })
    }

    fn read_plugin<G: Given>(plugin: &str, given: &mut G) -> Result<Self, G::Error> {
        let roughness = match plugin {
            "roughdielectric" => mitsuba::roughness(given)?,
            _ => NumberInput::Constant(0.0),
        };
        let inside = mitsuba::index(given, "int_ior", "bk7")?;
        Ok(Self {
            eta: inside / mitsuba::index(given, "ext_ior", "air")?,
            reflectance: given.color("specular_reflectance")?.unwrap_or(Rgb::WHITE),
            transmittance: given.color("specular_transmittance")?.unwrap_or(Rgb::WHITE),
            roughness,
        })
    }

    fn parameters(&mut self, see: &mut dyn FnMut(&'static str, Value<'_>)) {
        see("reflectance", Value::Share(&mut self.reflectance));
        see("transmittance", Value::Share(&mut self.transmittance));
        see("eta", Value::Number(&mut self.eta, Range::INDEX));
        see("roughness", Value::NumberInput(&mut self.roughness, Range::ROUGHNESS));
    }

    fn build(&self, inputs: &impl Inputs) -> Bsdf {
        let Self { eta, reflectance, transmittance, roughness } = *self;
        let facet = Dielectric { eta, reflectance, transmittance };
        if roughness.is_smooth() || (eta - 1.0).abs() < EQUAL_MEDIA {
            return Bsdf::Dielectric(facet);
        }
        let facets = Ggx::new(inputs.number(roughness));
        Bsdf::RoughDielectric(RoughDielectric { facet, facets })
    }

    fn inside_out(&self) -> Option<Self> {
        Some(Self { eta: 1.0 / self.eta, ..*self })
    }
}

#[cfg(test)]
impl Dielectric {
    /// Without tints.
    pub(super) const fn clear(eta: f64) -> Self {
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
