//! The multi-chain perturbation: a lens perturbation that goes on where a diffuse surface is itself
//! seen or lit through mirrors or glass [Veach and Guibas 1997, section 5.3].

use common::Camera;

use super::retrace::{LensWalk, Sizes, displace, from_lens, turn, walk_pdf};
use super::{Form, MixtureBasis, Mutation, Parameter, Tuning};
use crate::math::Rng;
use crate::path::{Draft, Failure, Kept, Path};
use crate::scene::{SceneFeatures, Tracer};

/// Displaces the film point, and turns the direction in which every further chain leaves.
#[derive(Clone, Copy, Debug)]
pub struct MultiChain {
    /// Displacement in pixels.
    pub radius: Sizes,
    /// Angle in radians by which a further chain's first direction is turned. The same for every
    /// state, so that it cancels from the ratio.
    pub angle: Sizes,
}

impl MultiChain {
    /// With displacements that suit the film, and the angles of the original.
    pub fn new(camera: &Camera) -> Self {
        let angle = Sizes { min: 0.0001_f64.to_radians(), max: 0.1_f64.to_radians() };
        Self { radius: Sizes::on_film(camera), angle }
    }
}

/// The vertex that the last chain from the lens ends at: the first one, seen from the lens, whose
/// neighbour towards the light it can be connected to; zero when the last chain ends on the light.
fn last_chain_end(x: &Path) -> usize {
    let diffuse = (1..x.edge_count()).rev().filter(|&j| x.is_connectable(j));
    diffuse.into_iter().find(|&j| x.is_connectable(j - 1)).unwrap_or(0)
}

impl Mutation for MultiChain {
    /// The vertex that the last chain ends at.
    type Move = usize;
    const NAME: &'static str = "multi-chain";
    const WEIGHT: f64 = 0.07;
    const PARAMETERS: &'static [Parameter] = &[
        Parameter::on_film("radius", "displacement of the film point, in pixels"),
        Parameter {
            name: "angle",
            about: "rotation of every further chain, in radians",
            form: Form::Sizes,
            lowest: 1e-9,
            highest: 3.0,
        },
    ];

    fn build(basis: &MixtureBasis<'_>, tuning: &Tuning) -> Self {
        let usual = Self::new(basis.camera);
        Self {
            radius: tuning.sizes("radius").unwrap_or(usual.radius),
            angle: tuning.sizes("angle").unwrap_or(usual.angle),
        }
    }

    fn is_possible(features: SceneFeatures) -> bool {
        features.specular
    }

    /// There must be at least two chains.
    fn applicable(&self, x: &Path) -> bool {
        let d = x.first_diffuse_from_eye();
        // A chain that ends on a light must be able to hit it.
        d >= 1 && !x.is_connectable(d - 1) && (x.reciprocal(0) > 0.0 || last_chain_end(x) > 0)
    }

    fn propose(
        &self,
        scene: &Tracer<'_>,
        x: &Path,
        rng: &mut Rng,
        draft: &mut Draft,
        y: &mut Path,
    ) -> Result<usize, Failure> {
        let end = last_chain_end(x);
        let film = displace(scene.camera(), x.film(), self.radius.draw(rng), rng);
        from_lens(scene, x, LensWalk { film, end }, draft, y, |direction| {
            turn(direction, self.angle.draw(rng), rng)
        })?;
        Ok(end)
    }

    /// In the measure film x solid angle at every further start of a chain the displacements are
    /// symmetric; the densities that a random walk would have had are not divided out.
    fn transition(&self, _: &Path, y: &Path, end: usize) -> f64 {
        y.reciprocal(end) / walk_pdf(y, end)
    }

    fn reverse(&self, end: usize) -> usize {
        end
    }

    fn kept(&self, _: &Path, end: usize) -> Kept {
        Kept { light: end, eye: 1 }
    }
}
