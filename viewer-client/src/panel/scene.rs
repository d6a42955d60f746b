//! How surfaces and drawing aids look, and what the scene holds.

use egui::{Button, RichText, Ui};

use super::lines::Lines;
use super::widgets::{row, setting};
use super::{Panel, Section};
use crate::command::{CameraCommand, Command, SceneCommand, SceneSettings};
use crate::keys::Group;
use crate::value::PanelName;
use crate::value::{ClipSide, Light, Shading, Switch, format};
use crate::world::World;

/// The settings of the view.
#[derive(Debug, Default)]
pub(super) struct Scene;

impl Panel for Scene {
    fn ui(&mut self, ui: &mut Ui, world: &World<'_>, commands: &mut Vec<Command>) {
        use SceneSettings as Look;
        setting(ui, world, &Look::shading(), commands);
        light(ui, world, commands);
        setting(ui, world, &Look::opacity(), commands);
        setting(ui, world, &Look::cutaway(), commands);
        setting(ui, world, &Look::clip(), commands);
        if world.settings.scene.clip != ClipSide::Off {
            setting(ui, world, &Look::cut(), commands);
        }
        setting(ui, world, &Look::camera(), commands);
        setting(ui, world, &Look::grid(), commands);
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

impl Section for Scene {
    const NAME: PanelName = PanelName::Scene;
    const TITLE: &'static str = "Scene";
    const HELP: &'static [&'static str] = &[
        "How surfaces are drawn. Make them transparent, cut the scene open, or show only edges to \
        see the paths behind them.",
    ];
    const KEYS: &'static [Group] = &[Group::Camera];

    fn text(world: &World<'_>) -> String {
        world.settings.scene.commands().into_iter().collect::<Lines>().text()
    }
}

/// The light of the preview, which has nothing to do with the lights of the scene.
fn light(ui: &mut Ui, world: &World<'_>, commands: &mut Vec<Command>) {
    let scene = &world.settings.scene;
    if matches!(scene.shading, Shading::Texture | Shading::Off | Shading::Wireframe) {
        return;
    }
    setting(ui, world, &SceneSettings::lighting(), commands);
    let form = SceneSettings::light().form;
    row(ui, form.label, &form.help(), |ui| {
        let at_eye = scene.light == Light::Camera;
        let mut push = |light| commands.push(Command::Scene(SceneCommand::Light(light)));
        let camera = ui
            .add(Button::new("At the eye").selected(at_eye))
            .on_hover_text("It moves with the camera");
        if camera.clicked() {
            push(Light::Camera);
        }
        let place = ui
            .add(Button::new("In the scene").selected(!at_eye))
            .on_hover_text("It stays at a point; drag its handles in the view");
        if place.clicked() && at_eye {
            let bounds = world.camera.bounds();
            let above = bounds.centre() + 0.6 * bounds.radius() * world.camera.up();
            let place = world.names().world(above.into());
            push(Light::At(place.to_array()));
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
            .on_hover_text("Look through the render camera (0)");
        if through.clicked() {
            commands.push(Command::Camera(CameraCommand::Through(Switch::Toggle)));
        }
        let fly = ui
            .add(Button::new("Fly").selected(world.camera.is_flying()))
            .on_hover_text("Move with W A S D, Q and E; look around with the mouse (F)");
        if fly.clicked() {
            commands.push(Command::Camera(CameraCommand::Fly(Switch::Toggle)));
        }
    });
}

#[cfg(test)]
mod tests {
    use egui_kittest::kittest::Queryable as _;

    use super::super::tests::Fixture;
    use super::*;

    #[test]
    fn the_light_leaves_the_eye_and_returns() {
        let mut harness = Fixture::new(Scene).harness();
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
            let mut fixture = Fixture::new(Scene);
            fixture.settings.scene.shading = shading;
            let mut harness = fixture.harness();
            harness.run();
            let lit = matches!(shading, Shading::Shaded | Shading::Plain | Shading::Edges);
            assert_eq!(harness.query_by_label("At the eye").is_some(), lit, "{shading}");
        }
    }
}
