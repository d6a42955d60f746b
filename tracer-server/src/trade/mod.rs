//! Speed against accuracy: the same picture by several settings, for several times, by many seeds.
//!
//! Errors of Markov chains have heavy tails, so that one run tells little: each point of a setting
//! is a number of independent runs with quantiles. All CPU time counts, seeding included.

mod chart;
mod summary;

pub use chart::draw;
pub use summary::{Efficiency, Quantiles, Summary, slope, summarize};

use common::{Floor, known, mean_of_smallest, mean_ratio, relative_errors};
use serde::Serialize;

use crate::film::Film;
use crate::render::{Budget, RenderSettings, Rendering, render};
use crate::scene::Scene;

/// Share of the pixels that the trimmed error keeps: all but the worst in a thousand.
const KEPT: f64 = 0.999;

/// A way to render, with the name that it has in tables.
#[derive(Clone, Debug, PartialEq)]
pub struct Setting {
    /// Its name.
    pub name: String,
    /// Everything but the budget; seeds count up from its seed.
    pub render: RenderSettings,
}

/// What to measure.
#[derive(Clone, Debug)]
pub struct Plan<'a> {
    /// The settings, the one that others are compared with first.
    pub settings: &'a [Setting],
    /// What each run may spend, from least to most.
    pub budgets: &'a [Budget],
    /// Independent runs of each setting with each budget.
    pub runs: u64,
    /// What errors are measured against.
    pub reference: &'a Film,
    /// How dark pixels count.
    pub floor: Floor,
}

/// One picture.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Run {
    /// Name of the setting.
    pub setting: String,
    /// Number of its budget in the plan.
    pub budget: usize,
    /// The run's seed.
    pub seed: u64,
    /// Seconds of all cores together, seeding included.
    pub cpu_seconds: f64,
    /// Seconds of wall clock, seeding included.
    pub wall_seconds: f64,
    /// Mutations, or samples, of all pixels together.
    pub mutations: u64,
    /// Mean relative squared error.
    pub relative_mse: f64,
    /// The same without the worst pixel in a thousand.
    pub trimmed: f64,
    /// Sum of the picture over the sum of the reference.
    pub mean_ratio: f64,
}

/// All runs of one setting with one budget.
#[derive(Clone, Debug)]
pub struct Point {
    /// Number of the setting in the plan.
    pub setting: usize,
    /// Number of the budget in the plan.
    pub budget: usize,
    /// The runs, by seed.
    pub runs: Vec<Run>,
    /// The error of the mean of all pictures: systematic error shows here.
    pub error_of_mean: f64,
    /// The first picture, to be looked at.
    pub picture: Film,
}

impl Plan<'_> {
    /// Runs everything.
    ///
    /// Settings alternate, so that a change in the machine's load meets all of them. `on_run` hears
    /// each run as it ends, with the share of the work that is done, and can stop the work.
    ///
    /// # Errors
    ///
    /// Those of `on_run`.
    pub fn measure<E>(
        &self,
        scene: &Scene,
        mut on_run: impl FnMut(f64, &Run) -> Result<(), E>,
    ) -> Result<Vec<Point>, E> {
        let mut points: Vec<Gathering> = Vec::new();
        let all = self.runs * (self.settings.len() * self.budgets.len()) as u64;
        let mut done = 0;
        for number in 0..self.runs {
            for cell in self.cells() {
                let (run, image) = self.run(scene, cell, number);
                done += 1;
                on_run(done as f64 / all as f64, &run)?;
                let known = points.iter_mut().find(|point| point.cell == cell);
                match known {
                    Some(point) => point.add(run, &image),
                    None => points.push(Gathering::new(cell, run, image)),
                }
            }
        }
        points.sort_by_key(|point| point.cell);
        Ok(points.into_iter().map(|point| point.finish(self)).collect())
    }

    fn cells(&self) -> impl Iterator<Item = Cell> {
        let settings = self.settings.len();
        let row = move |budget| (0..settings).map(move |setting| Cell { budget, setting });
        (0..self.budgets.len()).flat_map(row)
    }

    fn run(&self, scene: &Scene, cell: Cell, number: u64) -> (Run, Film) {
        let Cell { budget, setting } = cell;
        let Setting { name, render: settings } = &self.settings[setting];
        let mut settings = RenderSettings { budget: self.budgets[budget], ..*settings };
        // No two budgets share a seed: their errors are independent.
        settings.ensemble.seed += number + self.runs * budget as u64;
        let Rendering { image, report, .. } = render(scene, &settings, |_| ());
        let errors = self.errors(&image);
        let run = Run {
            setting: name.clone(),
            budget,
            seed: settings.ensemble.seed,
            cpu_seconds: report.cpu_seconds,
            wall_seconds: report.wall_seconds,
            mutations: report.mutations,
            relative_mse: mean_of_smallest(errors.clone(), 1.0),
            trimmed: mean_of_smallest(errors, KEPT),
            mean_ratio: mean_ratio(image.pixels(), self.reference.pixels()),
        };
        (run, image)
    }

    fn errors(&self, image: &Film) -> Vec<f64> {
        let reference = self.reference.pixels();
        known(relative_errors(image.pixels(), reference, self.floor), reference)
    }
}

/// A setting with a budget, by their numbers in the plan.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Cell {
    budget: usize,
    setting: usize,
}

/// A point that still grows.
struct Gathering {
    cell: Cell,
    runs: Vec<Run>,
    sum: Film,
    picture: Film,
}

impl Gathering {
    fn new(cell: Cell, run: Run, image: Film) -> Self {
        Self { cell, runs: vec![run], sum: image.clone(), picture: image }
    }

    fn add(&mut self, run: Run, image: &Film) {
        self.runs.push(run);
        self.sum.add(image);
    }

    fn finish(mut self, plan: &Plan<'_>) -> Point {
        self.sum.scale(1.0 / self.runs.len() as f64);
        Point {
            setting: self.cell.setting,
            budget: self.cell.budget,
            error_of_mean: mean_of_smallest(plan.errors(&self.sum), 1.0),
            runs: self.runs,
            picture: self.picture,
        }
    }
}

/// A picture to measure errors against, with its own error.
#[derive(Clone, Debug)]
pub struct Reference {
    /// The picture.
    pub image: Film,
    /// Its own relative mean squared error, if known: nothing can be measured below it.
    pub error: Option<f64>,
}

impl Reference {
    /// The mean of two independent renderings, from whose difference its error is known.
    ///
    /// `settings` should be a way to render without chains; `on_progress` hears the share done.
    pub fn render(
        scene: &Scene,
        settings: &RenderSettings,
        floor: Floor,
        mut on_progress: impl FnMut(f64) + Send,
    ) -> Self {
        let mut half = |seed: u64, begin: f64| {
            let mut settings = *settings;
            settings.ensemble.seed = seed;
            let progress = |at| {
                if let crate::render::Progress::Rendering(share) = at {
                    on_progress(begin + 0.5 * share);
                }
            };
            render(scene, &settings, progress).image
        };
        // Seeds that no run is likely to have.
        let (a, b) = (half(u64::MAX / 3, 0.0), half(u64::MAX / 3 + 1, 0.5));
        let mut image = Film::sum([&a, &b]);
        image.scale(0.5);
        // The halves' difference has four times the variance of their mean.
        let errors = relative_errors(a.pixels(), b.pixels(), floor);
        Self { image, error: Some(mean_of_smallest(errors, 1.0) / 4.0) }
    }
}

#[cfg(test)]
mod tests;
