//! The parts of the window: each reads the [`World`] and returns [`Command`]s.
//!
//! To add a panel: its file, and its line in [`all`]; a name in
//! [`PanelName`] where the user may close it.

mod cloud;
mod conditions;
mod connect;
mod diagnostics;
mod explorer;
mod filter;
mod help;
mod hint;
mod image;
mod menu;
mod notice;
mod palette;
mod path;
mod playback;
mod scene;
mod statistics;
mod status;
#[cfg(test)]
mod tests;
mod viewport;
mod widgets;

use std::fmt::Debug;

use egui::{Frame, Margin, ScrollArea, Ui};

pub use notice::NOTICE_TIME;

use crate::command::{Command, PanelName};
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
    /// One of the sections on the left, which the user may close.
    Left(PanelName),
    /// One of the sections on the right, which the user may close.
    Right(PanelName),
    /// What is left of the window.
    Centre,
    /// On top of everything.
    Overlay,
}

/// Every panel, in the order in which they are laid out.
pub fn all() -> Vec<(Slot, Box<dyn Panel>)> {
    vec![
        (Slot::Top, Box::new(menu::Menu::default())),
        (Slot::Bottom, Box::new(status::StatusBar)),
        (Slot::Left(PanelName::Cloud), Box::new(cloud::Cloud)),
        (Slot::Left(PanelName::Filter), Box::new(filter::FilterPanel::default())),
        (Slot::Left(PanelName::Scene), Box::new(scene::Scene)),
        (Slot::Right(PanelName::Image), Box::new(image::ImagePanel::default())),
        (Slot::Right(PanelName::Path), Box::new(path::PathPanel)),
        (Slot::Right(PanelName::Explorer), Box::new(explorer::ExplorerPanel::default())),
        (Slot::Right(PanelName::Playback), Box::new(playback::PlaybackPanel)),
        (Slot::Right(PanelName::Statistics), Box::new(statistics::StatisticsPanel)),
        (Slot::Right(PanelName::Diagnostics), Box::new(diagnostics::DiagnosticsPanel)),
        (Slot::Centre, Box::new(viewport::Viewport)),
        (Slot::Overlay, Box::new(hint::Hint)),
        (Slot::Overlay, Box::new(notice::NoticePanel)),
        (Slot::Overlay, Box::new(help::Help)),
        (Slot::Overlay, Box::new(palette::Palette::default())),
    ]
}

/// Width of the left side in points.
const LEFT_WIDTH: f32 = 244.0;
/// Width of the right side in points.
const RIGHT_WIDTH: f32 = 352.0;

/// Lays out all panels.
pub fn show(
    panels: &mut [(Slot, Box<dyn Panel>)],
    ui: &mut Ui,
    world: &World<'_>,
    commands: &mut Vec<Command>,
) {
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
            Slot::Left(_) | Slot::Right(_) | Slot::Centre | Slot::Overlay => {}
        }
    }
    let open = |slot: Slot| match slot {
        Slot::Left(name) | Slot::Right(name) => {
            world.settings.layout.is_open(name) && world.has_use_for(name)
        }
        _ => false,
    };
    let is_left = |slot: Slot| matches!(slot, Slot::Left(_)) && open(slot);
    let is_right = |slot: Slot| matches!(slot, Slot::Right(_)) && open(slot);
    if panels.iter().any(|(slot, _)| is_left(*slot)) {
        let left = egui::Panel::left("left").frame(side).default_size(LEFT_WIDTH);
        left.size_range(200.0..=420.0)
            .show(ui, |ui| sections(ui, panels, is_left, world, commands));
    }
    if panels.iter().any(|(slot, _)| is_right(*slot)) {
        let right = egui::Panel::right("right").frame(side).default_size(RIGHT_WIDTH);
        right
            .size_range(300.0..=640.0)
            .show(ui, |ui| sections(ui, panels, is_right, world, commands));
    }
    for (slot, panel) in panels.iter_mut() {
        match slot {
            Slot::Centre => {
                egui::CentralPanel::no_frame().show(ui, |ui| panel.ui(ui, world, commands));
            }
            Slot::Overlay => panel.ui(ui, world, commands),
            Slot::Top | Slot::Bottom | Slot::Left(_) | Slot::Right(_) => {}
        }
    }
}

/// The sections of one side, each under its heading.
fn sections(
    ui: &mut Ui,
    panels: &mut [(Slot, Box<dyn Panel>)],
    wanted: impl Fn(Slot) -> bool,
    world: &World<'_>,
    commands: &mut Vec<Command>,
) {
    ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        for (slot, panel) in panels.iter_mut().filter(|(slot, _)| wanted(*slot)) {
            if let Slot::Left(name) | Slot::Right(name) = slot {
                widgets::heading(ui, *name, commands);
                ui.push_id(*name as usize, |ui| panel.ui(ui, world, commands));
                ui.add_space(14.0);
            }
        }
    });
}
