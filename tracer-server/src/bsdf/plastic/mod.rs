//! Diffuse paint under a transparent coat, smooth and rough.

mod rough;
mod smooth;

use common::Rgb;

pub use rough::RoughPlastic;
pub use smooth::Plastic;

use super::mitsuba;
use super::model::{ColorInput, Given, Inputs, Model, NumberInput, Parameter, Range, Value};
use super::{Bsdf, Fresnel, Ggx};

/// Paint under a transparent coat as its author describes it: a [`Plastic`], or a [`RoughPlastic`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlasticDescription {
    /// Albedo of the base, each channel in [0, 1].
    pub diffuse: ColorInput,
    /// What the coat, or a facet of it, reflects.
    pub fresnel: Fresnel,
    /// Roughness of the coat: alpha of GGX, in [0, 1]; 0 is smooth.
    pub roughness: f64,
    /// True when light that goes to and fro between a dielectric coat and the base takes on
    /// its colour each time, false when `diffuse` is the colour as seen through the coat.
    pub nonlinear: bool,
}

impl PlasticDescription {
    /// The colour of the base as seen through the coat.
    fn base(&self, inputs: &impl Inputs) -> Rgb {
        let color = inputs.color(self.diffuse);
        match self.fresnel {
            Fresnel::Dielectric { eta, .. } if self.nonlinear => deepened(color, eta),
            Fresnel::Dielectric { .. }
            | Fresnel::Constant(_)
            | Fresnel::Schlick(_)
            | Fresnel::Conductor { .. } => color,
        }
    }
}

impl Model for PlasticDescription {
    const NAME: &'static str = "plastic";
    const ABOUT: &'static str = "diffuse paint under a transparent coat";
    const PARAMETERS: &'static [Parameter] = &[
        Parameter {
            name: "reflectance",
            about: "albedo of the paint, in [0, 1]: a number, [r, g, b] or a texture; required",
        },
        Parameter { name: "eta", about: "index of refraction of the coat; default 1.5" },
        Parameter {
            name: "specular",
            about: "instead of eta: reflectance of the coat at normal incidence, in [0, 1], with \
                Schlick's approximation for other angles",
        },
        Parameter {
            name: "roughness",
            about: "alpha of GGX in [0, 1], a number; default 0, smooth",
        },
        Parameter {
            name: "nonlinear",
            about: "true if inner reflections below the coat deepen the paint's colour; default \
                false",
        },
    ];
    const PLUGINS: &'static [&'static str] = &["plastic", "roughplastic"];

    fn read<G: Given>(given: &mut G) -> Result<Self, G::Error> {
        let fresnel = match (given.color("specular")?, given.number("eta")?) {
            (Some(_), Some(_)) => {
                return Err(given.error("specular", "give either specular or eta for a coat"));
            }
            (Some(specular), None) => Fresnel::Schlick(specular),
            (None, eta) => Fresnel::Dielectric { eta: eta.unwrap_or(1.5), tint: Rgb::WHITE },
        };
        Ok(Self {
            diffuse: given.needed_color_input("reflectance")?,
            fresnel,
            roughness: given.number("roughness")?.unwrap_or(0.0),
            nonlinear: given.flag("nonlinear")?,
        })
    }

    fn read_plugin<G: Given>(plugin: &str, given: &mut G) -> Result<Self, G::Error> {
        let roughness = match plugin {
            "roughplastic" => match mitsuba::roughness(given)? {
                NumberInput::Constant(roughness) => roughness,
                NumberInput::Texture { .. } => {
                    given.warn("the roughness of a coat cannot be a texture: 0.1 is used");
                    mitsuba::ROUGHNESS
                }
            },
            _ => 0.0,
        };
        let inside = mitsuba::index(given, "int_ior", "polypropylene")?;
        let eta = inside / mitsuba::index(given, "ext_ior", "air")?;
        let tint = given.color("specular_reflectance")?.unwrap_or(Rgb::WHITE);
        let diffuse = given.color_input("diffuse_reflectance")?;
        Ok(Self {
            diffuse: diffuse.unwrap_or(mitsuba::REFLECTANCE),
            fresnel: Fresnel::Dielectric { eta, tint },
            roughness,
            nonlinear: given.flag("nonlinear")?,
        })
    }

    fn parameters(&mut self, see: &mut dyn FnMut(&'static str, Value<'_>)) {
        see("reflectance", Value::ShareInput(&mut self.diffuse));
        self.fresnel.parameters(see);
        see("roughness", Value::Number(&mut self.roughness, Range::ROUGHNESS));
        see("nonlinear", Value::Flag(&mut self.nonlinear));
    }

    fn build(&self, inputs: &impl Inputs) -> Bsdf {
        let base = self.base(inputs);
        if NumberInput::Constant(self.roughness).is_smooth() {
            return Bsdf::Plastic(Plastic::new(base, self.fresnel));
        }
        Bsdf::RoughPlastic(RoughPlastic::new(base, self.fresnel, Ggx::new(self.roughness)))
    }

    /// The coat, whose albedo is an integral, stays as it is.
    fn rebuild(&self, built: &Bsdf, inputs: &impl Inputs) -> Bsdf {
        let diffuse = self.base(inputs);
        if let Bsdf::Plastic(plastic) = *built {
            Bsdf::Plastic(plastic.painted(diffuse))
        } else if let Bsdf::RoughPlastic(plastic) = *built {
            Bsdf::RoughPlastic(plastic.painted(diffuse))
        } else {
            self.build(inputs)
        }
    }
}

/// The colour that a base of the given albedo shows through a dielectric coat.
///
/// Every reflection from below the coat tints the light once more: `color (1 - R) / (1 - color R)`
/// with the diffuse reflectance `R` of the coat from below.
fn deepened(color: Rgb, eta: f64) -> Rgb {
    let outside = Fresnel::Dielectric { eta, tint: Rgb::WHITE }.mean().g;
    // The same light passes a boundary both ways [Egan et al. 1973].
    let inside = 1.0 - (1.0 - outside) / (eta * eta);
    let deepen = |c: f64| c * (1.0 - inside) / (1.0 - c * inside);
    Rgb::new(deepen(color.r), deepen(color.g), deepen(color.b))
}
