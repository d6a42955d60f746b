//! Where splats are added up.

use common::Rgb;

/// A grid of sums in double precision. Nothing is clamped, filtered or rescaled here.
#[derive(Clone, Debug, PartialEq)]
pub struct Film {
    width: u32,
    height: u32,
    pixels: Vec<Rgb>,
}

impl Film {
    /// A black film.
    pub fn new(width: u32, height: u32) -> Self {
        Self { width, height, pixels: vec![Rgb::BLACK; width as usize * height as usize] }
    }

    /// A film with these pixels, row by row from the top left.
    pub fn of(width: u32, height: u32, pixels: Vec<Rgb>) -> Self {
        debug_assert_eq!(pixels.len(), width as usize * height as usize, "one colour a pixel");
        Self { width, height, pixels }
    }

    /// Makes all of it black.
    pub fn clear(&mut self) {
        self.pixels.fill(Rgb::BLACK);
    }

    /// Width in pixels.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Height in pixels.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// The pixels, row by row from the top left.
    pub fn pixels(&self) -> &[Rgb] {
        &self.pixels
    }

    /// The pixels, row by row from the top left.
    pub fn into_pixels(self) -> Vec<Rgb> {
        self.pixels
    }

    /// Adds `color` to the pixel with index `pixel`.
    #[inline]
    pub fn splat(&mut self, pixel: usize, color: Rgb) {
        self.pixels[pixel] += color;
    }

    /// Replaces what is in the pixel with index `pixel`.
    pub fn set(&mut self, pixel: usize, color: Rgb) {
        self.pixels[pixel] = color;
    }

    /// The rows from the top, for workers that own one each.
    pub fn rows_mut(&mut self) -> std::slice::ChunksMut<'_, Rgb> {
        self.pixels.chunks_mut(self.width as usize)
    }

    /// The sum of films of one size, in their order. There must be at least one.
    pub fn sum<'a, I: IntoIterator<Item = &'a Self>>(films: I) -> Self {
        let mut films = films.into_iter();
        let mut sum = films.next().cloned().unwrap_or_else(|| Self::new(0, 0));
        films.for_each(|film| sum.add(film));
        sum
    }

    /// Adds another film of the same size, pixel by pixel.
    pub fn add(&mut self, other: &Self) {
        for (sum, &pixel) in self.pixels.iter_mut().zip(&other.pixels) {
            *sum += pixel;
        }
    }

    /// Adds another film of the same size times a factor, pixel by pixel.
    pub fn add_scaled(&mut self, other: &Self, factor: f64) {
        for (sum, &pixel) in self.pixels.iter_mut().zip(&other.pixels) {
            *sum += pixel * factor;
        }
    }

    /// Multiplies every pixel.
    pub fn scale(&mut self, factor: f64) {
        for pixel in &mut self.pixels {
            *pixel = *pixel * factor;
        }
    }

    /// Sum of the pixels' luminances.
    pub fn total_luminance(&self) -> f64 {
        self.pixels.iter().map(|p| p.luminance()).sum()
    }

    /// Mean colour.
    pub fn mean(&self) -> Rgb {
        let sum = self.pixels.iter().fold(Rgb::BLACK, |sum, &p| sum + p);
        sum / self.pixels.len() as f64
    }
}
