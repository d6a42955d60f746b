//! Film points on the image: of the selected path, of what is pointed at, and of the explorer.

use common::FocusOutcome;
use egui::{Color32, Painter, Pos2, Shape, Stroke, vec2};

use crate::panel::hover::{self, Pointed};
use crate::value::theme;
use crate::world::World;

/// Half the size of a cross, in points.
const ARM: f32 = 7.0;

/// Draws all marks; `place` tells where a film point is seen.
pub(super) fn paint(painter: &Painter, world: &World<'_>, place: impl Fn([f32; 2]) -> Pos2) {
    explorer(painter, world, &place);
    if let Some(selection) = world.selection {
        cross(painter, place(selection.header.film), theme::SELECTED, ARM);
    }
    let pointed = match hover::pointed(painter.ctx()) {
        Some(Pointed::Path(film)) => Some(film),
        Some(Pointed::Stay(rank)) => stay(world, rank),
        _ => None,
    };
    if let Some(film) = pointed {
        ring(painter, place(film), theme::SELECTED);
    }
}

fn stay(world: &World<'_>, rank: usize) -> Option<[f32; 2]> {
    let batch = world.diagnostics()?.longest.as_ref()?;
    batch.headers().nth(rank).map(|header| header.film)
}

/// From the explorer's path to its proposal: a dot, and an arrow to a ring.
fn explorer(painter: &Painter, world: &World<'_>, place: &impl Fn([f32; 2]) -> Pos2) {
    let Some(moment) = hover::moment(painter.ctx(), world) else {
        if let Some(path) = world.status.steering.focus.current() {
            dot(painter, place(path.header.film));
        }
        return;
    };
    let from = place(moment.before.header.film);
    if !matches!(moment.step.outcome, FocusOutcome::Failed(_)) {
        let to = place(moment.step.film);
        for (width, color) in [(3.5, Color32::from_black_alpha(170)), (1.5, theme::PROPOSED)] {
            painter.line_segment([from, to], Stroke::new(width, color));
        }
        ring(painter, to, theme::PROPOSED);
    }
    dot(painter, from);
}

fn dot(painter: &Painter, place: Pos2) {
    painter.circle(place, 3.5, theme::EXPLORED, Stroke::new(1.5, Color32::from_black_alpha(200)));
}

fn ring(painter: &Painter, place: Pos2, color: Color32) {
    painter.circle_stroke(place, 5.5, Stroke::new(4.0, Color32::from_black_alpha(170)));
    painter.circle_stroke(place, 5.5, Stroke::new(2.0, color));
}

fn cross(painter: &Painter, place: Pos2, color: Color32, arm: f32) {
    let arms = [vec2(arm, 0.0), vec2(0.0, arm)];
    for (width, color) in [(4.0, Color32::from_black_alpha(170)), (1.8, color)] {
        // The point itself stays free.
        for way in arms.into_iter().flat_map(|arm| [arm, -arm]) {
            let line = [place + 0.35 * way, place + way];
            painter.add(Shape::line_segment(line, Stroke::new(width, color)));
        }
    }
}
