//! Mouse and held keys as camera commands.

use egui::{Key, PointerButton, Response, Ui, Vec2};

use crate::command::{CameraCommand, Command};
use crate::value::{KeyPreset, MousePreset};
use crate::world::World;

/// Degrees the view turns for a drag over the height of the viewport.
const TURN: f32 = 200.0;
/// Points of the wheel that come closer by a factor of e.
const WHEEL: f32 = 320.0;
/// Logarithm of how much closer a drag over the height of the viewport comes.
const CLOSER: f32 = 3.0;
/// Sizes of the scene flown a second.
const SPEED: f32 = 0.35;
/// How much faster with Shift.
const FASTER: f32 = 4.0;

/// What the user does with the viewport.
pub(super) fn read(ui: &Ui, response: &Response, world: &World<'_>, commands: &mut Vec<Command>) {
    let mut push = |command| commands.push(Command::Camera(command));
    if let Some(command) = drag(ui, response, world) {
        push(command);
    }
    if response.double_clicked() {
        push(CameraCommand::Frame);
    }
    if response.contains_pointer()
        && let Some(command) = wheel(ui, response)
    {
        push(command);
    }
    if world.camera.is_flying()
        && world.settings.window.keys == KeyPreset::Today
        && let Some(command) = flight(ui)
    {
        push(command);
    }
}

fn drag(ui: &Ui, response: &Response, world: &World<'_>) -> Option<CameraCommand> {
    let delta = response.drag_delta() / response.rect.height().max(1.0);
    if delta == Vec2::ZERO {
        return None;
    }
    match dragging(ui, response, world)? {
        Dragging::Turn => {}
        Dragging::Shift => return Some(CameraCommand::Pan(delta.x, -delta.y)),
        Dragging::Closer => {
            let factor = (CLOSER * (delta.x - delta.y)).exp().clamp(0.1, 10.0);
            return Some(CameraCommand::Zoom(factor, [0.0; 2]));
        }
    }
    // Screens count downwards; a drag to the right turns the scene to the right.
    Some(if world.camera.is_flying() {
        CameraCommand::Look(TURN * delta.x * 0.5, -TURN * delta.y * 0.5)
    } else {
        CameraCommand::Orbit(TURN * delta.x, -TURN * delta.y)
    })
}

/// What a drag does to the camera.
enum Dragging {
    Turn,
    Shift,
    Closer,
}

/// What this drag does; `None` where it is none of the camera's.
fn dragging(ui: &Ui, response: &Response, world: &World<'_>) -> Option<Dragging> {
    let modifiers = ui.input(|input| input.modifiers);
    let [left, middle, right] =
        [PointerButton::Primary, PointerButton::Middle, PointerButton::Secondary]
            .map(|button| response.dragged_by(button));
    if world.settings.window.keys == KeyPreset::Classic {
        return match () {
            () if modifiers.shift => Some(Dragging::Shift),
            () if right => Some(Dragging::Turn),
            () => None,
        };
    }
    match world.settings.window.mouse {
        MousePreset::Rerun if right || modifiers.shift => Some(Dragging::Shift),
        MousePreset::Rerun => Some(Dragging::Turn),
        MousePreset::Blender if middle && modifiers.shift => Some(Dragging::Shift),
        MousePreset::Blender if middle && modifiers.command => Some(Dragging::Closer),
        MousePreset::Blender => middle.then_some(Dragging::Turn),
        MousePreset::Maya if !modifiers.alt => None,
        MousePreset::Maya if left => Some(Dragging::Turn),
        MousePreset::Maya if middle => Some(Dragging::Shift),
        MousePreset::Maya => right.then_some(Dragging::Closer),
    }
}

fn wheel(ui: &Ui, response: &Response) -> Option<CameraCommand> {
    let (scroll, pinch) = ui.input(|i| (i.smooth_scroll_delta.y, i.zoom_delta()));
    let factor = (scroll / WHEEL).exp() * pinch;
    if factor == 1.0 {
        return None;
    }
    let half_height = (0.5 * response.rect.height()).max(1.0);
    let centre = response.rect.center();
    let at = response.hover_pos().map_or(Vec2::ZERO, |p| (p - centre) / half_height);
    Some(CameraCommand::Zoom(factor.clamp(0.1, 10.0), [at.x, -at.y]))
}

/// Steps while keys are held; time is what it took to draw the last frame.
fn flight(ui: &Ui) -> Option<CameraCommand> {
    if ui.ctx().egui_wants_keyboard_input() {
        return None;
    }
    let (step, seconds) = ui.input(|input| {
        let axis = |plus: Key, minus: Key| {
            f32::from(u8::from(input.key_down(plus))) - f32::from(u8::from(input.key_down(minus)))
        };
        let step = [axis(Key::W, Key::S), axis(Key::D, Key::A), axis(Key::E, Key::Q)];
        let speed = if input.modifiers.shift { SPEED * FASTER } else { SPEED };
        (step.map(|s| s * speed), input.stable_dt.min(0.1))
    });
    if step == [0.0; 3] {
        return None;
    }
    ui.ctx().request_repaint();
    Some(CameraCommand::Move(step.map(|s| s * seconds)))
}
