//! Bidirectional path tracing as a source of weighted paths [Veach and Guibas 1995].

use arrayvec::ArrayVec;
use glam::DVec2;

use super::resample::{end_on_light, open_for_connection};
use super::walk::{Aim, emit, extend, light_vertex, scatter};
use super::{MAX_VERTICES, Numbers, Path, ROW, Splice, Strand, Vertex, Vertices};
use crate::bsdf::Scatter as _;
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

    /// The first `count` vertices, the last of them open for a connection, unless it is the start
    /// of the path on a light; `None` when it cannot be connected.
    fn open_end(&self, scene: &Tracer<'_>, count: usize, on_light: bool) -> Option<Vertices> {
        let mut vertices: Vertices = self.vertices[..count].iter().copied().collect();
        if let Some(end) = vertices.last_mut().filter(|_| !on_light) {
            open_for_connection(scene, end).ok()?;
        }
        Some(vertices)
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
        aim: Aim,
        numbers: &mut impl Numbers,
        mut visit: impl FnMut(&Path, f64),
    ) {
        let limit = scene.max_edges();
        self.light.clear();
        self.eye.clear();
        let Aim { film, lens } = aim;
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
            kept_light: 0,
            light: &[],
            eye: &self.eye.vertices[..count],
            kept_from: 0,
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
        let Self { lens, light: light_walk, eye: eye_walk, path } = self;
        let drawn = (eye > 0).then_some(film);
        let eye_survival = if eye > 0 { eye_walk.survival[eye - 1] } else { 1.0 };
        // The lens, `eye` vertices and `light` vertices make `eye + light` edges.
        let most = light_walk.vertices.len().min(scene.max_edges() - eye);
        let Some(eye_part) = eye_walk.open_end(scene, eye, false) else { return };
        for light in 1..=most {
            let Some(light_part) = light_walk.open_end(scene, light, light == 1) else { continue };
            let splice = Splice {
                base: lens,
                kept_light: 0,
                light: &light_part,
                eye: &eye_part,
                kept_from: 0,
                film: drawn,
            };
            if path.connect(scene, &splice).is_ok() {
                let survival = eye_survival * light_walk.survival[light - 1];
                visit(path, 1.0 / (path.density_sum() * survival));
            }
        }
    }
}
