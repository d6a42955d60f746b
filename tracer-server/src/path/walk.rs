//! Random walks from either end.

use common::{Event, VertexKind};
use glam::{DVec2, DVec3};

use super::{Failure, Numbers, Strand, Vertex, Vertices};
use crate::scene::{NO_PRIMITIVE, Tracer};

/// Where a walk from the lens begins: the film point, and the vertex on the lens.
#[derive(Clone, Copy, Debug)]
pub struct CameraSample {
    /// The film point, `u` to the right and `v` downwards, both in [0, 1).
    pub film: DVec2,
    /// The vertex on the lens.
    pub lens: Vertex,
}

impl CameraSample {
    /// Through `film`; `numbers` are asked for the lens point where the lens has an area.
    #[inline]
    pub fn through(scene: &Tracer<'_>, film: DVec2, numbers: impl FnOnce() -> [f64; 2]) -> Self {
        Self { film, lens: lens_vertex(scene, numbers) }
    }

    /// Film and lens point from the first row of numbers of a walk from the lens.
    #[inline]
    pub fn from_numbers(scene: &Tracer<'_>, numbers: &mut impl Numbers) -> Self {
        if scene.camera().has_aperture() {
            let [x, y, u, v] = numbers.row(Strand::Eye, 0);
            return Self::through(scene, DVec2::new(x, y), || [u, v]);
        }
        Self::through(scene, DVec2::from(numbers.row(Strand::Eye, 0)), || [0.0; 2])
    }

    /// Unit direction in which the walk begins.
    #[inline]
    pub fn direction(&self, scene: &Tracer<'_>) -> DVec3 {
        scene.camera().direction_from(self.lens.position, self.film)
    }
}

/// A vertex on the lens; `numbers` are asked for its place where the lens has an area.
#[inline]
pub fn lens_vertex(scene: &Tracer<'_>, numbers: impl FnOnce() -> [f64; 2]) -> Vertex {
    let camera = scene.camera();
    let position = if camera.has_aperture() { camera.lens_point(numbers()) } else { camera.origin };
    Vertex {
        position,
        normal: camera.forward,
        primitive: NO_PRIMITIVE,
        material: 0,
        kind: VertexKind::Eye,
        event: Event::End,
    }
}

/// The start of a path that [`crate::scene::Scene::sample_light`] makes of `u`, as a vertex.
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

/// The first surface from `at` in the unit `direction`, as a vertex with its event still open; or
/// the environment, which scatters nothing.
#[inline]
pub fn extend(scene: &Tracer<'_>, at: &Vertex, direction: DVec3) -> Result<Vertex, Failure> {
    match scene.closest(&at.anchor(), direction) {
        Some(hit) => Ok(Vertex::on_surface(&hit, scene.material_of(hit.primitive))),
        None => sky_vertex(scene, at, direction),
    }
}

/// The environment, seen from `at` in the unit `direction`.
#[cold]
fn sky_vertex(scene: &Tracer<'_>, at: &Vertex, direction: DVec3) -> Result<Vertex, Failure> {
    let material = scene.sky().ok_or(Failure::LeftScene)?;
    let far = scene.far_from(at.position, direction);
    Ok(Vertex {
        position: far.position,
        normal: far.normal,
        primitive: NO_PRIMITIVE,
        material,
        kind: VertexKind::Light,
        event: Event::End,
    })
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
    if at.is_lamp() {
        return Err(Failure::LeftScene);
    }
    let local = scene.local(&at.anchor(), at.material);
    let (direction, event) = local.sample(back, u).ok_or(Failure::ZeroContribution)?;
    at.set_event(event);
    Ok(direction)
}

/// A ray of light from the light vertex `at`: where it begins, and its unit direction. See
/// [`crate::scene::Scene::emit`].
#[inline]
pub fn emit(scene: &Tracer<'_>, at: &Vertex, u: [f64; 2]) -> (Vertex, DVec3) {
    let (anchor, direction) = scene.emit(&at.light_sample(), u);
    (Vertex { position: anchor.position, ..*at }, direction)
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
