//! What is pointed at in another panel, marked in the view.

use common::VertexRecord;
use egui::{Color32, Painter, Shape, Stroke};
use glam::Vec3;

use super::highlight::arrow_head;
use super::project::Projector;
use crate::camera::Lens;
use crate::draw::pick;
use crate::panel::hover::{self, Pointed};
use crate::value::theme;
use crate::world::World;

/// Draws a long stay, or the ray through a point of the image.
pub(super) fn paint(painter: &Painter, projector: &Projector, world: &World<'_>, ink: Color32) {
    match hover::pointed(painter.ctx()) {
        Some(Pointed::Stay(rank)) => stay(painter, projector, world, rank),
        Some(Pointed::Film(film)) => ray(painter, projector, world, film, ink),
        _ => {}
    }
}

fn stay(painter: &Painter, projector: &Projector, world: &World<'_>, rank: usize) {
    let Some(batch) = world.diagnostics().and_then(|d| d.longest.as_ref()) else { return };
    let mut reader = batch.reader();
    for _ in 0..rank {
        reader.next();
    }
    let Some(path) = reader.next() else { return };
    line(painter, projector, path.vertices);
}

fn line(painter: &Painter, projector: &Projector, vertices: &[VertexRecord]) {
    let rim = Stroke::new(6.0, Color32::from_black_alpha(140));
    for (stroke, arrow) in [(rim, false), (Stroke::new(2.5, theme::SELECTED), true)] {
        for pair in vertices.windows(2) {
            if let [a, b] = pair
                && let Some(line) = projector.segment(a.position.into(), b.position.into())
            {
                painter.line_segment(line, stroke);
                if arrow {
                    arrow_head(painter, line, stroke.color);
                }
            }
        }
    }
}

/// The ray of the render camera through a point of the film, to the first surface.
fn ray(painter: &Painter, projector: &Projector, world: &World<'_>, film: [f32; 2], ink: Color32) {
    let (Some(camera), Some(model)) = (world.camera.render_camera(), world.model) else { return };
    let lens = Lens {
        eye: camera.origin.as_vec3(),
        right: camera.right.as_vec3(),
        up: camera.up.as_vec3(),
        forward: camera.forward.as_vec3(),
        tan_y: camera.tan_y as f32,
        aspect: (camera.tan_x / camera.tan_y) as f32,
    };
    let [u, v] = film;
    let at = [(2.0 * u - 1.0) * camera.tan_x as f32, (1.0 - 2.0 * v) * camera.tan_y as f32];
    let hit = pick::surface_at(&model.mesh, &lens, at, true, glam::Vec4::W);
    let far = 2.0 * model.bounds.radius();
    let end: Vec3 = hit.map_or_else(|| lens.at(at, far), |(_, place)| place);
    if let Some(line) = projector.segment(lens.eye, end) {
        painter.extend(Shape::dashed_line(&line, Stroke::new(1.5, ink), 8.0, 5.0));
    }
    if let Some(place) = projector.point(end).filter(|_| hit.is_some()) {
        painter.circle(place, 5.0, theme::ACCENT, Stroke::new(1.5, ink));
    }
}
