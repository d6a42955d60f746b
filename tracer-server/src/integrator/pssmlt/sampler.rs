//! The renderers that turn numbers into light on the film.

use common::Rgb;
use serde::Serialize;

use super::super::path_tracer::radiance;
use crate::film::Film;
use crate::path::{BidirectionalSampler, CameraSample, Numbers};
use crate::scene::{Scene, Tracer};

/// Which renderer a chain in primary-sample space drives.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum PrimarySampler {
    /// Bidirectional path tracing: all splits of two walks in every sample.
    #[default]
    Bdpt,
    /// Path tracing with light sampling: one walk, and less work in every sample.
    Path,
}

impl PrimarySampler {
    /// Its name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Bdpt => "bdpt",
            Self::Path => "path",
        }
    }
}

/// Light for one pixel.
#[derive(Clone, Copy, Debug)]
struct Splat {
    pixel: usize,
    color: Rgb,
}

/// What the numbers of one point make: the splats of a sample of the image.
#[derive(Clone, Debug, Default)]
pub struct Sample {
    splats: Vec<Splat>,
    /// Sum of the splats' luminances: what the chain visits points in proportion to.
    intensity: f64,
}

impl Sample {
    fn clear(&mut self) {
        self.splats.clear();
        self.intensity = 0.0;
    }

    pub(super) fn add(&mut self, pixel: usize, color: Rgb) {
        if !color.is_black() {
            self.splats.push(Splat { pixel, color });
            self.intensity += color.luminance();
        }
    }

    /// Sum of the splats' luminances; NaN or infinite when any of them is.
    #[inline]
    pub fn intensity(&self) -> f64 {
        self.intensity
    }

    /// True when all of it can be put on a film.
    pub fn is_physical(&self) -> bool {
        self.splats.iter().all(|splat| splat.color.is_physical())
    }

    /// Puts all splats, times `weight`, on a film.
    pub fn splat(&self, weight: f64, film: &mut Film) {
        for splat in &self.splats {
            film.splat(splat.pixel, splat.color * weight);
        }
    }

    /// Pixels and colours.
    #[cfg(test)]
    pub(super) fn colors(&self) -> impl Iterator<Item = (usize, Rgb)> + '_ {
        self.splats.iter().map(|splat| (splat.pixel, splat.color))
    }
}

/// Something that makes a sample of numbers.
pub trait Sampler {
    /// Replaces `sample` by what the numbers make.
    fn sample(&mut self, numbers: &mut impl Numbers, sample: &mut Sample);
}

/// One worker's renderer.
#[derive(Debug)]
pub struct SceneSampler<'s> {
    scene: Tracer<'s>,
    /// Room for the walks of the bidirectional renderer; the path tracer needs none.
    walks: Option<Box<BidirectionalSampler>>,
}

impl<'s> SceneSampler<'s> {
    /// A renderer of `scene`.
    pub fn new(scene: &'s Scene, kind: PrimarySampler) -> Self {
        let scene = Tracer::new(scene);
        let walks = match kind {
            PrimarySampler::Bdpt => Some(Box::new(BidirectionalSampler::new(&scene))),
            PrimarySampler::Path => None,
        };
        Self { scene, walks }
    }

    /// The scene, with the rays cast so far.
    pub fn scene(&self) -> &Tracer<'s> {
        &self.scene
    }
}

impl Sampler for SceneSampler<'_> {
    fn sample(&mut self, numbers: &mut impl Numbers, sample: &mut Sample) {
        sample.clear();
        let Self { scene, walks } = self;
        let aim = CameraSample::from_numbers(scene, numbers);
        if let Some(walks) = walks {
            walks.sample(scene, aim, numbers, |path, weight| {
                sample.add(path.pixel(), path.unit_color() * weight);
            });
        } else {
            let color = radiance(scene, &aim, numbers);
            sample.add(scene.camera().pixel(aim.film), color);
        }
    }
}
