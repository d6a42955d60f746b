//! The first minute: what to try, until the user has seen it.

use egui::{Align2, Area, Frame, Grid, Id, Label, Order, RichText, Ui, vec2};

use super::Panel;
use crate::command::{Command, LayoutCommand, Switch};
use crate::theme;
use crate::world::World;

/// What to try first, and what it does.
const STEPS: [(&str, &str); 5] = [
    ("Drag, wheel", "turn the scene, come closer"),
    ("0", "look through the render camera"),
    ("C", "colour the paths by something else"),
    ("Click the image", "show only the paths to that pixel"),
    ("F1", "every key and mouse button"),
];

/// What to try first.
#[derive(Debug)]
pub(super) struct Hint;

impl Panel for Hint {
    fn ui(&mut self, ui: &mut Ui, world: &World<'_>, commands: &mut Vec<Command>) {
        if !world.settings.layout.hint || world.model.is_none() {
            return;
        }
        Area::new(Id::unique("hint"))
            .order(Order::Middle)
            .anchor(Align2::CENTER_TOP, vec2(0.0, 56.0))
            .show(ui.ctx(), |ui| card(ui, commands));
    }
}

fn card(ui: &mut Ui, commands: &mut Vec<Command>) {
    Frame::popup(ui.style()).inner_margin(16).show(ui, |ui| {
        ui.set_max_width(400.0);
        let text = "These lines are paths of light, as Metropolis chains find them.";
        ui.label(RichText::new(text).strong());
        ui.add_space(4.0);
        Grid::new("first steps").num_columns(2).spacing([14.0, 4.0]).show(ui, |ui| {
            for (action, effect) in STEPS {
                ui.label(
                    RichText::new(action).strong().color(theme::accent(ui.visuals().dark_mode)),
                );
                ui.add(Label::new(effect).wrap());
                ui.end_row();
            }
        });
        ui.add_space(4.0);
        if ui.button("Got it").clicked() {
            commands.push(Command::Layout(LayoutCommand::Hint(Switch::Off)));
        }
    });
}
