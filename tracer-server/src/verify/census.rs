//! How much light each class of paths carries, from bidirectional samples.

use std::collections::BTreeMap;

use crate::math::{Rng, Stream};
use crate::parallel;
use crate::path::{BidirectionalSampler, CameraSample, ClassKey, Path};
use crate::scene::{Scene, Tracer};

/// Samples that one stream of random numbers serves.
const CHUNK: u64 = 1000;

/// One class of paths.
#[derive(Clone, Debug, Default)]
pub struct ClassEnergy {
    /// Sum of the samples' light in the class.
    energy: f64,
    /// Sum of its squares.
    squares: f64,
    /// Sum of its products with the samples' light in all classes.
    products: f64,
    /// The first path that was found.
    pub example: Path,
}

/// All classes that were found.
#[derive(Clone, Debug, Default)]
pub struct Census {
    /// By class.
    pub classes: BTreeMap<ClassKey, ClassEnergy>,
    total: f64,
    squares: f64,
    samples: u64,
}

impl Census {
    /// Draws `samples` bidirectional samples.
    pub fn new(scene: &Scene, seed: u64, samples: u64, threads: usize) -> Self {
        let parts = parallel::map(
            threads,
            0..samples.div_ceil(CHUNK),
            || Tracer::new(scene),
            |scene, number| Self::chunk(scene, seed, number),
        );
        let mut census = Self::default();
        for part in parts {
            census.merge(part);
        }
        census
    }

    fn chunk(scene: &Tracer<'_>, seed: u64, number: u64) -> Self {
        let mut rng = Rng::new(seed, Stream::Census, number);
        let mut sampler = BidirectionalSampler::new(scene);
        let mut census = Self { samples: CHUNK, ..Self::default() };
        let mut sample: Vec<(ClassKey, f64)> = Vec::new();
        for _ in 0..CHUNK {
            let aim = CameraSample::from_numbers(scene, &mut rng);
            sampler.sample(scene, aim, &mut rng, |path, weight| {
                let key = ClassKey::of(path);
                let class = census.classes.entry(key);
                class
                    .or_insert_with(|| ClassEnergy { example: path.clone(), ..Default::default() });
                match sample.iter_mut().find(|(seen, _)| *seen == key) {
                    Some((_, sum)) => *sum += weight,
                    None => sample.push((key, weight)),
                }
            });
            let total: f64 = sample.iter().map(|(_, energy)| energy).sum();
            census.total += total;
            census.squares += total * total;
            for (key, energy) in sample.drain(..) {
                let class = census.classes.entry(key).or_default();
                class.energy += energy;
                class.squares += energy * energy;
                class.products += energy * total;
            }
        }
        census
    }

    fn merge(&mut self, part: Self) {
        self.total += part.total;
        self.squares += part.squares;
        self.samples += part.samples;
        for (key, class) in part.classes {
            match self.classes.get_mut(&key) {
                Some(sum) => {
                    sum.energy += class.energy;
                    sum.squares += class.squares;
                    sum.products += class.products;
                }
                None => drop(self.classes.insert(key, class)),
            }
        }
    }

    /// The share of all light that a class carries, with its standard error.
    pub fn share(&self, class: &ClassEnergy) -> (f64, f64) {
        let share = class.energy / self.total;
        // Of a ratio of two sums over the same samples.
        let residual = class.squares - 2.0 * share * class.products + share * share * self.squares;
        (share, residual.max(0.0).sqrt() / self.total)
    }

    /// Mean light of a sample.
    pub fn mean(&self) -> f64 {
        self.total / self.samples as f64
    }

    /// Entry `k`: the light that paths of `k` edges carry, relative to the others.
    pub fn lengths(&self, max_edges: usize) -> Vec<f64> {
        let mut lengths = vec![0.0; max_edges + 1];
        for class in self.classes.values() {
            if let Some(sum) = lengths.get_mut(class.example.edge_count()) {
                *sum += class.energy;
            }
        }
        lengths
    }

    /// True when no light was found.
    pub fn is_dark(&self) -> bool {
        !(self.total > 0.0)
    }
}
