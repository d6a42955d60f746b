//! Light from all around: a constant, or an image in latitude and longitude.

use std::f64::consts::{PI, TAU};

use common::Rgb;
use glam::{DMat3, DVec3};

use crate::math::{below_one, invert_uniform_sphere, turn, uniform_sphere};
use crate::scene::description::SkyImage;

/// Radiance from every direction, with a density to draw directions from.
///
/// Radiance is constant over a texel, and the density is proportional to its luminance: so the
/// weight of a drawn direction is bounded whatever the contrast of the image.
#[derive(Clone, Debug)]
pub(crate) struct Sky {
    /// From directions in the scene to directions in the image.
    to_image: DMat3,
    /// What the texels are multiplied by.
    factor: Rgb,
    image: Option<Distribution>,
    mean: Rgb,
}

/// An image with cumulated probabilities of its texels.
#[derive(Clone, Debug)]
struct Distribution {
    image: SkyImage,
    /// Probability that the row is at most this one.
    rows: Vec<f64>,
    /// For each row: probability that the column is at most this one.
    columns: Vec<f64>,
}

/// The cell of a table of cumulated probabilities that owns `u`, and where in it `u` lies.
fn locate(cumulative: &[f64], u: f64) -> (usize, f64) {
    let index = cumulative.partition_point(|&c| c <= u).min(cumulative.len() - 1);
    let (from, to) = span(cumulative, index);
    (index, below_one((u - from) / (to - from)))
}

/// The numbers that a cell owns: from, and up to.
fn span(cumulative: &[f64], index: usize) -> (f64, f64) {
    (index.checked_sub(1).map_or(0.0, |before| cumulative[before]), cumulative[index])
}

/// Replaces weights by cumulated probabilities that end at exactly one; returns their sum. All are
/// equally likely where all weights are zero.
fn cumulate(weights: &mut [f64]) -> f64 {
    let total: f64 = weights.iter().sum();
    let equal = 1.0 / weights.len() as f64;
    let mut sum = 0.0;
    for weight in weights.iter_mut() {
        sum += if total > 0.0 { *weight / total } else { equal };
        *weight = sum;
    }
    // The tail of cells without weight must not become likely by rounding.
    let last = weights.last().copied().unwrap_or(1.0);
    for weight in weights.iter_mut().rev().take_while(|weight| **weight == last) {
        *weight = 1.0;
    }
    total
}

impl Distribution {
    /// With the luminance of the texels times `factor`.
    fn new(image: SkyImage, factor: Rgb) -> Self {
        let SkyImage { width, height, ref texels } = image;
        let mut columns: Vec<f64> =
            texels.iter().map(|&texel| (color(texel) * factor).luminance()).collect();
        let mut rows: Vec<f64> = columns
            .chunks_exact_mut(width)
            .enumerate()
            .map(|(row, weights)| cumulate(weights) * band(row, height))
            .collect();
        cumulate(&mut rows);
        Self { image, rows, columns }
    }

    fn row(&self, row: usize) -> &[f64] {
        &self.columns[row * self.image.width..][..self.image.width]
    }

    /// Direction in the image's axes.
    fn sample(&self, [u, v]: [f64; 2]) -> DVec3 {
        let (row, along) = locate(&self.rows, u);
        let (column, across) = locate(self.row(row), v);
        // Even in the cosine is even in solid angle.
        let (top, bottom) = latitudes(row, self.image.height);
        let y = top.cos() + along * (bottom.cos() - top.cos());
        let (sin, cos) = (TAU * (column as f64 + across) / self.image.width as f64).sin_cos();
        let radius = (1.0 - y * y).max(0.0).sqrt();
        DVec3::new(radius * sin, y, -radius * cos)
    }

    fn invert(&self, direction: DVec3) -> [f64; 2] {
        let (row, column) = self.texel(direction);
        let (top, bottom) = latitudes(row, self.image.height);
        let along = below_one((direction.y - top.cos()) / (bottom.cos() - top.cos()));
        let across = below_one(longitude(direction) * self.image.width as f64 - column as f64);
        let number = |(from, to): (f64, f64), share: f64| below_one(from + share * (to - from));
        [number(span(&self.rows, row), along), number(span(self.row(row), column), across)]
    }

    /// Row and column of the texel that a direction looks at.
    fn texel(&self, direction: DVec3) -> (usize, usize) {
        let SkyImage { width, height, .. } = self.image;
        let row = direction.y.clamp(-1.0, 1.0).acos() / PI * height as f64;
        let column = longitude(direction) * width as f64;
        ((row as usize).min(height - 1), (column as usize).min(width - 1))
    }

    /// Radiance, and density per solid angle of drawing the direction.
    fn evaluate(&self, direction: DVec3) -> (Rgb, f64) {
        let SkyImage { width, height, ref texels } = self.image;
        let (row, column) = self.texel(direction);
        let probability = |(from, to): (f64, f64)| to - from;
        let texel = probability(span(&self.rows, row)) * probability(span(self.row(row), column));
        let solid_angle = band(row, height) / width as f64;
        (color(texels[row * width + column]), texel / solid_angle)
    }
}

fn color([r, g, b]: [f32; 3]) -> Rgb {
    Rgb::new(r.into(), g.into(), b.into())
}

/// Angles from the top at which a row begins and ends.
fn latitudes(row: usize, height: usize) -> (f64, f64) {
    let at = |row: usize| PI * row as f64 / height as f64;
    (at(row), at(row + 1))
}

/// Solid angle of a row.
fn band(row: usize, height: usize) -> f64 {
    let (top, bottom) = latitudes(row, height);
    TAU * (top.cos() - bottom.cos())
}

/// The turn around y as a share of a full one, in [0, 1).
fn longitude(direction: DVec3) -> f64 {
    turn(direction.x, -direction.z)
}

impl Sky {
    /// The same radiance from everywhere.
    pub(crate) fn constant(radiance: Rgb) -> Self {
        Self { to_image: DMat3::IDENTITY, factor: radiance, image: None, mean: radiance }
    }

    /// An image, turned by `rotation` from its own axes to the scene's and multiplied by `factor`.
    pub(crate) fn of_image(image: SkyImage, rotation: DMat3, factor: Rgb) -> Self {
        let (width, height) = (image.width, image.height);
        let mut mean = Rgb::BLACK;
        for (row, texels) in image.texels.chunks_exact(width).enumerate() {
            let share = band(row, height) / (4.0 * PI * width as f64);
            for &texel in texels {
                mean += color(texel) * factor * share;
            }
        }
        let image = Some(Distribution::new(image, factor));
        Self { to_image: rotation.transpose(), factor, image, mean }
    }

    /// Radiance on the average over all directions.
    pub(crate) fn mean(&self) -> Rgb {
        self.mean
    }

    pub(crate) fn dim(&mut self, divisor: f64) {
        self.factor = self.factor / divisor;
        self.mean = self.mean / divisor;
    }

    /// A direction to look at, made of two numbers.
    pub(crate) fn sample(&self, u: [f64; 2]) -> DVec3 {
        match &self.image {
            Some(image) => self.to_image.transpose() * image.sample(u),
            None => uniform_sphere(u[0], u[1]),
        }
    }

    /// The numbers from which [`Sky::sample`] makes `direction`.
    pub(crate) fn invert(&self, direction: DVec3) -> [f64; 2] {
        match &self.image {
            Some(image) => image.invert(self.to_image * direction),
            None => invert_uniform_sphere(direction),
        }
    }

    /// Radiance from where one looks in `direction`, and the density per solid angle with which
    /// [`Sky::sample`] draws it.
    pub(crate) fn evaluate(&self, direction: DVec3) -> (Rgb, f64) {
        match &self.image {
            Some(image) => {
                let (radiance, pdf) = image.evaluate(self.to_image * direction);
                (radiance * self.factor, pdf)
            }
            None => (self.factor, 1.0 / (4.0 * PI)),
        }
    }
}

#[cfg(test)]
mod tests {
    use ::tests::{Accumulator, chi_square_test};

    use super::*;
    use crate::math::{Rng, Stream};

    /// A dim sky with black texels, a bright one and a coloured row.
    fn sky() -> Sky {
        let (width, height) = (8, 4);
        let mut texels = vec![[0.2, 0.25, 0.3]; width * height];
        texels[..3].fill([0.0; 3]);
        texels[width + 5] = [900.0, 700.0, 300.0];
        texels[3 * width..].fill([0.1, 0.02, 0.0]);
        let rotation = DMat3::from_axis_angle(DVec3::new(1.0, 2.0, -0.5).normalize(), 0.7);
        Sky::of_image(SkyImage { width, height, texels }, rotation, Rgb::new(1.0, 0.9, 1.1))
    }

    #[test]
    fn directions_are_inverted_and_seen() {
        let sky = sky();
        let mut rng = Rng::new(8, Stream::Laboratory, 0);
        for _ in 0..20_000 {
            let u: [f64; 2] = rng.array();
            let direction = sky.sample(u);
            let again = sky.invert(direction);
            let off = (again[0] - u[0]).abs().max((again[1] - u[1]).abs());
            assert!(off < 1e-9, "{again:?} instead of {u:?}");
            let (radiance, pdf) = sky.evaluate(direction);
            assert!(pdf > 0.0 && !radiance.is_black(), "a direction without light was drawn");
        }
    }

    /// Looking around evenly, the density is that of the samples and the mean is right.
    #[test]
    fn the_density_is_that_of_the_samples() {
        const N: usize = 200_000;
        let sky = sky();
        let image = sky.image.as_ref().expect("an image");
        let mut rng = Rng::new(9, Stream::Laboratory, 0);
        let (mut observed, mut expected) = (vec![0_u64; 32], vec![0.0; 32]);
        let (mut by_samples, mut evenly) = (Accumulator::default(), Accumulator::default());
        for _ in 0..N {
            let direction = sky.sample(rng.array());
            let (row, column) = image.texel(sky.to_image * direction);
            observed[row * 8 + column] += 1;
            let (radiance, pdf) = sky.evaluate(direction);
            by_samples.push(radiance.luminance() / pdf);
            let [u, v] = rng.array();
            evenly.push(sky.evaluate(uniform_sphere(u, v)).1 * 4.0 * PI);
        }
        for row in 0..4 {
            for column in 0..8 {
                let (top, bottom) = latitudes(row, 4);
                let latitude = 0.5 * (top + bottom);
                let turn = TAU * (column as f64 + 0.5) / 8.0;
                let inside = DVec3::new(
                    latitude.sin() * turn.sin(),
                    latitude.cos(),
                    -latitude.sin() * turn.cos(),
                );
                let (_, pdf) = image.evaluate(inside);
                expected[row * 8 + column] = pdf * band(row, 4) / 8.0 * N as f64;
            }
        }
        let result = chi_square_test(&observed, &expected, 5.0).expect("valid counts");
        assert!(result.p_value > 1e-7, "p = {:e}", result.p_value);
        // Every direction's weight is the same: the density follows the luminance.
        let mean = 4.0 * PI * sky.mean().luminance();
        assert!((by_samples.mean() / mean - 1.0).abs() < 1e-9, "{}", by_samples.mean());
        let off = (evenly.mean() - 1.0) / evenly.standard_error();
        assert!(off.abs() < 5.5, "the density integrates to {}", evenly.mean());
    }

    #[test]
    fn the_image_is_the_right_way_round() {
        let mut texels = vec![[0.1; 3]; 32];
        texels[0] = [5.0; 3]; // top row, beginning at -z and turning to +x
        let image = SkyImage { width: 8, height: 4, texels };
        let sky = Sky::of_image(image, DMat3::IDENTITY, Rgb::WHITE);
        let bright = |x, y, z| sky.evaluate(DVec3::new(x, y, z).normalize()).0.g > 1.0;
        assert!(bright(0.1, 1.0, -0.9), "between -z and +x, high up");
        assert!(!bright(-0.1, 1.0, -0.9) && !bright(0.1, 1.0, 0.9) && !bright(0.1, -1.0, -0.9));
    }
}
