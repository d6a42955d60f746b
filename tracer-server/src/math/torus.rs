//! Small symmetric steps of numbers in [0, 1), whose ends are joined.

/// Steps of log-uniform size to either side [Kelemen et al. 2002, section 3.1].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TorusStep {
    max: f64,
    /// `ln(min / max)`.
    log_ratio: f64,
}

impl TorusStep {
    /// Steps from `min` to `max`, `0 < min < max < 1`.
    pub fn new(min: f64, max: f64) -> Self {
        Self { max, log_ratio: (min / max).ln() }
    }

    /// The number after a step from `u` that a `draw`, uniform in [0, 1), decides. As likely as the
    /// step back.
    #[inline]
    pub fn apply(self, u: f64, draw: f64) -> f64 {
        // The draw tells the side and, by what is left of it, the size.
        let draw = 2.0 * draw - 1.0;
        let size = self.max * (self.log_ratio * draw.abs()).exp();
        let moved = u + size.copysign(draw);
        let wrapped = moved - moved.floor();
        // The sum of a tiny negative number and one rounds to one.
        if wrapped < 1.0 { wrapped } else { 0.0 }
    }
}

impl Default for TorusStep {
    /// From 1/1024 to 1/64.
    fn default() -> Self {
        Self::new(1.0 / 1024.0, 1.0 / 64.0)
    }
}

#[cfg(test)]
mod tests {
    use ::tests::chi_square_test;

    use super::*;
    use crate::math::{Rng, Stream};

    #[test]
    fn steps_leave_uniform_numbers_uniform_and_have_the_wanted_sizes() {
        const SAMPLES: usize = 200_000;
        const CELLS: usize = 64;
        let step = TorusStep::default();
        let mut rng = Rng::new(9, Stream::Laboratory, 0);
        let (mut places, mut sizes) = (vec![0_u64; CELLS], vec![0_u64; 2 * CELLS]);
        for _ in 0..SAMPLES {
            let before = rng.uniform();
            let after = step.apply(before, rng.uniform());
            assert!((0.0..1.0).contains(&after), "{after} is outside");
            places[(after * CELLS as f64) as usize] += 1;
            let moved = after - before;
            let moved = moved - moved.round();
            // Uniform logarithms: four octaves.
            let log = (moved.abs() * 1024.0).log2() / 4.0;
            let cell = ((log * CELLS as f64) as usize).min(CELLS - 1);
            sizes[if moved > 0.0 { cell } else { CELLS + cell }] += 1;
        }
        for (what, observed) in [("places", places), ("sizes", sizes)] {
            let expected = vec![SAMPLES as f64 / observed.len() as f64; observed.len()];
            let result = chi_square_test(&observed, &expected, 20.0).expect("valid counts");
            assert!(result.p_value > 1e-7, "{what}: p = {:e}", result.p_value);
        }
        assert!(step.apply(0.0, 0.0) < 1.0 && step.apply(1e-300, 0.499) < 1.0, "wrapped");
    }
}
