//! A family of comparisons that is judged as one.

use std::fmt;

use crate::{ZScore, z_limit};

/// Collects named z-scores and passes or fails them together.
///
/// ```
/// let mut suite = tests::Suite::new("film");
/// suite.record("left half", tests::ZScore(0.7));
/// suite.record("right half", tests::ZScore(-1.2));
/// assert!(suite.verdict().is_pass());
/// ```
#[derive(Clone, Debug)]
pub struct Suite {
    name: String,
    scores: Vec<(String, ZScore)>,
}

/// What a suite found; its text is what a failing test prints.
#[derive(Clone, Debug, PartialEq)]
pub enum Verdict {
    /// Every score is within the limit of the family.
    Pass {
        /// How many comparisons were made.
        comparisons: usize,
        /// The largest |z| among them.
        worst: f64,
    },
    /// At least one score is not, or there was nothing to judge.
    Fail(String),
}

impl Verdict {
    /// True when nothing was found.
    pub fn is_pass(&self) -> bool {
        matches!(self, Self::Pass { .. })
    }
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Pass { comparisons, worst } => {
                write!(f, "pass: {comparisons} comparisons, worst |z| = {worst:.2}")
            }
            Self::Fail(report) => write!(f, "fail: {report}"),
        }
    }
}

impl Suite {
    /// How many offenders a failing verdict lists.
    const LISTED: usize = 8;

    /// An empty suite; `name` heads its report.
    pub fn new(name: impl Into<String>) -> Self {
        Self { name: name.into(), scores: Vec::new() }
    }

    /// Adds one comparison.
    pub fn record(&mut self, name: impl Into<String>, score: ZScore) {
        self.scores.push((name.into(), score));
    }

    /// The number of comparisons so far.
    pub fn len(&self) -> usize {
        self.scores.len()
    }

    /// True before the first comparison.
    pub fn is_empty(&self) -> bool {
        self.scores.is_empty()
    }

    /// The largest |z|; NaN when any score is NaN or there is none.
    pub fn worst(&self) -> f64 {
        let magnitudes = self.scores.iter().map(|(_, score)| score.0.abs());
        // Written so that a NaN, once met, is kept: `f64::max` would drop it.
        let keep_nan = |worst: f64, z: f64| if worst.is_nan() || worst >= z { worst } else { z };
        magnitudes.reduce(keep_nan).unwrap_or(f64::NAN)
    }

    /// The mean of z squared: one when nothing is wrong. NaN without scores.
    ///
    /// Its standard error over `n` independent comparisons is `sqrt(2 / n)`, so it finds a small
    /// error everywhere that no single comparison shows.
    pub fn mean_square(&self) -> f64 {
        let sum: f64 = self.scores.iter().map(|(_, score)| score.0 * score.0).sum();
        sum / self.scores.len() as f64
    }

    /// Judges all comparisons against the limit for a family of this size.
    pub fn verdict(&self) -> Verdict {
        let limit = z_limit(self.len());
        if self.is_empty() {
            return Verdict::Fail(format!("{}: no comparison was made", self.name));
        }
        let mut offenders: Vec<_> =
            self.scores.iter().filter(|(_, score)| !score.is_within(limit)).collect();
        if offenders.is_empty() {
            return Verdict::Pass { comparisons: self.len(), worst: self.worst() };
        }
        offenders.sort_by(|(_, a), (_, b)| b.0.abs().total_cmp(&a.0.abs()));
        let listed: Vec<_> = offenders
            .iter()
            .take(Self::LISTED)
            .map(|(name, score)| format!("{name}: {score}"))
            .collect();
        Verdict::Fail(format!(
            "{}: {} of {} comparisons beyond |z| = {limit:.2}; {}",
            self.name,
            offenders.len(),
            self.len(),
            listed.join("; "),
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn suite(scores: &[f64]) -> Suite {
        let mut suite = Suite::new("probe");
        for (i, z) in scores.iter().enumerate() {
            suite.record(format!("h{i}"), ZScore(*z));
        }
        suite
    }

    #[test]
    fn ordinary_scatter_passes() {
        let suite = suite(&[0.3, -3.0, 1.0]);
        assert_eq!(suite.verdict(), Verdict::Pass { comparisons: 3, worst: 3.0 }, "within limits");
        assert!((suite.mean_square() - 3.363_333).abs() < 1e-5, "{}", suite.mean_square());
    }

    #[test]
    fn one_outlier_fails_and_is_named() {
        let verdict = suite(&[0.3, -7.5, 1.0]).verdict();
        assert!(!verdict.is_pass(), "z = -7.5 is no chance");
        assert!(verdict.to_string().contains("h1: z = -7.50"), "{verdict}");
    }

    #[test]
    fn nothing_and_nan_fail() {
        assert!(!suite(&[]).verdict().is_pass(), "a suite that saw nothing proves nothing");
        let poisoned = suite(&[0.0, f64::NAN, 1.0]);
        assert!(!poisoned.verdict().is_pass(), "NaN is a failure");
        assert!(poisoned.worst().is_nan(), "and is not hidden by larger scores");
    }

    #[test]
    fn a_larger_family_may_scatter_more() {
        assert!(!suite(&[5.0]).verdict().is_pass(), "alone, five sigma is an alarm");
        let mut crowd = vec![0.0; 499];
        crowd.push(5.0);
        assert!(suite(&crowd).verdict().is_pass(), "among five hundred it is not");
    }
}
