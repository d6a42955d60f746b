//! Deviations in standard errors, and how large one may be before a test must fail.

use std::fmt;

use statrs::distribution::{ContinuousCDF as _, Normal, StudentsT};

use crate::{Accumulator, FALSE_ALARM};

/// A deviation in units of its own standard error; standard normal when there is nothing wrong.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct ZScore(pub f64);

impl ZScore {
    /// True when the deviation is within `limit` either way. NaN is not.
    pub fn is_within(self, limit: f64) -> bool {
        self.0.abs() <= limit
    }
}

impl fmt::Display for ZScore {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "z = {:+.2}", self.0)
    }
}

/// The largest |z| that is still no alarm when `comparisons` of them are made together.
///
/// With that many independent comparisons and nothing wrong, the chance that any of them exceeds
/// the limit is [`FALSE_ALARM`] (Bonferroni's bound).
pub fn z_limit(comparisons: usize) -> f64 {
    -Normal::standard().inverse_cdf(0.5 * p_limit(comparisons))
}

/// The smallest p-value that is still no alarm when `comparisons` of them are made together.
pub fn p_limit(comparisons: usize) -> f64 {
    FALSE_ALARM / comparisons.max(1) as f64
}

/// Compares two means whose variances may differ \[Welch 1947\].
///
/// The t value is turned into the z value of the same tail probability, so that results of few
/// runs can stand in one table with results of many. Positive when `a` has the larger mean.
pub fn welch_z(a: &Accumulator, b: &Accumulator) -> ZScore {
    let difference = a.mean() - b.mean();
    let share = |side: &Accumulator| side.variance() / side.count() as f64;
    let (va, vb) = (share(a), share(b));
    let variance = va + vb;
    if variance == 0.0 {
        return ZScore(if difference == 0.0 { 0.0 } else { difference / 0.0 });
    }
    // Welch and Satterthwaite's degrees of freedom.
    let squares = va * va / (a.count() as f64 - 1.0) + vb * vb / (b.count() as f64 - 1.0);
    let t = difference / variance.sqrt();
    match StudentsT::new(0.0, 1.0, variance * variance / squares) {
        Ok(student) if t.is_finite() => {
            // The upper tail keeps its digits where the lower one would round to one.
            let tail = student.sf(t.abs());
            ZScore(-Normal::standard().inverse_cdf(tail) * t.signum())
        }
        _ => ZScore(f64::NAN),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits_grow_slowly_with_the_family() {
        assert!((z_limit(1) - 4.892).abs() < 1e-3, "one comparison: {}", z_limit(1));
        assert!((z_limit(500) - 5.998).abs() < 1e-3, "five hundred: {}", z_limit(500));
        assert!(z_limit(0) == z_limit(1), "an empty family is treated as one comparison");
        assert!(!ZScore(f64::NAN).is_within(z_limit(1)), "NaN never passes");
        assert!(!ZScore(f64::NEG_INFINITY).is_within(z_limit(500)), "nor does infinity");
    }

    #[test]
    fn welch_matches_a_table() {
        // t(10) has a two-sided 5 % point at 2.2281; the normal distribution at 1.9600.
        let side = |mean: f64| -> Accumulator {
            let spread = [-2.0, -1.0, -0.5, 0.5, 1.0, 2.0];
            spread.into_iter().map(|x| x + mean).collect()
        };
        let error = side(0.0).standard_error() * 2.0_f64.sqrt();
        let z = welch_z(&side(2.2281 * error), &side(0.0));
        assert!((z.0 - 1.95996).abs() < 1e-3, "{z}");
        assert!((welch_z(&side(0.0), &side(2.2281 * error)).0 + z.0).abs() < 1e-9, "odd symmetry");
    }

    #[test]
    fn welch_refuses_what_it_cannot_judge() {
        let one: Accumulator = std::iter::once(1.0).collect();
        let many: Accumulator = [1.0, 2.0, 3.0].into_iter().collect();
        assert!(welch_z(&one, &many).0.is_nan(), "one sample has no variance");
        let nan: Accumulator = [1.0, f64::NAN].into_iter().collect();
        assert!(welch_z(&nan, &many).0.is_nan(), "NaN stays NaN");
        let flat: Accumulator = [5.0; 4].into_iter().collect();
        let other: Accumulator = [6.0; 4].into_iter().collect();
        assert_eq!(welch_z(&flat, &flat).0, 0.0, "equal constants agree");
        assert_eq!(welch_z(&flat, &other).0, f64::NEG_INFINITY, "different ones do not");
    }
}
