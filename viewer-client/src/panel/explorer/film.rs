//! The explorer's film: what an image of its steps alone would be. No part of the image.

use egui::{
    ColorImage, Image, RichText, Role, Sense, Shape, Stroke, TextureHandle, TextureOptions, Ui,
    WidgetInfo, pos2, vec2,
};

use crate::imaging::{self, Sources};
use crate::settings::ImageSettings;
use crate::value::Layer;
use crate::value::format;
use crate::value::theme;
use crate::world::World;

/// Widest that it gets, in points.
const WIDTH: f32 = 230.0;

/// The film as a texture.
#[derive(Default)]
pub(super) struct ExplorerFilm {
    texture: Option<TextureHandle>,
    shown: Option<(u64, ImageSettings)>,
}

impl std::fmt::Debug for ExplorerFilm {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("ExplorerFilm").field("shown", &self.shown).finish_non_exhaustive()
    }
}

impl ExplorerFilm {
    /// Shows the film once there is one, in a dashed frame, so that nobody takes it for the image.
    pub(super) fn show(&mut self, ui: &mut Ui, world: &World<'_>) {
        let film = &world.status.steering.film;
        let [width, height] = film.size();
        if width == 0 || height == 0 {
            return;
        }
        let look = ImageSettings { layer: Layer::Image, ..world.settings.image };
        self.refresh(ui, world, look);
        let Some(texture) = &self.texture else { return };
        ui.add_space(6.0);
        let caption =
            format!("This is exploration, not the image: {}", format::steps(film.steps()));
        ui.label(RichText::new(caption).small().color(theme::BUSY));
        let across = WIDTH.min(ui.available_width());
        let size = vec2(across, across * height as f32 / width as f32);
        let (rect, response) = ui.allocate_exact_size(size, Sense::hover());
        response.widget_info(|| WidgetInfo::labeled(Role::Image, true, "Film of the exploration"));
        Image::new((texture.id(), size)).paint_at(ui, rect);
        let corners = [
            rect.left_top(),
            rect.right_top(),
            rect.right_bottom(),
            rect.left_bottom(),
            pos2(rect.left(), rect.top()),
        ];
        let stroke = Stroke::new(1.5, theme::BUSY);
        ui.painter().extend(Shape::dashed_line(&corners, stroke, 6.0, 4.0));
        response.on_hover_text(
            "The image that the explorer's steps alone would produce, at the exposure of the \
            image. The explorer started from a chosen path, so this is biased until it has \
            explored everything.",
        );
    }

    fn refresh(&mut self, ui: &Ui, world: &World<'_>, look: ImageSettings) {
        let film = &world.status.steering.film;
        let wanted = (film.revision(), look);
        if self.shown == Some(wanted) && self.texture.is_some() {
            return;
        }
        let sources = Sources { film, reference: None, flip: None, diagnostics: None };
        let Some(bytes) = imaging::develop(sources, &look) else { return };
        let image = ColorImage::from_rgb(film.size(), &bytes);
        let options = TextureOptions::LINEAR;
        match &mut self.texture {
            Some(texture) => texture.set(image, options),
            None => {
                self.texture = Some(ui.ctx().load_texture("exploration", image, options));
            }
        }
        self.shown = Some(wanted);
    }
}
