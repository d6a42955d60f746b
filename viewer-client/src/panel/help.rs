//! The sheet of keys.

use egui::{Align2, Grid, RichText, Ui, Window, vec2};

use super::Panel;
use crate::command::{Command, LayoutCommand, Switch};
use crate::keys::{BINDINGS, Group, MOUSE};
use crate::world::World;

/// Every key and mouse button.
#[derive(Debug)]
pub(super) struct Help;

impl Panel for Help {
    fn ui(&mut self, ui: &mut Ui, world: &World<'_>, commands: &mut Vec<Command>) {
        let mut open = world.settings.layout.help;
        if !open {
            return;
        }
        Window::new("Keys and mouse")
            .open(&mut open)
            .collapsible(false)
            .resizable(false)
            .anchor(Align2::CENTER_CENTER, vec2(0.0, 0.0))
            .show(ui.ctx(), |ui| {
                ui.horizontal_top(|ui| {
                    ui.vertical(|ui| {
                        section(ui, "Mouse", MOUSE.map(|(k, h)| (k.to_owned(), h)));
                        section(ui, Group::Paths.title(), keys(ui, Group::Paths));
                    });
                    ui.add_space(28.0);
                    ui.vertical(|ui| section(ui, Group::Camera.title(), keys(ui, Group::Camera)));
                    ui.add_space(28.0);
                    ui.vertical(|ui| section(ui, Group::View.title(), keys(ui, Group::View)));
                });
                ui.add_space(6.0);
                let text = "A path starts at the light and ends at the camera.";
                ui.label(RichText::new(text).weak());
            });
        if !open {
            commands.push(Command::Layout(LayoutCommand::Help(Switch::Off)));
        }
    }
}

fn keys(ui: &Ui, group: Group) -> Vec<(String, &'static str)> {
    let of_group = BINDINGS.iter().filter(|b| b.group == group);
    of_group.map(|b| (ui.ctx().format_shortcut(&b.shortcut), b.help)).collect()
}

fn section(ui: &mut Ui, title: &str, lines: impl IntoIterator<Item = (String, &'static str)>) {
    ui.label(RichText::new(title).strong());
    Grid::new(title).num_columns(2).spacing([14.0, 4.0]).show(ui, |ui| {
        for (key, help) in lines {
            ui.label(RichText::new(key).monospace().strong());
            ui.label(help);
            ui.end_row();
        }
    });
    ui.add_space(8.0);
}
