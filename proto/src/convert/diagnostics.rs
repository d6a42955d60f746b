//! How well chains explore.

use common::{Diagnostics, TileGrid, TileMaps};

use super::{WireError, check, column};
use crate::v1;

/// Most tiles of a map.
const MAX_TILES: usize = 4096;
/// Most entries of the autocorrelation: stretches of up to `2^63` steps.
const MAX_SCALES: usize = 64;

impl From<&Diagnostics> for v1::Diagnostics {
    fn from(d: &Diagnostics) -> Self {
        let TileMaps { acceptance, dwell, visits, spread, r_hat } = &d.maps;
        Self {
            tile_side: d.grid.side,
            columns: d.grid.columns,
            rows: d.grid.rows,
            acceptance: column::encode(acceptance),
            dwell: column::encode(dwell),
            visits: column::encode(visits),
            spread: column::encode(spread),
            r_hat: column::encode(r_hat),
            autocorrelation: column::encode(&d.autocorrelation),
            correlation_steps: check::known_or_zero(d.correlation_steps),
            effective_samples: check::known_or_zero(d.effective_samples),
            film_r_hat: check::known_or_zero(d.r_hat),
            longest: d.longest.as_ref().map(Into::into),
        }
    }
}

impl TryFrom<v1::Diagnostics> for Diagnostics {
    type Error = WireError;

    fn try_from(wire: v1::Diagnostics) -> Result<Self, WireError> {
        let side = |field, found| check::within(field, found, 1, check::MAX_FILM_SIDE);
        let grid = TileGrid {
            side: side("diagnostics.tile_side", wire.tile_side)?,
            columns: side("diagnostics.columns", wire.columns)?,
            rows: side("diagnostics.rows", wire.rows)?,
        };
        check::length("diagnostics tiles", grid.len(), MAX_TILES)?;
        let map = |field, bytes: &[u8]| -> Result<Vec<f32>, WireError> {
            let values = column::decode(field, bytes, grid.len())?;
            check::all_finite(field, &values)?;
            Ok(values)
        };
        let scales = wire.autocorrelation.len() / size_of::<f32>();
        check::length("diagnostics.autocorrelation", scales, MAX_SCALES)?;
        let autocorrelation =
            column::decode("diagnostics.autocorrelation", &wire.autocorrelation, scales)?;
        check::all_finite("diagnostics.autocorrelation", &autocorrelation)?;
        Ok(Self {
            grid,
            maps: TileMaps {
                acceptance: map("diagnostics.acceptance", &wire.acceptance)?,
                dwell: map("diagnostics.dwell", &wire.dwell)?,
                visits: map("diagnostics.visits", &wire.visits)?,
                spread: map("diagnostics.spread", &wire.spread)?,
                r_hat: map("diagnostics.r_hat", &wire.r_hat)?,
            },
            autocorrelation,
            correlation_steps: check::not_negative(
                "diagnostics.correlation_steps",
                wire.correlation_steps,
            )?,
            effective_samples: check::not_negative(
                "diagnostics.effective_samples",
                wire.effective_samples,
            )?,
            r_hat: check::not_negative("diagnostics.film_r_hat", wire.film_r_hat)?,
            longest: wire.longest.map(TryInto::try_into).transpose()?,
        })
    }
}
