//! Path tracing with light sampling: one walk from the lens, which hits lights and is joined to
//! points on them, both weighted by the balance heuristic.
//!
//! The luminance of a weighted contribution is `1 / S_B`, with B the splits that hit and that join:
//! `S_B` is the sum of `p_i / lum f` over both, and the contribution is `f / (p_hit + p_join)`. So the
//! share that is the sampler's follows from the contribution itself, before roulette is made up for.

use common::Rgb;
use glam::DVec3;

use crate::path::{CameraSample, Numbers, ROW, Strand, Vertex, extend, light_vertex};
use crate::scene::Tracer;
use crate::target::Selective;

/// Edges that every walk gets before Russian roulette begins.
const SURE_EDGES: usize = 4;

/// The light that arrives along the ray `aim` and is left to the sampler.
pub(super) fn sample(
    scene: &Tracer<'_>,
    aim: &CameraSample,
    selective: Selective,
    numbers: &mut impl Numbers,
) -> Rgb {
    let mut sum = Rgb::BLACK;
    terms(scene, aim, numbers, |term| {
        sum += term.contribution
            * (selective.base_share(term.density_sum(), term.edges) / term.survival);
    });
    sum
}

/// What a walk contributes by one path.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Term {
    /// Weighted by the balance heuristic, but not for roulette; not black.
    pub(crate) contribution: Rgb,
    /// The odds that roulette let the walk come so far.
    pub(crate) survival: f64,
    /// Edges of the path.
    pub(crate) edges: usize,
}

impl Term {
    /// `S_B` of the path.
    #[inline]
    pub(crate) fn density_sum(&self) -> f64 {
        1.0 / self.contribution.luminance()
    }
}

/// Calls `visit` with every contribution of a walk.
pub(crate) fn terms(
    scene: &Tracer<'_>,
    aim: &CameraSample,
    numbers: &mut impl Numbers,
    mut visit: impl FnMut(Term),
) {
    let mut tell = |contribution: Rgb, survival, edges| {
        if contribution.luminance() > 0.0 {
            visit(Term { contribution, survival, edges });
        }
    };
    let mut direction = aim.direction(scene);
    let mut at = aim.lens;
    let (mut throughput, mut survival) = (Rgb::WHITE, 1.0);
    // Density per solid angle with which the walk took its direction; infinite where no point on a
    // light could have been joined instead.
    let mut density = f64::INFINITY;
    for edges in 1..=scene.max_edges() {
        let Ok(mut next) = extend(scene, &at, direction) else { return };
        if let Some(emitted) = hit(scene, &at, &next, direction, density) {
            tell(throughput * emitted, survival, edges);
        }
        if edges == scene.max_edges() || next.is_lamp() {
            return;
        }
        let back = -direction;
        let local = scene.local(&next.anchor(), next.material);
        if local.bsdf().connectable().is_some() {
            let lamp = light_vertex(scene, numbers.row(Strand::Connection, edges));
            if let Some(joined) = join(scene, &next, back, &lamp) {
                tell(throughput * joined, survival, edges + 1);
            }
        }
        let [u @ .., roulette] = numbers.row::<ROW>(Strand::Eye, edges);
        if edges >= SURE_EDGES {
            let odds = local.bsdf().albedo().clamp(0.1, 0.95);
            if roulette >= odds {
                return;
            }
            survival *= odds;
        }
        let Some((onward, event)) = local.sample(back, u) else { return };
        let Some(scattering) = local.evaluate(onward, back, event) else { return };
        next.set_event(event);
        throughput *= scattering.color * scattering.eye_weight;
        density = if event.is_specular() { f64::INFINITY } else { scattering.eye_pdf };
        direction = onward;
        at = next;
    }
}

/// Light that `hit` emits towards `from`, weighted against joining a point there.
fn hit(
    scene: &Tracer<'_>,
    from: &Vertex,
    hit: &Vertex,
    direction: DVec3,
    density: f64,
) -> Option<Rgb> {
    let emission = scene.emission(hit.primitive, hit.material, -direction)?;
    let cosine = -hit.normal.dot(direction);
    if !(cosine > 0.0) {
        return None;
    }
    // Of joining this very point, per solid angle at `from`.
    let joining = if hit.is_lamp() {
        emission.pdf
    } else {
        emission.pdf * (hit.position - from.position).length_squared() / cosine
    };
    let weight = if density.is_finite() { density / (density + joining) } else { 1.0 };
    Some(emission.color * weight)
}

/// Light of the start `lamp` that `at` scatters towards `back`, weighted against hitting it.
fn join(scene: &Tracer<'_>, at: &Vertex, back: DVec3, lamp: &Vertex) -> Option<Rgb> {
    let is_far = lamp.is_lamp() && scene.is_infinite(lamp.material);
    let from = if is_far { scene.far_from(at.position, -lamp.normal) } else { lamp.anchor() };
    let span = from.position - at.position;
    let distance_squared = span.length_squared();
    let reach = scene.reach(lamp.primitive, at.primitive);
    if !(distance_squared > reach * reach) {
        return None;
    }
    let towards = if is_far { -lamp.normal } else { span / distance_squared.sqrt() };
    let emission = scene.emission(lamp.primitive, lamp.material, -towards)?;
    // Solid angle at `at` for each unit of the measure of starts.
    let solid_angle = match (is_far, lamp.is_lamp()) {
        (true, _) => 1.0,
        (false, true) => 1.0 / distance_squared,
        (false, false) => -lamp.normal.dot(towards) / distance_squared,
    };
    if !(solid_angle > 0.0) {
        return None;
    }
    let local = scene.local(&at.anchor(), at.material);
    let scattering = local.evaluate(towards, back, local.bsdf().connectable()?)?;
    if !scene.visible(&from, &at.anchor()) {
        return None;
    }
    let joining = emission.pdf / solid_angle;
    let hitting = if emission.hittable { scattering.eye_pdf } else { 0.0 };
    let cosine = at.normal.dot(towards).abs();
    let value = scattering.connection * emission.connection * cosine / (joining + hitting);
    Some(scattering.color * emission.color * value)
}
