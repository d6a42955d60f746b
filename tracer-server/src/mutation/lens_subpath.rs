//! The lens subpath mutation: a fresh view ray, followed through mirrors and glass to the first
//! diffuse surface, joined to the light side of the path [Veach and Guibas 1997, section 5.4].

use glam::DVec2;

use super::{MixtureBasis, Mutation, Tuning};
use crate::bsdf::Scatter as _;
use crate::math::Rng;
use crate::path::{
    Draft, Failure, Path, Splice, camera_vertex, extend, open_for_connection, scatter,
};
use crate::scene::Tracer;

/// Replaces everything between the lens and the first diffuse vertex.
#[derive(Clone, Copy, Debug)]
pub struct LensSubpath {
    /// Longest path it may make, in edges.
    pub max_edges: usize,
}

/// The displacement number `n` of an evenly spread sequence on the unit square: multiples of the
/// reciprocal of the plastic number and of its square [Roberts 2018].
fn displacement(n: u64) -> DVec2 {
    const PLASTIC: f64 = 1.324_717_957_244_746;
    let n = (n % (1 << 40)) as f64;
    DVec2::new((n / PLASTIC).fract(), (n / (PLASTIC * PLASTIC)).fract())
}

impl LensSubpath {
    /// The film point of the next proposal. The displacement is fixed beforehand and only its sign
    /// is drawn, so every step is symmetric, and successive proposals cover the film evenly.
    fn film_point(film: DVec2, draft: &mut Draft, rng: &mut Rng) -> DVec2 {
        draft.displacements += 1;
        let sign = if rng.uniform() < 0.5 { 1.0 } else { -1.0 };
        let wrapped = film + sign * displacement(draft.displacements);
        let wrapped = wrapped - wrapped.floor();
        // Rounding can reach the far border, which belongs to the near one.
        wrapped.map(|c| if c < 1.0 { c } else { 0.0 })
    }
}

impl Mutation for LensSubpath {
    /// Index of the first diffuse vertex seen from the lens: the same before and after.
    type Move = usize;
    const NAME: &'static str = "lens subpath";
    const WEIGHT: f64 = 0.05;

    fn build(basis: &MixtureBasis<'_>, _tuning: &Tuning) -> Self {
        Self { max_edges: basis.max_edges }
    }

    fn applicable(&self, x: &Path) -> bool {
        let d = x.first_diffuse_from_eye();
        d >= 1 && x.is_connectable(d - 1)
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
        let film = Self::film_point(x.film(), draft, rng);
        draft.clear();
        let mut direction = scene.camera().direction(film);
        let mut at = camera_vertex(scene);
        loop {
            at = extend(scene, &at, direction)?;
            // `d` edges up to this vertex, one for each vertex of the walk.
            if d + draft.eye.len() + 1 > self.max_edges {
                return Err(Failure::LengthOutOfRange);
            }
            if scene.bsdf(at.material).connectable().is_some() {
                open_for_connection(scene, &mut at)?;
                draft.eye.push(at);
                break;
            }
            direction = scatter(scene, &mut at, -direction, rng.array())?;
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
        y.connect(scene, &splice)?;
        Ok(d)
    }

    /// The events are drawn anew, so their probabilities are divided out: `lum C_l`.
    fn transition(&self, _: &Path, y: &Path, d: usize) -> f64 {
        y.reciprocal(d)
    }

    fn reverse(&self, d: usize) -> usize {
        d
    }

    fn kept(&self, _: &Path, d: usize) -> (usize, usize) {
        (d, 1)
    }
}
