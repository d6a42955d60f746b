//! The parts of the window: each reads the [`World`] and returns [`Command`]s.
//!
//! To add a panel: its file, and its line in [`all`]; a name in
//! [`PanelName`] where the user may close it.

mod builder;
mod cloud;
mod connect;
mod copied;
mod diagnostics;
mod explorer;
mod filter;
mod heading;
mod help;
mod hint;
mod hover;
mod image;
mod menu;
mod notice;
mod palette;
mod path;
mod playback;
mod scene;
mod sheets;
mod statistics;
mod status;
#[cfg(test)]
mod tests;
mod viewport;
mod widgets;

use std::fmt::Debug;

use egui::text_selection::LabelSelectionState;
use egui::{Event, Frame, Id, Margin, Response, ScrollArea, Sense, Ui};

pub use copied::text as text_of;
pub use notice::NOTICE_TIME;

use crate::command::{
    Command, DeskCommand, LayoutCommand, Move, PanelName, Source, Switch, WindowSide,
};
use crate::settings::WIDTHS;
use crate::world::World;

/// A part of the window.
pub trait Panel: Debug {
    /// Shows itself and adds what the user asked for to `commands`.
    fn ui(&mut self, ui: &mut Ui, world: &World<'_>, commands: &mut Vec<Command>);
}

/// Where a panel lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Slot {
    /// A bar along the upper edge.
    Top,
    /// A bar along the lower edge.
    Bottom,
    /// One of the sections at the sides, which the user may close, fold and put elsewhere.
    Section(PanelName),
    /// What is left of the window.
    Centre,
    /// On top of everything.
    Overlay,
}

/// A panel and where it lies.
pub type Placed = (Slot, Box<dyn Panel>);

/// Every panel, in the order in which they are laid out.
pub fn all() -> Vec<Placed> {
    vec![
        (Slot::Top, Box::new(menu::Menu::default())),
        (Slot::Bottom, Box::new(status::StatusBar)),
        (Slot::Section(PanelName::Cloud), Box::new(cloud::Cloud)),
        (Slot::Section(PanelName::Filter), Box::new(filter::FilterPanel::default())),
        (Slot::Section(PanelName::Scene), Box::new(scene::Scene)),
        (Slot::Section(PanelName::Image), Box::new(image::ImagePanel::default())),
        (Slot::Section(PanelName::Path), Box::new(path::PathPanel::default())),
        (Slot::Section(PanelName::Explorer), Box::new(explorer::ExplorerPanel::default())),
        (Slot::Section(PanelName::Playback), Box::new(playback::PlaybackPanel)),
        (Slot::Section(PanelName::Statistics), Box::new(statistics::StatisticsPanel)),
        (Slot::Section(PanelName::Diagnostics), Box::new(diagnostics::DiagnosticsPanel)),
        (Slot::Centre, Box::new(viewport::Viewport::default())),
        (Slot::Overlay, Box::new(hint::Hint)),
        (Slot::Overlay, Box::new(notice::NoticePanel)),
        (Slot::Overlay, Box::new(help::Help)),
        (Slot::Overlay, Box::new(palette::Palette::default())),
    ]
}

/// Lays out all panels.
pub fn show(panels: &mut [Placed], ui: &mut Ui, world: &World<'_>, commands: &mut Vec<Command>) {
    hover::begin(ui.ctx());
    let bar = Frame::side_top_panel(ui.style()).inner_margin(Margin::symmetric(12, 5));
    let side = Frame::side_top_panel(ui.style()).inner_margin(Margin::symmetric(12, 8));
    for (slot, panel) in panels.iter_mut() {
        match slot {
            Slot::Top => {
                egui::Panel::top("top").frame(bar).show(ui, |ui| panel.ui(ui, world, commands));
            }
            Slot::Bottom => {
                egui::Panel::bottom("bottom")
                    .frame(bar)
                    .show(ui, |ui| panel.ui(ui, world, commands));
            }
            Slot::Section(_) | Slot::Centre | Slot::Overlay => {}
        }
    }
    for window_side in WindowSide::ALL {
        one_side(ui, (panels, side), window_side, world, commands);
    }
    for (slot, panel) in panels.iter_mut() {
        match slot {
            Slot::Centre => {
                egui::CentralPanel::no_frame().show(ui, |ui| panel.ui(ui, world, commands));
            }
            Slot::Overlay => panel.ui(ui, world, commands),
            Slot::Top | Slot::Bottom | Slot::Section(_) => {}
        }
    }
    hover::end(ui.ctx());
}

/// Height of the room below the last section, in points.
const FOOT: f32 = 40.0;

/// One side of the window, where it has anything to show. Its width is the user's.
fn one_side(
    ui: &mut Ui,
    (panels, frame): (&mut [Placed], Frame),
    side: WindowSide,
    world: &World<'_>,
    commands: &mut Vec<Command>,
) {
    let layout = &world.settings.layout;
    let is_shown = |name: &PanelName| layout.is_open(*name) && world.has_use_for(*name);
    let names: Vec<PanelName> = layout.side(side).filter(is_shown).collect();
    if names.is_empty() {
        return;
    }
    let width = layout.width(side);
    // The name tells the width, or a side would stay as wide as it first was.
    let id = Id::unique((side as usize, width));
    let panel = match side {
        WindowSide::Left => egui::Panel::left(id),
        WindowSide::Right => egui::Panel::right(id),
    };
    // A small window does not belong to one side alone.
    let most = (0.55 * ui.ctx().content_rect().width()).max(f32::from(*WIDTHS.start()));
    let range = f32::from(*WIDTHS.start())..=most.min(f32::from(*WIDTHS.end()));
    let panel = panel.frame(frame).default_size(f32::from(width)).size_range(range);
    let shown = panel.show(ui, |ui| sections(ui, (panels, &names), side, world, commands));
    let now = shown.response.rect.width().round();
    let let_go = ui.input(|input| input.pointer.any_released());
    if let_go && (now - f32::from(width)).abs() >= 2.0 && f32::from(width) <= most {
        let points = (now as u16).clamp(*WIDTHS.start(), *WIDTHS.end());
        commands.push(Command::Layout(LayoutCommand::Width(side, points)));
    }
}

/// The sections of one side, each under its heading.
fn sections(
    ui: &mut Ui,
    (panels, names): (&mut [Placed], &[PanelName]),
    side: WindowSide,
    world: &World<'_>,
    commands: &mut Vec<Command>,
) {
    ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        let mut pointed = None;
        for &name in names {
            let found = panels.iter_mut().find(|(slot, _)| *slot == Slot::Section(name));
            let Some((_, panel)) = found else { continue };
            let shown = ui.scope(|ui| {
                heading::show(ui, name, world, commands);
                if !world.settings.layout.is_folded(name) {
                    ui.push_id(name as usize, |ui| panel.ui(ui, world, commands));
                    ui.add_space(14.0);
                }
            });
            let above = shown.response.rect.top() - ui.min_rect().top();
            hold(ui, name, above);
            if ui.data(|data| data.get_temp(revealed())) == Some(name) {
                ui.data_mut(|data| data.remove::<PanelName>(revealed()));
                shown.response.scroll_to_me(Some(egui::Align::Min));
            }
            if shown.response.contains_pointer() {
                pointed = Some((name, above));
            }
            heading::receive(ui, &shown.response, name, commands);
            copy_by_key(ui, &shown.response, name, commands);
        }
        ui.data_mut(|data| data.insert_temp(ui.scope_id(), pointed));
        // What is dropped below the last one goes to the foot of the side.
        let foot = egui::vec2(ui.available_width(), FOOT);
        let (_, rest) = ui.allocate_exact_size(foot, Sense::hover());
        if let Some(dragged) = rest.dnd_release_payload::<PanelName>() {
            let place = match side {
                WindowSide::Left => Move::Left,
                WindowSide::Right => Move::Right,
            };
            commands.push(Command::Layout(LayoutCommand::Arrange(*dragged, place)));
        }
    });
}

/// Opens a section and scrolls to it: what someone asked to see appears there.
fn reveal(ui: &Ui, name: PanelName, world: &World<'_>, commands: &mut Vec<Command>) {
    let layout = &world.settings.layout;
    if !layout.is_open(name) {
        commands.push(Command::Layout(LayoutCommand::Panel(name, Switch::On)));
    }
    if layout.is_folded(name) {
        commands.push(Command::Layout(LayoutCommand::Fold(name, Switch::Off)));
    }
    ui.data_mut(|data| data.insert_temp(revealed(), name));
}

/// Where the section is kept that is to be scrolled to.
fn revealed() -> Id {
    Id::unique("revealed section")
}

/// Scrolls by as much as the sections above the one under the cursor have grown since the last frame,
/// which began it `above` points below the first: no button runs away from who is about to press it.
fn hold(ui: &Ui, name: PanelName, above: f32) {
    let pointed: Option<(PanelName, f32)> = ui.data(|data| data.get_temp(ui.scope_id())).flatten();
    if let Some((_, before)) =
        pointed.filter(|(pointed, before)| *pointed == name && *before != above)
    {
        let moved = egui::vec2(0.0, before - above);
        ui.scroll_with_delta_animation(moved, egui::style::ScrollAnimation::none());
    }
}

/// Ctrl+C over a section copies what it says, unless a text is selected or written.
fn copy_by_key(ui: &Ui, response: &Response, name: PanelName, commands: &mut Vec<Command>) {
    let ctx = ui.ctx();
    let is_copy = |event: &Event| matches!(event, Event::Copy);
    if !response.contains_pointer() || !ui.input(|input| input.events.iter().any(is_copy)) {
        return;
    }
    let selects = ctx.plugin::<LabelSelectionState>().lock().has_selection();
    if !selects && !ctx.egui_wants_keyboard_input() {
        ui.input_mut(|input| input.events.retain(|event| !is_copy(event)));
        commands.push(Command::Desk(DeskCommand::Copy(Source::Panel(name))));
    }
}
