//! Kolmogorov and Smirnov's test: do samples follow a cumulative distribution?

/// What the test found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Kolmogorov {
    /// Largest distance between the two cumulative distributions.
    pub statistic: f64,
    /// Chance of a distance at least this large when nothing is wrong.
    pub p_value: f64,
}

/// Compares samples with the cumulative distribution `cdf` that they should follow.
///
/// `cdf` must be continuous. The p-value is Kolmogorov's limit with the correction for small
/// samples of \[Stephens 1970\]; good to a per cent from eight samples on. `None` without samples,
/// or when a sample or a value of `cdf` is NaN or the latter lies outside [0, 1].
pub fn kolmogorov_test(samples: &[f64], cdf: impl Fn(f64) -> f64) -> Option<Kolmogorov> {
    if samples.is_empty() || samples.iter().any(|sample| sample.is_nan()) {
        return None;
    }
    let mut sorted = samples.to_vec();
    sorted.sort_by(f64::total_cmp);
    let n = sorted.len() as f64;
    let mut statistic = 0.0_f64;
    for (i, sample) in sorted.into_iter().enumerate() {
        let due = cdf(sample);
        if !(0.0..=1.0).contains(&due) {
            return None;
        }
        let (before, after) = (i as f64 / n, (i + 1) as f64 / n);
        statistic = statistic.max(due - before).max(after - due);
    }
    let scaled = statistic * (n.sqrt() + 0.12 + 0.11 / n.sqrt());
    Some(Kolmogorov { statistic, p_value: kolmogorov_tail(scaled) })
}

/// `2 sum_{j >= 1} (-1)^(j-1) exp(-2 j^2 x^2)`, the tail of Kolmogorov's distribution.
fn kolmogorov_tail(x: f64) -> f64 {
    // Below this the tail is one to all digits, and the alternating series converges slowly.
    if x < 0.2 {
        return 1.0;
    }
    let term = |j: f64| (-2.0 * j * j * x * x).exp();
    let sum: f64 =
        (1..=20).map(|j| if j % 2 == 1 { term(j.into()) } else { -term(j.into()) }).sum();
    (2.0 * sum).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use rand_core::{Rng as _, SeedableRng as _};
    use rand_xoshiro::Xoshiro256PlusPlus;

    use super::*;

    fn uniforms(count: usize) -> Vec<f64> {
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(7);
        (0..count).map(|_| (rng.next_u64() >> 11) as f64 * 2.0_f64.powi(-53)).collect()
    }

    #[test]
    fn the_tail_matches_a_table() {
        for (x, p) in [(1.3581, 0.05), (1.6276, 0.01), (0.8276, 0.5)] {
            let found = kolmogorov_tail(x);
            assert!((found - p).abs() < 1e-4, "tail({x}) is {found}, not {p}");
        }
        assert!((kolmogorov_tail(0.2) - 1.0).abs() < 1e-6, "the two branches meet");
    }

    #[test]
    fn the_right_distribution_passes() {
        let logarithmic: Vec<f64> =
            uniforms(20_000).into_iter().map(|u| 100.0_f64.powf(u)).collect();
        let found = kolmogorov_test(&logarithmic, |r| r.ln() / 100.0_f64.ln()).expect("samples");
        assert!(found.p_value > 1e-3, "log-uniform radii are log-uniform: {found:?}");
    }

    #[test]
    fn a_slightly_wrong_distribution_fails() {
        let bent: Vec<f64> = uniforms(20_000).into_iter().map(|u| u.powf(1.1)).collect();
        let found = kolmogorov_test(&bent, |x| x).expect("samples");
        assert!(found.p_value < 1e-6, "an exponent of 1.1 is seen: {found:?}");
    }

    #[test]
    fn the_distance_is_measured_on_both_sides() {
        let distance =
            |samples: &[f64]| kolmogorov_test(samples, |x| x).expect("samples").statistic;
        assert_eq!(distance(&[0.5, 0.9]), 0.5, "samples too large");
        assert_eq!(distance(&[0.1, 0.5]), 0.5, "samples too small");
    }

    #[test]
    fn nonsense_is_refused() {
        assert_eq!(kolmogorov_test(&[], |x| x), None, "no samples");
        assert_eq!(kolmogorov_test(&[0.5, f64::NAN], |x| x), None, "NaN sample");
        assert_eq!(kolmogorov_test(&[0.5], |_| f64::NAN), None, "NaN probability");
        assert_eq!(kolmogorov_test(&[0.5], |_| 1.5), None, "no probability at all");
    }
}
