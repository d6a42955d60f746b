//! A unidirectional path tracer with light sampling and multiple importance sampling.
//!
//! It shares scene, materials and rays with the rest, but neither paths nor their weights: a second
//! opinion on every image.

use common::Rgb;
use glam::{DVec2, DVec3};

use crate::film::Film;
use crate::math::{Rng, Stream};
use crate::parallel;
use crate::path::{CameraSample, Numbers, ROW, Strand, Vertex, extend, light_vertex, scatter};
use crate::scene::{RayCounts, Scene, Tracer};

/// Edges that every path gets before Russian roulette begins.
const SURE_EDGES: usize = 4;

/// Renders by path tracing, pass by pass.
#[derive(Debug)]
pub struct PathTracer {
    film: Film,
    /// One stream a pixel, so that the image does not depend on the number of threads.
    streams: Vec<Rng>,
    samples: u64,
    /// Samples through points anywhere on the film.
    scattered: u64,
    seed: u64,
    rays: RayCounts,
}

/// The balance heuristic for two techniques that each draw one sample.
fn balance(p: f64, other: f64) -> f64 {
    p / (p + other)
}

impl PathTracer {
    /// An empty image of `scene`.
    pub fn new(scene: &Scene, seed: u64) -> Self {
        let camera = scene.camera();
        let pixels = camera.pixel_count() as u64;
        Self {
            film: Film::new(camera.width, camera.height),
            streams: (0..pixels).map(|i| Rng::new(seed, Stream::PathTracer, i)).collect(),
            samples: 0,
            scattered: 0,
            seed,
            rays: RayCounts::default(),
        }
    }

    /// Adds `samples` samples to every pixel, on `threads` threads.
    pub fn advance(&mut self, scene: &Scene, samples: u64, threads: usize) {
        let width = self.film.width() as usize;
        let rows = self.film.rows_mut().zip(self.streams.chunks_mut(width)).enumerate();
        let workers = parallel::for_each(
            threads,
            rows,
            || Tracer::new(scene),
            |scene, (y, (pixels, streams))| {
                for (x, (pixel, rng)) in pixels.iter_mut().zip(streams).enumerate() {
                    for _ in 0..samples {
                        *pixel += sample_pixel(scene, x, y, rng);
                    }
                }
            },
        );
        for worker in workers {
            self.rays.add(&worker);
        }
        self.samples += samples;
    }

    /// Samples in every pixel so far.
    pub fn samples(&self) -> u64 {
        self.samples
    }

    /// Adds `count` samples through points anywhere on the film: less than a sample through every pixel,
    /// where time allows no more.
    pub fn scatter(&mut self, scene: &Scene, count: u64) {
        let scene = Tracer::new(scene);
        let mut rng = Rng::new(self.seed, Stream::Scattered, self.scattered);
        for _ in 0..count {
            let aim = CameraSample::from_numbers(&scene, &mut rng);
            let radiance = radiance(&scene, &aim, &mut rng);
            if radiance.is_physical() {
                self.film.splat(scene.camera().pixel(aim.film), radiance);
            }
        }
        self.rays.add(&scene);
        self.scattered += count;
    }

    /// Samples through points anywhere on the film so far.
    pub fn scattered(&self) -> u64 {
        self.scattered
    }

    /// Rays cast so far.
    pub fn rays(&self) -> RayCounts {
        self.rays
    }

    /// The image in radiance of the file's units.
    pub fn image(&self, scene: &Scene) -> Film {
        let mut image = self.film.clone();
        let scattered = self.scattered as f64 / scene.camera().pixel_count() as f64;
        let samples = self.samples as f64 + scattered;
        image.scale(scene.radiance_scale() / if samples > 0.0 { samples } else { 1.0 });
        image
    }
}

/// One sample of the radiance that arrives at a pixel; black where it is no number.
fn sample_pixel(scene: &Tracer<'_>, x: usize, y: usize, rng: &mut Rng) -> Rgb {
    let camera = scene.camera();
    let film = DVec2::new(
        (x as f64 + rng.uniform()) / f64::from(camera.width),
        (y as f64 + rng.uniform()) / f64::from(camera.height),
    );
    let aim = CameraSample::through(scene, film, || rng.array());
    let radiance = radiance(scene, &aim, rng);
    if radiance.is_physical() { radiance } else { Rgb::BLACK }
}

/// Radiance that arrives at the lens by the ray `aim`.
pub(super) fn radiance(scene: &Tracer<'_>, aim: &CameraSample, numbers: &mut impl Numbers) -> Rgb {
    let mut direction = aim.direction(scene);
    let mut sum = Rgb::BLACK;
    let mut throughput = Rgb::WHITE;
    let mut at = aim.lens;
    // Density per solid angle of the last direction; infinite where no light sample could match it.
    let mut pdf = f64::INFINITY;
    for edges in 1..=scene.max_edges() {
        let Ok(mut next) = extend(scene, &at, direction) else { break };
        sum += throughput * hit_light(scene, &at, &next, direction, pdf);
        if edges == scene.max_edges() || next.is_lamp() {
            break;
        }
        let bsdf = scene.bsdf(next.material);
        if bsdf.connectable().is_some() {
            let u = numbers.row(Strand::Connection, edges);
            sum += throughput * sample_light(scene, &next, -direction, u);
        }
        let [u @ .., roulette] = numbers.row::<ROW>(Strand::Eye, edges);
        if edges >= SURE_EDGES {
            let chance = bsdf.albedo().clamp(0.1, 0.95);
            if roulette >= chance {
                break;
            }
            throughput = throughput / chance;
        }
        let back = -direction;
        let Ok(onward) = scatter(scene, &mut next, back, u) else { break };
        let local = scene.local(&next.anchor(), next.material);
        let Some(s) = local.evaluate(onward, back, next.event) else { break };
        throughput *= s.color * s.eye_weight;
        pdf = if next.event.is_specular() { f64::INFINITY } else { s.eye_pdf };
        direction = onward;
        at = next;
    }
    sum
}

/// Emission of what was hit, weighted against light sampling.
fn hit_light(scene: &Tracer<'_>, from: &Vertex, hit: &Vertex, direction: DVec3, pdf: f64) -> Rgb {
    let Some(emission) = scene.emission(hit.primitive, hit.material, -direction) else {
        return Rgb::BLACK;
    };
    let cosine = -hit.normal.dot(direction);
    if !(cosine > 0.0) {
        return Rgb::BLACK;
    }
    let light_pdf = if hit.is_lamp() {
        emission.pdf
    } else {
        emission.pdf * (hit.position - from.position).length_squared() / cosine
    };
    let weight = if pdf.is_finite() { balance(pdf, light_pdf) } else { 1.0 };
    emission.color * weight
}

/// Direct light from a sampled start, weighted against hitting it by scattering.
fn sample_light(scene: &Tracer<'_>, at: &Vertex, back: DVec3, u: [f64; 3]) -> Rgb {
    let light = light_vertex(scene, u);
    let far = light.is_lamp() && scene.is_infinite(light.material);
    let from = if far { scene.far_from(at.position, -light.normal) } else { light.anchor() };
    let span = from.position - at.position;
    let distance_squared = span.length_squared();
    let reach = scene.reach(light.primitive, at.primitive);
    if !(distance_squared > reach * reach) {
        return Rgb::BLACK;
    }
    let to_light = if far { -light.normal } else { span / distance_squared.sqrt() };
    let Some(emission) = scene.emission(light.primitive, light.material, -to_light) else {
        return Rgb::BLACK;
    };
    // Solid angle at `at` for each unit of the measure of the start.
    let solid_angle = match (far, light.is_lamp()) {
        (true, _) => 1.0,
        (false, true) => 1.0 / distance_squared,
        (false, false) => -light.normal.dot(to_light) / distance_squared,
    };
    let local = scene.local(&at.anchor(), at.material);
    let open = local.bsdf().connectable();
    let Some(s) = open.and_then(|event| local.evaluate(to_light, back, event)) else {
        return Rgb::BLACK;
    };
    if !(solid_angle > 0.0) || !scene.visible(&from, &at.anchor()) {
        return Rgb::BLACK;
    }
    let light_pdf = emission.pdf / solid_angle;
    let weight = if emission.hittable { balance(light_pdf, s.eye_pdf) } else { 1.0 };
    let value = s.connection * emission.connection * at.normal.dot(to_light).abs() / light_pdf;
    s.color * emission.color * (value * weight)
}
