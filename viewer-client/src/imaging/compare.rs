//! How far the image is from a reference.

use common::{Floor, Rgb, known, mean_of_smallest, mean_ratio, relative_errors};

use crate::imaging::film::Film;

/// What keeps dark pixels from ruling the error, in squared units of radiance.
const FLOOR: Floor = Floor::Absolute(0.01);
/// Share of the pixels that the trimmed error keeps: without its worst, an image that is right but
/// for a few bright points shows.
const TRIMMED: f64 = 0.99;

/// An image to compare with.
#[derive(Clone, Debug, PartialEq)]
pub struct Reference {
    /// Where it came from, for people.
    pub name: String,
    /// Width in pixels.
    pub width: usize,
    /// Height in pixels.
    pub height: usize,
    /// Radiance, row by row from the top.
    pub pixels: Vec<Rgb>,
}

impl Reference {
    /// The radiance of a pixel.
    pub fn pixel(&self, x: usize, y: usize) -> Option<Rgb> {
        let inside = x < self.width;
        self.pixels.get(y * self.width + x).copied().filter(|_| inside)
    }

    /// True when its pixels are those of `film`.
    pub fn fits(&self, film: &Film) -> bool {
        film.size() == [self.width, self.height]
    }

    /// Pixels for which it has no value.
    pub fn missing(&self) -> usize {
        self.pixels.iter().filter(|pixel| !pixel.is_finite()).count()
    }

    /// Relative squared error of each pixel of `film`: the mean over the channels of
    /// `(x - r)^2 / (r^2 + 0.01)`. NaN where the reference has no value; empty when the sizes differ.
    pub fn errors(&self, film: &Film) -> Vec<f64> {
        if self.fits(film) {
            relative_errors(&film.radiance(), &self.pixels, FLOOR)
        } else {
            Vec::new()
        }
    }
}

/// How far an image is from a reference, in numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Comparison {
    /// Mean of [`Reference::errors`], where the reference has a value.
    pub relative_mse: f64,
    /// The same without the worst pixel in a hundred.
    pub trimmed: f64,
    /// Energy of the image over that of the reference.
    pub mean_ratio: f64,
}

impl Comparison {
    /// Compares; `None` when the sizes differ.
    pub fn of(film: &Film, reference: &Reference) -> Option<Self> {
        if !reference.fits(film) {
            return None;
        }
        let errors = known(reference.errors(film), &reference.pixels);
        Some(Self {
            relative_mse: mean_of_smallest(errors.clone(), 1.0),
            trimmed: mean_of_smallest(errors, TRIMMED),
            mean_ratio: mean_ratio(&film.radiance(), &reference.pixels),
        })
    }
}

#[cfg(test)]
mod tests {
    use common::FilmTile;

    use super::*;

    fn film(rgb: Vec<f32>) -> Film {
        let mut film = Film::default();
        let height = (rgb.len() / 6) as u32;
        let tile = FilmTile { sequence: 1, width: 2, height, first_row: 0, steps: 7, rgb };
        assert!(film.accept(&tile), "a whole image");
        film
    }

    #[test]
    fn the_error_is_that_of_the_literature() {
        let reference = Reference {
            name: "r".to_owned(),
            width: 2,
            height: 2,
            pixels: vec![Rgb::grey(0.5), Rgb::grey(0.0), Rgb::grey(1.0), Rgb::grey(2.0)],
        };
        let image = film([0.6_f32, 0.1, 1.0, 2.0].iter().flat_map(|v| [*v; 3]).collect());
        let comparison = Comparison::of(&image, &reference).expect("equal sizes");
        // (0.1^2 / (0.25 + 0.01) + 0.1^2 / 0.01) / 4
        let expected = (0.01 / 0.26 + 1.0) / 4.0;
        assert!((comparison.relative_mse - expected).abs() < 1e-6, "{comparison:?}");
        assert!((comparison.mean_ratio - 3.7 / 3.5).abs() < 1e-6, "{comparison:?}");
        let trimmed = 0.01 / 0.26 / 3.0;
        assert!((comparison.trimmed - trimmed).abs() < 1e-6, "without the worst: {comparison:?}");
        assert_eq!(Comparison::of(&film(vec![0.0; 6]), &reference), None, "another size");
    }
}
