//! Snapshots of a film on their way to one viewer, some rows at a time.

use common::FilmTile;

use super::NumberedFilm;

/// A film tile holds whole rows of about this many bytes.
const TILE_BYTES: usize = 192 << 10;
/// Bytes of a pixel in a tile.
const PIXEL_BYTES: usize = 12;

/// The snapshot that is being sent, and the newest one, which waits for it.
#[derive(Debug, Default)]
pub(super) struct FilmQueue {
    sending: Option<Progress>,
    newer: Option<NumberedFilm>,
}

/// A snapshot on its way: rows before `next_row` are sent.
#[derive(Debug)]
struct Progress {
    film: NumberedFilm,
    next_row: u32,
}

/// Rows of a snapshot that are due.
#[derive(Debug)]
pub(super) struct TileOrder {
    film: NumberedFilm,
    first_row: u32,
    rows: u32,
}

impl FilmQueue {
    /// Puts in a snapshot; it replaces one that waits.
    pub(super) fn push(&mut self, film: NumberedFilm) {
        if self.sending.is_none() {
            self.sending = Some(Progress { film, next_row: 0 });
        } else {
            self.newer = Some(film);
        }
    }

    /// Bytes that wait to be sent, and as many as may: two snapshots, which all viewers share.
    pub(super) fn byte_len(&self) -> (usize, usize) {
        let Some(Progress { film, next_row }) = &self.sending else { return (0, 0) };
        let row = PIXEL_BYTES * film.frame.width as usize;
        let (sent, whole) = (row * *next_row as usize, row * film.frame.height as usize);
        let newer = if self.newer.is_some() { whole } else { 0 };
        (whole - sent + newer, 2 * whole)
    }

    /// True when there is something to send.
    pub(super) fn is_waiting(&self) -> bool {
        self.sending.is_some()
    }

    /// True when no snapshot is sent in part.
    pub(super) fn is_between(&self) -> bool {
        self.sending.as_ref().is_none_or(|film| film.next_row == 0)
    }

    /// The next rows.
    pub(super) fn take_rows(&mut self) -> Option<TileOrder> {
        let progress = self.sending.as_mut()?;
        let frame = &progress.film.frame;
        let (width, height) = (frame.width as usize, frame.height);
        let rows = (TILE_BYTES / (PIXEL_BYTES * width.max(1))).max(1) as u32;
        let first_row = progress.next_row;
        let rows = rows.min(height - first_row);
        let order = TileOrder { film: progress.film.clone(), first_row, rows };
        progress.next_row += rows;
        if progress.next_row >= height {
            let next = self.newer.take();
            self.sending = next.map(|film| Progress { film, next_row: 0 });
        }
        Some(order)
    }
}

impl TileOrder {
    /// Bytes of the pixels.
    pub(super) fn byte_len(&self) -> usize {
        self.rows as usize * self.film.frame.width as usize * PIXEL_BYTES
    }

    /// The rows as they travel. A pixel that is not finite is sent as black: the picture shows the
    /// hole, and every other pixel arrives.
    pub(super) fn tile(&self) -> FilmTile {
        let frame = &self.film.frame;
        let width = frame.width as usize;
        let (skipped, taken) = (self.first_row as usize * width, self.rows as usize * width);
        let mut rgb: Vec<f32> = frame
            .pixels
            .iter()
            .skip(skipped)
            .take(taken)
            .flat_map(|pixel| pixel.to_f32())
            .map(|channel| if channel.is_finite() { channel } else { 0.0 })
            .collect();
        rgb.resize(3 * taken, 0.0);
        FilmTile {
            sequence: self.film.sequence,
            width: frame.width,
            height: frame.height,
            first_row: self.first_row,
            steps: frame.steps,
            rgb,
        }
    }
}
