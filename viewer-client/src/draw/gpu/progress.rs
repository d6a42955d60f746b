//! Pictures that take longer than a frame: what is drawn when.
//!
//! A picture is a list of steps, one a page of paths and layer, in a fixed order, so that it comes
//! out the same however many frames it takes.

use std::time::{Duration, Instant};

use shaders::FrameUniforms;

use super::pages::{PageRange, Pages};
pub use crate::draw::raster::Crossing;
pub(super) use crate::draw::raster::Layer;

/// What to draw.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// The eye and every number of the shaders.
    pub uniforms: FrameUniforms,
    /// The paths, newest page first.
    pub paths: Vec<PageRange>,
    /// Surfaces are drawn at all.
    pub surfaces: bool,
    /// The lines of paths are drawn, rather than their dots alone.
    pub lines: bool,
    /// What becomes of paths that cross.
    pub crossing: Crossing,
}

impl Picture {
    /// True when both show the same thing from the same place, whatever paths have come since.
    pub(super) fn same_view(&self, other: &Self) -> bool {
        let view = |picture: &Self| {
            let mut uniforms = picture.uniforms;
            // The newest ordinal and the range of radiances change with every path.
            uniforms.newest = 0;
            uniforms.darkest = 0.0;
            uniforms.inverse_range = 0.0;
            uniforms
        };
        self.size == other.size
            && self.surfaces == other.surfaces
            && self.lines == other.lines
            && self.crossing == other.crossing
            && view(self) == view(other)
    }

    /// The layers that are worth drawing, in their order.
    pub(super) fn layers(&self) -> impl Iterator<Item = Layer> {
        let uniforms = &self.uniforms;
        let hidden = self.lines && self.surfaces && uniforms.hidden_opacity > 0.0;
        let dots = uniforms.start_radius > 0.0 || uniforms.dot_radius > 0.0;
        [(hidden, Layer::Hidden), (self.lines, Layer::Visible), (dots, Layer::Dots)]
            .into_iter()
            .filter_map(|(wanted, layer)| wanted.then_some(layer))
    }

    /// Points that drawing it takes in, each as often as there are layers.
    pub(super) fn cost(&self, pages: &Pages) -> usize {
        let points: usize = self.paths.iter().map(|range| pages.points_of(*range)).sum();
        points * self.layers().count()
    }

    /// The same picture with no more than its newest `points` points or so, for a glance.
    pub(super) fn glance(&self, pages: &Pages, points: usize) -> Self {
        let mut room = points / self.layers().count().max(1);
        let mut paths = Vec::new();
        for range in &self.paths {
            let of_page = pages.points_of(*range);
            if of_page > room && !paths.is_empty() {
                break;
            }
            room = room.saturating_sub(of_page);
            paths.push(*range);
        }
        Self { paths, ..self.clone() }
    }

    /// Everything to draw of the paths: oldest first, because newer paths lie on top.
    pub(super) fn steps(&self) -> Vec<(Layer, PageRange)> {
        let of_layer = |layer| self.paths.iter().rev().map(move |range| (layer, *range));
        self.layers().flat_map(of_layer).collect()
    }
}

/// How many points a frame may draw, from how long the last frames took.
#[derive(Clone, Copy, Debug)]
pub(super) struct Allowance {
    points: usize,
    last: Option<Instant>,
}

/// Frames that draw a part of a picture should take about this long.
const GOAL: Duration = Duration::from_millis(80);
/// A pause longer than this says nothing of the graphics card.
const PAUSE: Duration = Duration::from_secs(3);

impl Allowance {
    /// The smallest allowance: a page of paths.
    const LEAST: usize = 16 * 1024;
    const MOST: usize = 16 << 20;

    pub(super) fn new(points: usize) -> Self {
        Self { points, last: None }
    }

    /// Points that this frame may draw.
    pub(super) fn points(self) -> usize {
        self.points
    }

    /// A frame begins that draws something.
    pub(super) fn tick(&mut self, now: Instant) {
        let took = self.last.replace(now).map(|last| now.saturating_duration_since(last));
        if let Some(took) = took.filter(|took| *took < PAUSE) {
            let wanted = if took < GOAL / 2 {
                self.points * 2
            } else if took > GOAL * 2 {
                self.points / 2
            } else {
                self.points
            };
            self.points = wanted.clamp(Self::LEAST, Self::MOST);
        }
    }

    /// The next frame will say nothing of how long parts take.
    pub(super) fn rest(&mut self) {
        self.last = None;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_allowance_follows_the_graphics_card() {
        let start = Instant::now();
        let mut allowance = Allowance::new(100_000);
        let mut time = start;
        for took in [10, 10, 10] {
            time += Duration::from_millis(took);
            allowance.tick(time);
        }
        assert_eq!(allowance.points(), 400_000, "two fast frames after the first");
        for _ in 0..9 {
            time += Duration::from_millis(900);
            allowance.tick(time);
        }
        assert_eq!(allowance.points(), Allowance::LEAST, "slow frames draw little");
        allowance.rest();
        allowance.tick(time + Duration::from_millis(1));
        assert_eq!(allowance.points(), Allowance::LEAST, "a rest tells nothing");
    }
}
