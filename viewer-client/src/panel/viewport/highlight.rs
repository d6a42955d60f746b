//! The selected path, drawn over everything: its ends, its direction and its vertices.

use egui::{Align2, Color32, FontId, Painter, Pos2, Stroke, vec2};
use glam::Vec3;

use super::ground::veil;
use super::project::Projector;
use crate::panel::hover::{self, Pointed};
use crate::source::selection::Selection;
use crate::value::theme;
use crate::world::World;

/// Width of the line and of the rim round it, in points.
const WIDTH: f32 = 3.0;
const RIM: f32 = 2.0;
/// More vertices than this are not numbered: the numbers would cover the path.
const MOST_NUMBERS: usize = 24;

/// Draws the selected path.
pub(super) fn paint(painter: &Painter, projector: &Projector, world: &World<'_>, ink: Color32) {
    let Some(selection) = world.selection else { return };
    let rim = if world.settings.window.is_dark() { Color32::BLACK } else { Color32::WHITE };
    let points: Vec<Vec3> = selection.vertices.iter().map(|v| v.position.into()).collect();
    let color = theme::SELECTED;
    // First all rims, or they would cut through crossing edges.
    for (stroke, arrow) in [
        (Stroke::new(WIDTH + 2.0 * RIM, rim.gamma_multiply(0.7)), false),
        (Stroke::new(WIDTH, color), true),
    ] {
        for pair in points.windows(2) {
            if let [a, b] = *pair
                && let Some(line) = projector.segment(a, b)
            {
                painter.line_segment(line, stroke);
                if arrow {
                    arrow_head(painter, line, color);
                }
            }
        }
    }
    let pointed = hover::pointed(painter.ctx());
    if let Some(Pointed::Edge(i)) = pointed
        && let (Some(a), Some(b)) = (points.get(i), points.get(i + 1))
        && let Some(line) = projector.segment(*a, *b)
    {
        painter.extend(egui::Shape::dashed_line(&line, Stroke::new(WIDTH + 2.0, ink), 6.0, 5.0));
    }
    for (i, point) in points.iter().enumerate() {
        if let Some(place) = projector.point(*point) {
            if pointed == Some(Pointed::Vertex(i)) {
                painter.circle_stroke(place, 15.0, Stroke::new(2.5, ink));
            }
            vertex(painter, place, selection, i, ink);
        }
    }
}

fn vertex(painter: &Painter, place: Pos2, selection: &Selection, i: usize, ink: Color32) {
    let last = selection.vertices.len().saturating_sub(1);
    let color = match i {
        0 => theme::LIGHT_END,
        i if i == last => theme::CAMERA_END,
        _ => theme::SELECTED,
    };
    let chosen = selection.vertex == Some(i);
    let radius = if chosen { 7.0 } else { 4.5 };
    painter.circle(place, radius, color, Stroke::new(1.5, Color32::from_black_alpha(200)));
    if chosen {
        painter.circle_stroke(place, radius + 4.0, Stroke::new(2.0, ink));
    }
    if let Some(vertex) = selection.vertices.get(i).filter(|_| last < MOST_NUMBERS) {
        let text = format!("x{i} {}", vertex.kind.letter());
        let galley = painter.layout_no_wrap(text, FontId::proportional(11.0), ink);
        let rect = Align2::LEFT_BOTTOM.anchor_size(place + vec2(9.0, -7.0), galley.size());
        veil(painter, rect, ink);
        painter.galley(rect.min, galley, ink);
    }
}

/// A head in the middle of an edge that points towards the camera end.
pub(super) fn arrow_head(painter: &Painter, [a, b]: [Pos2; 2], color: Color32) {
    let along = b - a;
    if along.length() < 34.0 {
        return;
    }
    let forward = along.normalized();
    let side = vec2(-forward.y, forward.x);
    let tip = a + 0.55 * along;
    let back = tip - 11.0 * forward;
    let corners = vec![tip, back + 5.5 * side, back - 5.5 * side];
    painter.add(egui::Shape::convex_polygon(corners, color, Stroke::NONE));
}
