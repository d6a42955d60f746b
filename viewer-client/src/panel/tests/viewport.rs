//! The mouse in the view of the scene.

use std::sync::Arc;

use egui::accesskit::Role as WidgetRole;
use egui::{Pos2, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;
use glam::Vec3;

use super::paths::{numbers, selected};
use super::{Fixture, shows};
use crate::command::{CameraCommand, Command, PathCommand};
use crate::panel::hover::{self, Pointed};
use crate::panel::viewport;
use crate::source::model::Model;
use crate::source::selection::{Detail, Selection};
use crate::synthetic::{batch, camera, mesh, welcome};

/// A view of the made-up scene with one path through its middle.
fn view() -> Fixture {
    let mut fixture = Fixture::new(viewport::Viewport::default());
    fixture.status.welcome(welcome());
    fixture.model = Model::new(mesh());
    let bounds = fixture.model.as_ref().expect("a model").bounds;
    fixture.camera.set_scene(bounds, Some(camera()));
    fixture.store.append(&batch(&[&[[-400.0, 0.0, 0.0], [400.0, 0.0, 0.0]]]));
    fixture
}

#[test]
fn a_click_in_the_viewport_picks() {
    let mut harness = Fixture::new(viewport::Viewport::default()).harness();
    harness.run_steps(2);
    harness.get_by_role_and_label(WidgetRole::Canvas, "Viewport").click();
    harness.run_steps(2);
    let said = &harness.state().said;
    let picked = |c: &Command| matches!(c, Command::Path(PathCommand::Pick(aim)) if aim.at[0].abs() < 1e-3 && aim.reach > 0.0);
    assert!(said.iter().any(picked), "the middle was clicked: {said:?}");
}

#[test]
fn dragging_in_the_viewport_turns_the_camera() {
    let mut harness = Fixture::new(viewport::Viewport::default()).harness();
    harness.run_steps(2);
    let view = harness.get_by_role_and_label(WidgetRole::Canvas, "Viewport").rect();
    harness.drag_at(view.center());
    harness.run_steps(1);
    harness.hover_at(view.center() + vec2(70.0, 0.0));
    harness.run_steps(2);
    harness.drop_at(view.center() + vec2(70.0, 0.0));
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

/// Where a point of the scene is seen.
fn seen(harness: &Harness<'_, Fixture>, point: Vec3) -> Pos2 {
    let rect = harness.get_by_role_and_label(WidgetRole::Canvas, "Viewport").rect();
    let lens = harness.state().camera.lens(rect.aspect_ratio());
    let d = point - lens.eye;
    let scale = 0.5 * rect.height() / (lens.tan_y * d.dot(lens.forward));
    rect.center() + scale * vec2(d.dot(lens.right), -d.dot(lens.up))
}

#[test]
fn a_path_under_the_resting_cursor_is_told_of() {
    let mut harness = view().harness();
    harness.run_steps(2);
    let middle = seen(&harness, Vec3::ZERO);
    harness.hover_at(middle);
    harness.run_steps(1);
    assert_eq!(hover::pointed(&harness.ctx), None, "the cursor has only just come");
    harness.run_steps(60);
    assert!(
        matches!(hover::pointed(&harness.ctx), Some(Pointed::Path(_))),
        "its film point is marked on the image"
    );
    for text in ["D D D", "bidirectional", "Luminance 1.000", "Click to select it"] {
        assert!(shows(&harness, text), "`{text}` is missing");
    }
    assert_eq!(harness.state().said, [], "to look is no command");
    harness.hover_at(seen(&harness, Vec3::new(0.0, 0.0, 500.0)) + vec2(60.0, 60.0));
    harness.run_steps(60);
    assert_eq!(hover::pointed(&harness.ctx), None, "nothing there");
}

#[test]
fn parts_of_the_selected_path_are_told_of_and_marked_in_the_list() {
    let mut fixture = view();
    let mut path = selected(Detail::Known(Arc::new(numbers())));
    path.vertices[0].position = [0.0, 0.0, 0.0];
    path.vertices[1].position = [400.0, 0.0, 0.0];
    fixture.selection = Some(Selection { vertex: None, ..path });
    let mut harness = fixture.harness();
    harness.run_steps(2);
    let middle = seen(&harness, Vec3::ZERO);
    harness.hover_at(middle);
    harness.run_steps(60);
    assert_eq!(hover::pointed(&harness.ctx), Some(Pointed::Vertex(0)), "a vertex");
    for text in ["x0, diffuse", "wall of room", "p from the light 0.1250"] {
        assert!(shows(&harness, text), "`{text}` is missing");
    }
    harness.hover_at(middle.lerp(seen(&harness, Vec3::new(400.0, 0.0, 0.0)), 0.5));
    harness.run_steps(60);
    assert_eq!(hover::pointed(&harness.ctx), Some(Pointed::Edge(0)), "an edge");
    assert!(shows(&harness, "Connecting here has weight 75.0 %"), "what a connection would count");
}
