//! The explorer: a chain that people seed and step, and every step of it.

use crate::{Author, PathHeader, PathId, StrategyId, VertexRecord};

/// Slowest and fastest play, in steps a second.
pub const MIN_RATE: f32 = 0.05;
/// See [`MIN_RATE`].
pub const MAX_RATE: f32 = 2000.0;
/// Most single steps in one order.
pub const MAX_STEPS: u32 = 10_000;
/// Most proposals of one fan.
pub const MAX_FAN: u32 = 1000;

/// Moves the explorer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ExplorerCommand {
    /// Makes a path its current state, and opens an epoch of its own.
    Seed(Seed),
    /// Steps continuously, at this many steps per second, from [`MIN_RATE`] to [`MAX_RATE`].
    Play(f32),
    /// Stands still.
    Pause,
    /// Takes this many steps, 1 to [`MAX_STEPS`], and stands still.
    Step(u32),
    /// Steps until something happens, and stands still.
    Skip(SkipTo),
    /// Restricts which strategies may act, with their weights of the chains. At least one must.
    Allow(StrategySet),
    /// Shows `count` proposals of one strategy, 1 to [`MAX_FAN`], without moving.
    Fan {
        /// The strategy.
        strategy: StrategyId,
        /// Number of proposals.
        count: u32,
    },
}

/// Where an explorer's path comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Seed {
    /// The path of this name, exactly; refused where it is gone.
    Path(PathId),
    /// Whatever path was shown last.
    Newest,
}

/// What ends a skip.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SkipTo {
    /// An accepted step.
    Acceptance,
    /// A step of this strategy.
    Strategy(StrategyId),
}

/// A set of strategies: bit `i` stands for the strategy number `i`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StrategySet(pub u64);

impl StrategySet {
    /// All of them.
    pub const ALL: Self = Self(u64::MAX);

    /// True when the strategy is in the set.
    pub fn contains(self, strategy: StrategyId) -> bool {
        strategy.0 < 64 && self.0 >> strategy.0 & 1 == 1
    }

    /// The set with a strategy added, or taken out.
    #[must_use]
    pub fn with(self, strategy: StrategyId, is_in: bool) -> Self {
        let bit = if strategy.0 < 64 { 1 << strategy.0 } else { 0 };
        Self(if is_in { self.0 | bit } else { self.0 & !bit })
    }
}

impl Default for StrategySet {
    fn default() -> Self {
        Self::ALL
    }
}

/// Whether the explorer moves.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Pace {
    /// It stands.
    #[default]
    Paused,
    /// It steps at its rate.
    Playing,
    /// It takes steps that were asked for, or steps until something happens.
    Skipping,
}

/// What the explorer is at.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ExplorerState {
    /// Whether it moves.
    pub pace: Pace,
    /// Steps a second while it plays.
    pub rate: f32,
    /// The strategies that may act.
    pub allowed: StrategySet,
    /// Its current path; `None` before it was seeded.
    pub current: Option<PathId>,
    /// The path that it was seeded with.
    pub origin: Option<PathId>,
    /// Steps since then.
    pub steps: u64,
    /// How many of them were accepted.
    pub accepted: u64,
    /// Number of the step that comes next; see [`FocusStep::number`].
    pub next: u64,
    /// Who gave the last order.
    pub by: Option<Author>,
}

/// The current path of the explorer: whole.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FocusPath {
    /// All but the vertices. The chain is [`crate::ChainId::EXPLORER`]; the weight is zero, since the path
    /// stands for nothing in the image.
    pub header: PathHeader,
    /// From the light to the lens.
    pub vertices: Vec<VertexRecord>,
    /// Number of the step that comes next; see [`FocusStep::number`].
    pub next: u64,
}

impl FocusPath {
    /// The current path after a step; `None` where the step does not follow this path.
    pub fn after(&self, step: &FocusStep) -> Option<Self> {
        if self.next != step.number || self.vertices.len() != step.length {
            return None;
        }
        let next = step.number.checked_add(1)?;
        if step.fan || step.outcome != FocusOutcome::Accepted {
            let dwell = self.header.dwell.saturating_add(u32::from(!step.fan));
            let header = PathHeader { dwell, ..self.header };
            return Some(Self { header, vertices: self.vertices.clone(), next });
        }
        let header = PathHeader {
            id: step.id,
            strategy: step.strategy,
            dwell: 0,
            weight: 0.0,
            acceptance: step.acceptance as f32,
            film: step.film,
            luminance: step.luminance,
            rgb: step.rgb,
        };
        Some(Self { header, vertices: step.proposal(&self.vertices)?, next })
    }

    /// Bytes that the path takes in a queue, about.
    pub fn byte_len(&self) -> usize {
        96 + 24 * self.vertices.len()
    }
}

/// What became of a step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FocusOutcome {
    /// The proposal is the current path now.
    Accepted,
    /// The proposal lost against its acceptance probability.
    #[default]
    Rejected,
    /// There is no proposal; index into the announced reasons.
    Failed(u8),
}

/// The factors of an acceptance probability:
/// `a(x -> y) = min(1, (backward / forward) (mixture_current / mixture_proposed)
/// (target_proposed / target_current))`.
///
/// A transition is a density over the light that the path carries, up to a factor that cancels.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RatioFactors {
    /// `Q(y | x)`, the density of proposing y from x over the luminance of y.
    pub forward: f64,
    /// `Q(x | y)`, the same for the way back.
    pub backward: f64,
    /// `Z(x)`, the weights of all strategies that can do something with x.
    pub mixture_current: f64,
    /// `Z(y)`; 0 where the strategy could not make the way back.
    pub mixture_proposed: f64,
    /// `rho(x)`, how much more often x is visited than its light alone would have it.
    pub target_current: f64,
    /// `rho(y)`; 0 where y is not visited at all.
    pub target_proposed: f64,
}

/// One step of the explorer, whatever became of it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FocusStep {
    /// Grows by one with every step and every proposal of a fan, whatever epoch they belong to.
    pub number: u64,
    /// What the proposal would be called: the explorer, its epoch, and the step that was tried. In a
    /// fan, the step that made the current path.
    pub id: PathId,
    /// One proposal of a fan, after which the explorer stands where it stood.
    pub fan: bool,
    /// The strategy.
    pub strategy: StrategyId,
    /// What became of it.
    pub outcome: FocusOutcome,
    /// Acceptance probability; 0 for a failure. In a fan it is what it would have been.
    pub acceptance: f64,
    /// What it is made of; zeros for a failure.
    pub factors: RatioFactors,
    /// Vertices of the path before the step.
    pub length: usize,
    /// How many of them are kept at the light end.
    pub kept_light: usize,
    /// How many of them are kept at the lens end; those between were deleted.
    pub kept_eye: usize,
    /// New vertices between the kept ends. For a failure, those made from the light side until then.
    pub inserted: Vec<VertexRecord>,
    /// For a failure, the vertices made from the eye side until then, in the order of the walk.
    pub eye_side: Vec<VertexRecord>,
    /// Where a blocked connection is blocked, in scene units.
    pub blocker: Option<[f32; 3]>,
    /// Film point of the proposal; zeros for a failure.
    pub film: [f32; 2],
    /// `1 / S(y)` of the proposal, in units of film luminance; zero for a failure.
    pub luminance: f32,
    /// Colour of its contribution, scaled to unit luminance.
    pub rgb: [f32; 3],
    /// Rays traced for it.
    pub rays: u32,
}

impl FocusStep {
    /// True when the proposal is a complete path.
    pub fn is_complete(&self) -> bool {
        !matches!(self.outcome, FocusOutcome::Failed(_))
    }

    /// The proposed path, made of the path `x` before the step; `None` for a failure or where `x` is
    /// not that path.
    pub fn proposal(&self, x: &[VertexRecord]) -> Option<Vec<VertexRecord>> {
        let from = x.len().checked_sub(self.kept_eye)?;
        if !self.is_complete() || x.len() != self.length || self.kept_light > from {
            return None;
        }
        let (light, eye) = (x.get(..self.kept_light)?, x.get(from..)?);
        Some([light, &self.inserted, eye].concat())
    }

    /// Bytes that the step takes in a queue, about.
    pub fn byte_len(&self) -> usize {
        160 + 24 * (self.inserted.len() + self.eye_side.len())
    }
}
