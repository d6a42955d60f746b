//! The explorer's chain, and what can be seen of each of its steps.

use std::collections::VecDeque;
use std::sync::Arc;

use common::{
    ChainId, FilmFrame, FocusOutcome, FocusPath, FocusStep, PathDetail, PathId, RatioFactors, Seed,
    StrategyId, StrategySet, VertexRecord,
};

use crate::chain::{Archive, Chain, Checkpoint, Kernel, Outcome, Round, Step};
use crate::film::Film;
use crate::hub::FocusNews;
use crate::math::{Rng, Stream};
use crate::path::{Cut, Draft, Failure, Kept, Path, Vertex};
use crate::scene::{RayCounts, Scene, Tracer};

/// Paths of its own that the explorer can go back to: about two megabytes.
const MEMORY: usize = 4096;

/// The explorer's chain with all that it needs.
#[derive(Debug)]
pub(super) struct Walker {
    scene: Arc<Scene>,
    run_seed: u64,
    epoch: u32,
    allowed: StrategySet,
    film: Film,
    walk: Option<Walk>,
    /// Number of the next step.
    number: u64,
    fans: u64,
    fan: Rng,
    /// The paths that it has had, oldest first, ready to go on from.
    memory: VecDeque<Checkpoint>,
}

/// How far a walk has come.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Progress {
    pub(super) steps: u64,
    pub(super) accepted: u64,
}

/// A walk from a seed.
#[derive(Debug)]
struct Walk {
    chain: Chain,
    /// Where it began, and the strategies with their weights of that time.
    origin: PathId,
    round: Arc<Round>,
    /// The strategies that may act.
    kernel: Kernel,
    current: Arc<FocusPath>,
    steps: u64,
    accepted: u64,
}

impl Walker {
    /// An explorer of `scene` without a path.
    pub(super) fn new(scene: Arc<Scene>, run_seed: u64) -> Self {
        let camera = scene.camera();
        let film = Film::new(camera.width, camera.height);
        Self {
            film,
            scene,
            run_seed,
            epoch: 0,
            allowed: StrategySet::ALL,
            walk: None,
            number: 1,
            fans: 0,
            fan: Rng::new(run_seed, Stream::Fan, 0),
            memory: VecDeque::new(),
        }
    }

    /// True when it has a path.
    pub(super) fn is_seeded(&self) -> bool {
        self.walk.is_some()
    }

    /// Names of the strategies, in their order.
    pub(super) fn strategies(&self) -> Vec<String> {
        self.walk.as_ref().map(|walk| walk.kernel.mixture.names()).unwrap_or_default()
    }

    /// The strategies that may act.
    pub(super) fn allowed(&self) -> StrategySet {
        self.allowed
    }

    /// The path that it was seeded with.
    pub(super) fn origin(&self) -> Option<PathId> {
        self.walk.as_ref().map(|walk| walk.origin)
    }

    /// Its current path.
    pub(super) fn current(&self) -> Option<&Arc<FocusPath>> {
        self.walk.as_ref().map(|walk| &walk.current)
    }

    /// Number of the next step.
    pub(super) fn next(&self) -> u64 {
        self.number
    }

    /// Steps since it was seeded, and how many of them were accepted.
    pub(super) fn progress(&self) -> Progress {
        let progress = |walk: &Walk| Progress { steps: walk.steps, accepted: walk.accepted };
        self.walk.as_ref().map(progress).unwrap_or_default()
    }

    /// Makes a path the current one; or says why it cannot.
    pub(super) fn seed(&mut self, seed: Seed, archive: &Archive) -> Result<FocusNews, String> {
        let origin = match seed {
            Seed::Path(id) => id,
            Seed::Newest => archive
                .newest_path()
                .ok_or("no path has been shown yet; watch the chains for a moment and try again")?,
        };
        let (path, round) = self.path(origin, archive)?;
        let kernel = restricted(&round.kernel, self.allowed)?;
        self.begin(path, origin, round, kernel);
        Ok(self.arrived())
    }

    /// The path of that name, made again, with the strategies of its time; or why it is gone.
    fn path(&self, id: PathId, archive: &Archive) -> Result<(Path, Arc<Round>), String> {
        let scene = Tracer::new(&self.scene);
        if id.chain == ChainId::EXPLORER {
            let known = self.memory.iter().find(|checkpoint| checkpoint.id() == id);
            let (checkpoint, walk) = known.zip(self.walk.as_ref()).ok_or_else(|| {
                format!(
                    "the path {id} is no longer stored: the explorer keeps its last {MEMORY} paths"
                )
            })?;
            let chain = Chain::resume(&scene, checkpoint, &walk.kernel)
                .map_err(|failure| format!("{id} is not a valid path: {}", failure.name()))?;
            return Ok((chain.current().clone(), Arc::clone(&walk.round)));
        }
        // The explorer's own film must not see steps that only find a path, or find none.
        let mut scratch = Film::new(self.film.width(), self.film.height());
        archive.path(&scene, id, &mut scratch).map_err(|gone| gone.to_string())
    }

    /// The numbers behind the path of that name, or why it is gone.
    pub(super) fn detail(&self, id: PathId, archive: &Archive) -> Result<PathDetail, String> {
        let (path, _) = self.path(id, archive)?;
        path.detail(&Tracer::new(&self.scene))
            .map_err(|failure| format!("{id} is not a valid path: {}", failure.name()))
    }

    /// Restricts which strategies may act; the path stays, in an epoch of its own.
    pub(super) fn allow(&mut self, set: StrategySet) -> Result<FocusNews, String> {
        if let Some(walk) = self.walk.take() {
            match restricted(&walk.round.kernel, set) {
                Ok(kernel) => {
                    self.allowed = set;
                    let path = walk.chain.current().clone();
                    self.begin(path, walk.origin, walk.round, kernel);
                }
                Err(error) => {
                    self.walk = Some(walk);
                    return Err(error);
                }
            }
        }
        Ok(self.arrived())
    }

    fn begin(&mut self, path: Path, origin: PathId, round: Arc<Round>, kernel: Kernel) {
        self.epoch += 1;
        let rng = Rng::new(self.run_seed, Stream::Explorer, self.epoch.into());
        let mut chain = Chain::with_stream(ChainId::EXPLORER, rng, path, &kernel);
        self.film = Film::new(self.film.width(), self.film.height());
        chain.begin_epoch(self.epoch, &kernel, &mut self.film);
        let current = Arc::new(focus_path(&chain, self.number));
        self.walk = Some(Walk { chain, origin, round, kernel, current, steps: 0, accepted: 0 });
        self.remember();
    }

    /// What is reported about a path that no step has led to.
    fn arrived(&self) -> FocusNews {
        let after = self.current().map_or_else(Arc::default, Arc::clone);
        FocusNews { step: None, after }
    }

    /// Tries one mutation. There must be a path.
    pub(super) fn step(&mut self) -> (Arc<FocusStep>, Arc<FocusPath>) {
        let scene = Tracer::new(&self.scene);
        let Some(walk) = &mut self.walk else { return Default::default() };
        let step = walk.chain.step(&scene, &walk.kernel, &mut self.film);
        walk.steps += 1;
        let id = PathId { chain: ChainId::EXPLORER, epoch: self.epoch, step: walk.chain.steps() };
        let moved = matches!(step.outcome, Outcome::Accepted { .. });
        let told = FocusStep { number: self.number, id, ..walk.describe(&scene, &step) };
        self.number += 1;
        walk.accepted += u64::from(moved);
        let after =
            walk.current.after(&told).unwrap_or_else(|| focus_path(&walk.chain, self.number));
        debug_assert_eq!(
            (after.vertices == records(walk.chain.current().vertices()), after.next),
            (true, self.number),
            "what is told is what happened"
        );
        walk.current = Arc::new(after);
        let after = Arc::clone(&walk.current);
        if moved {
            self.remember();
        }
        (Arc::new(told), after)
    }

    /// Begins a fan with a random stream of its own, which leaves that of the walk alone.
    pub(super) fn open_fan(&mut self) {
        self.fans += 1;
        self.fan = Rng::new(self.run_seed, Stream::Fan, self.fans);
    }

    /// One proposal of a fan. There must be a path, and such a strategy.
    pub(super) fn probe(&mut self, strategy: StrategyId) -> FocusNews {
        let scene = Tracer::new(&self.scene);
        let Some(walk) = &mut self.walk else { return self.arrived() };
        let index = usize::from(strategy.0);
        // The weights of all strategies: a fan may show one that must not act now.
        let weights = walk.kernel.mixture.weights();
        let kernel = if weights.get(index).is_some_and(|&weight| weight > 0.0) {
            &walk.kernel
        } else {
            &*walk.round.kernel
        };
        let step = walk.chain.probe(&scene, kernel, index, &mut self.fan);
        let id = walk.current.header.id;
        let seen = walk.describe(&scene, &step);
        let told = FocusStep { number: self.number, id, fan: true, strategy, ..seen };
        self.number += 1;
        if let Some(after) = walk.current.after(&told) {
            walk.current = Arc::new(after);
        }
        FocusNews { step: Some(Arc::new(told)), after: Arc::clone(&walk.current) }
    }

    /// The film, as bright on average as the image; `None` before the first step.
    pub(super) fn film(&mut self) -> Option<FilmFrame> {
        let walk = self.walk.as_mut().filter(|walk| walk.steps > 0)?;
        walk.chain.flush(&mut self.film);
        let mut film = self.film.clone();
        let pixels = f64::from(film.width()) * f64::from(film.height());
        film.scale(walk.round.normalization * pixels / walk.steps as f64);
        Some(FilmFrame {
            width: film.width(),
            height: film.height(),
            steps: walk.steps,
            pixels: film.into_pixels(),
        })
    }

    fn remember(&mut self) {
        let Some(walk) = &self.walk else { return };
        if self.memory.len() >= MEMORY {
            self.memory.pop_front();
        }
        self.memory.push_back(walk.chain.checkpoint());
    }
}

impl Walk {
    /// What is seen of a step that the chain has just tried. Number, id and fan are still to be set.
    fn describe(&self, scene: &Tracer<'_>, step: &Step) -> FocusStep {
        let mut rays = RayCounts::default();
        rays.add(scene);
        let failed = matches!(step.outcome, Outcome::Failed(_));
        let factors = self.chain.trial().filter(|_| !failed).map(|trial| RatioFactors {
            forward: trial.proposal.forward,
            backward: trial.proposal.backward,
            mixture_current: trial.mixture_current,
            mixture_proposed: trial.mixture_proposed,
            target_current: trial.target_current,
            target_proposed: trial.target_proposed,
        });
        let stuck = failed && !(self.kernel.mixture.total(self.chain.current()) > 0.0);
        let told = FocusStep {
            strategy: StrategyId(if stuck { u8::MAX } else { step.strategy as u8 }),
            acceptance: step.acceptance,
            factors: factors.unwrap_or_default(),
            length: self.current.vertices.len(),
            rays: (rays.rays + rays.shadow_rays) as u32,
            ..FocusStep::default()
        };
        match step.outcome {
            Outcome::Failed(reason) => self.describe_failure(scene, reason, told),
            Outcome::Rejected => {
                let kept = self.chain.trial().map(|trial| trial.proposal.kept);
                describe_proposal(self.chain.proposed(), kept.unwrap_or_default(), told)
            }
            // A step has moved the chain, a probe has not.
            Outcome::Accepted { kept_light, kept_eye } => {
                let moved = self.chain.header().id.step != self.current.header.id.step;
                let y = if moved { self.chain.current() } else { self.chain.proposed() };
                let told = FocusStep { outcome: FocusOutcome::Accepted, ..told };
                describe_proposal(y, Kept { light: kept_light, eye: kept_eye }, told)
            }
        }
    }

    fn describe_failure(&self, scene: &Tracer<'_>, reason: Failure, told: FocusStep) -> FocusStep {
        let outcome = FocusOutcome::Failed(reason as u8);
        let draft = self.chain.draft();
        let x = self.chain.current();
        let Some(cut) = draft.cut else {
            return FocusStep { outcome, kept_light: told.length, ..told };
        };
        let blocker = (reason == Failure::Occluded).then(|| blocker(scene, x, cut, draft));
        // A light infinitely far away moves with the vertex that it shines on.
        let moves = cut.light == 1 && x.is_lit_from_afar();
        let kept_light = if moves { 0 } else { cut.light };
        FocusStep {
            outcome,
            kept_light,
            kept_eye: cut.kept(told.length).eye.min(told.length - kept_light),
            inserted: records(&draft.light),
            eye_side: records(&draft.eye),
            blocker: blocker.flatten(),
            ..told
        }
    }
}

/// What is seen of a complete proposal.
fn describe_proposal(y: &Path, kept: Kept, told: FocusStep) -> FocusStep {
    let end = y.vertices().len().saturating_sub(kept.eye);
    FocusStep {
        kept_light: kept.light,
        kept_eye: kept.eye,
        inserted: records(y.vertices().get(kept.light..end).unwrap_or_default()),
        film: y.film().as_vec2().to_array(),
        luminance: (1.0 / y.density_sum()) as f32,
        rgb: y.unit_color().to_f32(),
        ..told
    }
}

/// The surface in the way between the two sides of a failed proposal.
fn blocker(scene: &Tracer<'_>, x: &Path, cut: Cut, draft: &Draft) -> Option<[f32; 3]> {
    let a = draft.light.last().or_else(|| x.vertices().get(cut.light.checked_sub(1)?))?;
    let b = draft.eye.last().or_else(|| x.vertices().get(cut.eye_from))?;
    // From b, which is always a place.
    let (direction, distance) = if a.is_lamp() && scene.is_infinite(a.material) {
        (-a.normal, f64::INFINITY)
    } else {
        let span = a.position - b.position;
        (span.normalize_or_zero(), span.length())
    };
    let hit = scene.closest(&b.anchor(), direction)?;
    let is_between = (hit.position - b.position).length() < distance;
    is_between.then(|| hit.position.as_vec3().to_array())
}

/// The kernel with nothing but the strategies of a set.
fn restricted(kernel: &Kernel, set: StrategySet) -> Result<Kernel, String> {
    let mut kernel = kernel.clone();
    let mixture = &mut kernel.mixture;
    let keep = |(index, &weight): (usize, &f64)| {
        if set.contains(StrategyId(index as u8)) { weight } else { 0.0 }
    };
    let weights: Vec<f64> = mixture.weights().iter().enumerate().map(keep).collect();
    if !weights.iter().any(|&weight| weight > 0.0) {
        return Err("none of the allowed strategies is switched on; allow others".to_owned());
    }
    mixture.set_weights(&weights);
    Ok(kernel)
}

fn records(vertices: &[Vertex]) -> Vec<VertexRecord> {
    vertices.iter().map(Vertex::record).collect()
}

fn focus_path(chain: &Chain, next: u64) -> FocusPath {
    FocusPath { header: chain.header(), vertices: records(chain.current().vertices()), next }
}
