//! The scene and its paths, and the user's hand on the camera.

mod gesture;
mod legend;
mod overlay;
mod picture;

use egui::{Role, Sense, Ui, WidgetInfo};

use super::Panel;
use crate::command::Command;
use crate::gpu::ViewportCallback;
use crate::world::World;

/// What is left of the window: the view into the scene.
#[derive(Debug)]
pub(super) struct Viewport;

impl Panel for Viewport {
    fn ui(&mut self, ui: &mut Ui, world: &World<'_>, commands: &mut Vec<Command>) {
        let (rect, response) = ui.allocate_exact_size(ui.available_size(), Sense::click_and_drag());
        response.widget_info(|| WidgetInfo::labeled(Role::Canvas, true, "Viewport"));
        gesture::read(ui, &response, world, commands);

        let pixels = rect.size() * ui.pixels_per_point();
        let size = [pixels.x.round().max(1.0) as u32, pixels.y.round().max(1.0) as u32];
        let picture = picture::of(world, size, ui.pixels_per_point());
        let callback = ViewportCallback { picture, ctx: ui.ctx().clone() };
        ui.painter().add(egui_wgpu::Callback::new_paint_callback(rect, callback));
        overlay::paint(ui, rect, world);
    }
}
