//! What the colours of the image say, below it.

use egui::epaint::Mesh;
use egui::{Align2, Color32, RichText, Sense, Shape, TextStyle, Ui, pos2, vec2};

use crate::imaging::{BAND, Legend, Ramp, ramp_color};

/// Height of the band in points.
const HEIGHT: f32 = 10.0;

/// Shows a legend.
pub(super) fn show(ui: &mut Ui, legend: &Legend) {
    ui.label(RichText::new(&legend.title).small().weak());
    let font = TextStyle::Small.resolve(ui.style());
    let size = vec2(ui.available_width(), HEIGHT + font.size + 4.0);
    let (rect, _) = ui.allocate_exact_size(size, Sense::hover());
    let band = egui::Rect::from_min_size(rect.min, vec2(rect.width(), HEIGHT));
    ui.painter().add(colors(band, legend.ramp));
    let ink = ui.visuals().text_color();
    let last = legend.ticks.len().saturating_sub(1);
    for (i, tick) in legend.ticks.iter().enumerate() {
        let share = if last == 0 { 0.0 } else { i as f32 / last as f32 };
        let anchor = match i {
            0 => Align2::LEFT_TOP,
            i if i == last => Align2::RIGHT_TOP,
            _ => Align2::CENTER_TOP,
        };
        let place = pos2(band.left() + share * band.width(), band.bottom() + 2.0);
        ui.painter().text(place, anchor, tick, font.clone(), ink);
    }
}

fn colors(band: egui::Rect, ramp: Ramp) -> Shape {
    let mut mesh = Mesh::default();
    for i in 0..=BAND {
        let share = i as f32 / BAND as f32;
        let [r, g, b] = ramp_color(ramp, share);
        let x = band.left() + share * band.width();
        mesh.colored_vertex(pos2(x, band.top()), Color32::from_rgb(r, g, b));
        mesh.colored_vertex(pos2(x, band.bottom()), Color32::from_rgb(r, g, b));
        if i > 0 {
            let next = 2 * i as u32;
            mesh.add_triangle(next - 2, next - 1, next);
            mesh.add_triangle(next - 1, next, next + 1);
        }
    }
    Shape::mesh(mesh)
}
