//! A bidirectional path tracer: the images of the samples that also seed the chains.

use glam::DVec2;

use crate::chain::LANES;
use crate::film::Film;
use crate::math::{Rng, Stream};
use crate::parallel;
use crate::path::{BidirectionalSampler, CameraSample, Path};
use crate::scene::{RayCounts, Scene, Tracer};

/// Renders by bidirectional path tracing, pass by pass.
#[derive(Debug)]
pub struct BidirectionalTracer {
    lanes: Vec<Film>,
    seed: u64,
    samples: u64,
    /// Samples through points anywhere on the film.
    scattered: u64,
    rays: RayCounts,
}

impl BidirectionalTracer {
    /// An empty image of `scene`.
    pub fn new(scene: &Scene, seed: u64) -> Self {
        let camera = scene.camera();
        Self {
            lanes: vec![Film::new(camera.width, camera.height); LANES],
            seed,
            samples: 0,
            scattered: 0,
            rays: RayCounts::default(),
        }
    }

    /// Draws `samples` more samples through every pixel, on `threads` threads. A row of the film
    /// belongs to a lane, so the image does not depend on the number of threads.
    pub fn advance(&mut self, scene: &Scene, samples: u64, threads: usize) {
        let (first, seed) = (self.samples, self.seed);
        let workers = parallel::for_each(
            threads.min(LANES),
            self.lanes.iter_mut().enumerate(),
            || Tracer::new(scene),
            |scene, (number, lane)| {
                for pass in first..first + samples {
                    render_lane(scene, lane, number, seed, pass);
                }
            },
        );
        for worker in workers {
            self.rays.add(&worker);
        }
        self.samples += samples;
    }

    /// Samples through every pixel so far.
    pub fn samples(&self) -> u64 {
        self.samples
    }

    /// Draws `count` samples through points anywhere on the film: less than a sample through every pixel,
    /// where time allows no more.
    pub fn scatter(&mut self, scene: &Scene, count: u64) {
        let scene = Tracer::new(scene);
        let mut sampler = BidirectionalSampler::new(&scene);
        let mut rng = Rng::new(self.seed, Stream::Scattered, self.scattered);
        let film = &mut self.lanes[0];
        for _ in 0..count {
            let aim = CameraSample::from_numbers(&scene, &mut rng);
            sampler.sample(&scene, aim, &mut rng, |path, weight| splat(film, path, weight));
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
        let mut image = Film::sum(&self.lanes);
        let scattered = self.scattered as f64 / scene.camera().pixel_count() as f64;
        let samples = self.samples as f64 + scattered;
        image.scale(scene.radiance_scale() / if samples > 0.0 { samples } else { 1.0 });
        image
    }
}

/// Adds a path of a sample to the film, unless it is no number.
fn splat(film: &mut Film, path: &Path, weight: f64) {
    let color = path.unit_color() * weight;
    if color.is_physical() {
        film.splat(path.pixel(), color);
    }
}

/// One pass over the rows of a lane: rows `lane`, `lane + LANES`, ...
fn render_lane(scene: &Tracer<'_>, film: &mut Film, lane: usize, seed: u64, pass: u64) {
    let camera = scene.camera();
    let (width, height) = (u64::from(camera.width), u64::from(camera.height));
    let mut sampler = BidirectionalSampler::new(scene);
    for y in (lane as u64..height).step_by(LANES) {
        let mut rng = Rng::new(seed, Stream::Bidirectional, pass * height + y);
        for x in 0..width {
            let film_point = DVec2::new(
                (x as f64 + rng.uniform()) / width as f64,
                (y as f64 + rng.uniform()) / height as f64,
            );
            let aim = CameraSample::through(scene, film_point, || rng.array());
            sampler.sample(scene, aim, &mut rng, |path, weight| splat(film, path, weight));
        }
    }
}
