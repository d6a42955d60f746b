//! The lens subpath mutation: a fresh view ray, followed through mirrors and glass to the first
//! diffuse surface, joined to the light side of the path [Veach and Guibas 1997, section 5.4].

use common::Event;
use glam::{DVec2, DVec3};

use super::{MixtureBasis, Mutation, Tuning};
use crate::bsdf::Local;
use crate::math::Rng;
use crate::path::{
    CameraSample, Cut, Draft, Failure, Kept, Path, Splice, Vertex, extend, open_for_connection,
    scatter,
};
use crate::scene::Tracer;

/// Replaces everything between the lens and the first diffuse vertex.
#[derive(Clone, Copy, Debug)]
pub struct LensSubpath {
    /// Longest path it may make, in edges.
    pub max_edges: usize,
    /// The lens has an area, over which its point is drawn anew.
    pub aperture: bool,
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

/// A fresh lens subpath.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fresh {
    /// Index of the first diffuse vertex seen from the lens: the same before and after.
    pub diffuse: usize,
    /// Probability that the walk that made the new path stopped at that vertex: a coat might have
    /// mirrored it instead.
    pub stopped: f64,
    /// The same for the old path.
    pub stopped_before: f64,
}

/// The Dirac events that may send on a walk that arrives at a connectable vertex from `back`, with
/// their directions and probabilities.
fn sent_on<'a>(
    local: &'a Local<'_>,
    back: DVec3,
) -> impl Iterator<Item = (Event, DVec3, f64)> + 'a {
    let possible = local.bsdf().has_dirac_lobe();
    let events = [Event::Reflect, Event::Transmit].into_iter().filter(move |_| possible);
    events.filter_map(move |event| {
        let onward = local.specular_direction(back, event)?;
        Some((event, onward, local.evaluate(onward, back, event)?.eye_pdf))
    })
}

/// Draws whether a coat sends the walk on.
fn send_on(scene: &Tracer<'_>, at: &Vertex, back: DVec3, rng: &mut Rng) -> Option<(Event, DVec3)> {
    let local = scene.local(&at.anchor(), at.material);
    if !local.bsdf().has_dirac_lobe() {
        return None;
    }
    let mut u = rng.uniform();
    let chosen = sent_on(&local, back).find(|&(.., probability)| {
        u -= probability;
        u < 0.0
    });
    chosen.map(|(event, onward, _)| (event, onward))
}

/// Probability that a walk that arrives at `at` from `back` is not sent on by a Dirac event.
fn stopping(scene: &Tracer<'_>, at: &Vertex, back: DVec3) -> f64 {
    let local = scene.local(&at.anchor(), at.material);
    1.0 - sent_on(&local, back).map(|(.., probability)| probability).sum::<f64>()
}

impl Mutation for LensSubpath {
    type Move = Fresh;
    const NAME: &'static str = "lens subpath";
    const WEIGHT: f64 = 0.05;

    fn build(basis: &MixtureBasis<'_>, _tuning: &Tuning) -> Self {
        Self { max_edges: basis.max_edges, aperture: basis.camera.has_aperture() }
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
    ) -> Result<Fresh, Failure> {
        let d = x.first_diffuse_from_eye();
        let film = Self::film_point(x.film(), draft, rng);
        let cut = Cut { light: d, eye_from: x.edge_count() + usize::from(self.aperture) };
        draft.open(cut);
        let aim = if self.aperture {
            let aim = CameraSample::through(scene, film, || rng.array());
            draft.eye.push(aim.lens);
            aim
        } else {
            CameraSample { film, lens: x.vertices()[x.edge_count()] }
        };
        let (mut at, mut direction) = (aim.lens, aim.direction(scene));
        for edges in d + 1.. {
            at = extend(scene, &at, direction)?;
            // `d` edges up to the first vertex, and one for each vertex of the walk.
            if edges > self.max_edges {
                return Err(Failure::LengthOutOfRange);
            }
            if at.is_lamp() {
                return Err(Failure::LeftScene);
            }
            if scene.bsdf(at.material).connectable().is_none() {
                direction = scatter(scene, &mut at, -direction, rng.array())?;
            } else if let Some((event, onward)) = send_on(scene, &at, -direction, rng) {
                at.set_event(event);
                direction = onward;
            } else {
                open_for_connection(scene, &mut at)?;
                draft.eye.push(at);
                break;
            }
            draft.eye.push(at);
        }
        let stopped = stopping(scene, &at, -direction);
        let stopped_before = stopping(scene, &x.vertices()[d], x.edges()[d].direction);
        let splice = Splice { base: x, cut, light: &[], eye: &draft.eye, film: Some(film) };
        y.connect(scene, &splice)?;
        Ok(Fresh { diffuse: d, stopped, stopped_before })
    }

    /// The events are drawn anew, so their probabilities are divided out: `lum C_l`.
    fn transition(&self, _: &Path, y: &Path, via: Fresh) -> f64 {
        y.reciprocal(via.diffuse) * via.stopped
    }

    fn reverse(&self, via: Fresh) -> Fresh {
        Fresh { stopped: via.stopped_before, stopped_before: via.stopped, ..via }
    }

    fn kept(&self, _: &Path, via: Fresh) -> Kept {
        Kept { light: via.diffuse, eye: usize::from(!self.aperture) }
    }
}
