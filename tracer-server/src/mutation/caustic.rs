//! The caustic perturbation [Veach and Guibas 1997, section 5.3].
//!
//! It turns the direction in which light leaves for the lens a little, and lets it follow, through
//! mirrors and glass, to the surface that the lens sees.

use common::Camera;
use std::f64::consts::FRAC_1_PI;

use super::retrace::{Sizes, repeat, turn};
use super::{MixtureBasis, Mutation, Parameter, Tuning};
use crate::math::Rng;
use crate::path::{Cut, Draft, Failure, Kept, Path, Splice, extend, open_for_connection};
use crate::scene::Tracer;

/// Turns the direction of the last chain from the light by a log-uniform angle.
#[derive(Clone, Copy, Debug)]
pub struct CausticPerturbation {
    /// Wanted displacement on the film, in pixels.
    pub radius: Sizes,
    /// Radians that a pixel spans.
    pub radians_per_pixel: f64,
}

/// A drawn turn.
#[derive(Clone, Copy, Debug)]
pub struct Turn {
    /// Index of the vertex whose direction was turned.
    pub start: usize,
    /// Angle in radians. Carried along: two rounded directions would no longer tell it.
    pub theta: f64,
}

impl CausticPerturbation {
    /// With displacements that suit the film.
    pub fn new(camera: &Camera) -> Self {
        let radians_per_pixel = 2.0 * camera.tan_y.atan() / f64::from(camera.height);
        Self { radius: Sizes::on_film(camera), radians_per_pixel }
    }

    /// Angles that move the image of `x` by about the wanted radii: they shrink with the length of
    /// the chain from the light and grow with the distance to the lens.
    pub(super) fn angles(&self, x: &Path, start: usize) -> Sizes {
        let v = x.vertices();
        let k = x.edge_count();
        let length = |j: usize| (v[j + 1].position - v[j].position).length();
        let chain: f64 = (start..k - 1).map(length).sum();
        let scale = self.radians_per_pixel * length(k - 1) / chain;
        let max = (self.radius.max * scale).min(1.0);
        Sizes { min: (self.radius.min * scale).min(0.1 * max), max }
    }
}

/// The vertex that the last chain from the light starts at: the next one below the vertex before
/// the lens that is not specular.
fn chain_start(x: &Path) -> usize {
    (0..x.edge_count() - 1).rev().find(|&j| x.is_connectable(j)).unwrap_or(0)
}

/// Density of the directions and probability of the events that a walk from vertex `start` to the
/// vertex before the lens has drawn.
pub(super) fn chain_pdf(x: &Path, start: usize) -> f64 {
    let drawn = |j: usize| match j {
        // Directions of points and spots have a constant density, which cancels.
        0 if x.vertices()[0].is_lamp() => 1.0,
        0 => x.vertices()[0].normal.dot(x.edges()[0].direction) * FRAC_1_PI,
        _ => x.scattering(j).light_pdf,
    };
    (start..x.edge_count() - 1).map(drawn).product()
}

impl Mutation for CausticPerturbation {
    type Move = Turn;
    const NAME: &'static str = "caustic";
    const WEIGHT: f64 = 0.1;
    const PARAMETERS: &'static [Parameter] =
        &[Parameter::on_film("radius", "intended displacement of the image, in pixels")];

    fn build(basis: &MixtureBasis<'_>, tuning: &Tuning) -> Self {
        let usual = Self::new(basis.camera);
        Self { radius: tuning.sizes("radius").unwrap_or(usual.radius), ..usual }
    }

    fn applicable(&self, x: &Path) -> bool {
        let k = x.edge_count();
        // The direction of an infinite light is its start: there is nothing to turn.
        k >= 2 && x.is_connectable(k - 1) && !(x.is_lit_from_afar() && chain_start(x) == 0)
    }

    fn propose(
        &self,
        scene: &Tracer<'_>,
        x: &Path,
        rng: &mut Rng,
        draft: &mut Draft,
        y: &mut Path,
    ) -> Result<Turn, Failure> {
        let (k, start) = (x.edge_count(), chain_start(x));
        let theta = self.angles(x, start).draw(rng);
        let mut direction = turn(x.edges()[start].direction, theta, rng);
        let cut = Cut { light: start + 1, eye_from: k };
        draft.open(cut);
        let mut at = x.vertices()[start];
        for j in start + 1..k {
            at = extend(scene, &at, direction)?;
            if j + 1 < k {
                let onward = repeat(scene, &mut at, direction, &x.vertices()[j]);
                // Where it went wrong is a vertex to look at.
                direction = onward.inspect_err(|_| draft.light.push(at))?;
            } else {
                open_for_connection(scene, &mut at).or(Err(Failure::KindChanged))?;
            }
            draft.light.push(at);
        }
        let splice = Splice { base: x, cut, light: &draft.light, eye: &[], film: None };
        y.connect(scene, &splice)?;
        Ok(Turn { start, theta })
    }

    /// In solid angle at the start the turn has the density `1 / (2 pi theta sin theta ln)` both
    /// ways, but its range depends on the state: an angle that `y` would never draw cannot be
    /// undone.
    fn transition(&self, x: &Path, y: &Path, via: Turn) -> f64 {
        let angles = self.angles(x, via.start);
        if !angles.contains(via.theta) {
            return 0.0;
        }
        y.reciprocal(y.edge_count()) / (chain_pdf(y, via.start) * angles.span())
    }

    fn reverse(&self, via: Turn) -> Turn {
        via
    }

    fn kept(&self, _: &Path, via: Turn) -> Kept {
        Kept { light: via.start + 1, eye: 1 }
    }
}
