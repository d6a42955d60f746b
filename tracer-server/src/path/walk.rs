//! Random walks from either end.

use common::{Event, VertexKind};
use glam::DVec3;

use super::{Failure, Vertex, Vertices};
use crate::bsdf::Scatter as _;
use crate::math::{Frame, cosine_hemisphere, invert_cosine_hemisphere};
use crate::scene::{NO_PRIMITIVE, Tracer};

/// The lens as a vertex.
#[inline]
pub fn camera_vertex(scene: &Tracer<'_>) -> Vertex {
    let camera = scene.camera();
    Vertex {
        position: camera.origin,
        normal: camera.forward,
        primitive: NO_PRIMITIVE,
        material: 0,
        kind: VertexKind::Eye,
        event: Event::End,
    }
}

/// The point on a light that [`crate::scene::Scene::sample_light`] makes of `u`, as a vertex.
#[inline]
pub fn light_vertex(scene: &Tracer<'_>, u: [f64; 3]) -> Vertex {
    let sample = scene.sample_light(u);
    Vertex {
        position: sample.anchor.position,
        normal: sample.anchor.normal,
        primitive: sample.anchor.primitive,
        material: sample.material,
        kind: VertexKind::Light,
        event: Event::End,
    }
}

/// The first surface from `at` in the unit `direction`, as a vertex with its event still open.
#[inline]
pub fn extend(scene: &Tracer<'_>, at: &Vertex, direction: DVec3) -> Result<Vertex, Failure> {
    let hit = scene.closest(&at.anchor(), direction).ok_or(Failure::LeftScene)?;
    Ok(Vertex::on_surface(&hit, scene.material_of(hit.primitive)))
}

/// Makes of the numbers `u` what happens at `at`, which was reached from the unit direction `back`:
/// sets its event and returns the direction in which the walk goes on.
#[inline]
pub fn scatter(
    scene: &Tracer<'_>,
    at: &mut Vertex,
    back: DVec3,
    u: [f64; 3],
) -> Result<DVec3, Failure> {
    let bsdf = scene.bsdf(at.material);
    let (direction, event) = bsdf.sample(at.normal, back, u).ok_or(Failure::ZeroContribution)?;
    at.set_event(event);
    Ok(direction)
}

/// A direction of emission from the light vertex `at`, with density `cos / pi`.
#[inline]
pub fn emit(at: &Vertex, [u, v]: [f64; 2]) -> DVec3 {
    Frame::new(at.normal).to_world(cosine_hemisphere(u, v))
}

/// The numbers from which [`emit`] makes `direction`.
pub fn invert_emission(at: &Vertex, direction: DVec3) -> [f64; 2] {
    invert_cosine_hemisphere(Frame::new(at.normal).to_local(direction))
}

/// Walks from `start` in `direction` and appends exactly `count` vertices to `out`, in the order of
/// the walk.
///
/// No Russian roulette; the event of the last vertex stays open. `scattering` gives the numbers for
/// the vertex number 1, 2, ... of the walk.
#[inline]
pub(super) fn walk(
    scene: &Tracer<'_>,
    start: &Vertex,
    mut direction: DVec3,
    count: usize,
    mut scattering: impl FnMut(usize) -> [f64; 3],
    out: &mut Vertices,
) -> Result<(), Failure> {
    let mut at = *start;
    for made in 1..=count {
        at = extend(scene, &at, direction)?;
        if made < count {
            direction = scatter(scene, &mut at, -direction, scattering(made))?;
        }
        out.push(at);
    }
    Ok(())
}
