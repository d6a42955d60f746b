//! The sheet of keys.

use egui::{Align, Button, Frame, Grid, Id, Label, Layout, Modal, RichText, Ui};

use super::Panel;
use super::widgets::capitalised;
use crate::command::{Command, LayoutCommand, Switch};
use crate::keys::{Group, KeyPreset, MousePreset, bindings, key_name};
use crate::settings::Layout as Settled;
use crate::theme;
use crate::world::World;

/// Widest that the sheet gets, in points.
const WIDTH: f32 = 1080.0;

/// Every key and mouse button.
#[derive(Debug)]
pub(super) struct Help;

impl Panel for Help {
    fn ui(&mut self, ui: &mut Ui, world: &World<'_>, commands: &mut Vec<Command>) {
        if !world.settings.layout.help {
            return;
        }
        let frame = Frame::popup(ui.style()).inner_margin(20);
        let modal = Modal::new(Id::unique("help"))
            .frame(frame)
            .show(ui.ctx(), |ui| sheet(ui, &world.settings.layout, commands));
        if modal.should_close() || modal.inner {
            commands.push(Command::Layout(LayoutCommand::Help(Switch::Off)));
        }
    }
}

/// The sheet; true when its button was clicked.
fn sheet(ui: &mut Ui, layout: &Settled, commands: &mut Vec<Command>) -> bool {
    let preset = layout.keys;
    let width = (ui.ctx().content_rect().width() - 60.0).min(WIDTH);
    ui.set_width(width);
    ui.label(RichText::new("Keys and mouse").heading().strong());
    ui.add_space(8.0);
    ui.columns(3, |columns| {
        if let [left, middle, right] = columns {
            let drags = match preset {
                KeyPreset::Today => layout.mouse.drags(),
                KeyPreset::Classic => &[],
            };
            let mouse = preset.mouse().iter().chain(drags);
            let mouse = mouse.map(|(key, help)| ((*key).to_owned(), *help));
            section(left, "Mouse", mouse);
            section(left, Group::Camera.title(), keys(preset, Group::Camera));
            section(middle, Group::Paths.title(), keys(preset, Group::Paths));
            section(middle, Group::Explorer.title(), keys(preset, Group::Explorer));
            section(right, Group::View.title(), keys(preset, Group::View));
        }
    });
    ui.horizontal(|ui| {
        let text = "A path starts at the light and ends at the camera.";
        ui.label(RichText::new(text).weak());
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            let close = ui.button("Close").on_hover_text("? or Escape").clicked();
            for other in KeyPreset::ALL.into_iter().rev() {
                let (name, tip) = match other {
                    KeyPreset::Today => ("Today's keys", "Those of today's programs"),
                    KeyPreset::Classic => ("Keys of 2014", "Those of the first Lvis"),
                };
                let button = Button::selectable(preset == other, name);
                if ui.add(button).on_hover_text(tip).clicked() {
                    commands.push(Command::Layout(LayoutCommand::Keys(other)));
                }
            }
            if preset == KeyPreset::Today {
                ui.separator();
                mice(ui, layout.mouse, commands);
            }
            close
        })
        .inner
    })
    .inner
}

/// What dragging with the mouse does, from the right to the left.
fn mice(ui: &mut Ui, chosen: MousePreset, commands: &mut Vec<Command>) {
    for preset in MousePreset::ALL.into_iter().rev() {
        let name = capitalised(&preset.to_string());
        let first = preset.drags().first().map_or("", |(drag, _)| drag);
        let tip = format!("Drag as in {name}: {first} turns");
        let button = Button::selectable(preset == chosen, name);
        if ui.add(button).on_hover_text(tip).clicked() {
            commands.push(Command::Layout(LayoutCommand::Mouse(preset)));
        }
    }
    ui.label(RichText::new("Mouse as in").weak());
}

fn keys(preset: KeyPreset, group: Group) -> Vec<(String, &'static str)> {
    let of_group = bindings(preset).into_iter().filter(|b| b.group == group);
    of_group.map(|b| (key_name(b.shortcut), b.help)).collect()
}

fn section(ui: &mut Ui, title: &str, lines: impl IntoIterator<Item = (String, &'static str)>) {
    ui.label(RichText::new(title).strong().color(theme::accent(ui.visuals().dark_mode)));
    Grid::new(title).num_columns(2).spacing([14.0, 4.0]).show(ui, |ui| {
        for (key, help) in lines {
            ui.label(RichText::new(key).monospace().strong());
            ui.add(Label::new(help).wrap());
            ui.end_row();
        }
    });
    ui.add_space(8.0);
}
