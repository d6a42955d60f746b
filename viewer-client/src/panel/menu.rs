//! The bar at the head: menus, and what is being looked at.

use egui::containers::menu::{MenuButton, MenuConfig};
use egui::{Align, Button, Label, Layout, MenuBar, PopupCloseBehavior, RichText, Ui};

use super::connect::ConnectMenu;
use super::widgets::{capitalised, scrolling};
use super::{Panel, about};
use crate::command::{Command, LayoutCommand, WindowCommand};
use crate::keys::{Binding, Group, bindings, key_name};
use crate::value::theme;
use crate::value::{PanelName, Switch, ThemeChange};
use crate::world::World;

/// Menus.
#[derive(Debug, Default)]
pub(super) struct Menu {
    connection: ConnectMenu,
}

impl Panel for Menu {
    fn ui(&mut self, ui: &mut Ui, world: &World<'_>, commands: &mut Vec<Command>) {
        MenuBar::new().ui(ui, |ui| {
            let name = RichText::new("Lvis")
                .strong()
                .size(16.0)
                .color(theme::accent(ui.visuals().dark_mode));
            ui.add(Label::new(name).selectable(false));
            ui.add_space(8.0);
            let config = MenuConfig::new().close_behavior(PopupCloseBehavior::CloseOnClickOutside);
            MenuButton::new("Connection")
                .config(config)
                .ui(ui, |ui| scrolling(ui, |ui| self.connection.show(ui, world, commands)));
            for (name, of) in
                [("Camera", Group::Camera), ("Paths", Group::Paths), ("Explorer", Group::Explorer)]
            {
                ui.menu_button(name, |ui| scrolling(ui, |ui| group(ui, world, of, commands)));
            }
            ui.menu_button("View", |ui| {
                scrolling(ui, |ui| {
                    windows(ui, world, commands);
                    ui.separator();
                    group(ui, world, Group::View, commands);
                });
            });
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                right(ui, world, commands);
            });
        });
    }
}

/// Every key of a group, as a menu.
fn group(ui: &mut Ui, world: &World<'_>, group: Group, commands: &mut Vec<Command>) {
    let keys = bindings(world.settings.window.keys);
    for binding in keys.into_iter().filter(|b| b.group == group) {
        item(ui, world, binding, commands);
    }
}

fn item(ui: &mut Ui, world: &World<'_>, binding: &Binding, commands: &mut Vec<Command>) {
    let label = capitalised(binding.help);
    let key = key_name(binding.shortcut);
    if ui.add(Button::new(label).shortcut_text(key)).clicked() {
        commands.push(binding.command(world));
        ui.close();
    }
}

fn windows(ui: &mut Ui, world: &World<'_>, commands: &mut Vec<Command>) {
    for name in PanelName::ALL {
        let mut open = world.settings.layout.is_open(name);
        if ui.checkbox(&mut open, about(name).title).changed() {
            commands.push(Command::Layout(LayoutCommand::Panel(name, Switch::to(open))));
        }
    }
}

fn right(ui: &mut Ui, world: &World<'_>, commands: &mut Vec<Command>) {
    let (symbol, tip) = if world.settings.window.is_dark() {
        ("Light", "Switch to the light theme (T)")
    } else {
        ("Dark", "Switch to the dark theme (T)")
    };
    if ui.button(symbol).on_hover_text(tip).clicked() {
        commands.push(Command::Window(WindowCommand::Theme(ThemeChange::Toggle)));
    }
    if let Some(welcome) = &world.status.welcome {
        let tip = format!(
            "Scene {}, paths of up to {} edges, film of {} × {} pixels",
            welcome.scene_hash, welcome.max_edges, welcome.camera.width, welcome.camera.height
        );
        ui.add_space(4.0);
        ui.add(Label::new(RichText::new(&welcome.scene_name).strong()).selectable(false))
            .on_hover_text(tip);
        ui.add(Label::new(RichText::new("scene").weak()).selectable(false));
    }
}
