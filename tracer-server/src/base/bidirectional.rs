//! All splits of two walks.

use super::Spread;
use crate::film::Film;
use crate::path::{BidirectionalSampler, CameraSample, Path};
use crate::scene::Tracer;
use crate::target::Selective;

/// Room for the walks of bidirectional sampling.
#[derive(Debug)]
pub(super) struct Bidirectional(BidirectionalSampler);

impl Bidirectional {
    pub(super) fn new(scene: &Tracer<'_>) -> Self {
        Self(BidirectionalSampler::new(scene))
    }

    /// Calls `visit` with every path of a sample and its weight.
    pub(super) fn look(
        &mut self,
        scene: &Tracer<'_>,
        aim: CameraSample,
        numbers: &mut Spread,
        visit: impl FnMut(&Path, f64),
    ) {
        self.0.sample(scene, aim, numbers, visit);
    }

    /// Adds what one sample carries to the film. Its weights are `1 / S` over the odds of roulette;
    /// the share that is the sampler's depends on S alone.
    pub(super) fn sample(
        &mut self,
        scene: &Tracer<'_>,
        aim: CameraSample,
        selective: Selective,
        numbers: &mut Spread,
        film: &mut Film,
    ) {
        self.0.sample(scene, aim, numbers, |path, weight| {
            let share = selective.base_share(path.density_sum(), path.edge_count());
            let color = path.unit_color() * (share * weight);
            if color.is_physical() {
                film.splat(path.pixel(), color);
            }
        });
    }
}
