//! The mouse in the view of the scene.

use egui::accesskit::Role as WidgetRole;
use egui_kittest::kittest::Queryable as _;

use super::Stage;
use crate::command::{CameraCommand, Command, PathCommand};
use crate::panel::viewport;

#[test]
fn a_click_in_the_viewport_picks() {
    let mut harness = Stage::new(viewport::Viewport).harness();
    harness.run_steps(2);
    harness.get_by_role_and_label(WidgetRole::Canvas, "Viewport").click();
    harness.run_steps(2);
    let said = &harness.state().said;
    let picked = |c: &Command| matches!(c, Command::Path(PathCommand::Pick(aim)) if aim.at[0].abs() < 1e-3 && aim.reach > 0.0);
    assert!(said.iter().any(picked), "the middle was clicked: {said:?}");
}

#[test]
fn dragging_in_the_viewport_turns_the_camera() {
    let mut harness = Stage::new(viewport::Viewport).harness();
    harness.run_steps(2);
    let view = harness.get_by_role_and_label(WidgetRole::Canvas, "Viewport").rect();
    harness.drag_at(view.center());
    harness.run_steps(1);
    harness.hover_at(view.center() + egui::vec2(70.0, 0.0));
    harness.run_steps(2);
    harness.drop_at(view.center() + egui::vec2(70.0, 0.0));
    harness.run_steps(1);
    let turned: f32 = harness
        .state()
        .said
        .iter()
        .map(|command| match command {
            Command::Camera(CameraCommand::Orbit(right, up)) => {
                assert_eq!(*up, 0.0, "a level drag");
                *right
            }
            other => panic!("{other} instead of a turn"),
        })
        .sum();
    assert!((turned - 20.0).abs() < 0.5, "a tenth of the height turns 20 degrees, not {turned}");
}
