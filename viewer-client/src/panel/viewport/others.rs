//! Where the other viewers look from, as far as they show it.

use common::Attendee;
use egui::{Align2, Color32, FontId, Painter, Shape, Stroke, vec2};
use glam::Vec3;

use super::project::Projector;
use crate::value::theme;
use crate::world::World;

/// Draws every other viewer's eye with its name, and what it looks at.
pub(super) fn paint(painter: &Painter, projector: &Projector, world: &World<'_>, ink: Color32) {
    for viewer in world.others() {
        one(painter, projector, viewer, ink);
    }
}

fn one(painter: &Painter, projector: &Projector, viewer: &Attendee, ink: Color32) {
    let Some(gaze) = viewer.appearance.gaze else { return };
    let (eye, target) = (Vec3::from(gaze.eye), Vec3::from(gaze.target));
    if let Some(line) = projector.segment(eye, target) {
        let stroke = Stroke::new(1.0, theme::ACCENT.gamma_multiply(0.6));
        painter.extend(Shape::dashed_line(&line, stroke, 4.0, 6.0));
    }
    if let Some(place) = projector.point(eye) {
        painter.circle(place, 6.0, theme::ACCENT, Stroke::new(1.5, ink));
        let font = FontId::proportional(12.0);
        painter.text(place + vec2(10.0, 0.0), Align2::LEFT_CENTER, &viewer.author.name, font, ink);
    }
}
