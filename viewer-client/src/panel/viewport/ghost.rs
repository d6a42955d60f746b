//! The explorer's step, drawn over the scene.
//!
//! It shows what stays, what is deleted, what is proposed, and where a connection was blocked. Deleted
//! edges are dashed and proposed ones thick, so that nothing rests on colour alone.

use common::VertexRecord;
use egui::{Align2, Color32, FontId, Painter, Pos2, Rect, Shape, Stroke, Vec2, pos2, vec2};
use glam::Vec3;

use super::ground::{MARGIN, veil};
use super::highlight::arrow_head;
use super::project::Projector;
use crate::panel::hover;
use crate::source::steering::Moment;
use crate::value::theme;
use crate::world::World;

/// Widths in points.
const KEPT: f32 = 2.5;
const NEW: f32 = 4.0;
const RIM: f32 = 2.0;
const FAN: f32 = 1.4;
/// Room for an entry of the key.
const KEY_ENTRY: Vec2 = vec2(118.0, 20.0);
/// Most proposals of a fan that are drawn.
const MOST_OF_FAN: usize = 200;

/// Draws what the explorer is at.
pub(super) fn paint(painter: &Painter, projector: &Projector, rect: Rect, world: &World<'_>) {
    let pen = Pen { painter, projector };
    let Some(moment) = hover::moment(painter.ctx(), world) else {
        if let Some(path) = world.status.steering.focus.current() {
            pen.line(&path.vertices, Stroke::new(KEPT, theme::EXPLORED));
            pen.dots(&path.vertices, theme::EXPLORED);
        }
        return;
    };
    if moment.step.fan {
        fan(&pen, world, moment);
    }
    step(&pen, moment);
    key(painter, rect, moment, world.settings.window.is_dark());
}

/// All proposals of the fan that `moment` belongs to, fainter the less likely they are; those that
/// failed, as far as they came.
fn fan(pen: &Pen<'_>, world: &World<'_>, moment: &Moment) {
    let moments = world.status.steering.focus.moments();
    let same = |other: &&Moment| other.step.fan && other.step.id == moment.step.id;
    for other in moments.iter().rev().take_while(same).take(MOST_OF_FAN) {
        if let Some(proposal) = other.proposal() {
            let opacity = 0.15 + 0.6 * other.step.acceptance as f32;
            pen.line(&proposal, Stroke::new(FAN, theme::PROPOSED.gamma_multiply(opacity)));
        } else {
            let stroke = Stroke::new(FAN, theme::BAD.gamma_multiply(0.5));
            for side in attempt(other) {
                pen.line(&side, stroke);
            }
            if let Some(blocker) = other.step.blocker {
                pen.cross(blocker.into(), 3.0, theme::BAD);
            }
        }
    }
}

/// How far a proposal came that failed: from the last vertex kept on the light side, and from the first
/// one on the eye side.
fn attempt(Moment { before, step }: &Moment) -> [Vec<VertexRecord>; 2] {
    let before = before.vertices.as_slice();
    let from_light = step.kept_light.checked_sub(1).and_then(|last| before.get(last));
    let from_eye = before.get(before.len().saturating_sub(step.kept_eye));
    let light = from_light.into_iter().chain(&step.inserted).copied().collect();
    [light, from_eye.into_iter().chain(&step.eye_side).copied().collect()]
}

fn step(pen: &Pen<'_>, moment: &Moment) {
    let (step, before) = (&moment.step, moment.before.vertices.as_slice());
    let kept_from = before.len().saturating_sub(step.kept_eye);
    let kept_light = step.kept_light.min(before.len());
    // The edges at both borders of the deleted range go with it.
    let deleted =
        &before[kept_light.saturating_sub(1).min(kept_from)..(kept_from + 1).min(before.len())];
    pen.line(&before[..kept_light], Stroke::new(KEPT, theme::EXPLORED));
    pen.line(&before[kept_from..], Stroke::new(KEPT, theme::EXPLORED));
    pen.dashes(deleted, Stroke::new(KEPT, theme::DELETED));
    pen.dots(&before[..kept_light], theme::EXPLORED);
    pen.dots(&before[kept_from..], theme::EXPLORED);
    for vertex in before.get(kept_light..kept_from).unwrap_or_default() {
        pen.cross(vertex.position.into(), 5.0, theme::DELETED);
    }
    let stroke = Stroke::new(NEW, theme::PROPOSED);
    if let Some(proposal) = moment.proposal() {
        let from = kept_light.saturating_sub(1);
        let to = (proposal.len() - step.kept_eye.min(proposal.len()) + 1).min(proposal.len());
        pen.line(&proposal[from..to], stroke);
    } else {
        for side in attempt(moment) {
            pen.line(&side, stroke);
        }
    }
    pen.rings(&step.inserted);
    pen.rings(&step.eye_side);
    if let Some(blocker) = step.blocker {
        pen.cross(blocker.into(), 9.0, theme::BAD);
        pen.label(blocker.into(), "blocked", theme::BAD);
    }
}

/// What the strokes mean, below the line that counts paths: beside each other where the view is wide
/// enough, and otherwise one over the other.
fn key(painter: &Painter, rect: Rect, moment: &Moment, dark: bool) {
    let ink = if dark { Color32::WHITE } else { Color32::from_rgb(40, 44, 50) };
    let is_wide = rect.width() >= 3.0 * KEY_ENTRY.x + 2.0 * MARGIN;
    let (size, step) = if is_wide {
        (vec2(3.0 * KEY_ENTRY.x, KEY_ENTRY.y), vec2(KEY_ENTRY.x, 0.0))
    } else {
        (vec2(KEY_ENTRY.x, 3.0 * KEY_ENTRY.y), vec2(0.0, KEY_ENTRY.y))
    };
    let left = if is_wide { rect.center().x - 0.5 * size.x } else { rect.left() + MARGIN };
    let area = Rect::from_min_size(pos2(left, rect.top() + MARGIN + 27.0), size);
    veil(painter, area, ink);
    let mut place = area.min + vec2(4.0, 0.5 * KEY_ENTRY.y);
    let made = if moment.step.is_complete() { "proposed" } else { "got this far" };
    for (name, color, width, dashed) in [
        ("kept", theme::EXPLORED, KEPT, false),
        ("deleted", theme::DELETED, KEPT, true),
        (made, theme::PROPOSED, NEW, false),
    ] {
        let line = [place, place + vec2(34.0, 0.0)];
        let stroke = Stroke::new(width, color);
        if !dark && !dashed {
            // As in the scene: pale lines need a rim on light ground.
            let rim = Stroke::new(width + 2.0 * RIM, Color32::from_black_alpha(110));
            painter.line_segment(line, rim);
        }
        if dashed {
            painter.extend(Shape::dashed_line(&line, stroke, 7.0, 5.0));
        } else {
            painter.line_segment(line, stroke);
        }
        let font = FontId::proportional(12.0);
        painter.text(place + vec2(42.0, 0.0), Align2::LEFT_CENTER, name, font, ink);
        place += step;
    }
}

/// Draws lines of the scene, each with a dark rim.
struct Pen<'a> {
    painter: &'a Painter,
    projector: &'a Projector,
}

impl Pen<'_> {
    fn segments<'v>(
        &'v self,
        vertices: &'v [VertexRecord],
    ) -> impl Iterator<Item = [Pos2; 2]> + 'v {
        vertices.windows(2).filter_map(|pair| {
            let [a, b] = pair.first_chunk::<2>()?;
            self.projector.segment(a.position.into(), b.position.into())
        })
    }

    fn line(&self, vertices: &[VertexRecord], stroke: Stroke) {
        let rim = Stroke::new(stroke.width + 2.0 * RIM, Color32::from_black_alpha(110));
        for line in self.segments(vertices).filter(|_| stroke.width > 1.5) {
            self.painter.line_segment(line, rim);
        }
        for line in self.segments(vertices) {
            self.painter.line_segment(line, stroke);
            if stroke.width > 1.5 {
                arrow_head(self.painter, line, stroke.color);
            }
        }
    }

    fn dashes(&self, vertices: &[VertexRecord], stroke: Stroke) {
        for line in self.segments(vertices) {
            self.painter.extend(Shape::dashed_line(&line, stroke, 9.0, 6.0));
        }
    }

    fn dots(&self, vertices: &[VertexRecord], color: Color32) {
        for place in vertices.iter().filter_map(|v| self.projector.point(v.position.into())) {
            self.painter.circle(
                place,
                4.0,
                color,
                Stroke::new(1.5, Color32::from_black_alpha(200)),
            );
        }
    }

    fn rings(&self, vertices: &[VertexRecord]) {
        for place in vertices.iter().filter_map(|v| self.projector.point(v.position.into())) {
            self.painter.circle_filled(place, 6.5, Color32::from_black_alpha(140));
            self.painter.circle_stroke(place, 6.0, Stroke::new(2.5, theme::PROPOSED));
        }
    }

    fn cross(&self, point: Vec3, size: f32, color: Color32) {
        let Some(place) = self.projector.point(point) else { return };
        for (width, color) in [(6.0, Color32::from_black_alpha(160)), (2.5, color)] {
            for arm in [vec2(size, size), vec2(size, -size)] {
                let line = [place - arm, place + arm];
                self.painter.line_segment(line, Stroke::new(width, color));
            }
        }
    }

    fn label(&self, point: Vec3, text: &str, color: Color32) {
        let Some(place) = self.projector.point(point) else { return };
        let galley =
            self.painter.layout_no_wrap(text.to_owned(), FontId::proportional(12.0), color);
        let corner = place + vec2(14.0, -8.0);
        veil(self.painter, Rect::from_min_size(corner, galley.size()), color);
        self.painter.galley(corner, galley, color);
    }
}
