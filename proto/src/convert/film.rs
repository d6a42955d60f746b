//! Film tiles.

use common::FilmTile;

use super::{WireError, check, column};
use crate::v1;

/// Most bytes of pixels in one tile.
const MAX_TILE_BYTES: usize = 1 << 20;

impl From<&FilmTile> for v1::FilmTile {
    fn from(tile: &FilmTile) -> Self {
        Self {
            sequence: tile.sequence,
            width: tile.width,
            height: tile.height,
            first_row: tile.first_row,
            steps: tile.steps,
            rgb: column::encode(&tile.rgb),
        }
    }
}

impl TryFrom<v1::FilmTile> for FilmTile {
    type Error = WireError;

    fn try_from(wire: v1::FilmTile) -> Result<Self, WireError> {
        let width = check::within("film_tile.width", wire.width, 1, check::MAX_FILM_SIDE)?;
        let height = check::within("film_tile.height", wire.height, 1, check::MAX_FILM_SIDE)?;
        let first_row = check::within("film_tile.first_row", wire.first_row, 0, height - 1)?;
        check::length("film_tile.rgb", wire.rgb.len(), MAX_TILE_BYTES)?;
        let row_floats = 3 * width as usize;
        let rows = wire.rgb.len() / (4 * row_floats);
        check::within("film_tile rows", rows as u32, 1, height - first_row)?;
        let rgb = column::decode("film_tile.rgb", &wire.rgb, rows * row_floats)?;
        check::all_finite("film_tile.rgb", &rgb)?;
        Ok(Self { sequence: wire.sequence, width, height, first_row, steps: wire.steps, rgb })
    }
}
