//! Mutation strategies: ways to propose a new path from the current one.
//!
//! To add one: write its file with an `impl Mutation`, declare the module, and add a line to the
//! list in `strategies!` below: weights, options, tables and checks follow from it.
//! `docs/EXTEND.md` walks through it.

mod bidirectional;
mod caustic;
mod independent;
mod lens;
mod lens_subpath;
mod mixture;
mod multi_chain;
mod primary;
mod retrace;
mod tuning;

#[cfg(test)]
mod fuzz;
#[cfg(test)]
mod laws;
#[cfg(test)]
mod mutants;

use std::fmt::Debug;

use crate::math::Rng;
use crate::path::{Draft, Failure, Kept, Path};
use crate::scene::{SceneFeatures, Tracer};

pub use bidirectional::{Bidirectional, Ends};
pub use caustic::{CausticPerturbation, Turn};
pub use independent::Independent;
pub use lens::LensPerturbation;
pub use lens_subpath::{Fresh, LensSubpath};
pub use mixture::{Mixture, MixtureBasis};
pub use multi_chain::MultiChain;
pub use primary::Primary;
pub use retrace::Sizes;
pub use tuning::{Form, OptionError, Parameter, StrategyOptions, Tuning, key_of};

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
    /// How often it is chosen, relative to the others, as long as nobody says otherwise.
    const WEIGHT: f64;
    /// What a user may tune.
    const PARAMETERS: &'static [Parameter] = &[];

    /// The strategy for a scene, with what the user has said of its parameters.
    fn build(basis: &MixtureBasis<'_>, tuning: &Tuning) -> Self
    where
        Self: Sized;

    /// False when a scene with these features has no path that the strategy could change.
    fn is_possible(_features: SceneFeatures) -> bool
    where
        Self: Sized,
    {
        true
    }

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

    /// What `x` and the proposal have in common.
    fn kept(&self, x: &Path, via: Self::Move) -> Kept;
}

/// A drawn proposal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Proposal {
    /// `f(y) T(x|y) / (f(x) T(y|x))`; may be anything, the chain checks it.
    pub ratio: f64,
    /// `Q(y | x)`.
    pub forward: f64,
    /// `Q(x | y)`.
    pub backward: f64,
    /// What it has in common with the current path.
    pub kept: Kept,
}

/// What `x` and the proposal have in common as they are drawn: a light infinitely far away moves with
/// the vertex that it shines on.
#[inline]
fn shared<M: Mutation>(mutation: &M, x: &Path, via: M::Move) -> Kept {
    let kept = mutation.kept(x, via);
    if kept.light == 1 && x.is_lit_from_afar() { Kept { light: 0, ..kept } } else { kept }
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
    let kept = shared(mutation, x, via);
    Ok(Proposal { ratio: backward / forward, forward, backward, kept })
}

/// One move and its reverse, looked at closely.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Inspection {
    /// The ratio of the move.
    pub forth: f64,
    /// The ratio of the reverse move, computed as if it had been drawn.
    pub back: f64,
    /// The strategy applies to the proposal, so the reverse move can be drawn.
    pub applies_back: bool,
    /// What is wrong with the proposal itself.
    pub flaw: Option<Flaw>,
}

/// An error that shows in a single proposal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Flaw {
    /// Vertices that the strategy claims to keep are not the same in both paths.
    NotKept,
    /// A cached value is not that of the vertices.
    Stale,
}

/// Draws a move and looks at it closely.
pub fn inspect<M: Mutation>(
    mutation: &M,
    scene: &Tracer<'_>,
    x: &Path,
    rng: &mut Rng,
    draft: &mut Draft,
    y: &mut Path,
) -> Result<Inspection, Failure> {
    let via = mutation.propose(scene, x, rng, draft, y)?;
    let reverse = mutation.reverse(via);
    let forth = mutation.transition(y, x, reverse) / mutation.transition(x, y, via);
    let again = mutation.reverse(reverse);
    let back = mutation.transition(x, y, again) / mutation.transition(y, x, reverse);
    let Kept { light, eye } = shared(mutation, x, via);
    let (xv, yv) = (x.vertices(), y.vertices());
    let same = |from_x: Option<usize>, from_y: Option<usize>| match (from_x, from_y) {
        (Some(a), Some(b)) => xv.get(a..) == yv.get(b..),
        _ => false,
    };
    let ends = (xv.len().checked_sub(eye), yv.len().checked_sub(eye));
    let keeps = light <= xv.len() && xv.get(..light) == yv.get(..light) && same(ends.0, ends.1);
    let flaw = match (keeps, y.is_fresh(scene)) {
        (false, _) => Some(Flaw::NotKept),
        (true, false) => Some(Flaw::Stale),
        (true, true) => None,
    };
    Ok(Inspection { forth, back, applies_back: mutation.applicable(y), flaw })
}

/// One entry of the table of strategies.
#[derive(Clone, Copy, Debug)]
pub struct Kind {
    /// A name for tables, options and viewers.
    pub name: &'static str,
    /// How often it is chosen, relative to the others, as long as nobody says otherwise.
    pub weight: f64,
    /// What a user may tune.
    pub parameters: &'static [Parameter],
    /// False when a scene with these features has no path that the strategy could change.
    pub is_possible: fn(SceneFeatures) -> bool,
    /// The strategy for a scene.
    pub build: fn(&MixtureBasis<'_>, &Tuning) -> Strategy,
}

/// Makes of one list the enum of strategies, the table of their kinds, and every `match` on them.
macro_rules! strategies {
    ($($(#[$doc:meta])* $variant:ident($mutation:ty),)*) => {
        /// A strategy with its parameters.
        #[derive(Clone, Debug)]
        pub enum Strategy {
            $($(#[$doc])* $variant($mutation),)*
        }

        /// Number of strategies.
        pub const STRATEGY_COUNT: usize = [$(<$mutation as Mutation>::NAME),*].len();

        /// All strategies, in the order of tables.
        pub const KINDS: [Kind; STRATEGY_COUNT] = [$(Kind {
            name: <$mutation as Mutation>::NAME,
            weight: <$mutation as Mutation>::WEIGHT,
            parameters: <$mutation as Mutation>::PARAMETERS,
            is_possible: <$mutation as Mutation>::is_possible,
            build: |basis, tuning| {
                Strategy::$variant(<$mutation as Mutation>::build(basis, tuning))
            },
        }),*];

        impl Strategy {
            /// A name for tables, options and viewers.
            pub fn name(&self) -> &'static str {
                match self {
                    $(Self::$variant(_) => <$mutation as Mutation>::NAME,)*
                }
            }

            /// True when it can do something with `x`.
            #[inline]
            pub fn applicable(&self, x: &Path) -> bool {
                match self {
                    $(Self::$variant(mutation) => mutation.applicable(x),)*
                }
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
                match self {
                    $(Self::$variant(mutation) => propose(mutation, scene, x, rng, draft, y),)*
                }
            }

            /// Draws a move and looks at it closely.
            pub fn inspect(
                &self,
                scene: &Tracer<'_>,
                x: &Path,
                rng: &mut Rng,
                draft: &mut Draft,
                y: &mut Path,
            ) -> Result<Inspection, Failure> {
                match self {
                    $(Self::$variant(mutation) => inspect(mutation, scene, x, rng, draft, y),)*
                }
            }
        }
    };
}

strategies! {
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
    /// Moves the numbers behind the path a little.
    Primary(Primary),
}
