//! Dark parts of the picture as often as bright ones: `h = 1`, `rho = 1 / sqrt(I^2 + floor^2)`.
//!
//! Proof: `rho` is positive everywhere, and a function of the film point alone.
//!
//! Why the root: with N states the variance of a pixel of luminance I is about `b_rho I / (rho N)`.
//! Relative errors weigh it by `1 / (I^2 + floor^2)`, and of all `rho` the root of that weight makes
//! their sum least (Cauchy and Schwarz). I is a coarse image, constant over each of its tiles.

use glam::DVec2;

use super::{Importance, Weighing};
use crate::path::Path;

/// The floor, as a share of the coarse image's root mean square.
const FLOOR: f64 = 0.1;

/// A coarse image that chains make up for.
#[derive(Clone, Debug, PartialEq)]
pub struct Equalised {
    columns: usize,
    rows: usize,
    /// `rho` of each tile, row by row.
    rho: Box<[f64]>,
}

impl Equalised {
    /// Of the mean luminances of `columns` x `rows` tiles, row by row from the top left. Even, where
    /// all of it is black.
    pub fn new(columns: usize, luminances: &[f64]) -> Self {
        let rows = luminances.len() / columns.max(1);
        let mean_square =
            luminances.iter().map(|l| l * l).sum::<f64>() / luminances.len().max(1) as f64;
        let rho = |luminance: &f64| {
            let relative = luminance * luminance / mean_square + FLOOR * FLOOR;
            if relative.is_finite() { 1.0 / relative.sqrt() } else { 1.0 }
        };
        Self { columns, rows, rho: luminances.iter().map(rho).collect() }
    }

    /// `rho` of what is seen at a film point.
    #[inline]
    pub fn at(&self, film: DVec2) -> f64 {
        let column = ((film.x * self.columns as f64) as usize).min(self.columns - 1);
        let row = ((film.y * self.rows as f64) as usize).min(self.rows - 1);
        self.rho[row * self.columns + column]
    }
}

impl Weighing for Equalised {
    #[inline]
    fn importance(&self, x: &Path) -> Importance {
        let rho = self.at(x.film());
        Importance { rho, share: 1.0 / rho }
    }
}
