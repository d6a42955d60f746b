//! Random walks from either end.

use common::{Event, VertexKind};
use glam::DVec3;

use super::{Failure, Vertex, Vertices};
use crate::bsdf::Scatter as _;
use crate::math::{Frame, Rng, cosine_hemisphere};
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

/// A random point on a light as a vertex.
#[inline]
pub fn light_vertex(scene: &Tracer<'_>, rng: &mut Rng) -> Vertex {
    let sample = scene.sample_light(rng);
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

/// Draws what happens at `at`, which was reached from the unit direction `back`: sets its event
/// and returns the direction in which the walk goes on.
#[inline]
pub fn scatter(
    scene: &Tracer<'_>,
    at: &mut Vertex,
    back: DVec3,
    rng: &mut Rng,
) -> Result<DVec3, Failure> {
    let bsdf = scene.bsdf(at.material);
    let (direction, event) = bsdf.sample(at.normal, back, rng).ok_or(Failure::ZeroContribution)?;
    at.set_event(event);
    Ok(direction)
}

/// A direction of emission from the light vertex `at`, with density `cos / pi`.
#[inline]
pub fn emit(at: &Vertex, rng: &mut Rng) -> DVec3 {
    Frame::new(at.normal).to_world(cosine_hemisphere(rng.uniform(), rng.uniform()))
}

/// Walks from `start` in `direction` and appends exactly `count` vertices to `out`, in the order of
/// the walk. No Russian roulette; the event of the last vertex stays open.
#[inline]
pub(super) fn walk(
    scene: &Tracer<'_>,
    start: &Vertex,
    mut direction: DVec3,
    count: usize,
    rng: &mut Rng,
    out: &mut Vertices,
) -> Result<(), Failure> {
    let mut at = *start;
    for made in 1..=count {
        at = extend(scene, &at, direction)?;
        if made < count {
            direction = scatter(scene, &mut at, -direction, rng)?;
        }
        out.push(at);
    }
    Ok(())
}
