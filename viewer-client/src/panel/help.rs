//! The sheet of keys.

use egui::{Align, Button, Frame, Grid, Id, Label, Layout, Modal, RichText, Ui, Vec2, vec2};

use super::Panel;
use super::widgets::scrolling_within;
use crate::command::{Command, WindowCommand};
use crate::keys::{Group, bindings, drags, key_name, mouse};
use crate::settings::WindowSettings;
use crate::value::Switch;
use crate::value::theme;
use crate::value::{Choice as _, KeyPreset, MousePreset};
use crate::world::World;

/// Widest that the sheet gets, in points.
const WIDTH: f32 = 1080.0;
/// Narrowest that a column of it may be, in points: a key, and a few words beside it.
const COLUMN: f32 = 270.0;
/// Points of the window that the lists leave free: for the rim, and for the heading above them.
const AROUND: Vec2 = vec2(60.0, 110.0);

/// A heading, and keys with what they do.
type List = (&'static str, Vec<(String, &'static str)>);

/// Every key and mouse button.
#[derive(Debug)]
pub(super) struct Help;

impl Panel for Help {
    fn ui(&mut self, ui: &mut Ui, world: &World<'_>, commands: &mut Vec<Command>) {
        if !world.settings.window.help {
            return;
        }
        let frame = Frame::popup(ui.style()).inner_margin(20);
        let modal = Modal::new(Id::unique("help"))
            .frame(frame)
            .show(ui.ctx(), |ui| sheet(ui, &world.settings.window, commands));
        if modal.should_close() || modal.inner {
            commands.push(Command::Window(WindowCommand::Help(Switch::Off)));
        }
    }
}

/// The sheet; true when its button was clicked.
fn sheet(ui: &mut Ui, window: &WindowSettings, commands: &mut Vec<Command>) -> bool {
    let size = ui.ctx().content_rect().size();
    ui.set_width((size.x - AROUND.x).min(WIDTH));
    let close = ui.horizontal(|ui| {
        ui.label(RichText::new("Keys and mouse").heading().strong());
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            ui.button("Close").on_hover_text("? or Escape").clicked()
        })
        .inner
    });
    ui.add_space(8.0);
    // The heading stays; all else scrolls where the window is low.
    scrolling_within(ui, size.y - AROUND.y, |ui| {
        lists(ui, window);
        choices(ui, window, commands);
    });
    close.inner
}

/// The lists, beside each other as far as there is room for their words.
fn lists(ui: &mut Ui, window: &WindowSettings) {
    let preset = window.keys;
    let dragged = match preset {
        KeyPreset::Today => drags(window.mouse),
        KeyPreset::Classic => &[],
    };
    let lines = mouse(preset).iter().chain(dragged);
    let lines = lines.map(|(key, help)| ((*key).to_owned(), *help)).collect();
    let of = |group: Group| (group.title(), keys(preset, group));
    let lists: [List; 5] = [
        ("Mouse", lines),
        of(Group::Camera),
        of(Group::Paths),
        of(Group::Explorer),
        of(Group::View),
    ];
    let many = ((ui.available_width() / COLUMN) as usize).clamp(1, 3);
    let places: [usize; 5] = match many {
        1 => [0; 5],
        2 => [0, 0, 0, 1, 1],
        _ => [0, 0, 1, 1, 2],
    };
    ui.columns(many, |columns| {
        for (place, (title, lines)) in places.into_iter().zip(lists) {
            if let Some(column) = columns.get_mut(place) {
                section(column, title, lines);
            }
        }
    });
}

/// Whose keys and whose mouse.
fn choices(ui: &mut Ui, window: &WindowSettings, commands: &mut Vec<Command>) {
    let text = "A path starts at the light and ends at the camera.";
    ui.label(RichText::new(text).weak());
    ui.horizontal_wrapped(|ui| {
        for preset in KeyPreset::ALL {
            let button = Button::selectable(preset == window.keys, preset.label());
            if ui.add(button).on_hover_text(preset.meaning()).clicked() {
                commands.push(Command::Window(WindowCommand::Keys(preset)));
            }
        }
        if window.keys == KeyPreset::Today {
            ui.add_space(12.0);
            mice(ui, window.mouse, commands);
        }
    });
}

/// What dragging with the mouse does.
fn mice(ui: &mut Ui, chosen: MousePreset, commands: &mut Vec<Command>) {
    ui.label(RichText::new("Mouse as in").weak());
    for preset in MousePreset::ALL {
        let button = Button::selectable(preset == chosen, preset.label());
        if ui.add(button).on_hover_text(preset.meaning()).clicked() {
            commands.push(Command::Window(WindowCommand::Mouse(preset)));
        }
    }
}

fn keys(preset: KeyPreset, group: Group) -> Vec<(String, &'static str)> {
    let of_group = bindings(preset).into_iter().filter(|b| b.group == group);
    of_group.map(|b| (key_name(b.shortcut), b.help)).collect()
}

fn section(ui: &mut Ui, title: &str, lines: Vec<(String, &'static str)>) {
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
