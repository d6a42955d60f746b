//! The scene and its paths, and the user's hand on the camera.

mod gesture;
mod ghost;
mod glimpse;
mod ground;
mod handles;
mod highlight;
mod legend;
mod light;
mod others;
mod overlay;
mod picture;
mod pointed;
mod project;
mod selectors;

use egui::{Role, Sense, Ui, WidgetInfo};

use self::project::Projector;
use super::{Panel, reveal_pick};
use crate::command::{Command, PathCommand};
use crate::draw::gpu::ViewportCallback;
use crate::world::World;

/// How far off a click may be, in points.
const TOLERANCE: f32 = 6.0;

/// What is left of the window: the view into the scene.
#[derive(Debug, Default)]
pub(super) struct Viewport {
    glimpse: glimpse::Glimpse,
}

impl Panel for Viewport {
    fn ui(&mut self, ui: &mut Ui, world: &World<'_>, commands: &mut Vec<Command>) {
        let (rect, response) = ui.allocate_exact_size(ui.available_size(), Sense::click_and_drag());
        response.widget_info(|| WidgetInfo::labeled(Role::Canvas, true, "Viewport"));
        let projector = Projector::new(world.camera.lens(rect.aspect_ratio()), rect);
        let held = selectors::interact(ui, &response, &projector, world, commands)
            || light::interact(ui, &response, &projector, world, commands);
        if !held {
            gesture::read(ui, &response, world, commands);
            if response.clicked()
                && let Some(place) = response.interact_pointer_pos()
            {
                let pointer = projector.pointer(place, TOLERANCE);
                commands.push(Command::Path(PathCommand::Pick(pointer)));
                reveal_pick(ui);
            }
        }

        let pixels = rect.size() * ui.pixels_per_point();
        let size = [pixels.x.round().max(1.0) as u32, pixels.y.round().max(1.0) as u32];
        let picture = picture::of(world, size, ui.pixels_per_point());
        let callback = ViewportCallback { picture, ctx: ui.ctx().clone() };
        ui.painter().add(egui_wgpu::Callback::new_paint_callback(rect, callback));
        overlay::paint(ui, &projector, rect, world);
        if world.model.is_some() {
            self.glimpse.show(ui, &response, &projector, world);
        }
    }
}
