//! Walks that repeat what a path did, along slightly other directions.

use std::f64::consts::TAU;

use common::Camera;
use glam::{DVec2, DVec3};

use crate::math::{Frame, Rng, log_uniform};
use crate::path::{
    Cut, Draft, Failure, Path, Splice, Vertex, end_on_light, extend, open_for_connection,
};
use crate::scene::Tracer;

/// A range of sizes, drawn log-uniformly: density `1 / (r ln(max / min))`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sizes {
    /// The smallest.
    pub min: f64,
    /// The largest.
    pub max: f64,
}

impl Sizes {
    /// Film displacements in pixels: from a tenth of a pixel to the radius of a disk that covers
    /// five per cent of the film.
    pub fn on_film(camera: &Camera) -> Self {
        let area = f64::from(camera.width) * f64::from(camera.height);
        let max = (0.05 * area / std::f64::consts::PI).sqrt();
        Self { min: 0.1 * max.min(1.0), max }
    }

    pub(super) fn draw(self, rng: &mut Rng) -> f64 {
        log_uniform(self.min, self.max, rng.uniform())
    }

    pub(super) fn contains(self, size: f64) -> bool {
        (self.min..=self.max).contains(&size)
    }

    /// `ln(max / min)`: what the density is divided by.
    pub(super) fn span(self) -> f64 {
        (self.max / self.min).ln()
    }
}

/// The film point at `radius` pixels from `film` in a random direction.
pub(super) fn displace(camera: &Camera, film: DVec2, radius: f64, rng: &mut Rng) -> DVec2 {
    let pixel = DVec2::new(1.0 / f64::from(camera.width), 1.0 / f64::from(camera.height));
    let (sin, cos) = (TAU * rng.uniform()).sin_cos();
    film + radius * DVec2::new(cos, sin) * pixel
}

/// The direction at the angle `theta` from `direction` with a random azimuth.
pub(super) fn turn(direction: DVec3, theta: f64, rng: &mut Rng) -> DVec3 {
    let (sin, cos) = (TAU * rng.uniform()).sin_cos();
    let (s, c) = theta.sin_cos();
    Frame::new(direction).to_world(DVec3::new(s * cos, s * sin, c))
}

/// Lets `at`, reached along `direction`, do again the Dirac `event` of the vertex it replaces.
pub(super) fn repeat(
    scene: &Tracer<'_>,
    at: &mut Vertex,
    direction: DVec3,
    old: &Vertex,
) -> Result<DVec3, Failure> {
    if at.is_lamp() {
        return Err(Failure::LeftScene);
    }
    let local = scene.local(&at.anchor(), at.material);
    let onward = local.specular_direction(-direction, old.event).ok_or(Failure::KindChanged)?;
    at.set_event(old.event);
    Ok(onward)
}

/// A walk from the lens.
#[derive(Clone, Copy, Debug)]
pub(super) struct LensWalk {
    /// The film point that it goes through.
    pub(super) film: DVec2,
    /// Index of the vertex that it goes down to.
    pub(super) end: usize,
}

/// Makes `y` of `x` by a walk from the lens through `film` down to vertex `end`.
///
/// Every mirror and glass does again what it did, and where a diffuse vertex lies on the way, the
/// walk leaves it in the direction that `leave` makes of the old one. Connects to vertex `end - 1`,
/// or ends on the light for `end = 0`.
pub(super) fn from_lens(
    scene: &Tracer<'_>,
    x: &Path,
    LensWalk { film, end }: LensWalk,
    draft: &mut Draft,
    y: &mut Path,
    mut leave: impl FnMut(DVec3) -> DVec3,
) -> Result<(), Failure> {
    if !((0.0..1.0).contains(&film.x) && (0.0..1.0).contains(&film.y)) {
        return Err(Failure::OffFilm);
    }
    let cut = Cut { light: end, eye_from: x.edge_count() };
    draft.open(cut);
    let mut at = x.vertices()[x.edge_count()];
    let mut direction = scene.camera().direction_from(at.position, film);
    for j in (end..x.edge_count()).rev() {
        at = extend(scene, &at, direction)?;
        let old = &x.vertices()[j];
        if old.event.is_specular() {
            let onward = repeat(scene, &mut at, direction, old);
            // Where it went wrong is a vertex to look at.
            direction = onward.inspect_err(|_| draft.eye.push(at))?;
        } else if j == 0 {
            end_on_light(scene, &mut at)?;
        } else {
            open_for_connection(scene, &mut at).or(Err(Failure::KindChanged))?;
            if j > end {
                direction = leave(-x.edges()[j - 1].direction);
            }
        }
        draft.eye.push(at);
    }
    let splice = Splice { base: x, cut, light: &[], eye: &draft.eye, film: Some(film) };
    y.connect(scene, &splice)
}

/// Density of the directions and probability of the events that a walk from the lens to vertex
/// `end` has drawn: what a perturbation, which repeats them, must not divide by.
pub(super) fn walk_pdf(x: &Path, end: usize) -> f64 {
    (end + 1..x.edge_count()).map(|j| x.scattering(j).eye_pdf).product()
}
