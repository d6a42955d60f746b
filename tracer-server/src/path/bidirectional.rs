//! Bidirectional path tracing as a source of weighted paths [Veach and Guibas 1995].

use arrayvec::ArrayVec;
use glam::DVec2;

use super::resample::{end_on_light, open_for_connection};
use super::walk::{CameraSample, emit, extend, light_vertex, scatter};
use super::{Cut, MAX_VERTICES, Numbers, Path, ROW, Splice, Strand, Vertex, Vertices};
use crate::scene::Tracer;

/// Vertices of a subpath that are made before Russian roulette begins.
const SURE_VERTICES: usize = 3;

/// A subpath and how likely Russian roulette lets it come to each of its vertices.
#[derive(Clone, Debug, Default)]
struct Subpath {
    vertices: Vertices,
    survival: ArrayVec<f64, MAX_VERTICES>,
}

/// Draws bidirectional samples; holds the room for them.
#[derive(Clone, Debug)]
pub struct BidirectionalSampler {
    /// Only the vertex on the lens.
    lens: Path,
    light: Subpath,
    eye: Subpath,
    path: Path,
}

impl Subpath {
    fn clear(&mut self) {
        self.vertices.clear();
        self.survival.clear();
    }

    fn push(&mut self, vertex: Vertex, survival: f64) {
        self.vertices.push(vertex);
        self.survival.push(survival);
    }

    /// Walks on from `from` in `direction` until it is lost, absorbed or `limit` vertices long.
    /// `numbers` gives the numbers of scattering and of Russian roulette for vertex 1, 2, ...
    fn grow(
        &mut self,
        scene: &Tracer<'_>,
        from: &Vertex,
        mut direction: glam::DVec3,
        limit: usize,
        mut numbers: impl FnMut(usize) -> [f64; ROW],
    ) {
        let mut at = *from;
        let mut survival = 1.0;
        for made in 1.. {
            if self.vertices.len() >= limit {
                return;
            }
            let Ok(next) = extend(scene, &at, direction) else { return };
            self.push(next, survival);
            if next.is_lamp() {
                return;
            }
            let last = self.vertices.len() - 1;
            let [u @ .., roulette] = numbers(made);
            if last + 1 >= SURE_VERTICES {
                let chance = scene.bsdf(next.material).albedo().clamp(0.1, 1.0);
                if roulette >= chance {
                    return;
                }
                survival *= chance;
            }
            match scatter(scene, &mut self.vertices[last], -direction, u) {
                Ok(next_direction) => direction = next_direction,
                Err(_) => return,
            }
            at = next;
        }
    }

    /// Opens the last of the first `count` vertices for a connection; returns what it was before, or
    /// `None`, with nothing changed, when it cannot be connected.
    #[inline]
    fn open_end(&mut self, scene: &Tracer<'_>, count: usize) -> Option<Vertex> {
        let end = &mut self.vertices[count - 1];
        let before = *end;
        if open_for_connection(scene, end).is_err() {
            *end = before;
            return None;
        }
        Some(before)
    }
}

impl BidirectionalSampler {
    /// A sampler for `scene`.
    pub fn new(scene: &Tracer<'_>) -> Self {
        Self {
            lens: Path::at_lens(scene),
            light: Subpath::default(),
            eye: Subpath::default(),
            path: Path::default(),
        }
    }

    /// Draws one sample whose eye walk begins with `aim` and calls `visit` with every complete path
    /// in it and the path's weight.
    ///
    /// The sum of `weight * h(path) * path.unit_color()` over the paths has the expectation
    /// `integral f h` for any function `h`: the weight is the balance-heuristic contribution
    /// `1 / S(path)`, divided by the odds of Russian roulette.
    pub fn sample(
        &mut self,
        scene: &Tracer<'_>,
        aim: CameraSample,
        numbers: &mut impl Numbers,
        mut visit: impl FnMut(&Path, f64),
    ) {
        let limit = scene.max_edges();
        self.light.clear();
        self.eye.clear();
        let CameraSample { film, lens } = aim;
        self.lens.move_lens(lens);
        self.eye.grow(scene, &lens, aim.direction(scene), limit, |j| {
            numbers.row(Strand::Eye, Strand::Eye.scattering_row(j))
        });
        let lamp = light_vertex(scene, numbers.row(Strand::Light, 0));
        let (from, direction) = emit(scene, &lamp, numbers.row(Strand::Light, 1));
        self.light.push(lamp, 1.0);
        self.light.grow(scene, &from, direction, limit, |j| {
            numbers.row(Strand::Light, Strand::Light.scattering_row(j))
        });

        for eye in 0..=self.eye.vertices.len() {
            if eye > 0 && self.hit_light(scene, eye, film) {
                let survival = self.eye.survival[eye - 1];
                visit(&self.path, 1.0 / (self.path.density_sum() * survival));
            }
            self.connect(scene, eye, film, &mut visit);
        }
    }

    /// Makes the path whose eye walk has hit a light at its vertex number `count`.
    fn hit_light(&mut self, scene: &Tracer<'_>, count: usize, film: DVec2) -> bool {
        let saved = self.eye.vertices[count - 1];
        if end_on_light(scene, &mut self.eye.vertices[count - 1]).is_err() {
            return false;
        }
        let splice = Splice {
            base: &self.lens,
            cut: Cut { light: 0, eye_from: 0 },
            light: &[],
            eye: &self.eye.vertices[..count],
            film: Some(film),
        };
        let made = self.path.splice(scene, &splice).is_ok();
        self.eye.vertices[count - 1] = saved;
        made
    }

    /// Joins the first `eye` vertices of the eye walk to every prefix of the light walk.
    fn connect(
        &mut self,
        scene: &Tracer<'_>,
        eye: usize,
        film: DVec2,
        visit: &mut impl FnMut(&Path, f64),
    ) {
        let mut closed_eye = None;
        if eye > 0 {
            closed_eye = self.eye.open_end(scene, eye);
            if closed_eye.is_none() {
                return;
            }
        }
        // The lens, `eye` vertices and `light` vertices make `eye + light` edges.
        let most = self.light.vertices.len().min(scene.max_edges() - eye);
        for light in 1..=most {
            // The start of the path needs no opening.
            let mut closed_light = None;
            if light > 1 {
                closed_light = self.light.open_end(scene, light);
                if closed_light.is_none() {
                    continue;
                }
            }
            let drawn = (eye > 0).then_some(film);
            if self.join(scene, light, eye, drawn) {
                let eye_survival = if eye > 0 { self.eye.survival[eye - 1] } else { 1.0 };
                let survival = eye_survival * self.light.survival[light - 1];
                visit(&self.path, 1.0 / (self.path.density_sum() * survival));
            }
            if let Some(before) = closed_light {
                self.light.vertices[light - 1] = before;
            }
        }
        if let Some(before) = closed_eye {
            self.eye.vertices[eye - 1] = before;
        }
    }

    /// Makes the path of the first `light` vertices and the first `eye` vertices, whose ends are
    /// open; false when it carries no light.
    fn join(&mut self, scene: &Tracer<'_>, light: usize, eye: usize, film: Option<DVec2>) -> bool {
        let splice = Splice {
            base: &self.lens,
            cut: Cut { light: 0, eye_from: 0 },
            light: &self.light.vertices[..light],
            eye: &self.eye.vertices[..eye],
            film,
        };
        self.path.connect(scene, &splice).is_ok()
    }
}
