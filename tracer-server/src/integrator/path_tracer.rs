//! A unidirectional path tracer with light sampling and multiple importance sampling.
//!
//! It shares scene, materials and rays with the rest, but neither paths nor their weights: a second
//! opinion on every image.

use common::Rgb;
use glam::{DVec2, DVec3};

use crate::bsdf::Scatter as _;
use crate::film::Film;
use crate::math::{Rng, Stream};
use crate::parallel;
use crate::path::{Vertex, camera_vertex, extend, light_vertex, scatter};
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

    /// Rays cast so far.
    pub fn rays(&self) -> RayCounts {
        self.rays
    }

    /// The image in radiance of the file's units.
    pub fn image(&self, scene: &Scene) -> Film {
        let mut image = self.film.clone();
        image.scale(scene.radiance_scale() / self.samples.max(1) as f64);
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
    let radiance = radiance(scene, camera.direction(film), rng);
    if radiance.is_physical() { radiance } else { Rgb::BLACK }
}

/// Radiance from `direction` at the lens.
fn radiance(scene: &Tracer<'_>, mut direction: DVec3, rng: &mut Rng) -> Rgb {
    let mut sum = Rgb::BLACK;
    let mut throughput = Rgb::WHITE;
    let mut at = camera_vertex(scene);
    // Density per solid angle of the last direction; infinite where no light sample could match it.
    let mut pdf = f64::INFINITY;
    for edges in 1..=scene.max_edges() {
        let Ok(mut next) = extend(scene, &at, direction) else { break };
        sum += throughput * hit_light(scene, &at, &next, direction, pdf);
        if edges == scene.max_edges() {
            break;
        }
        let bsdf = scene.bsdf(next.material);
        if bsdf.connectable().is_some() {
            sum += throughput * sample_light(scene, &next, -direction, rng.array());
        }
        if edges >= SURE_EDGES {
            let chance = bsdf.albedo().clamp(0.1, 0.95);
            if rng.uniform() >= chance {
                break;
            }
            throughput = throughput / chance;
        }
        let back = -direction;
        let Ok(onward) = scatter(scene, &mut next, back, rng.array()) else { break };
        let Some(s) = bsdf.evaluate(next.normal, onward, back, next.event) else { break };
        throughput *= s.color * s.eye_weight;
        pdf = if next.event.is_specular() { f64::INFINITY } else { s.eye_pdf };
        direction = onward;
        at = next;
    }
    sum
}

/// Emission of the surface that was hit, weighted against light sampling.
fn hit_light(scene: &Tracer<'_>, from: &Vertex, hit: &Vertex, direction: DVec3, pdf: f64) -> Rgb {
    let cosine = -hit.normal.dot(direction);
    match scene.emission(hit.primitive) {
        Some(emission) if cosine > 0.0 => {
            let distance_squared = (hit.position - from.position).length_squared();
            let light_pdf = emission.area_pdf * distance_squared / cosine;
            let weight = if pdf.is_finite() { balance(pdf, light_pdf) } else { 1.0 };
            emission.radiance * weight
        }
        _ => Rgb::BLACK,
    }
}

/// Direct light from a sampled point, weighted against hitting it by scattering.
fn sample_light(scene: &Tracer<'_>, at: &Vertex, back: DVec3, u: [f64; 3]) -> Rgb {
    let light = light_vertex(scene, u);
    let Some(emission) = scene.emission(light.primitive) else { return Rgb::BLACK };
    let span = light.position - at.position;
    let distance_squared = span.length_squared();
    let reach = scene.reach(light.primitive, at.primitive);
    if !(distance_squared > reach * reach) {
        return Rgb::BLACK;
    }
    let to_light = span / distance_squared.sqrt();
    let cosine = -light.normal.dot(to_light);
    let bsdf = scene.bsdf(at.material);
    let open = bsdf.connectable();
    let Some(s) = open.and_then(|event| bsdf.evaluate(at.normal, to_light, back, event)) else {
        return Rgb::BLACK;
    };
    if !(cosine > 0.0) || !scene.visible(&light.anchor(), &at.anchor()) {
        return Rgb::BLACK;
    }
    let light_pdf = emission.area_pdf * distance_squared / cosine;
    let value = s.connection * at.normal.dot(to_light).abs() / light_pdf;
    s.color * emission.radiance * (value * balance(light_pdf, s.eye_pdf))
}
