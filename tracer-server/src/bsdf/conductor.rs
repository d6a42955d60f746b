//! A rough metal.

use common::Event;
use glam::DVec3;

use super::{Fresnel, Ggx, Scatter, Scattering, reflect};
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

    fn follow(&self, _: DVec3, _: DVec3, _: Event) -> Option<DVec3> {
        None
    }

    fn connectable(&self) -> Option<Event> {
        Some(Event::Glossy)
    }

    fn albedo(&self) -> f64 {
        self.fresnel.at(1.0).max_channel()
    }
}
