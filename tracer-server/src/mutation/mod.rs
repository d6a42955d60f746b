//! Mutation strategies: ways to propose a new path from the current one.
//!
//! To add one: write its file with an `impl Mutation`, add a variant to [`Strategy`] and an arm to
//! `strategy!`, and list it in [`Mixture`]. The laws in `laws.rs` then hold it to account.

mod bidirectional;
mod caustic;
mod independent;
mod lens;
mod lens_subpath;
mod mixture;
mod multi_chain;
mod retrace;

#[cfg(test)]
mod laws;
#[cfg(test)]
mod mutants;

use std::fmt::Debug;

use crate::math::Rng;
use crate::path::{Draft, Failure, Path};
use crate::scene::Tracer;

pub use bidirectional::{Bidirectional, Ends};
pub use caustic::{CausticPerturbation, Turn};
pub use independent::Independent;
pub use lens::LensPerturbation;
pub use lens_subpath::LensSubpath;
pub use mixture::{Mixture, MixtureBasis, StrategyWeights};
pub use multi_chain::MultiChain;
pub use retrace::Sizes;

/// One way to mutate a path.
///
/// The author writes both halves of one direction only: how a proposal is drawn, and with what
/// density. The reverse is the same density with the roles exchanged, so detailed balance cannot be
/// broken by forgetting the other direction.
pub trait Mutation: Debug + Send + Sync {
    /// The discrete choices behind one proposal.
    type Move: Copy + Debug;

    /// A name for tables, options and viewers.
    const NAME: &'static str;

    /// True when the strategy can do something with `x`.
    fn applicable(&self, x: &Path) -> bool;

    /// Draws a proposal from `x` and writes it to `y`. A failure must be reported, never drawn
    /// again: it is a step in which the chain stays.
    fn propose(
        &self,
        scene: &Tracer<'_>,
        x: &Path,
        rng: &mut Rng,
        draft: &mut Draft,
        y: &mut Path,
    ) -> Result<Self::Move, Failure>;

    /// `Q(y | x)`: the density of proposing `y` from `x` by the choices `via`, divided by the
    /// luminance of `f(y)`, up to a factor that is the same in both directions. The acceptance
    /// ratio is `Q(x | y) / Q(y | x)`.
    fn transition(&self, x: &Path, y: &Path, via: Self::Move) -> f64;

    /// The choices by which the opposite move is made.
    fn reverse(&self, via: Self::Move) -> Self::Move;

    /// Vertices that `x` and the proposal share, from the light end and from the lens end.
    fn kept(&self, x: &Path, via: Self::Move) -> (usize, usize);
}

/// A drawn proposal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Proposal {
    /// `f(y) T(x|y) / (f(x) T(y|x))`; may be anything, the chain checks it.
    pub ratio: f64,
    /// Vertices shared with the current path, from the light end.
    pub kept_light: usize,
    /// Vertices shared with the current path, from the lens end.
    pub kept_eye: usize,
}

/// Proposes by `mutation` and evaluates both directions.
#[inline]
pub fn propose<M: Mutation>(
    mutation: &M,
    scene: &Tracer<'_>,
    x: &Path,
    rng: &mut Rng,
    draft: &mut Draft,
    y: &mut Path,
) -> Result<Proposal, Failure> {
    let via = mutation.propose(scene, x, rng, draft, y)?;
    let backward = mutation.transition(y, x, mutation.reverse(via));
    let forward = mutation.transition(x, y, via);
    let (kept_light, kept_eye) = mutation.kept(x, via);
    Ok(Proposal { ratio: backward / forward, kept_light, kept_eye })
}

/// A strategy with its parameters.
#[derive(Clone, Debug)]
pub enum Strategy {
    /// Replaces a range by fresh walks.
    Bidirectional(Bidirectional),
    /// Starts anew.
    Independent(Independent),
    /// Moves the film point a little.
    Lens(LensPerturbation),
    /// Moves the film point anywhere.
    LensSubpath(LensSubpath),
    /// Turns the light a little.
    Caustic(CausticPerturbation),
    /// Moves the film point and every further chain a little.
    MultiChain(MultiChain),
}

/// Does something with the strategy behind the variant: the only match on [`Strategy`].
macro_rules! strategy {
    ($strategy:expr, $mutation:ident => $call:expr) => {
        match $strategy {
            Strategy::Bidirectional($mutation) => $call,
            Strategy::Independent($mutation) => $call,
            Strategy::Lens($mutation) => $call,
            Strategy::LensSubpath($mutation) => $call,
            Strategy::Caustic($mutation) => $call,
            Strategy::MultiChain($mutation) => $call,
        }
    };
}

impl Strategy {
    /// A name for tables, options and viewers.
    pub fn name(&self) -> &'static str {
        fn name<M: Mutation>(_: &M) -> &'static str {
            M::NAME
        }
        strategy!(self, m => name(m))
    }

    /// True when it can do something with `x`.
    #[inline]
    pub fn applicable(&self, x: &Path) -> bool {
        strategy!(self, m => m.applicable(x))
    }

    /// Draws a proposal from `x` into `y`.
    #[inline]
    pub fn propose(
        &self,
        scene: &Tracer<'_>,
        x: &Path,
        rng: &mut Rng,
        draft: &mut Draft,
        y: &mut Path,
    ) -> Result<Proposal, Failure> {
        strategy!(self, m => propose(m, scene, x, rng, draft, y))
    }
}
