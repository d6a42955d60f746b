//! The base of a picture: independent samples that carry what they find well.
//!
//! They are evenly spread within a replicate. What they would find rarely and brightly is left to chains: see
//! [`crate::target::Selective`].

mod bidirectional;
mod path;

#[cfg(test)]
mod laws;

use glam::DVec2;

use crate::film::Film;
use crate::math::{Rng, Strata, Stream};
use crate::path::{CameraSample, Numbers, Strand};
use crate::scene::{RayCounts, Scene, Tracer};
use crate::target::{Base, Selective};

use bidirectional::Bidirectional;

/// Draws the base samples of one replicate after the other.
#[derive(Debug)]
pub struct BaseSampler {
    selective: Selective,
    /// Room for the walks of bidirectional sampling.
    walks: Option<Box<Bidirectional>>,
}

/// Where the samples of a pass belong.
#[derive(Clone, Copy, Debug)]
pub struct Pass {
    /// The sequences of the replicate.
    pub strata: Strata,
    /// Number of the pass in the replicate: the number of each sample in its pixel's sequences.
    pub index: u32,
}

/// The numbers of one sample.
#[derive(Debug)]
pub(crate) struct Spread {
    strata: Strata,
    index: u32,
}

impl Spread {
    /// Those of the sample through a pixel in a pass.
    #[inline]
    pub(crate) fn new(pass: Pass, pixel: u64) -> Self {
        Self { strata: pass.strata.of(pixel), index: pass.index }
    }

    /// A ray through a pixel.
    #[inline]
    fn aim(&mut self, scene: &Tracer<'_>, pixel: usize) -> CameraSample {
        let camera = scene.camera();
        let [u, v, a, b] = self.row(Strand::Eye, 0);
        let (x, y) = (pixel as u32 % camera.width, pixel as u32 / camera.width);
        let point = DVec2::new(
            (f64::from(x) + u) / f64::from(camera.width),
            (f64::from(y) + v) / f64::from(camera.height),
        );
        CameraSample::through(scene, point, || [a, b])
    }
}

impl Numbers for Spread {
    #[inline]
    fn row<const N: usize>(&mut self, strand: Strand, row: usize) -> [f64; N] {
        let place = (strand as u64) << 32 | row as u64;
        let point = self.strata.point(place, self.index);
        std::array::from_fn(|i| point[i])
    }
}

/// The mean work of a sample of path tracing, in rays: counted, over rays through random points of the
/// film.
pub fn work_of_paths(scene: &Scene) -> f64 {
    const SAMPLES: u64 = 256;
    let tracer = Tracer::new(scene);
    let mut rng = Rng::new(0, Stream::Scout, u64::MAX);
    for _ in 0..SAMPLES {
        let aim = CameraSample::from_numbers(&tracer, &mut rng);
        path::terms(&tracer, &aim, &mut rng, |_| ());
    }
    let counts = RayCounts::of(&tracer);
    (2.4 * counts.rays as f64 + counts.shadow_rays as f64) / SAMPLES as f64
}

impl BaseSampler {
    /// A sampler of the light that `selective` leaves to it.
    pub fn new(scene: &Tracer<'_>, selective: Selective) -> Self {
        let walks = match selective.base {
            Base::Path => None,
            Base::Bidirectional => Some(Box::new(Bidirectional::new(scene))),
        };
        Self { selective, walks }
    }

    /// Draws one sample through every pixel of the rows that `rows` gives, and adds what they carry to
    /// the film: radiance in film units of the scene, the whole of which a pass over all rows
    /// estimates once.
    pub fn pass(
        &mut self,
        scene: &Tracer<'_>,
        pass: Pass,
        rows: std::ops::Range<u32>,
        film: &mut Film,
    ) {
        let width = scene.camera().width as usize;
        for y in rows {
            for pixel in y as usize * width..(y as usize + 1) * width {
                let mut numbers = Spread::new(pass, pixel as u64);
                let aim = numbers.aim(scene, pixel);
                self.sample(scene, &aim, pixel, &mut numbers, film);
            }
        }
    }

    /// Calls `visit` with everything that the sample through a pixel in a pass carries, whatever part of
    /// it is the sampler's: the pixel that it counts in, its luminance, `S_B` and its edges.
    pub fn look(
        &mut self,
        scene: &Tracer<'_>,
        pass: Pass,
        pixel: usize,
        mut visit: impl FnMut(usize, f64, f64, usize),
    ) {
        let mut numbers = Spread::new(pass, pixel as u64);
        let aim = numbers.aim(scene, pixel);
        match &mut self.walks {
            None => path::terms(scene, &aim, &mut numbers, |term| {
                let luminance = term.contribution.luminance() / term.survival;
                visit(pixel, luminance, term.density_sum(), term.edges);
            }),
            Some(walks) => walks.look(scene, aim, &mut numbers, |path, weight| {
                visit(path.pixel(), weight, path.density_sum(), path.edge_count());
            }),
        }
    }

    fn sample(
        &mut self,
        scene: &Tracer<'_>,
        aim: &CameraSample,
        pixel: usize,
        numbers: &mut Spread,
        film: &mut Film,
    ) {
        match &mut self.walks {
            None => {
                let color = path::sample(scene, aim, self.selective, numbers);
                if color.is_physical() {
                    film.splat(pixel, color);
                }
            }
            Some(walks) => walks.sample(scene, *aim, self.selective, numbers, film),
        }
    }
}
