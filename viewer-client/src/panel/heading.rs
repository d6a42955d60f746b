//! The heading of a section: folds it, moves it, explains it, copies it, closes it.

use std::sync::Arc;

use egui::collapsing_header::paint_default_icon;
use egui::containers::menu::MenuButton;
use egui::{Align, Button, Grid, Label, Layout, Response, RichText, Sense, Ui, vec2};

use super::about;
use super::widgets::scrolling;
use crate::command::{Command, DesktopCommand, LayoutCommand};
use crate::keys::{bindings, key_name};
use crate::settings::Layout as Settled;
use crate::value::theme;
use crate::value::{Move, PanelName, Part, Switch};
use crate::world::World;

/// Shows the heading of a section.
pub(super) fn show(ui: &mut Ui, name: PanelName, world: &World<'_>, commands: &mut Vec<Command>) {
    let folded = world.settings.layout.is_folded(name);
    let mut push = |command| commands.push(Command::Layout(command));
    let mut copy = false;
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 4.0;
        if title(ui, name, folded).clicked() {
            push(LayoutCommand::Fold(name, Switch::to(!folded)));
        }
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            let close = Button::new(RichText::new("×").weak().size(15.0)).frame(false);
            let tip = format!("Close; the View menu reopens {}", about(name).title);
            if ui.add(close).on_hover_text(tip).clicked() {
                push(LayoutCommand::Panel(name, Switch::Off));
            }
            copy = menu(ui, name, &world.settings.layout, &mut push);
            let mark = Button::new(RichText::new("?").weak()).frame(false);
            let menu = MenuButton::from_button(mark);
            let (response, _) = menu.ui(ui, |ui| scrolling(ui, |ui| sheet(ui, name, world)));
            response.on_hover_text(format!("About {}", about(name).title));
        });
    });
    if copy {
        commands.push(Command::Desktop(DesktopCommand::Copy(Part::Panel(name))));
    }
    let line = ui.visuals().widgets.noninteractive.bg_stroke;
    let (rect, _) = ui.allocate_exact_size(vec2(ui.available_width(), 5.0), Sense::hover());
    ui.painter().hline(rect.x_range(), rect.top(), line);
}

/// What can be done with a section; true when it is to be copied.
fn menu(
    ui: &mut Ui,
    name: PanelName,
    layout: &Settled,
    push: &mut impl FnMut(LayoutCommand),
) -> bool {
    let other = if layout.is_left(name) {
        ("Move to the right side", Move::Right)
    } else {
        ("Move to the left side", Move::Left)
    };
    let dots = Button::new(RichText::new("…").weak()).frame(false);
    let (response, shown) = MenuButton::from_button(dots).ui(ui, |ui| {
        let copy =
            ui.button("Copy as text").on_hover_text("Or press Ctrl+C over the section").clicked();
        ui.separator();
        for (label, step) in [("Move up", Move::Up), ("Move down", Move::Down), other] {
            if ui.button(label).clicked() {
                push(LayoutCommand::Arrange(name, step));
            }
        }
        if ui.button("Restore default layout").clicked() {
            push(LayoutCommand::Usual);
        }
        copy
    });
    response.on_hover_text(format!("Copy or move {}", about(name).title));
    shown.is_some_and(|shown| shown.inner)
}

/// The arrow and the name: a click folds, a drag moves.
fn title(ui: &mut Ui, name: PanelName, folded: bool) -> Response {
    let (_, arrow) = ui.allocate_exact_size(vec2(11.0, 11.0), Sense::hover());
    paint_default_icon(ui, if folded { 0.0 } else { 1.0 }, &arrow);
    let text = RichText::new(about(name).title).strong().size(14.0);
    let title = ui.add(Label::new(text).selectable(false).sense(Sense::click_and_drag()));
    title.dnd_set_drag_payload(name);
    let fold = if folded { "unfolds" } else { "folds" };
    title.on_hover_text(format!("Click {fold} it; drag to move it"))
}

/// Takes a section that was dragged here, and puts it before `name`.
pub(super) fn receive(ui: &Ui, response: &Response, name: PanelName, commands: &mut Vec<Command>) {
    let is_other = |dragged: &Arc<PanelName>| **dragged != name;
    if response.dnd_hover_payload::<PanelName>().as_ref().is_some_and(is_other) {
        let stroke = egui::Stroke::new(2.0, theme::ACCENT);
        ui.painter().hline(response.rect.x_range(), response.rect.top(), stroke);
    }
    if let Some(dragged) = response.dnd_release_payload::<PanelName>().filter(is_other) {
        commands.push(Command::Layout(LayoutCommand::Arrange(*dragged, Move::Before(name))));
    }
}

/// What a section is for, and its keys.
fn sheet(ui: &mut Ui, name: PanelName, world: &World<'_>) {
    ui.set_max_width(340.0);
    ui.label(RichText::new(about(name).title).strong().size(14.0));
    for line in about(name).help {
        ui.add(Label::new(*line).wrap());
    }
    let keys: Vec<_> = bindings(world.settings.window.keys)
        .into_iter()
        .filter(|binding| about(name).keys.contains(&binding.group))
        .collect();
    if keys.is_empty() {
        return;
    }
    ui.add_space(4.0);
    Grid::new("keys").num_columns(2).spacing([12.0, 3.0]).show(ui, |ui| {
        for binding in keys {
            ui.label(RichText::new(key_name(binding.shortcut)).monospace().strong());
            ui.add(Label::new(binding.help));
            ui.end_row();
        }
    });
}
