//! A rough boundary between two transparent media [Walter et al. 2007].

use common::{Event, Rgb};
use glam::DVec3;

use super::smooth::{Dielectric, refract};
use crate::bsdf::conductor::facing;
#[cfg(test)]
use crate::bsdf::laws::Specimens;
use crate::bsdf::{Ggx, Scatter, Scattering, fresnel, reflect};
use crate::math::{Rng, below_one};

/// Reflects and refracts by microfacets that are smooth boundaries, once: light that would meet a
/// second facet is lost.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RoughDielectric {
    /// What a facet does. Its index must differ from 1: rough or not, a boundary between equal
    /// media would let light pass straight.
    pub facet: Dielectric,
    /// How the facets are turned.
    pub facets: Ggx,
}

/// The two directions in the frame of the light's side, and the facet that joins them.
struct Meeting {
    l: DVec3,
    e: DVec3,
    /// The facet's normal on the light's side.
    half: DVec3,
    /// Index of refraction on the far side over that on the light's side.
    eta: f64,
    /// The share that the facet reflects.
    reflected: f64,
}

impl RoughDielectric {
    /// `None` where no facet joins the two directions.
    fn meet(&self, n: DVec3, w_l: DVec3, w_e: DVec3) -> Option<Meeting> {
        let frame = facing(n, w_l);
        let (l, e) = (frame.to_local(w_l), frame.to_local(w_e));
        let eta = self.facet.relative_eta(n, w_l);
        let half = (if e.z > 0.0 { l + e } else { l + eta * e }).normalize();
        let half = if half.z > 0.0 { half } else { -half };
        // Seen from their back facets do nothing.
        let joined = l.dot(half) > 0.0 && e.dot(half) * e.z > 0.0 && l.z > 0.0;
        let reflected = fresnel::dielectric(l.dot(half), eta);
        joined.then_some(Meeting { l, e, half, eta, reflected })
    }

    fn reflection(&self, m: &Meeting) -> Scattering {
        let facets = self.facets;
        let density = facets.density(m.half);
        Scattering {
            color: self.facet.reflectance,
            connection: m.reflected * density * facets.visibility(m.l, m.e),
            light_weight: facets.shadowing(m.l, m.e),
            eye_weight: facets.shadowing(m.e, m.l),
            light_pdf: 0.5 * m.reflected * density / (m.l.z + facets.stretch(m.l)),
            eye_pdf: 0.5 * m.reflected * density / (m.e.z + facets.stretch(m.e)),
        }
    }

    fn refraction(&self, m: &Meeting) -> Scattering {
        let facets = self.facets;
        // The eye side seen from its own side of the surface.
        let (e, eta) = (-m.e, m.eta);
        let (l_half, e_half) = (m.l.dot(m.half), e.dot(m.half));
        let passed = 1.0 - m.reflected;
        // Solid angle of facet normals per solid angle of `w_e`, without the cosine of `w_e`.
        let spread = l_half / eta - e_half;
        let spread = 1.0 / (spread * spread);
        let density = facets.density(m.half);
        let refracted = 4.0 * passed * l_half * e_half * spread * density;
        Scattering {
            color: self.facet.transmittance,
            connection: refracted * facets.visibility(m.l, e),
            light_weight: facets.shadowing(m.l, e),
            // Radiance carries the squared ratio of the indices, as at a smooth boundary.
            eye_weight: eta * eta * facets.shadowing(e, m.l),
            light_pdf: 0.5 * refracted / (m.l.z + facets.stretch(m.l)),
            eye_pdf: 0.5 * refracted / (eta * eta * (e.z + facets.stretch(e))),
        }
    }
}

impl Scatter for RoughDielectric {
    const NAME: &'static str = "rough dielectric";
    const IS_TRANSPARENT: bool = true;

    fn sample(&self, n: DVec3, w: DVec3, [choice, u, v]: [f64; 3]) -> Option<(DVec3, Event)> {
        let frame = facing(n, w);
        let local = frame.to_local(w);
        let half = self.facets.sample_visible(local, u, v);
        let eta = self.facet.relative_eta(n, w);
        let reflects = choice < fresnel::dielectric(local.dot(half), eta);
        let (color, onward) = if reflects {
            (self.facet.reflectance, reflect(half, local))
        } else {
            (self.facet.transmittance, refract(half, local, eta)?)
        };
        let side = if reflects { onward.z } else { -onward.z };
        let passes = side > 0.0 && local.z > 0.0 && !color.is_black();
        passes.then(|| (frame.to_world(onward).normalize(), Event::Glossy))
    }

    fn invert(&self, n: DVec3, w: DVec3, w_out: DVec3, _: Event, rng: &mut Rng) -> [f64; 3] {
        let Some(m) = self.meet(n, w, w_out) else { return rng.array() };
        let (u, v) = self.facets.invert_visible(m.l, m.half);
        let choice = if m.e.z > 0.0 {
            rng.uniform() * m.reflected
        } else {
            m.reflected + rng.uniform() * (1.0 - m.reflected)
        };
        [below_one(choice), u, v]
    }

    fn evaluate(&self, n: DVec3, w_l: DVec3, w_e: DVec3, event: Event) -> Option<Scattering> {
        if event != Event::Glossy {
            return None;
        }
        let meeting = self.meet(n, w_l, w_e)?;
        let scattering =
            if meeting.e.z > 0.0 { self.reflection(&meeting) } else { self.refraction(&meeting) };
        let lit = scattering.connection > 0.0 && !scattering.color.is_black();
        lit.then_some(scattering)
    }

    fn specular_direction(&self, _: DVec3, _: DVec3, _: Event) -> Option<DVec3> {
        None
    }

    fn connectable(&self) -> Option<Event> {
        Some(Event::Glossy)
    }

    fn albedo(&self) -> f64 {
        self.facet.albedo()
    }

    fn preview_color(&self) -> Rgb {
        self.facet.transmittance
    }
}

#[cfg(test)]
impl Specimens for RoughDielectric {
    fn specimens() -> Vec<(&'static str, Self)> {
        let glass = |eta, alpha| Self { facet: Dielectric::clear(eta), facets: Ggx::new(alpha) };
        vec![
            ("hazy glass", glass(1.5, 0.12)),
            ("frosted glass", glass(1.5, 0.5)),
            ("rough bubble", glass(1.0 / 1.33, 0.3)),
        ]
    }

    fn samplers(_: Event) -> u32 {
        1
    }

    fn index(&self) -> f64 {
        self.facet.eta
    }
}
