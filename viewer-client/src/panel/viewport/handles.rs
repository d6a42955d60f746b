//! Handles that move a ball along an axis or scale it: a selector, or the light.

use egui::{Color32, Id, Painter, Pos2, Rect, Response, Stroke, StrokeKind, Ui, vec2};
use glam::Vec3;

use super::project::Projector;
use crate::value::Handles;
use crate::value::theme;

/// How near to a handle the cursor must be, in points.
pub(super) const REACH: f32 = 11.0;
/// The ends of the axes, in radii from the centre.
const ARM: f32 = 1.5;

/// What is held, in scene units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Ball {
    pub(super) centre: Vec3,
    pub(super) radius: f32,
}

/// What the user holds of it.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Grip {
    /// Its middle: it follows the cursor in the plane of the screen.
    Centre,
    /// An axis: it moves along, or grows and shrinks.
    Axis(Vec3),
    /// Its rim: it grows or shrinks.
    Rim,
}

/// How a ball may be held.
#[derive(Clone, Copy, Debug)]
pub(super) struct Hold {
    /// What remembers the grip from frame to frame.
    pub(super) name: &'static str,
    /// What the axes do.
    pub(super) handles: Handles,
    /// Whether it has a size that the rim changes.
    pub(super) is_sized: bool,
}

impl Hold {
    /// The ball after the hand has moved, while the hand is on it.
    pub(super) fn pull(
        self,
        ui: &Ui,
        response: &Response,
        projector: &Projector,
        ball: Ball,
    ) -> Option<Ball> {
        let id = Id::unique(self.name);
        if response.drag_started() {
            let origin = ui.input(|input| input.pointer.press_origin());
            let grip = origin.and_then(|place| self.grip_at(projector, ball, place));
            ui.data_mut(|data| data.insert_temp(id, grip));
        }
        let held: Option<Grip> = ui.data(|data| data.get_temp(id)).flatten();
        if response.drag_stopped() {
            ui.data_mut(|data| data.insert_temp::<Option<Grip>>(id, None));
        }
        let grip = held.filter(|_| response.dragged())?;
        let (pointer, delta) = (response.interact_pointer_pos(), response.drag_delta());
        let moved = pulled(projector, ball, grip, self.handles, pointer, delta);
        Some(moved.unwrap_or(ball))
    }

    fn grip_at(self, projector: &Projector, ball: Ball, place: Pos2) -> Option<Grip> {
        let near = |point: Vec3| projector.point(point).is_some_and(|p| p.distance(place) <= REACH);
        if self.is_sized && near(rim(projector, ball)) {
            return Some(Grip::Rim);
        }
        let axis = tips(ball).into_iter().find(|(_, tip)| near(*tip));
        axis.map(|(axis, _)| Grip::Axis(axis)).or_else(|| near(ball.centre).then_some(Grip::Centre))
    }

    /// Draws the axes, whose ends are round where they move and square where they scale, and the
    /// rim's handle.
    pub(super) fn paint(self, painter: &Painter, projector: &Projector, ball: Ball) {
        let Some(centre) = projector.point(ball.centre) else { return };
        let edge = Stroke::new(1.0, Color32::from_black_alpha(200));
        for (axis, tip) in tips(ball) {
            let Some(tip) = projector.point(tip) else { continue };
            let color = theme::axis_color(axis);
            painter.line_segment([centre, tip], Stroke::new(2.0, color));
            match self.handles {
                Handles::Move => {
                    painter.circle(tip, 6.0, color, edge);
                }
                Handles::Scale => square(painter, tip, color, edge),
            }
        }
        if let Some(rim) = projector.point(rim(projector, ball)).filter(|_| self.is_sized) {
            square(painter, rim, Color32::WHITE, edge);
        }
    }
}

/// The ends of the axes, beyond the ball.
fn tips(ball: Ball) -> [(Vec3, Vec3); 3] {
    [Vec3::X, Vec3::Y, Vec3::Z].map(|axis| (axis, ball.centre + ARM * ball.radius * axis))
}

/// A point of the rim as it is seen.
fn rim(projector: &Projector, ball: Ball) -> Vec3 {
    let lens = &projector.lens;
    ball.centre + ball.radius * (lens.right - lens.up).normalize_or_zero()
}

/// The ball after the hand has moved.
fn pulled(
    projector: &Projector,
    ball: Ball,
    grip: Grip,
    handles: Handles,
    pointer: Option<Pos2>,
    delta: egui::Vec2,
) -> Option<Ball> {
    let lens = &projector.lens;
    let depth = (ball.centre - lens.eye).dot(lens.forward);
    let unit = depth / projector.scale();
    let shift = unit * (delta.x * lens.right - delta.y * lens.up);
    let at_least = |radius: f32| radius.max(1e-3 * ball.radius);
    Some(match grip {
        Grip::Centre => Ball { centre: ball.centre + shift, ..ball },
        Grip::Axis(axis) => {
            // What the axis looks like on the screen decides how far the hand pulls along it.
            let [a, b] = [ball.centre, ball.centre + axis].map(|p| projector.point(p));
            let seen = b? - a?;
            let along = delta.dot(seen) / seen.length_sq().max(1e-6);
            match handles {
                Handles::Move => Ball { centre: ball.centre + along * axis, ..ball },
                // The tip stays under the hand.
                Handles::Scale => Ball { radius: at_least(ball.radius + along / ARM), ..ball },
            }
        }
        Grip::Rim => {
            let centre = projector.point(ball.centre)?;
            Ball { radius: at_least(unit * pointer?.distance(centre)), ..ball }
        }
    })
}

fn square(painter: &Painter, place: Pos2, color: Color32, edge: Stroke) {
    let square = Rect::from_center_size(place, vec2(10.0, 10.0));
    painter.rect_filled(square, 1.0, color);
    painter.rect_stroke(square, 1.0, edge, StrokeKind::Outside);
}

#[cfg(test)]
mod tests {
    use common::SelectorKind;
    use egui::accesskit::Role as WidgetRole;
    use egui_kittest::kittest::Queryable as _;

    use super::*;
    use crate::command::{Command, FilterCommand, SceneCommand};
    use crate::panel::tests::Fixture;
    use crate::panel::viewport::Viewport;
    use crate::value::Bounds;
    use crate::value::{Light, Sphere};

    /// What is said when the x axis of a ball of this radius in the middle is pulled outwards.
    fn pull(mut fixture: Fixture, radius: f32) -> Vec<Command> {
        let bounds = Bounds { min: Vec3::splat(-100.0), max: Vec3::splat(100.0) };
        fixture.camera.set_scene(bounds, None);
        let mut harness = fixture.harness();
        harness.run_steps(2);
        let view = harness.get_by_role_and_label(WidgetRole::Canvas, "Viewport").rect();
        let lens = harness.state().camera.lens(view.aspect_ratio());
        let projector = Projector::new(lens, view);
        let seen = |x: f32| projector.point(Vec3::new(x, 0.0, 0.0)).expect("before the eye");
        let (tip, beyond) = (seen(ARM * radius), seen(2.0 * ARM * radius));
        harness.drag_at(tip);
        harness.run_steps(1);
        harness.hover_at(beyond);
        harness.run_steps(2);
        harness.drop_at(beyond);
        harness.run_steps(1);
        harness.state().said.clone()
    }

    #[test]
    fn an_axis_moves_a_selector_or_scales_it() {
        for handles in Handles::ALL {
            let mut fixture = Fixture::new(Viewport::default());
            let sphere = Sphere { kind: SelectorKind::Any, place: [0.0, 0.0, 0.0, 30.0] };
            fixture.settings.filter.apply(&FilterCommand::Add(sphere));
            fixture.settings.scene.handles = handles;
            let said = pull(fixture, 30.0);
            let places: Vec<_> = said
                .iter()
                .map(|command| match command {
                    Command::Filter(FilterCommand::Move(0, place)) => *place,
                    other => panic!("{other} instead of a move"),
                })
                .collect();
            let moved = places.iter().any(|[x, ..]| *x > 5.0);
            let scaled = places.iter().any(|[.., radius]| *radius > 35.0);
            assert_eq!(
                (moved, scaled),
                match handles {
                    Handles::Move => (true, false),
                    Handles::Scale => (false, true),
                },
                "{handles}: {places:?}"
            );
        }
    }

    #[test]
    fn an_axis_moves_the_light() {
        let mut fixture = Fixture::new(Viewport::default());
        fixture.settings.scene.light = Light::At([0.0; 3]);
        // The light's handles are as long as a twentieth of the scene.
        let said = pull(fixture, 0.05 * Vec3::splat(100.0).length());
        let to_the_right = |c: &Command| matches!(c, Command::Scene(SceneCommand::Light(Light::At([x, ..]))) if *x > 1.0);
        assert!(said.iter().any(to_the_right), "{said:?}");
    }
}
