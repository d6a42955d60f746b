//! Paths drawn by the processor.
//!
//! Where a program stands in for the graphics card, it spends most of its time on what lines do not
//! need: triangles, blocks of pixels, textures of half floats. Drawing them straight into memory takes
//! a small part of that. The newest paths come first, so that pixels that they fill cost older ones
//! next to nothing, and so that a picture that is not done yet shows the newest.
//!
//! Knows no graphics library: points and uniforms go in, pixels come out.

mod band;
mod mark;
mod shade;
#[cfg(test)]
mod tests;

use std::num::NonZero;
use std::thread;

use glam::Vec4;
use shaders::{FrameUniforms, LinePoint};

use band::{Band, Brush, TILE};
use mark::{Mark, Marker};
use shade::Shader;

/// What is drawn of the paths, one above the other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Layer {
    /// Lines behind surfaces.
    Hidden,
    /// Lines in front of them.
    Visible,
    /// Dots at vertices.
    Dots,
}

/// What becomes of paths that cross.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Crossing {
    /// They lie on each other, the newest on top.
    Stacked,
    /// They are weighed against each other, whatever their order.
    Weighed,
}

/// Bands a thread: paths seldom fill all of the picture alike.
const BANDS: usize = 4;

/// Paths that lie on each other.
#[derive(Debug, Default)]
pub struct Canvas {
    width: usize,
    /// Linear colours times their opacity, and what shines through. Where paths are weighed, the
    /// colours are sums of weighted ones.
    pixels: Vec<Vec4>,
    /// Pixels of each tile that something shines through, row by row of tiles.
    open: Vec<u16>,
    /// Sums of weights, where paths are weighed.
    weights: Vec<f32>,
    /// How near surfaces are, reversed: 0 at infinity. Empty where there are none.
    depths: Vec<f32>,
    /// Marks of the points at hand, a list a thread.
    marks: Vec<Vec<Mark>>,
    threads: usize,
}

impl Canvas {
    /// Begins a picture of `width` and `height` pixels, with how near surfaces are at each of them, or
    /// nothing where there are none.
    pub fn begin(&mut self, [width, height]: [u32; 2], crossing: Crossing, depths: Vec<f32>) {
        self.threads = thread::available_parallelism().map_or(1, NonZero::get);
        self.width = width as usize;
        let len = self.width * height as usize;
        self.pixels.clear();
        self.pixels.resize(len, Vec4::W);
        self.open = open_tiles([self.width, height as usize]);
        self.weights.clear();
        self.weights.resize(if crossing == Crossing::Weighed { len } else { 0 }, 0.0);
        self.depths = depths;
    }

    /// Draws one layer of some paths under what is there. The points must begin and end with a path.
    pub fn draw(
        &mut self,
        points: &[LinePoint],
        frame: &FrameUniforms,
        layer: Layer,
        crossing: Crossing,
    ) {
        if self.pixels.is_empty() || points.is_empty() {
            return;
        }
        let shader = Shader { frame };
        self.mark(points, Marker::new(shader, layer));
        self.fill(Brush { shader, layer, crossing });
    }

    fn mark(&mut self, points: &[LinePoint], marker: Marker<'_>) {
        let share = points.len().div_ceil(self.threads);
        self.marks.resize_with(self.threads, Vec::new);
        thread::scope(|scope| {
            for (i, marks) in self.marks.iter_mut().enumerate() {
                // One more point, at which the last segment ends.
                let begin = (i * share).min(points.len());
                let part = points.get(begin..).unwrap_or_default();
                scope.spawn(move || {
                    marks.clear();
                    marker.mark(&part[..part.len().min(share + 1)], share, marks);
                });
            }
        });
    }

    fn fill(&mut self, brush: Brush<'_>) {
        let Self { width, pixels, open, weights, depths, marks, threads } = self;
        let tiles = width.div_ceil(TILE);
        let tile_rows = (open.len() / tiles).div_ceil(*threads * BANDS);
        let rows = tile_rows * TILE;
        let size = rows * *width;
        let bands = pixels.chunks_mut(size).enumerate();
        let mut open = open.chunks_mut(tile_rows * tiles);
        let mut weights = weights.chunks_mut(size);
        let mut depths = depths.chunks(size);
        let mut shares: Vec<Vec<Band<'_>>> = Vec::new();
        shares.resize_with(*threads, Vec::new);
        for (i, pixels) in bands {
            shares[i % *threads].push(Band {
                top: i * rows,
                width: *width,
                pixels,
                open: open.next().unwrap_or_default(),
                weights: weights.next().unwrap_or_default(),
                depths: depths.next().unwrap_or_default(),
            });
        }
        let lists = &*marks;
        let draw = |share: Vec<Band<'_>>| {
            for mut band in share {
                for marks in lists.iter().rev() {
                    brush.draw(marks, &mut band);
                }
            }
        };
        thread::scope(|scope| {
            for share in shares {
                let draw = &draw;
                scope.spawn(move || draw(share));
            }
        });
    }

    /// Colours times their opacity, and their opacity, row by row from the top.
    pub fn finished(&self) -> Vec<Vec4> {
        let opaque = |pixel: &Vec4| pixel.truncate().extend(1.0 - pixel.w);
        if self.weights.is_empty() {
            return self.pixels.iter().map(opaque).collect();
        }
        // [McGuire and Bavoil 2013, equation 6].
        let pixels = self.pixels.iter().zip(&self.weights);
        let blended = |(pixel, weight): (&Vec4, &f32)| {
            let opacity = 1.0 - pixel.w;
            (pixel.truncate() * (opacity / weight.max(1e-5))).extend(opacity)
        };
        pixels.map(blended).collect()
    }
}

/// The pixels of each tile of a canvas.
fn open_tiles([width, height]: [usize; 2]) -> Vec<u16> {
    let sides = |size: usize| (0..size).step_by(TILE).map(move |i| TILE.min(size - i));
    sides(height).flat_map(|h| sides(width).map(move |w| (w * h) as u16)).collect()
}
