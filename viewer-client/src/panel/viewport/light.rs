//! The light of the preview in the view, where it stays at a point.

use egui::{Align2, Color32, FontId, Painter, Response, Stroke, Ui, vec2};

use super::handles::{Ball, Hold};
use super::project::Projector;
use crate::command::{Command, SceneCommand};
use crate::value::theme;
use crate::value::{Handles, Light};
use crate::world::World;

/// Half the length of its handles in radii of the scene.
const SIZE: f32 = 0.05;
/// How it is held.
const HOLD: Hold = Hold { name: "grip of the light", handles: Handles::Move, is_sized: false };
/// Rays of its picture.
const RAYS: usize = 8;

fn ball(world: &World<'_>) -> Option<Ball> {
    match world.settings.scene.light {
        Light::Camera => None,
        Light::At(place) => Some(Ball {
            centre: world.names().scene(place.into()).as_vec3(),
            radius: SIZE * world.camera.bounds().radius(),
        }),
    }
}

/// Takes the user's hand; true when it is on the light.
pub(super) fn interact(
    ui: &Ui,
    response: &Response,
    projector: &Projector,
    world: &World<'_>,
    commands: &mut Vec<Command>,
) -> bool {
    let Some(ball) = ball(world) else { return false };
    let Some(moved) = HOLD.pull(ui, response, projector, ball) else { return false };
    let place = world.names().world(moved.centre.into()).to_array();
    commands.push(Command::Scene(SceneCommand::Light(Light::At(place))));
    true
}

/// Draws a small sun with handles.
pub(super) fn paint(painter: &Painter, projector: &Projector, world: &World<'_>) {
    let Some(ball) = ball(world) else { return };
    let Some(centre) = projector.point(ball.centre) else { return };
    HOLD.paint(painter, projector, ball);
    let rim = Stroke::new(1.0, Color32::from_black_alpha(200));
    for ray in 0..RAYS {
        let (sin, cos) = (ray as f32 / RAYS as f32 * std::f32::consts::TAU).sin_cos();
        let away = vec2(cos, sin);
        let line = [centre + 8.0 * away, centre + 12.0 * away];
        painter.line_segment(line, Stroke::new(2.0, theme::LIGHT_END));
    }
    painter.circle(centre, 6.0, theme::LIGHT_END, rim);
    let place = centre + vec2(14.0, -8.0);
    let font = FontId::proportional(12.0);
    painter.text(place, Align2::LEFT_BOTTOM, "light", font, theme::LIGHT_END);
}
