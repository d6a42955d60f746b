//! The lens perturbation: move the film point a little and let the view ray follow, through mirrors
//! and glass, to the first diffuse surface [Veach and Guibas 1997, section 5.3].

use std::f64::consts::{PI, TAU};

use common::Camera;
use glam::DVec2;

use super::Mutation;
use crate::bsdf::Scatter as _;
use crate::math::{Rng, log_uniform};
use crate::path::{
    Draft, Failure, Path, Splice, camera_vertex, end_on_light, extend, open_for_connection,
};
use crate::scene::Tracer;

/// Displaces the film point by a log-uniform radius in a uniform direction.
#[derive(Clone, Copy, Debug)]
pub struct LensPerturbation {
    /// Smallest displacement in pixels.
    pub min_radius: f64,
    /// Largest displacement in pixels.
    pub max_radius: f64,
    /// One pixel in film units.
    pub pixel: DVec2,
}

impl LensPerturbation {
    /// Radii from a tenth of a pixel to those of a disk that covers five per cent of the film.
    pub fn new(camera: &Camera) -> Self {
        let (width, height) = (f64::from(camera.width), f64::from(camera.height));
        let max_radius = (0.05 * width * height / PI).sqrt();
        Self {
            min_radius: max_radius.min(1.0) * 0.1,
            max_radius,
            pixel: DVec2::new(1.0 / width, 1.0 / height),
        }
    }

    pub(super) fn displace(&self, film: DVec2, rng: &mut Rng) -> DVec2 {
        let radius = log_uniform(self.min_radius, self.max_radius, rng.uniform());
        let (sin, cos) = (TAU * rng.uniform()).sin_cos();
        film + radius * DVec2::new(cos, sin) * self.pixel
    }

    /// Rebuilds the part of `x` that is seen through `film`, down to its first diffuse vertex seen
    /// from the lens; every mirror and every glass does again what it did.
    pub(super) fn retrace(
        scene: &Tracer<'_>,
        x: &Path,
        film: DVec2,
        draft: &mut Draft,
        y: &mut Path,
    ) -> Result<usize, Failure> {
        if !((0.0..1.0).contains(&film.x) && (0.0..1.0).contains(&film.y)) {
            return Err(Failure::OffFilm);
        }
        draft.clear();
        let d = x.first_diffuse_from_eye();
        let mut direction = scene.camera().direction(film);
        let mut at = camera_vertex(scene);
        for j in (d..x.edge_count()).rev() {
            at = extend(scene, &at, direction)?;
            if j > d {
                let event = x.vertices()[j].event;
                let bsdf = scene.bsdf(at.material);
                direction =
                    bsdf.follow(at.normal, -direction, event).ok_or(Failure::KindChanged)?;
                at.set_event(event);
            } else if d == 0 {
                end_on_light(scene, &mut at)?;
            } else {
                open_for_connection(scene, &mut at).or(Err(Failure::KindChanged))?;
            }
            draft.eye.push(at);
        }
        let splice = Splice {
            base: x,
            kept_light: d,
            light: &[],
            eye: &draft.eye,
            kept_from: x.edge_count(),
            film: Some(film),
        };
        y.splice(scene, &splice)?;
        if d > 0 && !y.connection_is_clear(scene, d - 1) {
            return Err(Failure::Occluded);
        }
        Ok(d)
    }
}

/// Probability of the events at the specular vertices that the view ray passes.
pub(super) fn event_probability(x: &Path, d: usize) -> f64 {
    (d + 1..x.edge_count()).map(|j| x.scattering(j).eye_pdf).product()
}

impl Mutation for LensPerturbation {
    /// Index of the first diffuse vertex seen from the lens: `d`.
    type Move = usize;
    const NAME: &'static str = "lens";

    /// The vertex behind the first diffuse one must be connectable, unless the light itself is seen.
    fn applicable(&self, x: &Path) -> bool {
        let d = x.first_diffuse_from_eye();
        d == 0 || x.connectable() >> (d - 1) & 1 == 1
    }

    fn propose(
        &self,
        scene: &Tracer<'_>,
        x: &Path,
        rng: &mut Rng,
        draft: &mut Draft,
        y: &mut Path,
    ) -> Result<usize, Failure> {
        Self::retrace(scene, x, self.displace(x.film(), rng), draft, y)
    }

    /// The displacement is symmetric in film measure, and in film measure the value of a path is
    /// `E_l = lum C_l` with the probabilities of its events *not* divided out: the events are
    /// repeated, not drawn.
    fn transition(&self, _: &Path, y: &Path, d: usize) -> f64 {
        y.reciprocal(d) / event_probability(y, d)
    }

    fn reverse(&self, d: usize) -> usize {
        d
    }

    fn kept(&self, _: &Path, d: usize) -> (usize, usize) {
        (d, 1)
    }
}
