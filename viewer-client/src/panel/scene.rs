//! How surfaces and drawing aids look, and what the scene holds.

use egui::{Button, RichText, Ui};

use super::Panel;
use super::widgets::{Scale, choice, slider, toggle};
use crate::command::{CameraCommand, ClipSide, Command, SceneCommand, Shading, Switch};
use crate::format;
use crate::world::World;

/// The settings of the view.
#[derive(Debug)]
pub(super) struct Scene;

impl Panel for Scene {
    fn ui(&mut self, ui: &mut Ui, world: &World<'_>, commands: &mut Vec<Command>) {
        let scene = &world.settings.scene;
        let mut push = |command| commands.push(Command::Scene(command));
        let tip = "How surfaces are drawn (Z)";
        if let Some(shading) = choice(ui, "Surfaces", tip, scene.shading, &Shading::ALL) {
            push(SceneCommand::Shading(shading));
        }
        let tip = "Below 1, paths inside and behind are seen through surfaces (X)";
        if let Some(x) = slider(ui, "Opacity", tip, scene.opacity, Scale::linear(0.0..=1.0, 2)) {
            push(SceneCommand::Opacity(x));
        }
        let tip = "Surfaces seen from behind become glass, so that one looks into rooms (B)";
        if let Some(switch) = toggle(ui, "Cut away backs", tip, scene.cutaway) {
            push(SceneCommand::Cutaway(switch));
        }
        let tip = "A plane that cuts away what lies before it along an axis";
        if let Some(side) = choice(ui, "Clip", tip, scene.clip, &ClipSide::ALL) {
            push(SceneCommand::Clip(side));
        }
        if scene.clip != ClipSide::Off {
            let tip = "Where the plane lies across the scene";
            if let Some(x) = slider(ui, "Cut at", tip, scene.cut, Scale::linear(0.0..=1.0, 2)) {
                push(SceneCommand::Cut(x));
            }
        }
        let tip = "A wireframe model where the picture is taken from";
        if let Some(switch) = toggle(ui, "Camera model", tip, scene.aids.camera) {
            push(SceneCommand::Camera(switch));
        }
        if let Some(switch) = toggle(ui, "Grid", "The ground below the scene (G)", scene.aids.grid)
        {
            push(SceneCommand::Grid(switch));
        }
        ui.add_space(4.0);
        views(ui, world, commands);
        if let Some(model) = world.model {
            let text = format!(
                "{} triangles, {} materials",
                format::count(model.mesh.triangles.len() as f64),
                model.mesh.materials.len()
            );
            ui.add_space(2.0);
            ui.label(RichText::new(text).small().weak());
        }
    }
}

fn views(ui: &mut Ui, world: &World<'_>, commands: &mut Vec<Command>) {
    ui.horizontal_wrapped(|ui| {
        let frame = ui.button("Frame all").on_hover_text("Show the whole scene (Home)");
        if frame.clicked() {
            commands.push(Command::Camera(CameraCommand::Frame));
        }
        let through = ui
            .add(Button::new("Camera view").selected(world.camera.is_through()))
            .on_hover_text("Look through the camera that takes the picture (0)");
        if through.clicked() {
            commands.push(Command::Camera(CameraCommand::Through(Switch::Toggle)));
        }
        let fly = ui
            .add(Button::new("Fly").selected(world.camera.is_flying()))
            .on_hover_text("Move with W A S D, Q and E; look about with the mouse (F)");
        if fly.clicked() {
            commands.push(Command::Camera(CameraCommand::Fly(Switch::Toggle)));
        }
    });
}
