//! Points of the scene on the screen.

use egui::{Pos2, Rect, vec2};
use glam::Vec3;

use crate::camera::{Lens, NEAR};
use crate::value::Pointer;

/// Where points of the scene are seen in the viewport.
#[derive(Clone, Copy, Debug)]
pub(super) struct Projector {
    pub(super) lens: Lens,
    rect: Rect,
}

impl Projector {
    pub(super) fn new(lens: Lens, rect: Rect) -> Self {
        Self { lens, rect }
    }

    /// Right, up and depth of a point, seen from the eye.
    fn view(&self, point: Vec3) -> Vec3 {
        let d = point - self.lens.eye;
        Vec3::new(d.dot(self.lens.right), d.dot(self.lens.up), d.dot(self.lens.forward))
    }

    /// Screen points a unit of tangent.
    pub(super) fn scale(&self) -> f32 {
        0.5 * self.rect.height() / self.lens.tan_y
    }

    fn place(&self, view: Vec3) -> Pos2 {
        self.rect.center() + self.scale() * vec2(view.x / view.z, -view.y / view.z)
    }

    /// Where a point is seen, unless it lies behind the eye.
    pub(super) fn point(&self, point: Vec3) -> Option<Pos2> {
        let view = self.view(point);
        (view.z >= NEAR).then(|| self.place(view))
    }

    /// The part of a segment that lies before the eye.
    pub(super) fn segment(&self, a: Vec3, b: Vec3) -> Option<[Pos2; 2]> {
        let (mut p, mut q) = (self.view(a), self.view(b));
        if p.z < NEAR && q.z < NEAR {
            return None;
        }
        if p.z < NEAR {
            p = p.lerp(q, (NEAR - p.z) / (q.z - p.z));
        } else if q.z < NEAR {
            q = q.lerp(p, (NEAR - q.z) / (p.z - q.z));
        }
        Some([self.place(p), self.place(q)])
    }

    /// What the user points at, with a tolerance in screen points.
    pub(super) fn pointer(&self, at: Pos2, tolerance: f32) -> Pointer {
        let offset = (at - self.rect.center()) / self.scale();
        Pointer { at: [offset.x, -offset.y], reach: tolerance / self.scale() }
    }
}
