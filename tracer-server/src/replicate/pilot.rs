//! What the replicates of a scene are made of: decided by samples that are thrown away.
//!
//! The pilot looks at bidirectional samples only. They tell of every base sampler how far its terms
//! would spread: a term is `1 / S_B` whenever it is drawn, so that the mean of its square is
//! `integral f (1 - g)^2 / S_B`, and what such a sampler would draw once in a million samples shows as
//! an ordinary path with a tiny `S_B`. Short chains tell how many mutations are worth one independent
//! sample. Work is counted in rays and operations, never in seconds, so that the same seed makes the
//! same plan on any machine.

use std::sync::Arc;

use common::Rgb;

use super::plan::{Outlook, Plan};
use crate::base::{BaseSampler, Pass, work_of_paths};
use crate::chain::{Chain, Kernel, PilotSettings, PoolKey, Sighting, Source, Survey, survey};
use crate::film::Film;
use crate::math::{Rng, Strata, Stream};
use crate::mutation::StrategyOptions;
use crate::parallel::{self, Stop};
use crate::scene::{RayCounts, Scene, Tracer};
use crate::target::{Base, Equalised, Selective, Target};

/// Bidirectional samples of the pilot.
const SAMPLES: u64 = 4096;
/// Tiles along each side of the coarse image.
const TILES: usize = 12;
/// Chains that tell how far mutations are correlated, the samples that seed them, and their steps.
const SCOUTS: (u32, u64, usize) = (64, 1024, 600);
/// Work of a replicate, in rays: about half a second of one core.
const REPLICATE_WORK: f64 = 4e6;
/// Most parts of a replicate.
const MOST_PARTS: u32 = 16;
/// Share of the work that pools may take.
const POOL_SHARE: f64 = 0.08;
/// Mutations for each base sample: within these limits a part stays short.
const MUTATIONS: (f64, f64) = (0.25, 16.0);
/// Mutations for each pixel in a part without base samples.
const MUTATIONS_ALONE: f64 = 4.0;
/// Independent samples of a pool for each seed.
const DIVERSITY: f64 = 8.0;
/// Steps of a chain in a replicate, about.
const STEPS: f64 = 1000.0;
/// Dials that are looked at: powers of two times the mean luminance.
const DIALS: std::ops::RangeInclusive<i32> = -6..=10;

/// A dial that is right for many scenes.
const LIKELY: f64 = 4.0;

/// Pixels through which base samples are drawn, by base sampler, and samples of a group.
const LOOKED_AT: [u32; 2] = [768, 192];
/// See [`LOOKED_AT`].
const GROUP: u32 = 4;
/// Terms of a base sample that are brighter than so many times the mean are looked for among whole paths.
const COMMON: f64 = 8.0;
/// By how much better work in bulky parts must be than work that a budget can cut anywhere.
const BULKY: f64 = 1.25;

/// Rays that a mutation is worth beside those that it casts.
const MUTATION: f64 = 3.0;

/// The work of bidirectional samples, in rays.
fn work_of_bidirectional(counts: RayCounts) -> f64 {
    2.3 * counts.rays as f64 + 1.6 * counts.shadow_rays as f64
}

/// The work of mutations, in rays.
fn work_of_mutations(counts: RayCounts, mutations: u64) -> f64 {
    counts.rays as f64 + 0.5 * counts.shadow_rays as f64 + MUTATION * mutations as f64
}

/// Makes the plan for a scene. Without light on the film there are no chains. What it has found by the
/// time that it is told to `stop` is of no use.
pub fn prepare(scene: &Scene, settings: &PlanSettings, stop: &Stop) -> Plan {
    let &PlanSettings { seed, threads, ref strategies, dial } = settings;
    let pilot = PilotSettings { seed, threads, samples: SAMPLES, stop: stop.clone() };
    let survey = survey(scene, strategies, &pilot);
    let view = View::new(scene, survey);
    // Chains of a likely choice tell more, and may change it.
    let likely = view.choose(Dial { tau: dial.tau.or(Some(LIKELY)), ..dial }, FIRST_GUESS);
    let scouting = view.scout(scene, settings, &view.kernel(&likely));
    let choice = view.choose(dial, scouting);
    view.plan(scene, seed, &choice)
}

/// What a plan is made from, besides the scene.
#[derive(Clone, Debug)]
pub struct PlanSettings {
    /// Number of the run; the same number gives the same plan.
    pub seed: u64,
    /// Worker threads; the plan does not depend on it.
    pub threads: usize,
    /// What the user wants of the strategies.
    pub strategies: StrategyOptions,
    /// What the user says of the division of the work.
    pub dial: Dial,
}

/// What a user says of the dial between base samples and chains.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Dial {
    /// The base sampler; the pilot's choice without.
    pub base: Option<Base>,
    /// The luminance above which light is left to chains, as a multiple of the mean luminance of the
    /// picture; the pilot's choice without.
    pub tau: Option<f64>,
}

/// What chains cost and what they are worth.
#[derive(Clone, Copy, Debug)]
struct Scouting {
    /// Work of a mutation.
    mutation: f64,
    /// Mutations that are worth one independent sample.
    correlation: f64,
}

/// Before any chain has run.
const FIRST_GUESS: Scouting = Scouting { mutation: MUTATION + 3.0, correlation: 2.0 };

/// One way to divide the work.
#[derive(Clone, Copy, Debug)]
struct Choice {
    /// The base sampler; none where chains have all of the light.
    base: Option<Selective>,
    is_equalised: bool,
    /// Share of the light that is the chains'.
    chains_share: f64,
    /// Relative variance of a picture with one base sample for each pixel, and with one mutation.
    variances: [f64; 2],
    scouting: Scouting,
    /// Variance times work of the best division.
    score: f64,
}

/// The light of the scene as the pilot sees it.
struct View {
    survey: Survey,
    /// Weight of a squared error in each tile, over the square of the mean luminance.
    weights: Vec<f64>,
    luminances: Vec<f64>,
    mean: f64,
    pixels: f64,
    /// Work of a base sample through one pixel, by base sampler.
    work: [f64; 2],
    /// What base samples through some pixels carry, by base sampler.
    looks: [Vec<Look>; 2],
}

/// What one term of a base sample carries.
#[derive(Clone, Copy, Debug)]
struct Look {
    /// Number of the pixel among those looked at, and which of two groups of samples through it.
    place: (u32, bool),
    /// Whether it counts in the pixel that the sample was drawn through.
    is_own: bool,
    /// Weight of a squared error where it counts.
    omega: f64,
    luminance: f64,
    density_sum: f64,
    edges: usize,
}

fn tile(sighting: &Sighting) -> usize {
    let place = |at: f32| ((at * TILES as f32) as usize).min(TILES - 1);
    place(sighting.film[1]) * TILES + place(sighting.film[0])
}

impl View {
    fn new(scene: &Scene, survey: Survey) -> Self {
        let samples = survey.samples as f64;
        let mut luminances = vec![0.0; TILES * TILES];
        for sighting in &survey.sightings {
            luminances[tile(sighting)] += sighting.weight / samples * (TILES * TILES) as f64;
        }
        let mean = luminances.iter().sum::<f64>() / luminances.len() as f64;
        // Few samples are in a tile: part of the mean keeps one that saw nothing from ruling all.
        for luminance in &mut luminances {
            *luminance = 0.95 * *luminance + 0.05 * mean;
        }
        let square = luminances.iter().map(|l| l * l).sum::<f64>() / luminances.len() as f64;
        let weights = luminances.iter().map(|l| 1.0 / (l * l + 0.01 * square)).collect();
        let bidirectional = work_of_bidirectional(survey.rays) / samples;
        let work = [work_of_paths(scene), bidirectional];
        let pixels = scene.camera().pixel_count() as f64;
        let mut view =
            Self { weights, luminances, mean, pixels, work, looks: Default::default(), survey };
        view.looks = Base::ALL.map(|base| view.look(scene, base));
        view
    }

    /// Draws two groups of base samples through some pixels, spread as they will be.
    fn look(&self, scene: &Scene, base: Base) -> Vec<Look> {
        let tracer = Tracer::new(scene);
        let mut sampler = BaseSampler::new(&tracer, Selective { base, tau: f64::INFINITY });
        let camera = scene.camera();
        let place = |at: usize| {
            let (x, y) = (at as u32 % camera.width, at as u32 / camera.width);
            glam::DVec2::new(
                (f64::from(x) + 0.5) / f64::from(camera.width),
                (f64::from(y) + 0.5) / f64::from(camera.height),
            )
        };
        let pixel_of = |number: u32| {
            let mut choice = Rng::new(0, Stream::Scout, 1 << 40 | u64::from(number));
            choice.below(camera.pixel_count())
        };
        let groups = (0..LOOKED_AT[base as usize]).flat_map(|n| [(n, false), (n, true)]);
        let mut looks = Vec::new();
        for (place_of, index) in groups.flat_map(|group| (0..GROUP).map(move |i| (group, i))) {
            let (number, second) = place_of;
            let key = u64::from(number) << 1 | u64::from(second);
            let pass = Pass { strata: Strata::new(0, Stream::Scout, key), index };
            let pixel = pixel_of(number);
            sampler.look(&tracer, pass, pixel, |at, luminance, density_sum, edges| {
                let (is_own, omega) = (at == pixel, self.weight_at(place(at)));
                looks.push(Look { place: place_of, is_own, omega, luminance, density_sum, edges });
            });
        }
        looks
    }

    /// Relative variance of a picture with one base sample for each pixel, but for terms of more than
    /// [`COMMON`] times the mean, which are too rare to be seen by few samples.
    fn common_variance(&self, selective: Selective) -> f64 {
        let count = LOOKED_AT[selective.base as usize];
        let mut groups = vec![[0.0; 2]; count as usize];
        let mut omegas = vec![0.0; count as usize];
        let mut others = 0.0;
        for look in &self.looks[selective.base as usize] {
            if 1.0 / look.density_sum > COMMON * self.mean && look.edges > 1 {
                continue;
            }
            let share = selective.base_share(look.density_sum, look.edges);
            let value = look.luminance * share;
            if look.is_own {
                let (number, second) = look.place;
                groups[number as usize][usize::from(second)] += value;
                omegas[number as usize] = look.omega;
            } else {
                others += value * value * look.omega;
            }
        }
        let samples = f64::from(count * 2 * GROUP);
        let square = |([a, b], omega): (&[f64; 2], &f64)| (a - b).powi(2) * omega;
        let own: f64 = groups.iter().zip(&omegas).map(square).sum();
        (own + others) / samples
    }

    /// The best way to divide the work, as far as the dial is free.
    fn choose(&self, dial: Dial, scouting: Scouting) -> Choice {
        let taus: Vec<f64> = match dial.tau {
            Some(tau) => vec![tau * self.mean],
            None => DIALS.map(|k| self.mean * 2_f64.powi(k)).chain([f64::INFINITY]).collect(),
        };
        let bases = Base::ALL.into_iter().filter(|base| dial.base.is_none_or(|b| b == *base));
        let mut best = self.judge(None, scouting);
        if dial.tau.is_some_and(|tau| tau > 0.0) || dial.base.is_some() {
            best.score = f64::INFINITY;
        }
        for base in bases {
            for &tau in taus.iter().filter(|tau| **tau > 0.0) {
                let choice = self.judge(Some(Selective { base, tau }), scouting);
                if choice.score < best.score {
                    best = choice;
                }
            }
        }
        best
    }

    /// What a division is worth.
    fn judge(&self, base: Option<Selective>, scouting: Scouting) -> Choice {
        let samples = self.survey.samples as f64;
        let (mut second, mut fourth) = (0.0, 0.0);
        // Light of the chains; weighted errors where it is visited as it is, and made even.
        let (mut light, mut errors, mut even) = (0.0, 0.0, 0.0);
        let mut found_all = true;
        for sighting in &self.survey.sightings {
            let tile = tile(sighting);
            let weight = sighting.weight / samples;
            let omega = self.weights[tile];
            let (mut g, mut term) = (1.0, 0.0);
            if let Some(selective) = base {
                let sum = sighting.density_sum(selective.base);
                let share = selective.base_share(sum, sighting.edges);
                g = 1.0 - share;
                found_all &= sum > 0.0;
                if sum > 0.0 && 1.0 / sum > COMMON * self.mean && sighting.edges > 1 {
                    term = weight * share * share / sum * omega;
                }
            }
            second += term;
            fourth += term * term;
            light += weight * g;
            errors += weight * g * omega;
            even += weight * g * omega.sqrt();
        }
        // What the tail of rare bright terms may still hide counts as seen.
        let rare = second + 2.0 * fourth.sqrt();
        let first = base.map_or(0.0, |selective| self.common_variance(selective) + rare);
        let nothing_left = base.is_some_and(|b| b.tau.is_infinite()) && found_all;
        let plain = light * errors;
        let is_equalised = even * even < 0.8 * plain;
        let spread = if is_equalised { even * even } else { plain };
        let second = if nothing_left { 0.0 } else { spread * scouting.correlation };
        let sample = base.map_or(0.0, |selective| self.work[selective.base as usize]);
        // Pools are paid for by the chains.
        let mutation = scouting.mutation * (1.0 + POOL_SHARE);
        let best = ((first * sample).sqrt() + (second * mutation).sqrt()).powi(2);
        let ratio = (second * sample / (first * mutation)).sqrt();
        let part = self.pixels * (sample + ratio.clamp(0.0, MUTATIONS.1) * mutation);
        // A budget of time is met part by part.
        let is_bulky = base.is_some() && second > 0.0 && part > REPLICATE_WORK;
        let score = if is_bulky { BULKY * best } else { best };
        tracing::debug!(
            "{:?}, tau {:.3}: {score:.3} of samples {first:.4} x {sample:.1} (rare {rare:.4}), \
             mutations {second:.4} x {mutation:.1} (correlation {:.2}, {:.2} % of the light)",
            base.map(|b| b.base),
            base.map_or(0.0, |b| b.tau / self.mean),
            scouting.correlation,
            100.0 * light / self.mean,
        );
        Choice {
            base,
            is_equalised,
            chains_share: if nothing_left { 0.0 } else { light / self.mean },
            variances: [first, second],
            scouting,
            score,
        }
    }

    fn kernel(&self, choice: &Choice) -> Kernel {
        let selective = choice.base.map_or(Target::Whole, Target::Selective);
        let equalised = if choice.is_equalised {
            Target::Equalised(Arc::new(Equalised::new(TILES, &self.luminances)))
        } else {
            Target::Whole
        };
        Kernel { mixture: self.survey.mixture.clone(), target: selective.times(equalised) }
    }

    /// Runs short chains, each by itself, and looks how far their splats lie together.
    fn scout(&self, scene: &Scene, settings: &PlanSettings, kernel: &Kernel) -> Scouting {
        let &PlanSettings { seed, threads, .. } = settings;
        let (chains, samples, steps) = SCOUTS;
        let tracer = Tracer::new(scene);
        // Replicates have the numbers from one on.
        let key = PoolKey { seed, number: 0 };
        let mut source = Source::new(&tracer, key, &kernel.target);
        let pool = source.pool(samples);
        let seeds = source.seeds(&pool, chains);
        let runs = parallel::map(
            threads,
            0..seeds.len() as u64,
            || Scout::new(scene),
            |scout, number| {
                let rng = Rng::new(seed, Stream::Scout, number);
                let start = seeds[number as usize].clone();
                scout.run(kernel, Chain::with_stream(common::ChainId(0), rng, start, kernel), self)
            },
        );
        let guess = FIRST_GUESS;
        let (mut spread, mut work) = (0.0, 0.0);
        for run in &runs {
            spread += run.0;
            work += work_of_mutations(run.1, steps as u64);
        }
        let mutations = (runs.len() * steps) as f64;
        if !(mutations > 0.0) {
            return guess;
        }
        // Independent states would spread by the sum over all pixels of what one state adds. Few chains
        // that stay rule the mean: one standard error more keeps a lucky look from promising too much.
        let alone = runs.iter().map(|run| run.2).sum::<f64>();
        let mean = spread / runs.len() as f64;
        let squares = runs.iter().map(|run| (run.0 - mean).powi(2)).sum::<f64>();
        let correlation = (spread + squares.sqrt()) / alone;
        let correlation = if correlation.is_finite() { correlation } else { guess.correlation };
        Scouting { mutation: work / mutations, correlation: correlation.clamp(0.5, 200.0) }
    }

    fn plan(self, scene: &Scene, seed: u64, choice: &Choice) -> Plan {
        let pixels = scene.camera().pixel_count() as f64;
        let has_chains = choice.chains_share > 0.0 && self.mean > 0.0;
        let [first, second] = choice.variances;
        let sample = choice.base.map_or(0.0, |b| self.work[b.base as usize]);
        let mutation = choice.scouting.mutation;
        let ratio = match (choice.base.is_some(), has_chains) {
            (_, false) => 0.0,
            (false, true) => MUTATIONS_ALONE,
            (true, true) => {
                let best = (second * sample / (first * mutation)).sqrt();
                if best.is_nan() { 1.0 } else { best.clamp(MUTATIONS.0, MUTATIONS.1) }
            }
        };
        let part = pixels * (sample + ratio * mutation);
        let fits = (REPLICATE_WORK / part).log2().floor().clamp(0.0, 31.0);
        let parts = (1_u32 << fits as u32).min(MOST_PARTS);
        let work = part * f64::from(parts);
        let pooled = self.work[Base::Bidirectional as usize];
        let pool = (POOL_SHARE * work / pooled).clamp(64.0, 65_536.0) as u64;
        let mutations = ratio * pixels * f64::from(parts);
        let kernel = self.kernel(choice);
        let diverse = pool as f64 * self.effective_share(&kernel.target) / DIVERSITY;
        let chains =
            if has_chains { (mutations / STEPS).min(diverse).clamp(4.0, 1024.0) as u32 } else { 0 };
        let steps =
            (mutations / f64::from(chains.max(1)) / f64::from(parts)).ceil().max(1.0) as u64;
        let outlook = Outlook {
            base: choice.base.map(|selective| selective.base),
            tau: choice.base.map_or(0.0, |selective| selective.tau),
            chains_share: if has_chains { choice.chains_share } else { 0.0 },
            mutations_per_sample: ratio,
            pool_share: if has_chains {
                pool as f64 * pooled / (work + pool as f64 * pooled)
            } else {
                0.0
            },
            correlation: choice.scouting.correlation,
            is_equalised: choice.is_equalised && has_chains,
        };
        Plan {
            seed,
            base: choice.base,
            kernel: Arc::new(kernel),
            parts,
            pool: if has_chains { pool } else { 0 },
            chains,
            steps,
            brightness: self.mean,
            prospects: self.survey.prospects,
            outlook,
        }
    }

    /// Share of the samples of a pool for chains that visit `target` that would be as good if they
    /// were equal: `(sum w)^2 / (n sum w^2)`.
    fn effective_share(&self, target: &Target) -> f64 {
        let mut weights = vec![0.0; self.survey.samples as usize];
        for sighting in &self.survey.sightings {
            weights[sighting.sample as usize] += sighting.weight * rho(sighting, target);
        }
        let sum: f64 = weights.iter().sum();
        let squares: f64 = weights.iter().map(|w| w * w).sum();
        if squares > 0.0 { sum * sum / squares / weights.len() as f64 } else { 0.0 }
    }
}

/// `rho` of a path that was seen.
fn rho(sighting: &Sighting, target: &Target) -> f64 {
    match target {
        Target::Whole => 1.0,
        Target::Selective(s) => 1.0 - s.base_share(sighting.density_sum(s.base), sighting.edges),
        Target::Equalised(equalised) => equalised.at(glam::Vec2::from(sighting.film).as_dvec2()),
        Target::Product(parts) => parts.iter().map(|part| rho(sighting, part)).product(),
    }
}

/// One worker of the scouting.
struct Scout<'s> {
    scene: Tracer<'s>,
    film: Film,
    touched: Vec<usize>,
}

impl<'s> Scout<'s> {
    fn new(scene: &'s Scene) -> Self {
        let camera = scene.camera();
        let film = Film::new(camera.width, camera.height);
        Self { scene: Tracer::new(scene), film, touched: Vec::new() }
    }

    /// Sum over the pixels of their weighted squares after a number of steps, the rays that the steps
    /// took, and what the sum would be were no two splats in the same pixel.
    fn run(&mut self, kernel: &Kernel, mut chain: Chain, view: &View) -> (f64, RayCounts, f64) {
        let Self { scene, film, touched } = self;
        let before = RayCounts::of(scene);
        touched.clear();
        touched.push(chain.current().pixel());
        let mut alone = 0.0;
        for _ in 0..SCOUTS.2 {
            chain.step(scene, kernel, film);
            touched.push(chain.current().pixel());
            touched.push(chain.proposed().pixel());
            let share = kernel.target.importance(chain.current()).share;
            alone += share * share * view.weight_at(chain.current().film());
        }
        chain.flush(film);
        touched.sort_unstable();
        touched.dedup();
        let mut spread = 0.0;
        let camera = scene.camera();
        for &pixel in touched.iter() {
            let color = film.pixels()[pixel];
            let (x, y) = (pixel as u32 % camera.width, pixel as u32 / camera.width);
            let place = glam::DVec2::new(
                (f64::from(x) + 0.5) / f64::from(camera.width),
                (f64::from(y) + 0.5) / f64::from(camera.height),
            );
            spread += color.luminance().powi(2) * view.weight_at(place);
            film.set(pixel, Rgb::BLACK);
        }
        (spread, RayCounts::of(scene).since(before), alone)
    }
}

impl View {
    fn weight_at(&self, film: glam::DVec2) -> f64 {
        let place = |at: f64| ((at * TILES as f64) as usize).min(TILES - 1);
        self.weights[place(film.y) * TILES + place(film.x)]
    }
}
