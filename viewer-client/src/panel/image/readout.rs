//! The raw values of the pixel under the cursor, on lines that are always there.

use common::Rgb;
use egui::{Color32, Grid, RichText, Ui};

use crate::imaging;
use crate::value::format;
use crate::world::World;

/// Letters of a value: a sign, digits, a point and an exponent.
const DIGITS: usize = 8;

/// Shows the values of a pixel, or how to get at them.
pub(super) fn show(ui: &mut Ui, world: &World<'_>, hovered: Option<[usize; 2]>) {
    let pixel = hovered.and_then(|[x, y]| Some((x, y, world.film.pixel(x, y)?)));
    let Some((x, y, rgb)) = pixel else {
        let hint = "Point at a pixel to see its values; click it, or drag a rectangle, to see its \
            paths.";
        let has_map = world.settings.image.layer.is_map();
        let lines = 1 + usize::from(world.reference.is_some()) + usize::from(has_map);
        let font = egui::TextStyle::Monospace.resolve(ui.style());
        let height = lines as f32 * (ui.fonts_mut(|f| f.row_height(&font)) + 3.0) + 14.0;
        ui.allocate_ui(egui::vec2(ui.available_width(), height), |ui| {
            ui.set_min_height(height);
            ui.label(RichText::new(hint).small().weak());
        });
        return;
    };
    let reference = world.reference.filter(|r| r.fits(world.film)).and_then(|r| r.pixel(x, y));
    Grid::new("readout").num_columns(5).spacing([6.0, 3.0]).show(ui, |ui| {
        ui.label(RichText::new(format!("{x}, {y}")).small().weak());
        for (name, color) in channels(ui) {
            ui.label(RichText::new(format!("{name:>DIGITS$}")).monospace().color(color));
        }
        ui.end_row();
        line(ui, "image", Rgb::from(rgb));
        if let Some(reference) = reference {
            line(ui, "reference", reference);
        }
        if let Some((name, value)) = map_value(world, x, y) {
            ui.label(RichText::new(name).small().weak());
            ui.label(RichText::new(value).monospace());
            ui.end_row();
        }
    });
}

/// The raw values of a pixel as text: its place, its radiance and, where there is one, that of the
/// reference.
pub(super) fn text(world: &World<'_>, [x, y]: [usize; 2]) -> Option<String> {
    let line = |name: &str, rgb: Rgb| {
        format!("{name}\t{:e}\t{:e}\t{:e}\t{:e}\n", rgb.r, rgb.g, rgb.b, rgb.luminance())
    };
    let mut text = format!("{x}, {y}\tR\tG\tB\tY\n");
    text.push_str(&line("image", Rgb::from(world.film.pixel(x, y)?)));
    let reference = world.reference.filter(|r| r.fits(world.film)).and_then(|r| r.pixel(x, y));
    text.extend(reference.map(|reference| line("reference", reference)));
    if let Some((name, value)) = map_value(world, x, y) {
        text.extend([name.as_str(), "\t", value.as_str(), "\n"]);
    }
    Some(text)
}

/// What the map that is shown says of a pixel's tile.
fn map_value(world: &World<'_>, x: usize, y: usize) -> Option<(String, String)> {
    let (layer, diagnostics) = (world.settings.image.layer, world.diagnostics()?);
    let tile = diagnostics.grid.tile(x as u32, y as u32);
    let value = *imaging::map_values(diagnostics, layer).get(tile)?;
    let text = if value < 0.0 { "unknown".to_owned() } else { format::value(value) };
    Some((layer.to_string(), text))
}

fn channels(ui: &Ui) -> [(&'static str, Color32); 4] {
    let text = ui.visuals().text_color();
    if ui.visuals().dark_mode {
        let [red, green, blue] = [[240, 110, 100], [110, 200, 120], [110, 160, 250]]
            .map(|[r, g, b]| Color32::from_rgb(r, g, b));
        [("R", red), ("G", green), ("B", blue), ("Y", text)]
    } else {
        let [red, green, blue] = [[180, 40, 30], [20, 110, 40], [30, 80, 190]]
            .map(|[r, g, b]| Color32::from_rgb(r, g, b));
        [("R", red), ("G", green), ("B", blue), ("Y", text)]
    }
}

fn line(ui: &mut Ui, name: &str, rgb: Rgb) {
    ui.label(RichText::new(name).small().weak());
    for value in [rgb.r, rgb.g, rgb.b, rgb.luminance()] {
        let digits = if value == 0.0 || (1e-3..1e4).contains(&value.abs()) {
            format!("{value:.4}")
        } else {
            format!("{value:.2e}")
        };
        ui.label(RichText::new(format!("{digits:>DIGITS$}")).monospace());
    }
    ui.end_row();
}
