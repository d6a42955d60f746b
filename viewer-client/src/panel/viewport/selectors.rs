//! Spherical selectors in the view: drawn, made under the cursor, moved and scaled by handles.

use egui::{Align2, Color32, FontId, Key, Painter, Pos2, Response, Stroke, Ui, vec2};
use glam::{DVec3, Vec3};

use super::handles::{Ball, Hold, REACH};
use super::project::Projector;
use crate::command::{Command, FilterCommand};
use crate::draw::pick;
use crate::keys;
use crate::value::theme;
use crate::value::{Sphere, kind_name};
use crate::world::World;

/// A new sphere's radius in radii of the scene.
const SIZE: f32 = 0.06;
/// Points of a drawn circle.
const CIRCLE: usize = 48;

/// Takes the user's hand; true when it is on a selector, so that it does not turn the camera too.
pub(super) fn interact(
    ui: &Ui,
    response: &Response,
    projector: &Projector,
    world: &World<'_>,
    commands: &mut Vec<Command>,
) -> bool {
    let mut push = |command| commands.push(Command::Filter(command));
    if let Some(place) = response.hover_pos() {
        let keys = keys::selectors(world.settings.window.keys);
        let pressed = keys.into_iter().find(|(key, _)| ui.input(|input| input.key_pressed(*key)));
        if let Some((_, kind)) = pressed {
            let ball = under_cursor(projector, place, world);
            push(FilterCommand::Add(Sphere { kind, place: place_of(ball, world) }));
            return true;
        }
    }
    let settings = &world.settings.filter;
    let pointer = response.interact_pointer_pos();
    if response.clicked()
        && let Some(number) = pointer.and_then(|place| centre_at(projector, place, world))
    {
        push(FilterCommand::Choose(number as u32));
        return true;
    }
    let chosen = settings.chosen().and_then(|n| settings.selectors().get(n).map(|s| (n, s)));
    let Some((number, sphere)) = chosen else { return false };
    if let Some(moved) = hold(world).pull(ui, response, projector, ball_of(sphere, world)) {
        push(FilterCommand::Move(number as u32, place_of(moved, world)));
        return true;
    }
    let delete = response.hovered() && ui.input(|input| input.key_pressed(Key::Delete));
    if delete {
        push(FilterCommand::Delete(number as u32));
    }
    delete
}

/// How the chosen selector is held.
fn hold(world: &World<'_>) -> Hold {
    let handles = world.settings.scene.handles;
    Hold { name: "grip of a selector", handles, is_sized: true }
}

/// A selector in scene units.
fn ball_of(sphere: &Sphere, world: &World<'_>) -> Ball {
    let [x, y, z, radius] = sphere.place;
    let scale = world.names().frame.map_or(1.0, |frame| frame.scale);
    let centre = world.names().scene(DVec3::new(x, y, z)).as_vec3();
    Ball { centre, radius: (radius * scale) as f32 }
}

/// Centre and radius in the units of the scene file.
fn place_of(ball: Ball, world: &World<'_>) -> [f64; 4] {
    let centre = world.names().world(ball.centre.into());
    let scale = world.names().frame.map_or(1.0, |frame| frame.scale);
    [centre.x, centre.y, centre.z, f64::from(ball.radius) / scale]
}

/// A sphere on the surface under the cursor, or as deep as the middle of the scene.
fn under_cursor(projector: &Projector, place: Pos2, world: &World<'_>) -> Ball {
    let lens = &projector.lens;
    let at = projector.pointer(place, 1.0).at;
    let bounds = world.camera.bounds();
    let scene = &world.settings.scene;
    let mesh = world.model.map(|model| &model.mesh);
    let clip = scene.clip_plane(bounds);
    let hit = mesh.and_then(|mesh| pick::surface_at(mesh, lens, at, !scene.cutaway, clip));
    let depth = (bounds.centre() - lens.eye).dot(lens.forward).max(crate::camera::NEAR);
    let centre = hit.map_or_else(|| lens.at(at, depth), |(_, point)| point);
    Ball { centre, radius: SIZE * bounds.radius() }
}

/// The selector whose middle is under the cursor.
fn centre_at(projector: &Projector, place: Pos2, world: &World<'_>) -> Option<usize> {
    world.settings.filter.selectors().iter().position(|sphere| {
        let seen = projector.point(ball_of(sphere, world).centre);
        seen.is_some_and(|centre| centre.distance(place) <= REACH)
    })
}

/// Draws every selector, and the handles of the chosen one.
pub(super) fn paint(painter: &Painter, projector: &Projector, world: &World<'_>) {
    let settings = &world.settings.filter;
    let faint = if settings.is_off() { 0.35 } else { 1.0 };
    for (number, sphere) in settings.selectors().iter().enumerate() {
        let ball = ball_of(sphere, world);
        let color = theme::selector_color(sphere.kind).gamma_multiply(faint);
        let chosen = settings.chosen() == Some(number);
        let width = if chosen { 2.0 } else { 1.2 };
        for [u, v] in [[Vec3::X, Vec3::Y], [Vec3::Y, Vec3::Z], [Vec3::Z, Vec3::X]] {
            circle(painter, projector, ball, [u, v], Stroke::new(width, color));
        }
        let Some(centre) = projector.point(ball.centre) else { continue };
        painter.circle(centre, 4.0, color, Stroke::new(1.0, Color32::from_black_alpha(200)));
        let name = format!("{} {}", kind_name(sphere.kind), number + 1);
        let place = centre + vec2(8.0, -6.0);
        painter.text(place, Align2::LEFT_BOTTOM, name, FontId::proportional(12.0), color);
        if chosen {
            hold(world).paint(painter, projector, ball);
        }
    }
}

fn circle(painter: &Painter, projector: &Projector, ball: Ball, [u, v]: [Vec3; 2], stroke: Stroke) {
    let point = |i: usize| {
        let (sin, cos) = (i as f32 / CIRCLE as f32 * std::f32::consts::TAU).sin_cos();
        ball.centre + ball.radius * (cos * u + sin * v)
    };
    for i in 0..CIRCLE {
        if let Some(line) = projector.segment(point(i), point(i + 1)) {
            painter.line_segment(line, stroke);
        }
    }
}
