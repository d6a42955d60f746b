//! The progressive image.

use egui::{
    Color32, ColorImage, Image, RichText, ScrollArea, Sense, TextureHandle, TextureOptions, Ui,
    Vec2, vec2,
};

use super::Panel;
use super::widgets::{Scale, empty_state, slider};
use crate::command::{Command, ImageCommand};
use crate::film::Film;
use crate::format;
use crate::world::World;

/// Tallest that the image gets while it fits itself, in shares of the window's height: the rest is
/// for the statistics.
const TALLEST: f32 = 0.34;

/// The image as a texture.
#[derive(Default)]
pub(super) struct ImagePanel {
    texture: Option<TextureHandle>,
    /// Revision of the film and exposure that the texture shows.
    shown: Option<(u64, f32)>,
}

impl std::fmt::Debug for ImagePanel {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("ImagePanel").field("shown", &self.shown).finish_non_exhaustive()
    }
}

impl Panel for ImagePanel {
    fn ui(&mut self, ui: &mut Ui, world: &World<'_>, commands: &mut Vec<Command>) {
        let film = world.film;
        let [width, height] = film.size();
        if width == 0 || height == 0 {
            self.texture = None;
            self.shown = None;
            empty_state(
                ui,
                "No image yet",
                "It appears as soon as a daemon is connected, and gets better by the second.",
            );
            return;
        }
        self.refresh(ui, film, world.settings.image.exposure);
        self.picture(ui, world);
        exposure(ui, world, commands);
        zoom(ui, world, commands);
        let text = format!(
            "{width} × {height}, {} mutations a pixel",
            format::count(film.steps() as f64 / (width * height) as f64)
        );
        ui.label(RichText::new(text).small().weak());
    }
}

impl ImagePanel {
    fn refresh(&mut self, ui: &Ui, film: &Film, stops: f32) {
        let wanted = (film.revision(), stops);
        if self.shown == Some(wanted) && self.texture.is_some() {
            return;
        }
        let image = ColorImage::from_rgb(film.size(), &film.to_srgb(stops));
        let options = TextureOptions {
            magnification: egui::TextureFilter::Nearest,
            ..TextureOptions::LINEAR
        };
        match &mut self.texture {
            Some(texture) => texture.set(image, options),
            None => self.texture = Some(ui.ctx().load_texture("film", image, options)),
        }
        self.shown = Some(wanted);
    }

    fn picture(&self, ui: &mut Ui, world: &World<'_>) {
        let Some(texture) = &self.texture else { return };
        let [width, height] = world.film.size();
        let film = vec2(width as f32, height as f32);
        let available = ui.available_width();
        let fit = (available / film.x).min(TALLEST * ui.ctx().content_rect().height() / film.y);
        let scale = world.settings.image.zoom.unwrap_or(fit);
        let frame_size = film * fit;
        ui.vertical_centered(|ui| {
            ui.set_max_width(frame_size.x);
            ScrollArea::both()
                .id_salt("film")
                .max_height(frame_size.y)
                .max_width(frame_size.x)
                .auto_shrink(world.settings.image.zoom.is_none())
                .show(ui, |ui| {
                    let image = Image::new((texture.id(), film * scale))
                        .fit_to_exact_size(film * scale)
                        .sense(Sense::hover());
                    let response = ui.add(image);
                    let place = response.hover_pos().map(|p| (p - response.rect.min) / scale);
                    if let Some(place) = place {
                        response.on_hover_ui_at_pointer(|ui| pixel(ui, world.film, place));
                    }
                });
        });
        ui.add_space(4.0);
    }
}

/// What the tooltip says of one pixel.
fn pixel(ui: &mut Ui, film: &Film, place: Vec2) {
    let (x, y) = (place.x as usize, place.y as usize);
    let Some([r, g, b]) = film.pixel(x, y) else { return };
    ui.label(format!("Pixel {x}, {y}"));
    for (name, value, color) in [
        ("R", r, Color32::from_rgb(240, 110, 100)),
        ("G", g, Color32::from_rgb(110, 200, 120)),
        ("B", b, Color32::from_rgb(110, 160, 250)),
    ] {
        ui.label(RichText::new(format!("{name} {value:10.5}")).monospace().color(color));
    }
}

fn exposure(ui: &mut Ui, world: &World<'_>, commands: &mut Vec<Command>) {
    let tip = "Brightness of the image on screen; each stop doubles it ( , and . )";
    let scale = Scale::linear(-10.0..=10.0, 1).suffix(" EV");
    let stops = world.settings.image.exposure;
    if let Some(stops) = slider(ui, "Exposure", tip, stops, scale) {
        commands.push(Command::Image(ImageCommand::Exposure(stops)));
    }
}

fn zoom(ui: &mut Ui, world: &World<'_>, commands: &mut Vec<Command>) {
    let zoom = world.settings.image.zoom;
    ui.horizontal(|ui| {
        let fit = ui.selectable_label(zoom.is_none(), "Fit").on_hover_text("As wide as the panel");
        if fit.clicked() {
            commands.push(Command::Image(ImageCommand::Fit));
        }
        for factor in [1.0, 2.0, 4.0] {
            let label = format!("{factor:.0}:1");
            let chosen = ui
                .selectable_label(zoom == Some(factor), label)
                .on_hover_text("Screen points a pixel of the film");
            if chosen.clicked() {
                commands.push(Command::Image(ImageCommand::Zoom(factor)));
            }
        }
        let auto = ui
            .selectable_label(!world.settings.image.chosen, "Auto")
            .on_hover_text("Brightness that suits the scene");
        if auto.clicked() {
            commands.push(Command::Image(ImageCommand::Auto));
        }
    });
}
