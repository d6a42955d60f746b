//! What is drawn of a path: strokes along its edges and dots at its vertices, in pixels.

use glam::{Vec2, Vec4, Vec4Swizzles as _};
use shaders::LinePoint;

use super::Layer;
use super::shade::{Shaded, Shader};

/// One end of a stroke.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct End {
    /// Pixels from the upper left corner.
    pub(super) pixel: Vec2,
    /// Reversed: 1 at the near plane, 0 at infinity.
    pub(super) depth: f32,
    /// Distance along the view.
    pub(super) distance: f32,
    /// Colour times opacity, and opacity.
    pub(super) color: Vec4,
}

/// A line of constant width in pixels from `a` to `b`, or a dot at both.
#[derive(Clone, Copy, Debug)]
pub(super) struct Mark {
    pub(super) a: End,
    pub(super) b: End,
    /// Half the width of a line, the radius of a dot.
    pub(super) half_width: f32,
}

/// Makes the marks of one layer.
#[derive(Clone, Copy, Debug)]
pub(super) struct Marker<'a> {
    shader: Shader<'a>,
    layer: Layer,
    half_size: Vec2,
}

impl<'a> Marker<'a> {
    pub(super) fn new(shader: Shader<'a>, layer: Layer) -> Self {
        Self { shader, layer, half_size: 0.5 * shader.frame.size }
    }

    /// Makes the marks of those `points` that begin in the first `count`, in their order.
    pub(super) fn mark(self, points: &[LinePoint], count: usize, marks: &mut Vec<Mark>) {
        let mut shaded = points.iter().map(|point| self.shader.shade(point));
        let Some(mut here) = shaded.next() else { return };
        for _ in 0..count {
            let next = shaded.next();
            let mark = match self.layer {
                Layer::Dots => self.dot(here, next),
                Layer::Visible | Layer::Hidden => next.and_then(|next| self.line(here, next)),
            };
            marks.extend(mark);
            let Some(next) = next else { return };
            here = next;
        }
    }

    fn line(self, start: Shaded, end: Shaded) -> Option<Mark> {
        let frame = self.shader.frame;
        if start.is_last() || start.side < 0.0 && end.side < 0.0 {
            return None;
        }
        let (mut a, mut b) = (start.clip, end.clip);
        let (mut color_a, mut color_b) = (start.color, end.color);
        if start.side < 0.0 {
            a = a.lerp(b, start.side / (start.side - end.side));
        } else if end.side < 0.0 {
            b = b.lerp(a, end.side / (end.side - start.side));
        }
        if end.is_last() {
            color_a.w *= frame.lens_opacity + (1.0 - frame.lens_opacity) * 0.22;
            color_b.w *= frame.lens_opacity;
        }
        color_a.w *= self.shader.cue(a.w);
        color_b.w *= self.shader.cue(b.w);
        let near = frame.near;
        if a.w < near && b.w < near {
            return None;
        }
        if a.w < near {
            let t = (near - a.w) / (b.w - a.w);
            (a, color_a) = (a.lerp(b, t), color_a.lerp(color_b, t));
        } else if b.w < near {
            let t = (near - b.w) / (a.w - b.w);
            (b, color_b) = (b.lerp(a, t), color_b.lerp(color_a, t));
        }
        let mut opacity = frame.line_width.min(1.0);
        if self.layer == Layer::Hidden {
            opacity *= frame.hidden_opacity;
        }
        self.seen(Mark {
            a: self.end(a, color_a, opacity),
            b: self.end(b, color_b, opacity),
            half_width: 0.5 * frame.line_width.max(1.0),
        })
    }

    fn dot(self, point: Shaded, next: Option<Shaded>) -> Option<Mark> {
        let frame = self.shader.frame;
        let lens_follows = next.is_some_and(Shaded::is_last);
        let wanted = frame.ends_only == 0 || point.starts() || lens_follows;
        let radius = if point.starts() { frame.start_radius } else { frame.dot_radius };
        let skipped = point.is_last() || !wanted || radius <= 0.0;
        if skipped || point.side < 0.0 || point.clip.w < frame.near {
            return None;
        }
        let mut color = point.color;
        if lens_follows {
            color = self.shader.end_of(color);
        }
        color.w = (color.w * 1.6 * self.shader.cue(point.clip.w)).min(1.0);
        let end = self.end(point.clip, color, 1.0);
        self.seen(Mark { a: end, b: end, half_width: radius })
    }

    fn end(self, clip: Vec4, color: Vec4, opacity: f32) -> End {
        let alpha = color.w * opacity;
        let place = clip.xy() / clip.w;
        End {
            pixel: (Vec2::ONE + Vec2::new(place.x, -place.y)) * self.half_size,
            depth: clip.z / clip.w,
            distance: clip.w,
            color: (color.truncate() * alpha).extend(alpha),
        }
    }

    /// The mark, if any of it may lie in the picture.
    fn seen(self, mark: Mark) -> Option<Mark> {
        let [low, high] = [mark.a.pixel.min(mark.b.pixel), mark.a.pixel.max(mark.b.pixel)];
        let reach = Vec2::splat(mark.half_width + 1.0);
        let is_in = (high + reach).cmpgt(Vec2::ZERO).all()
            && (low - reach).cmplt(2.0 * self.half_size).all();
        let finite = low.is_finite() && high.is_finite();
        (finite && is_in && mark.a.color.w + mark.b.color.w > 0.0).then_some(mark)
    }
}
