//! How well chains explore: what those who see every step measured.

use crate::PathBatch;

/// The value of a tile of which nothing is known.
pub const UNKNOWN: f32 = -1.0;

/// Square tiles that cover the film, row by row from the upper left.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TileGrid {
    /// Pixels a side of a tile; the last ones of a row or column may stick out.
    pub side: u32,
    /// Tiles in a row.
    pub columns: u32,
    /// Rows.
    pub rows: u32,
}

impl TileGrid {
    /// The finest grid of at most `most` tiles over a film of `width` by `height` pixels.
    pub fn over(width: u32, height: u32, most: u32) -> Self {
        let count = |side: u32| u64::from(width.div_ceil(side)) * u64::from(height.div_ceil(side));
        let mut side = 1;
        while count(side) > u64::from(most.max(1)) {
            side += 1;
        }
        Self { side, columns: width.div_ceil(side), rows: height.div_ceil(side) }
    }

    /// Number of tiles.
    pub fn len(self) -> usize {
        self.columns as usize * self.rows as usize
    }

    /// True without tiles.
    pub fn is_empty(self) -> bool {
        self.len() == 0
    }

    /// The tile of a pixel.
    pub fn tile(self, x: u32, y: u32) -> usize {
        let side = self.side.max(1);
        (y / side) as usize * self.columns as usize + (x / side) as usize
    }

    /// First pixel of a tile.
    pub fn origin(self, tile: usize) -> [u32; 2] {
        let columns = self.columns.max(1);
        let (row, column) = (tile as u32 / columns, tile as u32 % columns);
        [column * self.side, row * self.side]
    }
}

/// One value a tile each; [`UNKNOWN`] where chains came too seldom.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TileMaps {
    /// Mean acceptance probability of the proposals that were made from paths that end here.
    pub acceptance: Vec<f32>,
    /// Mean number of steps that a chain stayed at a path that ends here.
    pub dwell: Vec<f32>,
    /// Arrivals a pixel, over the mean of the film.
    pub visits: Vec<f32>,
    /// Relative standard error of the energy, from how much chains differ.
    pub spread: Vec<f32>,
    /// Potential scale reduction between chains; 1 where they agree.
    pub r_hat: Vec<f32>,
}

/// How well the chains explore, since the epoch began.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Diagnostics {
    /// The tiles of [`Self::maps`].
    pub grid: TileGrid,
    /// What differs over the film.
    pub maps: TileMaps,
    /// Correlation between the mean of log luminance over `2^k` steps of a chain and over the next
    /// `2^k`, at index `k`.
    pub autocorrelation: Vec<f32>,
    /// How many steps are worth an independent one.
    pub correlation_steps: f64,
    /// Independent samples that all steps together are worth.
    pub effective_samples: f64,
    /// Potential scale reduction of log luminance between chains; 1 where they agree.
    pub r_hat: f64,
    /// The paths at which chains stayed longest, longest first, each with its dwell.
    pub longest: Option<PathBatch>,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_pixel_has_its_tile() {
        for (width, height, most) in [(256, 256, 1024), (1280, 720, 1024), (3, 500, 7), (1, 1, 1)] {
            let grid = TileGrid::over(width, height, most);
            assert!((1..=most as usize).contains(&grid.len()), "{grid:?}");
            let mut seen = vec![false; grid.len()];
            for (x, y) in (0..height).flat_map(|y| (0..width).map(move |x| (x, y))) {
                let tile = grid.tile(x, y);
                seen[tile] = true;
                let [left, top] = grid.origin(tile);
                let inside = (left..left + grid.side).contains(&x);
                assert!(inside && (top..top + grid.side).contains(&y), "{x}, {y} in {tile}");
            }
            assert!(seen.iter().all(|seen| *seen), "no tile is empty: {grid:?}");
        }
        assert_eq!(TileGrid::over(256, 256, 1024).side, 8, "as fine as allowed");
    }
}
