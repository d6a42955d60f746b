//! Diffuse paint under a smooth transparent coat.

use std::f64::consts::FRAC_1_PI;

use common::{Event, Rgb};
use glam::DVec3;

use super::conductor::facing;
#[cfg(test)]
use super::laws::Specimens;
use super::mitsuba;
use super::model::{ColorInput, Given, Inputs, Model, NumberInput, Parameter, Range, Value};
use super::{Bsdf, Fresnel, Ggx, RoughPlastic, Scatter, Scattering, reflect};
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
            about: "albedo of the paint, in [0, 1]: a number, [r, g, b] or a texture; needed",
        },
        Parameter { name: "eta", about: "index of refraction of the coat; default 1.5" },
        Parameter {
            name: "specular",
            about: "in place of eta: what the coat reflects at normal incidence, in [0, 1], and \
                    more at other angles by Schlick's approximation",
        },
        Parameter {
            name: "roughness",
            about: "alpha of GGX in [0, 1], a number; default 0, smooth",
        },
        Parameter {
            name: "nonlinear",
            about: "true when light that goes to and fro below the coat takes on the paint's \
                    colour each time; default false",
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
                    given.warn("the roughness of a coat reads no texture: 0.1 is used");
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
            Bsdf::Plastic(Plastic { diffuse, ..plastic })
        } else if let Bsdf::RoughPlastic(plastic) = *built {
            Bsdf::RoughPlastic(plastic.painted(diffuse))
        } else {
            self.build(inputs)
        }
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
