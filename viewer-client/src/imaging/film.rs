//! The progressive image: put together from tiles.

use std::sync::LazyLock;

use common::{FilmTile, Rgb};

use crate::value::fresh;

/// Larger films are refused: their image would not fit into a texture of common graphics cards.
const LARGEST_SIDE: u32 = 8192;
/// Entries of the table from linear light to sRGB.
const TABLE_SIZE: usize = 1024;

/// The image as it came last.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Film {
    width: u32,
    height: u32,
    steps: u64,
    revision: u64,
    /// Radiance, three floats a pixel, row by row from the top.
    pixels: Vec<f32>,
}

impl Film {
    /// Takes the rows of a tile; one of another size begins a new image. A tile that contradicts
    /// itself changes nothing, and the answer is false.
    pub fn accept(&mut self, tile: &FilmTile) -> bool {
        let row = 3 * tile.width as usize;
        let fits = (1..=LARGEST_SIDE).contains(&tile.width)
            && (1..=LARGEST_SIDE).contains(&tile.height)
            && tile.rgb.len().is_multiple_of(row)
            && tile.first_row as usize + tile.rgb.len() / row <= tile.height as usize;
        if !fits {
            return false;
        }
        if (self.width, self.height) != (tile.width, tile.height) {
            (self.width, self.height) = (tile.width, tile.height);
            self.pixels = vec![0.0; row * tile.height as usize];
        }
        let start = row * tile.first_row as usize;
        if let Some(rows) = self.pixels.get_mut(start..start + tile.rgb.len()) {
            rows.copy_from_slice(&tile.rgb);
        }
        self.steps = tile.steps;
        self.revision = fresh();
        true
    }

    /// Width and height in pixels; zero before the first tile.
    pub fn size(&self) -> [usize; 2] {
        [self.width as usize, self.height as usize]
    }

    /// Mutations behind the image.
    pub fn steps(&self) -> u64 {
        self.steps
    }

    /// Another one after every change; no two images have the same.
    pub fn revision(&self) -> u64 {
        self.revision
    }

    /// The radiance of a pixel.
    pub fn pixel(&self, x: usize, y: usize) -> Option<[f32; 3]> {
        let inside = x < self.width as usize && y < self.height as usize;
        let start = 3 * (y * self.width as usize + x);
        let rgb = self.pixels.get(start..start + 3).filter(|_| inside)?;
        Some([rgb[0], rgb[1], rgb[2]])
    }

    /// Radiance, three floats a pixel, row by row from the top.
    pub fn rgb(&self) -> &[f32] {
        &self.pixels
    }

    /// The radiance of every pixel, row by row from the top.
    pub fn radiance(&self) -> Vec<Rgb> {
        self.pixels.as_chunks::<3>().0.iter().map(|rgb| Rgb::from(*rgb)).collect()
    }
}

/// Linear light from 0 to 1 as an sRGB byte; brighter is white, and what is no number is black.
pub fn encode_srgb(linear: f32) -> u8 {
    // The table is indexed by the square root, which resolves shadows as finely as lights.
    static TABLE: LazyLock<Vec<u8>> = LazyLock::new(|| {
        let entry = |i| {
            let linear = (i as f32 / (TABLE_SIZE - 1) as f32).powi(2);
            let encoded = if linear <= 0.003_130_8 {
                12.92 * linear
            } else {
                1.055 * linear.powf(1.0 / 2.4) - 0.055
            };
            (encoded * 255.0).round() as u8
        };
        (0..TABLE_SIZE).map(entry).collect()
    });
    let place = linear.clamp(0.0, 1.0).sqrt() * (TABLE_SIZE - 1) as f32;
    TABLE.get(place.round() as usize).copied().unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tile(first_row: u32, rgb: Vec<f32>) -> FilmTile {
        FilmTile { sequence: 1, width: 2, height: 3, first_row, steps: 7, rgb }
    }

    #[test]
    fn tiles_fill_their_rows() {
        let mut film = Film::default();
        assert!(film.accept(&tile(1, vec![0.5; 12])), "two rows from the second on");
        assert_eq!(film.pixel(0, 0), Some([0.0; 3]), "the first row is still dark");
        assert_eq!(film.pixel(1, 2), Some([0.5; 3]), "the last row came");
        assert_eq!((film.pixel(2, 0), film.pixel(0, 3)), (None, None), "outside");
        assert_eq!((film.size(), film.steps()), ([2, 3], 7), "size and steps");
    }

    #[test]
    fn tiles_that_contradict_themselves_change_nothing() {
        let mut film = Film::default();
        assert!(film.accept(&tile(0, vec![0.5; 18])), "a whole image");
        let before = film.clone();
        assert!(!film.accept(&tile(2, vec![1.0; 12])), "more rows than the film has");
        assert!(!film.accept(&tile(0, vec![1.0; 5])), "half a pixel");
        assert!(!film.accept(&FilmTile { width: 0, ..tile(0, vec![]) }), "no width");
        assert!(!film.accept(&FilmTile { height: 1 << 20, ..tile(0, vec![]) }), "absurd height");
        assert_eq!(film, before, "nothing changed");
    }

    #[test]
    fn srgb_is_exact_to_one_byte() {
        for byte in 0..=255_u8 {
            let encoded = f32::from(byte) / 255.0;
            let linear = if encoded <= 0.040_45 {
                encoded / 12.92
            } else {
                ((encoded + 0.055) / 1.055).powf(2.4)
            };
            assert!(encode_srgb(linear).abs_diff(byte) <= 1, "byte {byte}");
        }
        assert_eq!(encode_srgb(7.0), 255, "too bright");
        assert_eq!(encode_srgb(f32::NAN), 0, "no number");
    }
}
