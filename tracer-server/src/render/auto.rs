//! Pictures of replicates: base samples for what they find well, chains for the rest.

use std::time::{Duration, Instant};

use cpu_time::ProcessTime;

use super::{Budget, Progress, RenderSettings, Rendering, Report, chain_report};
use crate::chain::Normalization;
use crate::parallel::Stop;
use crate::replicate::{
    Advance, Ledger, Limits, Origin, Part, Picture, Plan, PlanSettings, Selection, TILE, prepare,
};
use crate::scene::Scene;
use host::picture::Plane;

/// Numbers of replicates after which a picture that is to reach an error is looked at: each is about
/// a third more than the one before.
const LOOKS: [u64; 36] = [
    4, 6, 8, 11, 15, 20, 27, 36, 48, 64, 85, 113, 150, 200, 270, 360, 480, 640, 850, 1130, 1500,
    2000, 2700, 3600, 4800, 6400, 8500, 11_300, 15_000, 20_000, 27_000, 36_000, 48_000, 64_000,
    85_000, 113_000,
];
/// Time between two films that are saved, in seconds.
const SAVING: Duration = Duration::from_secs(4);

/// Keeps what there is of a picture.
pub type Save<'a> = dyn FnMut(&Part) + Send + 'a;

/// What is asked for besides the settings of every picture.
pub struct Wish<'a> {
    /// Which replicates; as many as the budget allows without.
    pub selection: Option<Selection>,
    /// Replicates that are there already.
    pub begun: Option<Part>,
    /// The noise at which the picture is done.
    pub until: Option<f64>,
    /// Somebody wants it to end.
    pub stop: Stop,
    /// Who keeps the replicates there are, every few seconds and at the end.
    pub save: Option<&'a mut Save<'a>>,
}

impl Wish<'_> {
    /// Nothing besides.
    pub fn none() -> Self {
        Self { selection: None, begun: None, until: None, stop: Stop::default(), save: None }
    }
}

impl std::fmt::Debug for Wish<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Wish")
            .field("selection", &self.selection)
            .field("until", &self.until)
            .finish_non_exhaustive()
    }
}

/// What a plan's replicates are of.
pub fn origin(scene: &Scene, plan: &Plan) -> Origin {
    let camera = scene.camera();
    let digest = blake3::hash(format!("{plan:?}").as_bytes());
    Origin {
        version: env!("CARGO_PKG_VERSION").to_owned(),
        scene: scene.name().to_owned(),
        scene_hash: scene.hash().to_owned(),
        settings_hash: digest.to_hex().to_string(),
        settings: plan.describe(),
        size: [camera.width, camera.height],
        radiance_scale: scene.radiance_scale().to_bits(),
    }
}

/// Renders a picture of replicates.
///
/// # Errors
///
/// Where the replicates there are do not belong to the picture.
pub fn render(
    scene: &Scene,
    settings: &RenderSettings,
    wish: Wish<'_>,
    on_progress: &mut (dyn FnMut(Progress) + Send),
) -> anyhow::Result<Rendering> {
    let (wall, cpu) = (Instant::now(), ProcessTime::now());
    let ensemble = &settings.ensemble;
    let threads = ensemble.threads.max(1);
    on_progress(Progress::Seeding(0));
    let wanted = PlanSettings {
        seed: ensemble.seed,
        threads,
        strategies: ensemble.strategies,
        dial: settings.dial,
    };
    let plan = prepare(scene, &wanted, &wish.stop);
    let seeding_seconds = wall.elapsed().as_secs_f64();
    let mut picture = Picture::new(scene, &plan);
    let origin = origin(scene, &plan);
    if let Some(begun) = wish.begun {
        origin.check(&begun)?;
        picture.ledger = begun.ledger;
    }
    let mut job = Job {
        scene,
        plan: &plan,
        origin,
        limits: Limits { deadline: deadline(settings.budget, wall), stop: &wish.stop, threads },
        budget: settings.budget,
        began: wall,
        saved: Instant::now(),
        save: wish.save,
    };
    let most = match settings.budget {
        Budget::PerPixel(n) => plan.replicates_for(n, scene.camera()),
        Budget::Time(_) => u64::MAX - 1,
    };
    match (wish.selection, wish.until) {
        (Some(selection), _) => job.work(&mut picture, &selection.closed(most), on_progress),
        (None, Some(noise)) => job.work_until(&mut picture, noise, most, on_progress),
        (None, None) => job.work(&mut picture, &Selection::first(most), on_progress),
    }
    job.keep(&picture);
    let mut image = picture.image();
    image.scale(scene.radiance_scale());
    let (wall_seconds, cpu_seconds) = (wall.elapsed().as_secs_f64(), cpu.elapsed().as_secs_f64());
    let report = Report {
        wall_seconds,
        cpu_seconds,
        seeding_seconds,
        threads,
        stopped: wish.stop.is_set(),
        mean: image.mean().into(),
        ..report(scene, &plan, &picture)
    };
    let rate = report.mutations as f64 / (wall_seconds - seeding_seconds).max(1e-9);
    let errors = Some(picture.ledger).filter(|ledger| ledger.count() > 1);
    Ok(Rendering { image, report: Report { rate, ..report }, errors })
}

fn deadline(budget: Budget, began: Instant) -> Option<Instant> {
    match budget {
        Budget::PerPixel(_) => None,
        Budget::Time(limit) => Some(began + limit),
    }
}

/// A picture at work.
struct Job<'a, 'w> {
    scene: &'a Scene,
    plan: &'a Plan,
    origin: Origin,
    limits: Limits<'a>,
    budget: Budget,
    began: Instant,
    saved: Instant,
    save: Option<&'w mut Save<'w>>,
}

impl Job<'_, '_> {
    fn work(
        &mut self,
        picture: &mut Picture,
        selection: &Selection,
        on_progress: &mut (dyn FnMut(Progress) + Send),
    ) {
        let all = selection.count() as f64
            + selection.tails.iter().map(|(_, parts)| f64::from(*parts)).sum::<f64>()
                / f64::from(self.plan.parts);
        let (budget, began) = (self.budget, self.began);
        let limits = Limits { stop: self.limits.stop, ..self.limits };
        let (scene, plan) = (self.scene, self.plan);
        let mut on_advance = |advance: Advance, picture: Option<&Picture>| {
            let share = match budget {
                Budget::PerPixel(_) => advance.replicates / all,
                Budget::Time(limit) => {
                    began.elapsed().as_secs_f64() / limit.as_secs_f64().max(1e-9)
                }
            };
            on_progress(Progress::Rendering(share.min(1.0)));
            if let Some(picture) = picture.filter(|_| self.saved.elapsed() > SAVING) {
                self.keep(picture);
            }
        };
        picture.work(scene, plan, selection, &limits, &mut on_advance);
    }

    /// Works until the noise is low enough, which is looked at after preset numbers of replicates.
    fn work_until(
        &mut self,
        picture: &mut Picture,
        noise: f64,
        most: u64,
        on_progress: &mut (dyn FnMut(Progress) + Send),
    ) {
        for look in LOOKS {
            self.work(picture, &Selection::first(look.min(most)), &mut |_| ());
            let now = picture.ledger.noise();
            // Noise falls with the root of the number of replicates.
            on_progress(Progress::Rendering((noise / now).powi(2).clamp(0.0, 1.0)));
            let is_over = self.limits.stop.is_set()
                || self.limits.deadline.is_some_and(|deadline| Instant::now() >= deadline);
            if now <= noise || look >= most || is_over {
                return;
            }
        }
    }

    /// Keeps the replicates there are.
    fn keep(&mut self, picture: &Picture) {
        if let Some(save) = &mut self.save {
            let part = Part { origin: self.origin.clone(), ledger: picture.ledger.clone() };
            save(&part);
            self.saved = Instant::now();
        }
    }
}

/// The part of the report that follows from the replicates.
fn report(scene: &Scene, plan: &Plan, picture: &Picture) -> Report {
    let camera = scene.camera();
    let names = plan.kernel.mixture.names();
    let scale = scene.radiance_scale();
    let b = picture.ledger.normalization();
    let normalization = Normalization { b: b.mean * scale, error: b.error * scale };
    let sum = |value: fn(&crate::replicate::Row) -> u64| picture.rows().map(value).sum::<u64>();
    let replicates = picture.ledger.count();
    let mean = picture.ledger.mean();
    Report {
        scene: scene.name().to_owned(),
        scene_hash: scene.hash().to_owned(),
        integrator: super::Integrator::Auto.name().to_owned(),
        seed: plan.seed,
        width: camera.width,
        height: camera.height,
        max_edges: scene.max_edges(),
        mutations: sum(|row| row.steps + row.samples),
        base_samples: sum(|row| row.samples),
        rays: sum(|row| row.rays),
        shadow_rays: sum(|row| row.shadow_rays),
        chains: plan.chains as usize,
        bootstrap_samples: plan.pool,
        prospects: plan.prospects.clone(),
        replicates,
        selection: picture.selection().to_string(),
        outlook: Some(plan.outlook),
        noise: (replicates > 1).then(|| picture.ledger.noise()),
        mean_error: (replicates > 1).then_some(mean.error * scale),
        mean_kurtosis: (replicates > 3).then_some(mean.kurtosis),
        ..chain_report(&names, &picture.statistics, normalization)
    }
}

/// What is known of the errors of a picture, pixel by pixel: the standard error of its luminance, that of
/// the mean of its tile, in radiance of the file's units, and whether the former can be trusted.
pub fn planes(ledger: &Ledger, radiance_scale: f64) -> Vec<Plane> {
    let scaled = |values: Vec<f32>| -> Vec<f32> {
        values.into_iter().map(|value| (f64::from(value) * radiance_scale) as f32).collect()
    };
    let reliable = ledger.is_reliable().into_iter().map(|is| f32::from(u8::from(is)));
    let (width, columns) = (ledger.width(), ledger.width().div_ceil(TILE));
    let tiles = ledger.tile_errors();
    let of_tile = |pixel: u32| {
        let (x, y) = (pixel % width, pixel / width);
        tiles[(y / TILE * columns + x / TILE) as usize]
    };
    let of_tiles = (0..width * ledger.height()).map(of_tile).collect();
    vec![
        Plane { name: "error", values: scaled(ledger.standard_errors()) },
        Plane { name: "tile_error", values: scaled(of_tiles) },
        Plane { name: "reliable", values: reliable.collect() },
    ]
}

/// The picture of a film of replicates, with its report.
pub fn of_part(part: &Part) -> (crate::film::Film, Ledger) {
    let ledger = part.ledger.clone();
    let mut image = ledger.sum();
    let scale = f64::from_bits(part.origin.radiance_scale);
    image.scale(if ledger.count() > 0 { scale / ledger.count() as f64 } else { 0.0 });
    (image, ledger)
}

/// Renders with nothing wished for besides the settings.
pub(super) fn plain(
    stop: &Stop,
    scene: &Scene,
    settings: &RenderSettings,
    on_progress: &mut (dyn FnMut(Progress) + Send),
) -> Rendering {
    // Without a film to begin with, nothing can go wrong.
    let wish = Wish { stop: stop.clone(), ..Wish::none() };
    render(scene, settings, wish, on_progress).unwrap_or_else(|_error| Rendering {
        image: crate::film::Film::new(scene.camera().width, scene.camera().height),
        report: Report::default(),
        errors: None,
    })
}
