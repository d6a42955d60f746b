//! A rough metal.

use common::{Event, Rgb};
use glam::DVec3;

#[cfg(test)]
use super::laws::Specimens;
use super::mitsuba;
use super::model::{Given, Inputs, Model, NumberInput, Parameter, Range, Value};
use super::{Bsdf, Fresnel, Ggx, Mirror, Scatter, Scattering, reflect};
use crate::math::{Frame, Rng};

/// Reflects on both sides by microfacets that are mirrors, once: light that would meet a second
/// facet is lost.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RoughConductor {
    /// What a facet reflects.
    pub fresnel: Fresnel,
    /// How the facets are turned.
    pub facets: Ggx,
}

/// The frame of a surface on the side of `w`, with `n` or its opposite as third axis.
#[inline]
pub(super) fn facing(n: DVec3, w: DVec3) -> Frame {
    Frame::new(if n.dot(w) > 0.0 { n } else { -n })
}

impl Scatter for RoughConductor {
    const NAME: &'static str = "rough conductor";

    fn sample(&self, n: DVec3, w: DVec3, [_, u, v]: [f64; 3]) -> Option<(DVec3, Event)> {
        let frame = facing(n, w);
        let local = frame.to_local(w);
        let onward = reflect(self.facets.sample_visible(local, u, v), local);
        (onward.z > 0.0 && local.z > 0.0)
            .then(|| (frame.to_world(onward).normalize(), Event::Glossy))
    }

    fn invert(&self, n: DVec3, w: DVec3, w_out: DVec3, _: Event, rng: &mut Rng) -> [f64; 3] {
        let frame = facing(n, w);
        let (local, onward) = (frame.to_local(w), frame.to_local(w_out));
        let (u, v) = self.facets.invert_visible(local, (local + onward).normalize());
        [rng.uniform(), u, v]
    }

    fn evaluate(&self, n: DVec3, w_l: DVec3, w_e: DVec3, event: Event) -> Option<Scattering> {
        let frame = facing(n, w_l);
        let (l, e) = (frame.to_local(w_l), frame.to_local(w_e));
        if !(l.z > 0.0 && e.z > 0.0 && event == Event::Glossy) {
            return None;
        }
        let half = (l + e).normalize();
        let color = self.fresnel.at(l.dot(half));
        let facets = self.facets;
        let density = facets.density(half);
        (!color.is_black()).then(|| Scattering {
            color,
            connection: density * facets.visibility(l, e),
            // In closed form: the density of the facets has cancelled.
            light_weight: facets.shadowing(l, e),
            eye_weight: facets.shadowing(e, l),
            light_pdf: 0.5 * density / (l.z + facets.stretch(l)),
            eye_pdf: 0.5 * density / (e.z + facets.stretch(e)),
        })
    }

    fn specular_direction(&self, _: DVec3, _: DVec3, _: Event) -> Option<DVec3> {
        None
    }

    fn connectable(&self) -> Option<Event> {
        Some(Event::Glossy)
    }

    fn albedo(&self) -> f64 {
        self.fresnel.at(1.0).max_channel()
    }

    fn preview_color(&self) -> Rgb {
        self.fresnel.at(1.0)
    }
}

/// A metal as its author describes it: a [`RoughConductor`], or a [`Mirror`] where it is smooth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ConductorDescription {
    /// What it, or a facet of it, reflects.
    pub fresnel: Fresnel,
    /// Roughness of the facets: alpha of GGX, in [0, 1]; 0 is a mirror.
    pub roughness: NumberInput,
}

impl Model for ConductorDescription {
    const NAME: &'static str = "conductor";
    const ABOUT: &'static str = "a metal";
    const PARAMETERS: &'static [Parameter] = &[
        Parameter {
            name: "specular",
            about: "reflectance at normal incidence, in [0, 1], with Schlick's approximation for \
                other angles; this, or eta and k",
        },
        Parameter { name: "eta", about: "index of refraction, a number or [r, g, b]" },
        Parameter { name: "k", about: "extinction coefficient, a number or [r, g, b]" },
        Parameter {
            name: "reflectance",
            about: "with eta and k: tint of the reflection, in [0, 1]; default 1",
        },
        Parameter {
            name: "roughness",
            about: "alpha of GGX in [0, 1], a number or a texture; default 0, a mirror",
        },
    ];
    const PLUGINS: &'static [&'static str] = &["conductor", "roughconductor"];

    fn read<G: Given>(given: &mut G) -> Result<Self, G::Error> {
        let tint = given.color("reflectance")?;
        let indices = (given.color("specular")?, given.color("eta")?, given.color("k")?);
        let fresnel = match indices {
            (Some(specular), None, None) => Fresnel::Schlick(specular),
            (None, Some(eta), Some(k)) => {
                Fresnel::Conductor { eta, k, tint: tint.unwrap_or(Rgb::WHITE) }
            }
            _ => {
                let message = "give either specular, or eta and k, for a conductor";
                return Err(given.error("model", message));
            }
        };
        let roughness = given.number_input("roughness")?.unwrap_or(NumberInput::Constant(0.0));
        Ok(Self { fresnel, roughness })
    }

    fn read_plugin<G: Given>(plugin: &str, given: &mut G) -> Result<Self, G::Error> {
        let roughness = match plugin {
            "roughconductor" => mitsuba::roughness(given)?,
            _ => NumberInput::Constant(0.0),
        };
        Ok(Self { fresnel: mitsuba::metal(given)?, roughness })
    }

    fn parameters(&mut self, see: &mut dyn FnMut(&'static str, Value<'_>)) {
        self.fresnel.parameters(see);
        see("roughness", Value::NumberInput(&mut self.roughness, Range::ROUGHNESS));
    }

    fn build(&self, inputs: &impl Inputs) -> Bsdf {
        let fresnel = self.fresnel;
        if self.roughness.is_smooth() {
            return Bsdf::Mirror(Mirror { fresnel });
        }
        let facets = Ggx::new(inputs.number(self.roughness));
        Bsdf::RoughConductor(RoughConductor { fresnel, facets })
    }
}

#[cfg(test)]
impl Specimens for RoughConductor {
    fn specimens() -> Vec<(&'static str, Self)> {
        let metal = |fresnel, alpha| Self { fresnel, facets: Ggx::new(alpha) };
        vec![
            ("polished gold", metal(Fresnel::GOLD, 0.08)),
            ("brushed steel", metal(Fresnel::Schlick(Rgb::new(0.56, 0.57, 0.58)), 0.35)),
            ("matt silver", metal(Fresnel::Constant(Rgb::WHITE), 1.0)),
        ]
    }

    fn samplers(_: Event) -> u32 {
        1
    }
}
