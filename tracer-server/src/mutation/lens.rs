//! The lens perturbation: move the film point a little and let the view ray follow, through mirrors
//! and glass, to the first diffuse surface [Veach and Guibas 1997, section 5.3].

use common::Camera;

use super::retrace::{LensWalk, Sizes, displace, from_lens, walk_pdf};
use super::{MixtureBasis, Mutation, Parameter, Tuning};
use crate::math::Rng;
use crate::path::{Draft, Failure, Kept, Path};
use crate::scene::Tracer;

/// Displaces the film point by a log-uniform radius in a uniform direction.
#[derive(Clone, Copy, Debug)]
pub struct LensPerturbation {
    /// Displacement in pixels.
    pub radius: Sizes,
}

impl LensPerturbation {
    /// With displacements that suit the film.
    pub fn new(camera: &Camera) -> Self {
        Self { radius: Sizes::on_film(camera) }
    }
}

impl Mutation for LensPerturbation {
    /// Index of the first diffuse vertex seen from the lens: `d`.
    type Move = usize;
    const NAME: &'static str = "lens";
    const WEIGHT: f64 = 0.2;
    const PARAMETERS: &'static [Parameter] =
        &[Parameter::on_film("radius", "displacement of the film point, in pixels")];

    fn build(basis: &MixtureBasis<'_>, tuning: &Tuning) -> Self {
        let usual = Self::new(basis.camera);
        Self { radius: tuning.sizes("radius").unwrap_or(usual.radius) }
    }

    /// The vertex behind the first diffuse one must be connectable, unless the light itself is seen.
    fn applicable(&self, x: &Path) -> bool {
        let d = x.first_diffuse_from_eye();
        d == 0 || x.is_connectable(d - 1)
    }

    fn propose(
        &self,
        scene: &Tracer<'_>,
        x: &Path,
        rng: &mut Rng,
        draft: &mut Draft,
        y: &mut Path,
    ) -> Result<usize, Failure> {
        let d = x.first_diffuse_from_eye();
        let film = displace(scene.camera(), x.film(), self.radius.draw(rng), rng);
        from_lens(scene, x, LensWalk { film, end: d }, draft, y, |direction| direction)?;
        Ok(d)
    }

    /// The displacement is symmetric in film measure, and in film measure the value of a path is
    /// `E_l = lum C_l` with the probabilities of its events *not* divided out: the events are
    /// repeated, not drawn.
    fn transition(&self, _: &Path, y: &Path, d: usize) -> f64 {
        y.reciprocal(d) / walk_pdf(y, d)
    }

    fn reverse(&self, d: usize) -> usize {
        d
    }

    fn kept(&self, _: &Path, d: usize) -> Kept {
        Kept { light: d, eye: 1 }
    }
}
