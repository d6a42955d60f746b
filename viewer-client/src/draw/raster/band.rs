//! Rows of a canvas that one thread draws.

use std::ops::Range;

use glam::{Vec2, Vec4};

use super::mark::{End, Mark};
use super::shade::Shader;
use super::{Crossing, Layer};

/// Where less than this shines through, nothing further down is worth drawing: two steps of dark
/// grey at most.
const FAINTEST: f32 = 0.0006;

/// Side of a tile in pixels: tiles that nothing shines through any more are passed over as a whole.
pub(super) const TILE: usize = 16;

/// Some rows of a canvas, from a row of tiles on. What is drawn comes to lie under what is there.
#[derive(Debug)]
pub(super) struct Band<'a> {
    /// The number of its first row.
    pub(super) top: usize,
    pub(super) width: usize,
    /// Colours times their opacity, and what shines through. Where paths are weighed, the colours
    /// are sums of weighted ones.
    pub(super) pixels: &'a mut [Vec4],
    /// Pixels of each tile that something shines through.
    pub(super) open: &'a mut [u16],
    /// Sums of weights, where paths are weighed against each other.
    pub(super) weights: &'a mut [f32],
    /// How near surfaces are, if there are any.
    pub(super) depths: &'a [f32],
}

impl Band<'_> {
    fn rows(&self) -> Range<usize> {
        self.top..self.top + self.pixels.len() / self.width
    }

    /// Whether nothing shines through any of these tiles, which lie `step` from each other.
    fn is_shut(&self, first: usize, tiles: Range<usize>, step: usize) -> bool {
        tiles.into_iter().all(|i| self.open.get(first + i * step).is_none_or(|open| *open == 0))
    }

    fn shut(&mut self, place: usize) {
        let tile =
            place / self.width / TILE * self.width.div_ceil(TILE) + place % self.width / TILE;
        if let Some(open) = self.open.get_mut(tile) {
            *open = open.saturating_sub(1);
        }
    }
}

/// How marks are drawn.
#[derive(Clone, Copy, Debug)]
pub(super) struct Brush<'a> {
    pub(super) shader: Shader<'a>,
    pub(super) layer: Layer,
    pub(super) crossing: Crossing,
}

/// A point of a stroke.
#[derive(Clone, Copy, Debug)]
struct Ink {
    /// Colour times opacity, and less opacity.
    color: Vec4,
    depth: f32,
    /// What it weighs, where paths are weighed.
    weight: f32,
}

impl Brush<'_> {
    /// The marks in reverse order: each under the ones before.
    pub(super) fn draw(self, marks: &[Mark], band: &mut Band<'_>) {
        if band.open.iter().all(|open| *open == 0) {
            return;
        }
        let Range { start, end } = band.rows();
        let (top, bottom) = (start as f32, end as f32);
        for mark in marks.iter().rev() {
            // Half of the diagonal of a pixel, beyond half of the width, is as far as ink gets.
            let reach = mark.half_width + 1.0;
            let (a, b) = (mark.a.pixel.y, mark.b.pixel.y);
            if a.max(b) + reach < top || a.min(b) - reach > bottom {
                continue;
            }
            match self.layer {
                Layer::Dots => self.dot(mark, band),
                Layer::Visible | Layer::Hidden => self.stroke(mark, band),
            }
        }
    }

    /// A line, column by column where it is rather level, and row by row where it is rather steep.
    fn stroke(self, mark: &Mark, band: &mut Band<'_>) {
        let Some(run) = Run::new(mark, band) else { return };
        let inks = Inks::new(self, mark, run.length);
        let mut i = run.columns.start;
        while i < run.columns.end {
            let block = (i - run.origin[0]) / TILE;
            let end = (run.origin[0] + (block + 1) * TILE).min(run.columns.end);
            let (from, to) = (run.across(i), run.across(end - 1));
            let [low, high] = [from.start.min(to.start), from.end.max(to.end)]
                .map(|j| j.saturating_sub(run.origin[1]));
            let tiles = low / TILE..high.div_ceil(TILE);
            if !band.is_shut(block * run.tile_steps[0], tiles, run.tile_steps[1]) {
                for i in i..end {
                    self.column(band, &run, i, &inks);
                }
            }
            i = end;
        }
    }

    fn column(self, band: &mut Band<'_>, run: &Run, i: usize, inks: &Inks<'_>) {
        let middle = run.middle(i);
        let along = run.along(i);
        let ink = inks.at(along);
        let inner = run.is_inner(along);
        // What is left after the point is small, and as exact for any row as for the first.
        let whole = middle as isize;
        let rest = (middle - whole as f64) as f32 - 0.5;
        for j in run.across(i) {
            let off = j.wrapping_sub_signed(whole).cast_signed() as f32 - rest;
            let place = along + off * run.minor;
            if inner || (place >= -0.5 && place <= run.length + 0.5) {
                let coverage = (run.reach - off.abs() * run.major).min(1.0);
                self.lay(band, run.place(i, j), ink, coverage);
            }
        }
    }

    fn dot(self, mark: &Mark, band: &mut Band<'_>) {
        let centre = mark.a.pixel;
        let [x, y] = [centre.x, centre.y].map(f64::from);
        let reach = mark.half_width + 0.5;
        let ink = Inks::new(self, mark, 0.0).at(0.0);
        for row in pixels_between([y, y], reach, band.rows()) {
            for column in pixels_between([x, x], reach, 0..band.width) {
                let pixel = Vec2::new(column as f32 + 0.5, row as f32 + 0.5);
                let coverage = (reach - centre.distance(pixel)).min(1.0);
                self.lay(band, (row - band.top) * band.width + column, ink, coverage);
            }
        }
    }

    /// Lays ink under the pixel at `place`, as far as it covers it.
    #[inline]
    fn lay(self, band: &mut Band<'_>, place: usize, ink: Ink, coverage: f32) {
        let Some(pixel) = band.pixels.get_mut(place).filter(|_| coverage > 0.0) else { return };
        // Depth is reversed.
        let hidden = band.depths.get(place).is_some_and(|surface| ink.depth < *surface);
        if hidden != (self.layer == Layer::Hidden) {
            return;
        }
        match self.crossing {
            Crossing::Stacked if pixel.w < FAINTEST => {}
            Crossing::Stacked => {
                *pixel += ink.color * (coverage * pixel.w);
                if pixel.w < FAINTEST {
                    band.shut(place);
                }
            }
            Crossing::Weighed => {
                let Some(weight) = band.weights.get_mut(place) else { return };
                let color = ink.color * coverage;
                let opacity = -color.w;
                *weight += opacity * ink.weight;
                *pixel = (pixel.truncate() + color.truncate() * ink.weight)
                    .extend(pixel.w * (1.0 - opacity));
            }
        }
    }
}

/// Pixels of `range` whose middles lie no further than `reach` outside two places.
fn pixels_between([low, high]: [f64; 2], reach: f32, range: Range<usize>) -> Range<usize> {
    let reach = f64::from(reach);
    // Casts saturate, and cut off what follows the point.
    let (first, end) = ((low - reach + 0.5) as usize, (high + reach + 0.5) as usize);
    first.max(range.start)..end.min(range.end)
}

/// Which pixels of a band a stroke covers: in columns where it is rather level, in rows where it is
/// rather steep. Coordinates are turned so that `x` and `i` count along its major axis.
///
/// Places along the stroke are f64, since its ends may lie far outside; and they count from the upper
/// left corner of the picture, so that no band draws otherwise than another would.
#[derive(Clone, Debug)]
struct Run {
    /// What `i` runs through.
    columns: Range<usize>,
    /// What `j` may run through.
    rows: Range<usize>,
    /// How far along the stroke, and on which `y`, it passes the middle of column 0; and how these
    /// change from column to column.
    along: [f64; 2],
    middle: [f64; 2],
    /// Components of its direction: the major one's size, and the minor one.
    major: f32,
    minor: f32,
    length: f32,
    /// Pixels from its middle to where it covers nothing any more; and the same along `y`.
    reach: f32,
    spread: f32,
    /// The first `i` and `j` of the band, and from a pixel to the next along either.
    origin: [usize; 2],
    steps: [usize; 2],
    /// From a tile to the next along either.
    tile_steps: [usize; 2],
}

impl Run {
    fn new(mark: &Mark, band: &Band<'_>) -> Option<Self> {
        let (start, end) = (mark.a.pixel, mark.b.pixel);
        let length = start.distance(end);
        let direction = if length > 1e-4 { (end - start) / length } else { Vec2::X };
        let steep = direction.y.abs() > direction.x.abs();
        let turned = |v: Vec2| if steep { Vec2::new(v.y, v.x) } else { v };
        let (start, end, direction) = (turned(start), turned(end), turned(direction));
        let (width, tiles) = (band.width, band.width.div_ceil(TILE));
        let ([range_i, rows], steps, tile_steps) = if steep {
            ([band.rows(), 0..width], [width, 1], [tiles, 1])
        } else {
            ([0..width, band.rows()], [1, width], [1, tiles])
        };
        let reach = mark.half_width + 0.5;
        let (major, minor) = (direction.x.abs(), direction.y);
        let slope = f64::from(direction.y) / f64::from(direction.x);
        let spread = reach / major;
        let [x, y] = [start.x, start.y].map(f64::from);
        // The ends are square: half a pixel beyond, and as far as their corners lie outside.
        let overhang = 0.5 * major + reach * minor.abs();
        let mut ends = [start.x.min(end.x), start.x.max(end.x)].map(f64::from);
        if slope.abs() > 1e-6 {
            // Where it crosses the band, and a little more.
            let [c, d] =
                [rows.start as f64 - f64::from(spread), rows.end as f64 + f64::from(spread)]
                    .map(|j| x + (j - y) / slope);
            ends = [ends[0].max(c.min(d)), ends[1].min(c.max(d))];
        }
        let columns = pixels_between(ends, overhang, range_i.clone());
        let pace = f64::from(direction.x).recip();
        (!columns.is_empty()).then_some(Self {
            along: [(0.5 - x) * pace, pace],
            middle: [y + (0.5 - x) * slope, slope],
            columns,
            major,
            minor,
            length,
            reach,
            spread,
            origin: [range_i.start, rows.start],
            rows,
            steps,
            tile_steps,
        })
    }

    fn middle(&self, i: usize) -> f64 {
        self.middle[0] + self.middle[1] * i as f64
    }

    fn along(&self, i: usize) -> f32 {
        (self.along[0] + self.along[1] * i as f64) as f32
    }

    /// What `j` runs through in column `i`.
    fn across(&self, i: usize) -> Range<usize> {
        let middle = self.middle(i);
        pixels_between([middle, middle], self.spread, self.rows.clone())
    }

    /// The place of a pixel in its band.
    fn place(&self, i: usize, j: usize) -> usize {
        (i - self.origin[0]) * self.steps[0] + (j - self.origin[1]) * self.steps[1]
    }

    /// Whether no pixel of a column there lies beyond the ends.
    fn is_inner(&self, along: f32) -> bool {
        let margin = self.spread * self.minor.abs();
        along >= margin && along <= self.length - margin
    }
}

/// The ink along a stroke.
#[derive(Clone, Copy, Debug)]
struct Inks<'a> {
    brush: Brush<'a>,
    a: End,
    b: End,
    length: f32,
    /// The ink is the same everywhere but for its depth.
    even: bool,
}

impl<'a> Inks<'a> {
    fn new(brush: Brush<'a>, mark: &Mark, length: f32) -> Self {
        // Glow takes less away of what lies behind; weighed paths have none.
        let glow = match brush.crossing {
            Crossing::Stacked => brush.shader.frame.glow,
            Crossing::Weighed => 0.0,
        };
        let inked = |end: End| End {
            color: end.color.truncate().extend(-end.color.w * (1.0 - glow)),
            ..end
        };
        let (a, b) = (inked(mark.a), inked(mark.b));
        let even = a.color == b.color && brush.crossing == Crossing::Stacked;
        Self { brush, a, b, length, even }
    }

    /// The ink so many pixels along the stroke.
    fn at(&self, along: f32) -> Ink {
        let Self { a, b, .. } = *self;
        // A stroke is drawn half a pixel beyond its ends, and has their colours there.
        let s = ((along + 0.5) / (self.length + 1.0)).clamp(0.0, 1.0);
        let depth = a.depth + (b.depth - a.depth) * s;
        if self.even {
            return Ink { color: a.color, depth, weight: 1.0 };
        }
        // What is linear in space is not so on the screen.
        let divisor = (1.0 - s) * b.distance + s * a.distance;
        let t = s * a.distance / divisor;
        let weight = match self.brush.crossing {
            Crossing::Stacked => 1.0,
            Crossing::Weighed => self.brush.shader.weight(a.distance * b.distance / divisor),
        };
        Ink { color: a.color.lerp(b.color, t), depth, weight }
    }
}
