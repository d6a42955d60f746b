//! Whether the way back is open: what can be checked of every single move.

use super::judge::{Finding, Verdict};
use crate::math::{Rng, Stream};
use crate::mutation::{Flaw, Inspection, Strategy};
use crate::path::{BidirectionalSampler, CameraSample, Draft, Path};
use crate::scene::{Scene, Tracer};

/// How far the product of a ratio and that of the reverse move may be from one.
const TOLERANCE: f64 = 1e-9;

/// What was seen of a strategy's moves.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Reversals {
    /// Moves looked at.
    pub moves: u64,
    /// Those that the reverse move could not make, because the strategy does not apply there.
    pub closed: u64,
    /// Largest distance from one of a ratio times the ratio of the reverse move.
    pub asymmetry: f64,
    /// Moves that changed vertices which they claim to keep.
    pub not_kept: u64,
    /// Moves to a path whose cached values are not those of its vertices.
    pub stale: u64,
}

/// Draws `samples` bidirectional samples and looks at one move from a path of each.
pub fn reversals(scene: &Scene, strategy: &Strategy, seed: u64, samples: u64) -> Reversals {
    let scene = Tracer::new(scene);
    let mut sampler = BidirectionalSampler::new(&scene);
    // Runs of the other laws end below this number.
    let mut rng = Rng::new(seed, Stream::Verification, u64::MAX);
    let mut choice = Rng::new(seed, Stream::Verification, u64::MAX - 1);
    let mut draft: Box<Draft> = Box::default();
    let (mut x, mut y): (Box<Path>, Box<Path>) = Default::default();
    let mut seen = Reversals::default();
    for _ in 0..samples {
        let aim = CameraSample::from_numbers(&scene, &mut rng);
        let mut paths = 0.0;
        sampler.sample(&scene, aim, &mut rng, |path, _| {
            // Each of the sample's paths to which the strategy applies, with equal chance.
            if strategy.applicable(path) {
                paths += 1.0;
                if choice.uniform() * paths < 1.0 {
                    (*x).clone_from(path);
                }
            }
        });
        if paths > 0.0
            && let Ok(inspection) = strategy.inspect(&scene, &x, &mut rng, &mut draft, &mut y)
        {
            seen.add(&inspection);
        }
    }
    seen
}

impl Reversals {
    fn add(&mut self, inspection: &Inspection) {
        self.moves += 1;
        self.closed += u64::from(!inspection.applies_back);
        self.not_kept += u64::from(inspection.flaw == Some(Flaw::NotKept));
        self.stale += u64::from(inspection.flaw == Some(Flaw::Stale));
        let product = inspection.forth * inspection.back;
        // A move that could not be undone is rejected: its ratio is zero.
        if inspection.forth != 0.0 {
            let distance = (product - 1.0).abs();
            // NaN stays: no later move may hide it.
            if !(distance <= self.asymmetry) && !self.asymmetry.is_nan() {
                self.asymmetry = distance;
            }
        }
    }

    /// The verdict on a strategy.
    pub fn finding(&self, name: &str, samples: u64) -> Finding {
        let Self { moves, closed, asymmetry, not_kept, stale } = *self;
        let mut remarks = Vec::new();
        if !(asymmetry <= TOLERANCE) {
            remarks.push(format!(
                "a ratio times that of the reverse move is off one by {asymmetry:.1e}"
            ));
        }
        for (count, what) in [
            (not_kept, "changed vertices that they claim to keep"),
            (stale, "left stale values in the path"),
        ] {
            if count > 0 {
                remarks.push(format!("{count} moves {what}"));
            }
        }
        let verdict = match (remarks.is_empty(), moves) {
            (false, _) => Verdict::Fail,
            (true, 0) => Verdict::Unjudged,
            (true, _) => Verdict::Pass,
        };
        if closed > 0 {
            remarks.push(format!("{closed} moves led to where the strategy does not apply"));
        }
        Finding {
            subject: name.to_owned(),
            law: "reversal",
            judged: moves as usize,
            samples,
            worst: 0.0,
            limit: 0.0,
            verdict,
            remark: remarks.join("; "),
        }
    }
}
