//! How surfaces and drawing aids look, and what the scene holds.

use egui::{Button, RichText, Ui};

use super::Panel;
use super::widgets::{Scale, choice, row, slider, toggle};
use crate::command::{
    CameraCommand, ClipSide, Command, Light, Lighting, SceneCommand, Shading, Switch,
};
use crate::value::format;
use crate::world::World;

/// The settings of the view.
#[derive(Debug)]
pub(super) struct Scene;

impl Panel for Scene {
    fn ui(&mut self, ui: &mut Ui, world: &World<'_>, commands: &mut Vec<Command>) {
        let scene = &world.settings.scene;
        let mut push = |command| commands.push(Command::Scene(command));
        let tip = "Lit with textures, lit in plain colours, textures alone, with edges, or not (Z)";
        if let Some(shading) = choice(ui, "Surfaces", tip, scene.shading, &Shading::ALL) {
            push(SceneCommand::Shading(shading));
        }
        light(ui, world, &mut push);
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

/// The light of the preview, which has nothing to do with the lights of the scene.
fn light(ui: &mut Ui, world: &World<'_>, push: &mut impl FnMut(SceneCommand)) {
    let scene = &world.settings.scene;
    if matches!(scene.shading, Shading::Texture | Shading::Off | Shading::Wireframe) {
        return;
    }
    let tip = "Soft: a sky, too, so that nothing is black. Phong: one point light, as in 2014";
    if let Some(lighting) = choice(ui, "Lighting", tip, scene.lighting, &Lighting::ALL) {
        push(SceneCommand::Lighting(lighting));
    }
    row(ui, "Light", "Where the preview is lit from; its lamps stay as they are", |ui| {
        let at_eye = scene.light == Light::Camera;
        let camera = ui
            .add(Button::new("At the eye").selected(at_eye))
            .on_hover_text("It goes wherever you look from");
        if camera.clicked() {
            push(SceneCommand::Light(Light::Camera));
        }
        let place = ui
            .add(Button::new("In the scene").selected(!at_eye))
            .on_hover_text("It stays at a point; drag its handles in the view");
        if place.clicked() && at_eye {
            let bounds = world.camera.bounds();
            let above = bounds.centre() + 0.6 * bounds.radius() * world.camera.up();
            let place = world.names().world(above.into());
            push(SceneCommand::Light(Light::At(place.to_array())));
        }
    });
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

#[cfg(test)]
mod tests {
    use egui_kittest::kittest::Queryable as _;

    use super::super::tests::Stage;
    use super::*;

    #[test]
    fn the_light_leaves_the_eye_and_returns() {
        let mut harness = Stage::new(Scene).harness();
        harness.run();
        harness.get_by_label("In the scene").click();
        harness.run();
        let said = harness.state_mut().said.split_off(0);
        let [Command::Scene(SceneCommand::Light(light @ Light::At(_)))] = said.as_slice() else {
            panic!("{said:?} instead of a place");
        };
        harness.state_mut().settings.scene.light = *light;
        harness.run();
        harness.get_by_label("At the eye").click();
        harness.run();
        let expected = Command::Scene(SceneCommand::Light(Light::Camera));
        assert_eq!(harness.state().said, [expected], "and back");
    }

    #[test]
    fn surfaces_without_shade_need_no_light() {
        for shading in Shading::ALL {
            let mut stage = Stage::new(Scene);
            stage.settings.scene.shading = shading;
            let mut harness = stage.harness();
            harness.run();
            let lit = matches!(shading, Shading::Shaded | Shading::Plain | Shading::Edges);
            assert_eq!(harness.query_by_label("At the eye").is_some(), lit, "{shading}");
        }
    }
}
