//! The first minute: what to try, until the user has seen it.

use egui::{Align2, Area, Frame, Grid, Id, Order, Rect, RichText, Ui, vec2};

use super::Panel;
use crate::command::{Command, WindowCommand};
use crate::value::Switch;
use crate::value::theme;
use crate::world::World;

/// What to try first, and what it does.
const STEPS: [(&str, &str); 5] = [
    ("Drag, wheel", "orbit the scene, zoom"),
    ("0", "look through the render camera"),
    ("C", "change what the colour of paths means"),
    ("Click the image", "show only the paths through that pixel"),
    ("F1", "list all keys and mouse buttons"),
];

/// Distance from the lower edge of the view, in points.
const MARGIN: f32 = 14.0;
/// In a narrower view, in points, there is no room beside the legend, only above it.
const NARROW: f32 = 640.0;
/// Height of the legend as it is at first, and of the axes, in points.
const LEGEND: f32 = 84.0;

/// What to try first.
#[derive(Debug)]
pub(super) struct Hint;

impl Panel for Hint {
    fn ui(&mut self, ui: &mut Ui, world: &World<'_>, commands: &mut Vec<Command>) {
        if !world.settings.window.hint || world.model.is_none() {
            return;
        }
        let view = ui.max_rect();
        Area::new(Id::unique("hint"))
            .order(Order::Middle)
            .pivot(Align2::CENTER_BOTTOM)
            .fixed_pos(view.center_bottom() - vec2(0.0, lift(view)))
            .show(ui.ctx(), |ui| card(ui, commands));
    }
}

/// How far above the lower edge of the view it lies: what the colours say stays to be seen.
fn lift(view: Rect) -> f32 {
    if view.width() < NARROW { MARGIN + LEGEND } else { MARGIN }
}

fn card(ui: &mut Ui, commands: &mut Vec<Command>) {
    Frame::popup(ui.style()).inner_margin(9).show(ui, |ui| {
        ui.spacing_mut().interact_size.y = 0.0;
        ui.horizontal(|ui| {
            let text = "The lines are light paths, drawn as the chains find them.";
            ui.label(RichText::new(text).small().strong());
            if ui.small_button("Got it").clicked() {
                commands.push(Command::Window(WindowCommand::Hint(Switch::Off)));
            }
        });
        let accent = theme::accent(ui.visuals().dark_mode);
        Grid::new("first steps").num_columns(2).spacing([10.0, 1.0]).show(ui, |ui| {
            for (action, effect) in STEPS {
                ui.label(RichText::new(action).small().strong().color(accent));
                ui.label(RichText::new(effect).small());
                ui.end_row();
            }
        });
    });
}
