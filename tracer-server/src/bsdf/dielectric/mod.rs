//! Boundaries between two transparent media, smooth and rough.

mod rough;
mod smooth;

use common::Rgb;

pub use rough::RoughDielectric;
pub use smooth::Dielectric;

use super::mitsuba;
use super::model::{Given, Inputs, Model, NumberInput, Parameter, Range, Value};
use super::{Bsdf, Ggx};

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
            about: "index of refraction behind the surface divided by that in front of it; \
                required",
        },
        Parameter {
            name: "reflectance",
            about: "tint of the reflection, in [0, 1]: a number or [r, g, b]; default 1",
        },
        Parameter {
            name: "transmittance",
            about: "tint of the refraction at each crossing, in [0, 1]; default 1",
        },
        Parameter {
            name: "roughness",
            about: "alpha of GGX in [0, 1], a number or a texture; default 0, smooth",
        },
    ];
    const PLUGINS: &'static [&'static str] = &["dielectric", "thindielectric", "roughdielectric"];

    fn read<G: Given>(given: &mut G) -> Result<Self, G::Error> {
        let missing = "the model `dielectric` requires it (glass is 1.5)";
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
