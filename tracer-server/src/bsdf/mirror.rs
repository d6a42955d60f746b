//! Ideal mirror reflection on both sides of a surface.

use common::{Event, Rgb};
use glam::DVec3;

use super::{Scatter, Scattering, reflect};
use crate::math::Rng;

/// Reflects into the one mirrored direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mirror {
    /// Reflectance at every angle, each channel in [0, 1].
    pub reflectance: Rgb,
}

impl Scatter for Mirror {
    fn sample(&self, n: DVec3, w: DVec3, _: [f64; 3]) -> Option<(DVec3, Event)> {
        self.follow(n, w, Event::Reflect).map(|direction| (direction, Event::Reflect))
    }

    fn invert(&self, _: DVec3, _: DVec3, _: DVec3, _: Event, rng: &mut Rng) -> [f64; 3] {
        rng.array()
    }

    fn evaluate(&self, n: DVec3, w_l: DVec3, w_e: DVec3, event: Event) -> Option<Scattering> {
        let lit = n.dot(w_l) * n.dot(w_e) > 0.0
            && event == Event::Reflect
            && !self.reflectance.is_black();
        lit.then_some(Scattering {
            color: self.reflectance,
            connection: 0.0,
            light_weight: 1.0,
            eye_weight: 1.0,
            light_pdf: 1.0,
            eye_pdf: 1.0,
        })
    }

    fn follow(&self, n: DVec3, w: DVec3, event: Event) -> Option<DVec3> {
        (event == Event::Reflect && !self.reflectance.is_black()).then(|| reflect(n, w))
    }

    fn connectable(&self) -> Option<Event> {
        None
    }

    fn albedo(&self) -> f64 {
        self.reflectance.max_channel()
    }
}
