//! Turning, panning, zooming and framing keep what they promise.

use common::CameraPose;
use glam::{DVec3, Vec2};

use super::*;
use crate::value::Switch;

fn render_camera() -> Camera {
    let pose = CameraPose {
        origin: DVec3::new(30.0, -2000.0, 100.0),
        target: DVec3::new(0.0, 0.0, 20.0),
        up: DVec3::Z,
        vertical_fov: 40.0,
    };
    Camera::new(&pose, 400, 300).expect("a valid pose")
}

fn view() -> ViewCamera {
    let mut view = ViewCamera::default();
    let bounds = Bounds { min: Vec3::splat(-500.0), max: Vec3::new(500.0, 600.0, 400.0) };
    view.set_scene(bounds, Some(render_camera()));
    view
}

/// Where a point lands in the picture, -1 to 1 to the right and upwards.
fn project(view: &ViewCamera, point: Vec3) -> Vec2 {
    let clip = view.lens(1.5).view_projection() * point.extend(1.0);
    assert!(clip.w > 0.0, "{point} lies behind the eye");
    Vec2::new(clip.x, clip.y) / clip.w
}

fn near(a: Vec2, b: Vec2) -> bool {
    (a - b).length() < 1e-4
}

#[test]
fn a_scene_with_z_up_stands_upright() {
    let view = view();
    assert_eq!(view.up(), Vec3::Z, "up follows the render camera");
    let centre = view.bounds().centre();
    assert!(project(&view, centre + 100.0 * Vec3::Z).y > project(&view, centre).y, "up is up");
}

#[test]
fn orbiting_keeps_the_pivot_and_the_distance() {
    let mut view = view();
    let distance = (view.eye() - view.pivot).length();
    let before = project(&view, view.pivot);
    for _ in 0..100 {
        view.apply(CameraCommand::Orbit(33.0, 17.0));
    }
    assert!(near(project(&view, view.pivot), before), "the pivot stays put");
    assert!(((view.eye() - view.pivot).length() - distance).abs() < 0.1, "the distance stays");
    assert!(view.pitch <= STEEPEST, "the view never turns over");
}

#[test]
fn orbiting_to_the_right_moves_the_near_side_to_the_right() {
    let mut view = view();
    let near_side = view.pivot - 0.3 * view.distance * view.forward();
    let before = project(&view, near_side);
    view.apply(CameraCommand::Orbit(-10.0, 0.0));
    assert!(project(&view, near_side).x < before.x, "dragging left turns the near side left");
}

#[test]
fn panning_moves_the_picture_by_what_was_asked() {
    let mut view = view();
    let point = view.pivot;
    view.apply(CameraCommand::Pan(0.25, -0.1));
    // A height of the viewport is 2 units upwards, and 2 / aspect to the side.
    let moved = project(&view, point);
    assert!(near(moved, Vec2::new(0.5 / 1.5, -0.2)), "moved to {moved}");
}

#[test]
fn zooming_leaves_the_point_under_the_cursor() {
    let mut view = view();
    let up = view.right().cross(view.forward());
    let half_height = 0.5 * view.height_at_pivot();
    let point = view.pivot + half_height * (0.6 * view.right() - 0.4 * up);
    let before = project(&view, point);
    view.apply(CameraCommand::Zoom(1.7, [0.6, -0.4]));
    assert!(near(project(&view, point), before), "the point moved");
    let distance = view.distance;
    view.apply(CameraCommand::Zoom(1000.0, [0.0, 0.0]));
    view.apply(CameraCommand::Zoom(1000.0, [0.0, 0.0]));
    assert!(view.distance > 0.0 && view.distance < distance, "closer, but never at the pivot");
}

#[test]
fn framing_shows_every_corner() {
    let mut view = view();
    view.apply(CameraCommand::Move([3.0, 1.0, -2.0]));
    for side in Side::ALL {
        view.apply(CameraCommand::View(side));
        let b = view.bounds();
        for i in 0..8 {
            let pick = |bit: u32, low: f32, high: f32| if i >> bit & 1 == 1 { high } else { low };
            let corner = Vec3::new(
                pick(0, b.min.x, b.max.x),
                pick(1, b.min.y, b.max.y),
                pick(2, b.min.z, b.max.z),
            );
            let seen = project(&view, corner);
            assert!(seen.abs().max_element() <= 1.0, "{side}: {corner} lands at {seen}");
        }
    }
}

#[test]
fn looking_through_the_render_camera_shows_its_picture() {
    let mut view = view();
    let camera = render_camera();
    view.apply(CameraCommand::Through(Switch::On));
    let gate = view.gate(1.5).expect("a gate while looking through");
    for (u, v) in [(0.0, 0.0), (1.0, 0.0), (0.3, 0.8)] {
        let direction = camera.direction(glam::DVec2::new(u, v));
        let point = (camera.origin + 1234.0 * direction).as_vec3();
        let expected = Vec2::new(2.0 * u as f32 - 1.0, 1.0 - 2.0 * v as f32);
        let seen = project(&view, point) / Vec2::new(gate.width, gate.height);
        assert!((seen - expected).length() < 1e-3, "({u}, {v}) is seen at {seen}");
    }
    assert!(gate.width <= 1.0 && gate.height <= 1.0, "the whole picture fits");
}

#[test]
fn moving_leaves_the_render_camera_where_it_stands() {
    let mut view = view();
    view.apply(CameraCommand::Through(Switch::On));
    view.apply(CameraCommand::Look(0.0, 0.0));
    assert!(!view.is_through(), "a move ends the look through the camera");
    let camera = render_camera();
    assert!((view.eye() - camera.origin.as_vec3()).length() < 0.5, "the eye stayed");
    assert!(view.forward().dot(camera.forward.as_vec3()) > 0.99999, "and looks the same way");
}

#[test]
fn looking_turns_on_the_spot() {
    let mut view = view();
    let eye = view.eye();
    view.apply(CameraCommand::Look(40.0, -20.0));
    assert!((view.eye() - eye).length() < 0.5, "the eye stayed");
}

#[test]
fn without_a_render_camera_nobody_looks_through_it() {
    let mut view = ViewCamera::default();
    view.apply(CameraCommand::Through(Switch::Toggle));
    assert!(!view.is_through(), "there is nothing to look through");
}
