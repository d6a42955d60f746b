//! How paths and surfaces are drawn.

use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;

use super::Fixture;
use crate::command::{CameraCommand, CloudCommand, Command, SceneCommand};
use crate::panel::{cloud, scene};
use crate::value::Switch;
use crate::value::WindowSide;

#[test]
fn the_cloud_panel_speaks_in_commands() {
    let mut harness = Fixture::new(cloud::Cloud).harness();
    harness.run();
    harness.get_by_label("Freeze").click();
    harness.run();
    harness.get_by_label("Clear").click();
    harness.run();
    harness.get_by_label("Tint start and end").click();
    harness.run();
    let expected =
        [CloudCommand::Freeze(Switch::On), CloudCommand::Clear, CloudCommand::Ends(Switch::Off)];
    assert_eq!(harness.state().said, expected.map(Command::Cloud), "three clicks");
}

#[test]
fn a_slider_at_rest_says_nothing() {
    let mut fixture = Fixture::new(cloud::Cloud);
    // Values that no slider can show exactly.
    fixture.settings.cloud.width = 0.123_456;
    fixture.settings.cloud.fade = 1e9;
    let mut harness = fixture.harness();
    harness.run();
    assert_eq!(harness.state().said, [], "rounding is not the user's hand");
}

#[test]
fn long_numbers_do_not_widen_their_panel() {
    let mut fixture = Fixture::new(cloud::Cloud);
    fixture.settings.cloud.fade = 1e7;
    fixture.settings.cloud.shown = 10_000_000;
    fixture.settings.cloud.budget_mib = 65_536;
    let harness = Harness::builder().with_size(egui::vec2(800.0, 700.0)).build_ui_state(
        |ui, (fixture, widths): &mut (Fixture, Vec<f32>)| {
            let width = f32::from(fixture.settings.layout.width(WindowSide::Left));
            let left = egui::Panel::left("left").default_size(width);
            let shown = left.show(ui, |ui| fixture.show(ui));
            widths.push(shown.response.rect.width());
        },
        (fixture, Vec::new()),
    );
    let mut harness = harness;
    harness.run_steps(5);
    let widths = &harness.state().1;
    assert!(widths.windows(2).all(|w| w[0] == w[1]), "the panel creeps: {widths:?}");
}

#[test]
fn the_scene_panel_speaks_in_commands() {
    let mut harness = Fixture::new(scene::Scene).harness();
    harness.run();
    for label in ["Grid", "Frame all", "Fly"] {
        harness.get_by_label(label).click();
        harness.run();
    }
    let expected = [
        Command::Scene(SceneCommand::Grid(Switch::Off)),
        Command::Camera(CameraCommand::Frame),
        Command::Camera(CameraCommand::Fly(Switch::Toggle)),
    ];
    assert_eq!(harness.state().said, expected, "three clicks");
}
