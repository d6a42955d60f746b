//! Sums over replicates that are the same whatever the order and the grouping.
//!
//! Every pixel of a replicate is rounded once, to a quantum frozen beforehand, and added as an
//! integer. Sums of integers are associative: parts of a picture that were made apart, in any order,
//! on any number of threads, add up to the very same bits as one run.

use std::io::{self, Read, Write};

use common::Rgb;
use serde::Serialize;

use crate::film::Film;

/// Side of a tile in pixels.
pub const TILE: u32 = 8;
/// Replicates below which nothing is said of a single pixel's error.
const ENOUGH: u64 = 8;
/// Share of a pixel's squared deviations that a single replicate may have before its error bar is not
/// to be trusted.
const DOMINANT: f64 = 0.6;

/// What is told of one replicate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Row {
    /// Its number.
    pub number: u64,
    /// Its `b`, in film units of the scene; zero without chains.
    pub normalization: f64,
    /// Mean luminance of its picture, likewise.
    pub mean: f64,
    /// Base samples.
    pub samples: u64,
    /// Mutations.
    pub steps: u64,
    /// Closest-hit rays.
    pub rays: u64,
    /// Shadow rays.
    pub shadow_rays: u64,
}

impl Row {
    /// Words of a row in a file.
    pub(super) const WORDS: usize = 7;

    /// The row in a file.
    pub(super) fn words(&self) -> [u64; Self::WORDS] {
        let &Self { number, normalization, mean, samples, steps, rays, shadow_rays } = self;
        [number, normalization.to_bits(), mean.to_bits(), samples, steps, rays, shadow_rays]
    }

    /// The row with these words in a file.
    pub(super) fn of(words: [u64; Self::WORDS]) -> Self {
        let [number, normalization, mean, samples, steps, rays, shadow_rays] = words;
        let (normalization, mean) = (f64::from_bits(normalization), f64::from_bits(mean));
        Self { number, normalization, mean, samples, steps, rays, shadow_rays }
    }
}

/// Sums over replicates.
#[derive(Clone, Debug, PartialEq)]
pub struct Ledger {
    width: u32,
    height: u32,
    quantum: f64,
    /// By number.
    rows: Vec<Row>,
    columns: Columns,
}

/// The sums of every pixel and tile.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Columns {
    /// Of each pixel's channels, in quanta.
    sums: Vec<[i64; 3]>,
    /// Of the squares of each pixel's luminance, in quanta squared.
    luminance_squares: Vec<u128>,
    /// Of the squares of each pixel's channels, likewise.
    color_squares: Vec<u128>,
    /// The largest luminance that any replicate had in each pixel.
    peaks: Vec<f32>,
    /// Of the squares of each tile's luminance, summed over its pixels.
    tile_squares: Vec<u128>,
}

impl Columns {
    fn new(width: u32, height: u32) -> Self {
        let pixels = width as usize * height as usize;
        let tiles = width.div_ceil(TILE) as usize * height.div_ceil(TILE) as usize;
        Self {
            sums: vec![[0; 3]; pixels],
            luminance_squares: vec![0; pixels],
            color_squares: vec![0; pixels],
            peaks: vec![0.0; pixels],
            tile_squares: vec![0; tiles],
        }
    }

    /// Reads what [`Ledger::write`] wrote.
    pub(super) fn read(file: &mut impl Read, width: u32, height: u32) -> io::Result<Self> {
        let mut columns = Self::new(width, height);
        for sum in columns.sums.iter_mut().flatten() {
            let mut bytes = [0; 8];
            file.read_exact(&mut bytes)?;
            *sum = i64::from_le_bytes(bytes);
        }
        let Self { luminance_squares, color_squares, tile_squares, peaks, .. } = &mut columns;
        for square in luminance_squares.iter_mut().chain(color_squares).chain(tile_squares) {
            let mut bytes = [0; 16];
            file.read_exact(&mut bytes)?;
            *square = u128::from_le_bytes(bytes);
        }
        for peak in peaks {
            let mut bytes = [0; 4];
            file.read_exact(&mut bytes)?;
            *peak = f32::from_le_bytes(bytes);
        }
        Ok(columns)
    }
}

/// An estimate with its error.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Estimate {
    /// The mean over replicates.
    pub mean: f64,
    /// Its standard error; NaN of a single replicate.
    pub error: f64,
    /// Kurtosis over replicates: 3 for a normal distribution; large where the error cannot be trusted.
    pub kurtosis: f64,
}

impl Estimate {
    fn of(values: &[f64]) -> Self {
        let n = values.len() as f64;
        let mean = values.iter().sum::<f64>() / n;
        let moment = |power: i32| values.iter().map(|v| (v - mean).powi(power)).sum::<f64>();
        let squares = moment(2);
        let kurtosis = n * moment(4) / (squares * squares);
        Self { mean, error: (squares / (n - 1.0) / n).sqrt(), kurtosis }
    }
}

impl Ledger {
    /// No replicate yet of a picture of this size.
    pub fn new(width: u32, height: u32, quantum: f64) -> Self {
        Self { width, height, quantum, rows: Vec::new(), columns: Columns::new(width, height) }
    }

    /// Of sums that were read.
    pub(super) fn from_parts(
        [width, height]: [u32; 2],
        quantum: f64,
        rows: Vec<Row>,
        columns: Columns,
    ) -> Self {
        Self { width, height, quantum, rows, columns }
    }

    /// The quantum of the sums, in film units of the scene.
    pub(super) fn quantum(&self) -> f64 {
        self.quantum
    }

    /// Writes the columns in little endian.
    pub(super) fn write(&self, out: &mut impl Write) -> io::Result<()> {
        let Columns { sums, luminance_squares, color_squares, peaks, tile_squares } = &self.columns;
        for sum in sums.iter().flatten() {
            out.write_all(&sum.to_le_bytes())?;
        }
        for square in luminance_squares.iter().chain(color_squares).chain(tile_squares) {
            out.write_all(&square.to_le_bytes())?;
        }
        for peak in peaks {
            out.write_all(&peak.to_le_bytes())?;
        }
        Ok(())
    }

    /// Width in pixels.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Height in pixels.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// What is told of each replicate, by number.
    pub fn rows(&self) -> &[Row] {
        &self.rows
    }

    /// Number of replicates.
    pub fn count(&self) -> u64 {
        self.rows.len() as u64
    }

    /// True when the replicate of that number is in.
    pub fn has(&self, number: u64) -> bool {
        self.rows.binary_search_by_key(&number, |row| row.number).is_ok()
    }

    /// Bytes that a pixel takes.
    pub const BYTES_A_PIXEL: usize =
        size_of::<[i64; 3]>() + 2 * size_of::<u128>() + size_of::<f32>() + size_of::<u128>() / 64;

    /// Takes in a replicate with its picture; one that is in already is not taken again.
    pub fn add(&mut self, row: Row, film: &Film) {
        let Err(place) = self.rows.binary_search_by_key(&row.number, |row| row.number) else {
            return;
        };
        self.rows.insert(place, row);
        let quanta = |value: f64| (value / self.quantum).round_ties_even() as i64;
        let columns = self.width.div_ceil(TILE) as usize;
        let mut tiles = vec![0_i64; self.columns.tile_squares.len()];
        for (pixel, color) in film.pixels().iter().enumerate() {
            let channels = [color.r, color.g, color.b].map(quanta);
            let luminance = quanta(color.luminance());
            for (sum, channel) in self.columns.sums[pixel].iter_mut().zip(channels) {
                *sum = sum.saturating_add(channel);
            }
            let squares = channels.map(square);
            let squares = squares[0].saturating_add(squares[1]).saturating_add(squares[2]);
            add(&mut self.columns.color_squares[pixel], squares);
            add(&mut self.columns.luminance_squares[pixel], square(luminance));
            self.columns.peaks[pixel] = self.columns.peaks[pixel].max(color.luminance() as f32);
            let (x, y) = (pixel % self.width as usize, pixel / self.width as usize);
            let tile = &mut tiles[y / TILE as usize * columns + x / TILE as usize];
            *tile = tile.saturating_add(luminance);
        }
        for (sum, tile) in self.columns.tile_squares.iter_mut().zip(tiles) {
            add(sum, square(tile));
        }
    }

    /// Takes in all replicates of another ledger of the same picture, none of which is in.
    pub fn merge(&mut self, other: &Self) {
        self.rows.extend_from_slice(&other.rows);
        self.rows.sort_by_key(|row| row.number);
        for (sum, other) in self.columns.sums.iter_mut().zip(&other.columns.sums) {
            sum.iter_mut().zip(other).for_each(|(sum, other)| *sum = sum.saturating_add(*other));
        }
        for (sums, others) in [
            (&mut self.columns.luminance_squares, &other.columns.luminance_squares),
            (&mut self.columns.color_squares, &other.columns.color_squares),
            (&mut self.columns.tile_squares, &other.columns.tile_squares),
        ] {
            sums.iter_mut().zip(others).for_each(|(sum, other)| add(sum, *other));
        }
        for (peak, other) in self.columns.peaks.iter_mut().zip(&other.columns.peaks) {
            *peak = peak.max(*other);
        }
    }

    /// The sum of all pictures, in film units of the scene.
    pub fn sum(&self) -> Film {
        let pixel = |[r, g, b]: &[i64; 3]| Rgb::new(*r as f64, *g as f64, *b as f64) * self.quantum;
        Film::of(self.width, self.height, self.columns.sums.iter().map(pixel).collect())
    }

    /// Mean luminance of the picture.
    pub fn mean(&self) -> Estimate {
        Estimate::of(&self.rows.iter().map(|row| row.mean).collect::<Vec<_>>())
    }

    /// `b`: what the chains have of it.
    pub fn normalization(&self) -> Estimate {
        Estimate::of(&self.rows.iter().map(|row| row.normalization).collect::<Vec<_>>())
    }

    /// Variance of the mean of a quantity with this sum and sum of squares, in quanta; NaN of a single
    /// replicate.
    fn variance(&self, sum: f64, squares: u128) -> f64 {
        let n = self.rows.len() as f64;
        ((squares as f64 - sum * sum / n) / (n - 1.0)).max(0.0) / n
    }

    fn luminance_sum(&self, pixel: usize) -> f64 {
        let [r, g, b] = self.columns.sums[pixel].map(|sum| sum as f64);
        Rgb::new(r, g, b).luminance()
    }

    /// Standard errors of the luminance of every pixel, in film units of the scene.
    pub fn standard_errors(&self) -> Vec<f32> {
        let error = |(pixel, squares): (usize, &u128)| {
            let variance = self.variance(self.luminance_sum(pixel), *squares);
            (variance.sqrt() * self.quantum) as f32
        };
        self.columns.luminance_squares.iter().enumerate().map(error).collect()
    }

    /// Whether each pixel's standard error can be trusted: there are enough replicates, and no single
    /// one makes most of their spread.
    pub fn is_reliable(&self) -> Vec<bool> {
        let n = self.rows.len() as f64;
        let reliable = |pixel: usize| {
            let mean = self.luminance_sum(pixel) / n;
            let squares =
                self.variance(mean * n, self.columns.luminance_squares[pixel]) * n * (n - 1.0);
            let peak = f64::from(self.columns.peaks[pixel]) / self.quantum - mean;
            self.count() >= ENOUGH && !(peak * peak > DOMINANT * squares)
        };
        (0..self.columns.sums.len()).map(reliable).collect()
    }

    /// Standard errors of the mean luminance of every tile of [`TILE`] pixels a side, row by row.
    pub fn tile_errors(&self) -> Vec<f32> {
        let columns = self.width.div_ceil(TILE) as usize;
        let mut sums = vec![(0.0, 0.0); self.columns.tile_squares.len()];
        for pixel in 0..self.columns.sums.len() {
            let (x, y) = (pixel % self.width as usize, pixel / self.width as usize);
            let (sum, area) = &mut sums[y / TILE as usize * columns + x / TILE as usize];
            *sum += self.luminance_sum(pixel);
            *area += 1.0;
        }
        let error = |((sum, area), squares): (&(f64, f64), &u128)| {
            (self.variance(*sum, *squares).sqrt() / area * self.quantum) as f32
        };
        sums.iter().zip(&self.columns.tile_squares).map(error).collect()
    }

    /// Estimated relative mean squared error of the picture, as [`common::relative_mse`] has it, and its
    /// root, which is the noise; NaN of a single replicate.
    pub fn noise(&self) -> f64 {
        let n = self.rows.len() as f64;
        let mean_square = |pixel: usize| {
            self.columns.sums[pixel].iter().map(|&sum| (sum as f64 / n).powi(2)).sum::<f64>()
        };
        let pixels = self.columns.sums.len();
        let total: f64 = (0..pixels).map(mean_square).sum();
        let floor = 0.01 * total / pixels as f64;
        let relative = |pixel: usize| {
            let signal = mean_square(pixel);
            let variance =
                (self.columns.color_squares[pixel] as f64 / n - signal).max(0.0) / (n - 1.0);
            // The square of a noisy pixel is too large by its variance.
            variance / ((signal - variance).max(0.0) + floor)
        };
        ((0..pixels).map(relative).sum::<f64>() / pixels as f64).sqrt()
    }
}

fn square(value: i64) -> u128 {
    u128::from(value.unsigned_abs()).pow(2)
}

fn add(sum: &mut u128, value: u128) {
    *sum = sum.saturating_add(value);
}
