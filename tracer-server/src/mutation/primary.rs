//! The primary-sample mutation of a path: find the numbers that would have made it, change them a
//! little, and make another path of them [Bitterli et al. 2018; Otsu et al. 2017; Pantaleoni 2017].
//!
//! Which of the bidirectional samplers is meant to have made the path is drawn anew in every step,
//! with the probability that it would have been this one.

use super::{Form, MixtureBasis, Mutation, Parameter, Tuning};
use crate::math::{Rng, TorusStep, pick};
use crate::path::{Draft, Failure, Kept, Numbers, Path, Range, Strand, Tape, resample};
use crate::scene::Tracer;

/// Perturbs the numbers behind a path, all at once.
#[derive(Clone, Copy, Debug)]
pub struct Primary {
    /// How far a number moves.
    pub step: TorusStep,
    /// Probability of replacing all numbers by fresh ones.
    pub fresh: f64,
    /// The lens has an area, and its point has numbers too.
    pub aperture: bool,
}

impl Default for Primary {
    fn default() -> Self {
        Self { step: TorusStep::default(), fresh: 0.1, aperture: false }
    }
}

/// The numbers of a tape, each moved when it is asked for.
struct Moved<'a> {
    tape: &'a Tape,
    /// How far; without, the numbers are drawn afresh.
    step: Option<TorusStep>,
    rng: &'a mut Rng,
}

impl Numbers for Moved<'_> {
    #[inline]
    fn row<const N: usize>(&mut self, strand: Strand, row: usize) -> [f64; N] {
        match (self.step, self.tape.row(strand, row)) {
            (Some(step), Some(row)) => {
                std::array::from_fn(|i| step.apply(row[i], self.rng.uniform()))
            }
            // The walks of a proposal are as long as those on the tape, and ask for no more.
            _ => self.rng.array(),
        }
    }
}

/// A path with the numbers that are behind it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Recorded<'a> {
    /// The path.
    pub(super) path: &'a Path,
    /// How many of its vertices the walk from the light is meant to have made.
    pub(super) light: usize,
    /// The numbers that both walks are meant to have used.
    pub(super) tape: &'a Tape,
}

impl Primary {
    /// A number of light vertices, with the probability that bidirectional sampling would have
    /// made `x` by this split: `(1 / lum C_i) / S`.
    pub(super) fn choose_split(x: &Path, rng: &mut Rng) -> usize {
        let splits = (0..=x.edge_count()).map(|light| (light, x.reciprocal(light)));
        let possible = splits.filter(|(_, reciprocal)| *reciprocal > 0.0);
        pick(rng.uniform() * x.density_sum(), possible).unwrap_or(0)
    }

    /// Makes `y` of the numbers on `tape`, changed, by the walks of a split of `x`.
    pub(super) fn rebuild(
        self,
        scene: &Tracer<'_>,
        of: Recorded<'_>,
        rng: &mut Rng,
        draft: &mut Draft,
        y: &mut Path,
    ) -> Result<(), Failure> {
        let Recorded { path: x, light, tape } = of;
        let k = x.edge_count();
        let range = Range::whole(k, light, k - light, self.aperture);
        let step = (rng.uniform() >= self.fresh).then_some(self.step);
        resample(scene, x, range, &mut Moved { tape, step, rng }, draft, y)
    }
}

impl Mutation for Primary {
    /// Vertices on the light side: the split that is meant to have made the path.
    type Move = usize;
    const NAME: &'static str = "primary";
    const WEIGHT: f64 = 0.25;
    const PARAMETERS: &'static [Parameter] = &[
        Parameter {
            name: "step",
            about: "change of every number in a small step, as a share of its range from 0 to 1",
            form: Form::Sizes,
            lowest: 1e-9,
            highest: 0.5,
        },
        Parameter {
            name: "fresh",
            about: "share of steps that replace all numbers",
            form: Form::Number,
            lowest: 0.0,
            highest: 1.0,
        },
    ];

    fn build(basis: &MixtureBasis<'_>, tuning: &Tuning) -> Self {
        let usual = Self::default();
        let step = tuning.sizes("step").map(|sizes| TorusStep::new(sizes.min, sizes.max));
        Self {
            step: step.unwrap_or(usual.step),
            fresh: tuning.number("fresh").unwrap_or(usual.fresh),
            aperture: basis.camera.has_aperture(),
        }
    }

    fn applicable(&self, _: &Path) -> bool {
        true
    }

    fn propose(
        &self,
        scene: &Tracer<'_>,
        x: &Path,
        rng: &mut Rng,
        draft: &mut Draft,
        y: &mut Path,
    ) -> Result<usize, Failure> {
        let light = Self::choose_split(x, rng);
        let mut tape = Tape::default();
        tape.record(scene, x, light, rng).ok_or(Failure::NoSubpath)?;
        self.rebuild(scene, Recorded { path: x, light, tape: &tape }, rng, draft, y)?;
        Ok(light)
    }

    /// The numbers move symmetrically and the split makes `y` with the density `p_i(y)`, so that
    /// `Q(y | x) = (1 / lum C_i(x)) / S(x) / lum C_i(y)`: all but `S` is the same in both
    /// directions, and the ratio is `S(x) / S(y)`.
    fn transition(&self, x: &Path, _: &Path, _: usize) -> f64 {
        1.0 / x.density_sum()
    }

    fn reverse(&self, light: usize) -> usize {
        light
    }

    fn kept(&self, _: &Path, _: usize) -> Kept {
        Kept { light: 0, eye: usize::from(!self.aperture) }
    }
}
