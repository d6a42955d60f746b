//! Pearson's test: do counts follow the frequencies that a density predicts?

use std::error::Error;
use std::fmt;

use statrs::distribution::{ChiSquared, ContinuousCDF as _};

/// What the test found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChiSquare {
    /// Sum of `(observed - expected)^2 / expected` over the cells.
    pub statistic: f64,
    /// Cells after pooling, less one.
    pub degrees_of_freedom: usize,
    /// Chance of a statistic at least this large when nothing is wrong.
    pub p_value: f64,
}

/// Why counts and frequencies cannot even be compared. Each of them is a failed test.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ChiSquareError {
    /// The two slices differ in length.
    Length {
        /// Cells with counts.
        observed: usize,
        /// Cells with expectations.
        expected: usize,
    },
    /// An expectation that is NaN, infinite or negative.
    Expectation {
        /// Index of the cell.
        cell: usize,
        /// The expectation.
        value: f64,
    },
    /// Samples fell where the density is zero.
    Impossible {
        /// Index of the cell.
        cell: usize,
        /// Samples in it.
        observed: u64,
    },
    /// The expectations do not add up to the number of samples: the density is not normalised.
    Total {
        /// Number of samples.
        observed: u64,
        /// Sum of the expectations.
        expected: f64,
    },
    /// Fewer than two cells remain after pooling: the test would pass whatever it is given.
    TooFewCells,
}

impl fmt::Display for ChiSquareError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Length { observed, expected } => {
                write!(f, "{observed} counts cannot be compared with {expected} expectations")
            }
            Self::Expectation { cell, value } => {
                write!(f, "cell {cell} expects {value} samples, which is no frequency")
            }
            Self::Impossible { cell, observed } => {
                write!(f, "{observed} samples in cell {cell}, where the density is zero")
            }
            Self::Total { observed, expected } => write!(
                f,
                "{observed} samples, but the expectations add up to {expected}: \
                 the density is not normalised"
            ),
            Self::TooFewCells => write!(f, "fewer than two cells expect enough samples"),
        }
    }
}

impl Error for ChiSquareError {}

/// Relative mismatch of totals that is put down to the quadrature behind the expectations.
const TOTAL_TOLERANCE: f64 = 1e-3;

/// Compares `observed` counts with `expected` ones, cell by cell.
///
/// Cells that expect fewer than `min_expected` samples are pooled (see [`pool_cells`]), never
/// dropped. Samples that a sampler legitimately loses, such as absorbed ones, need a cell of their
/// own: the totals must agree.
pub fn chi_square_test(
    observed: &[u64],
    expected: &[f64],
    min_expected: f64,
) -> Result<ChiSquare, ChiSquareError> {
    check(observed, expected)?;
    let cells = pool_cells(observed, expected, min_expected);
    if cells.len() < 2 {
        return Err(ChiSquareError::TooFewCells);
    }
    let statistic = cells.iter().map(|(count, due)| (count - due).powi(2) / due).sum();
    let degrees_of_freedom = cells.len() - 1;
    let p_value = match ChiSquared::new(degrees_of_freedom as f64) {
        Ok(distribution) => distribution.sf(statistic),
        Err(_) => f64::NAN,
    };
    Ok(ChiSquare { statistic, degrees_of_freedom, p_value })
}

/// Merges cells that expect fewer than `min_expected` samples into one.
///
/// When all of them together still expect too few, they join the smallest of the other cells.
/// Returns pairs of observed and expected counts; their totals are those of the input.
pub fn pool_cells(observed: &[u64], expected: &[f64], min_expected: f64) -> Vec<(f64, f64)> {
    let pairs = observed.iter().map(|count| *count as f64).zip(expected.iter().copied());
    let (mut cells, sparse): (Vec<_>, Vec<_>) = pairs.partition(|(_, due)| *due >= min_expected);
    let pool = sparse.iter().fold((0.0, 0.0), |sum, cell| (sum.0 + cell.0, sum.1 + cell.1));
    let smallest = cells.iter_mut().min_by(|a, b| a.1.total_cmp(&b.1));
    match smallest {
        Some(cell) if pool.1 < min_expected => *cell = (cell.0 + pool.0, cell.1 + pool.1),
        _ if pool.1 > 0.0 => cells.push(pool),
        _ => {}
    }
    cells
}

fn check(observed: &[u64], expected: &[f64]) -> Result<(), ChiSquareError> {
    if observed.len() != expected.len() {
        return Err(ChiSquareError::Length { observed: observed.len(), expected: expected.len() });
    }
    for (cell, (&count, &value)) in observed.iter().zip(expected).enumerate() {
        if !(value.is_finite() && value >= 0.0) {
            return Err(ChiSquareError::Expectation { cell, value });
        }
        if value == 0.0 && count > 0 {
            return Err(ChiSquareError::Impossible { cell, observed: count });
        }
    }
    let (samples, due) = (observed.iter().sum::<u64>(), expected.iter().sum::<f64>());
    if (samples as f64 - due).abs() > TOTAL_TOLERANCE * due.max(1.0) {
        return Err(ChiSquareError::Total { observed: samples, expected: due });
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_known_value_comes_out() {
        // Squares of 3, 1 and 4 over 20, 10 and 20 expected. With two degrees of freedom the tail
        // is exp(-x / 2).
        let result = chi_square_test(&[23, 11, 16], &[20.0, 10.0, 20.0], 5.0);
        let expected = 0.45 + 0.1 + 0.8;
        let found = result.expect("comparable");
        assert!((found.statistic - expected).abs() < 1e-12, "{found:?}");
        assert!((found.p_value - (-0.5 * expected).exp()).abs() < 1e-9, "{found:?}");
    }

    #[test]
    fn a_wrong_density_is_found() {
        let expected = [1000.0; 10];
        let mut observed = [1000; 10];
        observed[0] = 1200;
        observed[1] = 800;
        let found = chi_square_test(&observed, &expected, 5.0).expect("comparable");
        assert!(found.p_value < 1e-6, "six sigma in two cells: {found:?}");
    }

    #[test]
    fn sparse_cells_are_pooled_and_still_seen() {
        // Twenty cells expect one sample each; a hundred came. Dropping them would pass.
        let expected: Vec<f64> = [490.0, 490.0].into_iter().chain([1.0; 20]).collect();
        let observed: Vec<u64> = [450, 450].into_iter().chain([5; 20]).collect();
        let cells = pool_cells(&observed, &expected, 20.0);
        assert_eq!(cells, [(450.0, 490.0), (450.0, 490.0), (100.0, 20.0)], "one pooled cell");
        let found = chi_square_test(&observed, &expected, 20.0).expect("comparable");
        assert!(found.p_value < 1e-6, "{found:?}");
    }

    #[test]
    fn a_pool_that_is_too_small_joins_a_neighbour() {
        let cells = pool_cells(&[50, 40, 1], &[50.0, 40.0, 1.0], 20.0);
        assert_eq!(cells, [(50.0, 50.0), (41.0, 41.0)], "the smallest regular cell takes it");
    }

    #[test]
    fn nonsense_is_refused() {
        let test = |observed: &[u64], expected: &[f64]| {
            chi_square_test(observed, expected, 5.0).expect_err("must be refused")
        };
        let nan = test(&[10, 10], &[f64::NAN, 20.0]);
        assert!(matches!(nan, ChiSquareError::Expectation { cell: 0, .. }), "{nan}");
        let negative = test(&[10, 10], &[21.0, -1.0]);
        assert!(matches!(negative, ChiSquareError::Expectation { cell: 1, .. }), "{negative}");
        let dark = test(&[19, 1], &[20.0, 0.0]);
        assert_eq!(dark, ChiSquareError::Impossible { cell: 1, observed: 1 }, "density denies it");
        let scaled = test(&[90, 90], &[100.0, 100.0]);
        assert!(matches!(scaled, ChiSquareError::Total { .. }), "{scaled}");
        assert_eq!(test(&[20, 0], &[20.0, 0.0]), ChiSquareError::TooFewCells, "one cell is none");
        assert!(matches!(test(&[1], &[1.0, 2.0]), ChiSquareError::Length { .. }), "lengths differ");
    }
}
