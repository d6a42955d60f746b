//! Spherical selectors in the view: drawn, made under the cursor, moved and scaled by handles.

use egui::{Align2, Color32, FontId, Id, Key, Painter, Pos2, Response, Stroke, Ui, vec2};
use glam::{DVec3, Vec3};

use super::project::Projector;
use crate::command::{Command, FilterCommand, Sphere, kind_name};
use crate::pick;
use crate::theme;
use crate::world::World;

/// A new sphere's radius in radii of the scene.
const SIZE: f32 = 0.06;
/// How near to a handle the cursor must be, in points.
const REACH: f32 = 11.0;
/// Points of a drawn circle.
const CIRCLE: usize = 48;

/// What the user holds of the chosen selector.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Grip {
    /// Its middle: it follows the cursor in the plane of the screen.
    Centre,
    /// An axis: it moves along.
    Axis(Vec3),
    /// Its rim: it grows or shrinks.
    Rim,
}

/// A selector in scene units.
#[derive(Clone, Copy, Debug)]
struct Ball {
    centre: Vec3,
    radius: f32,
}

impl Ball {
    fn of(sphere: &Sphere, world: &World<'_>) -> Self {
        let [x, y, z, radius] = sphere.place;
        let centre = DVec3::new(x, y, z);
        match world.names().frame {
            Some(frame) => Self {
                centre: frame.to_scene(centre).as_vec3(),
                radius: (radius * frame.scale) as f32,
            },
            None => Self { centre: centre.as_vec3(), radius: radius as f32 },
        }
    }

    /// Centre and radius in the units of the scene file.
    fn place(self, world: &World<'_>) -> [f64; 4] {
        let centre = world.names().world(self.centre.into());
        let scale = world.names().frame.map_or(1.0, |frame| frame.scale);
        [centre.x, centre.y, centre.z, f64::from(self.radius) / scale]
    }
}

/// Takes the user's hand; true when it is on a selector, so that it does not turn the camera too.
pub(super) fn interact(
    ui: &Ui,
    (response, projector): (&Response, &Projector),
    world: &World<'_>,
    commands: &mut Vec<Command>,
) -> bool {
    let mut push = |command| commands.push(Command::Filter(command));
    if let Some(place) = response.hover_pos() {
        let keys = world.settings.layout.keys.selectors();
        let pressed = keys.into_iter().find(|(key, _)| ui.input(|input| input.key_pressed(*key)));
        if let Some((_, kind)) = pressed {
            let ball = under_cursor(projector, place, world);
            push(FilterCommand::Add(Sphere { kind, place: ball.place(world) }));
            return true;
        }
    }
    let settings = &world.settings.filter;
    let id = Id::unique("grip of a selector");
    let pointer = response.interact_pointer_pos();
    if response.clicked()
        && let Some(number) = pointer.and_then(|place| centre_at(projector, place, world))
    {
        push(FilterCommand::Choose(number as u32));
        return true;
    }
    let chosen = settings.chosen.and_then(|n| settings.selectors.get(n).map(|s| (n, s)));
    let Some((number, sphere)) = chosen else { return false };
    let ball = Ball::of(sphere, world);
    if response.drag_started() {
        let origin = ui.input(|input| input.pointer.press_origin());
        let grip = origin.and_then(|place| grip_at(projector, ball, place));
        ui.data_mut(|data| data.insert_temp(id, grip));
    }
    let held: Option<Grip> = ui.data(|data| data.get_temp(id)).flatten();
    if response.drag_stopped() {
        ui.data_mut(|data| data.insert_temp::<Option<Grip>>(id, None));
    }
    if let Some(grip) = held.filter(|_| response.dragged()) {
        if let Some(moved) = pulled(projector, ball, grip, (pointer, response.drag_delta())) {
            push(FilterCommand::Move(number as u32, moved.place(world)));
        }
        return true;
    }
    let delete = response.hovered() && ui.input(|input| input.key_pressed(Key::Delete));
    if delete {
        push(FilterCommand::Delete(number as u32));
    }
    delete
}

/// A sphere on the surface under the cursor, or as deep as the middle of the scene.
fn under_cursor(projector: &Projector, place: Pos2, world: &World<'_>) -> Ball {
    let lens = &projector.lens;
    let at = projector.aim(place, 1.0).at;
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
    world.settings.filter.selectors.iter().position(|sphere| {
        let seen = projector.point(Ball::of(sphere, world).centre);
        seen.is_some_and(|centre| centre.distance(place) <= REACH)
    })
}

/// The ends of the handles, beyond the sphere.
fn tips(ball: Ball) -> [(Vec3, Vec3); 3] {
    [Vec3::X, Vec3::Y, Vec3::Z].map(|axis| (axis, ball.centre + 1.5 * ball.radius * axis))
}

/// A point of the rim as it is seen.
fn rim(projector: &Projector, ball: Ball) -> Vec3 {
    let lens = &projector.lens;
    ball.centre + ball.radius * (lens.right - lens.up).normalize_or_zero()
}

fn grip_at(projector: &Projector, ball: Ball, place: Pos2) -> Option<Grip> {
    let near = |point: Vec3| projector.point(point).is_some_and(|p| p.distance(place) <= REACH);
    if near(rim(projector, ball)) {
        return Some(Grip::Rim);
    }
    let axis = tips(ball).into_iter().find(|(_, tip)| near(*tip));
    axis.map(|(axis, _)| Grip::Axis(axis)).or_else(|| near(ball.centre).then_some(Grip::Centre))
}

/// The sphere after the hand has moved.
fn pulled(
    projector: &Projector,
    ball: Ball,
    grip: Grip,
    (pointer, delta): (Option<Pos2>, egui::Vec2),
) -> Option<Ball> {
    let lens = &projector.lens;
    let depth = (ball.centre - lens.eye).dot(lens.forward);
    let unit = depth / projector.scale();
    let shift = unit * (delta.x * lens.right - delta.y * lens.up);
    Some(match grip {
        Grip::Centre => Ball { centre: ball.centre + shift, ..ball },
        Grip::Axis(axis) => {
            // What the axis looks like on the screen decides how far the hand pulls along it.
            let [a, b] = [ball.centre, ball.centre + axis].map(|p| projector.point(p));
            let seen = b? - a?;
            let along = delta.dot(seen) / seen.length_sq().max(1e-6);
            Ball { centre: ball.centre + along * axis, ..ball }
        }
        Grip::Rim => {
            let centre = projector.point(ball.centre)?;
            let radius = unit * pointer?.distance(centre);
            Ball { radius: radius.max(1e-3 * ball.radius), ..ball }
        }
    })
}

/// Draws every selector, and the handles of the chosen one.
pub(super) fn paint(painter: &Painter, projector: &Projector, world: &World<'_>) {
    let settings = &world.settings.filter;
    let faint = if settings.off { 0.35 } else { 1.0 };
    for (number, sphere) in settings.selectors.iter().enumerate() {
        let ball = Ball::of(sphere, world);
        let color = theme::selector_color(sphere.kind).gamma_multiply(faint);
        let chosen = settings.chosen == Some(number);
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
            handles(painter, projector, ball, centre);
        }
    }
}

fn handles(painter: &Painter, projector: &Projector, ball: Ball, centre: Pos2) {
    for (axis, tip) in tips(ball) {
        let Some(tip) = projector.point(tip) else { continue };
        let color = theme::axis_color(axis);
        painter.line_segment([centre, tip], Stroke::new(2.0, color));
        painter.circle(tip, 6.0, color, Stroke::new(1.0, Color32::from_black_alpha(200)));
    }
    if let Some(rim) = projector.point(rim(projector, ball)) {
        let square = egui::Rect::from_center_size(rim, vec2(10.0, 10.0));
        painter.rect_filled(square, 1.0, Color32::WHITE);
        let edge = Stroke::new(1.0, Color32::from_black_alpha(220));
        painter.rect_stroke(square, 1.0, edge, egui::StrokeKind::Outside);
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
