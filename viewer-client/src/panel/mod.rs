//! The parts of the window: each reads the [`World`] and returns [`Command`]s.
//!
//! To add a section: its file, which says all about it ([`Section`]), with its `mod` and its line in
//! [`SECTIONS`]; and its name in [`PanelName`], by which commands call it.

mod builder;
mod cloud;
mod connect;
mod diagnostics;
mod explorer;
mod filter;
mod heading;
mod help;
mod hint;
mod hover;
mod image;
mod lines;
mod menu;
mod notice;
mod palette;
mod path;
mod playback;
mod scene;
mod section;
mod sides;
mod statistics;
mod status;
#[cfg(test)]
mod tests;
mod viewport;
mod widgets;

use std::fmt::Debug;

use egui::{Frame, Margin, Ui, UiBuilder};

pub use notice::NOTICE_TIME;
pub use section::{About, Section};

use crate::command::Command;
use crate::value::{PanelName, Part, WindowSide};
use crate::world::World;
use lines::Lines;
use sides::{Sides, Window, edge, one_side, reveal, reveal_pick};

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
    /// At one of the sides; see [`Section`].
    Section(PanelName),
    /// What is left of the window.
    Centre,
    /// On top of everything; its `Ui` is as large as the view.
    Overlay,
}

/// A panel and where it lies.
pub type Placed = (Slot, Box<dyn Panel>);

/// Every section.
pub static SECTIONS: &[About] = &[
    About::of::<cloud::Cloud>(),
    About::of::<filter::FilterPanel>(),
    About::of::<scene::Scene>(),
    About::of::<image::ImagePanel>(),
    About::of::<path::PathPanel>(),
    About::of::<explorer::ExplorerPanel>(),
    About::of::<playback::PlaybackPanel>(),
    About::of::<statistics::StatisticsPanel>(),
    About::of::<diagnostics::DiagnosticsPanel>(),
];

/// What a section says of itself.
pub fn about(name: PanelName) -> &'static About {
    // A test sees to it that there is one for every name.
    SECTIONS.iter().find(|about| about.name == name).unwrap_or(&SECTIONS[0])
}

/// Every panel, in the order in which they are laid out.
pub fn all() -> Vec<Placed> {
    let bars: [Placed; 2] =
        [(Slot::Top, Box::new(menu::Menu::default())), (Slot::Bottom, Box::new(status::StatusBar))];
    let sections = SECTIONS.iter().map(|about| (Slot::Section(about.name), (about.make)()));
    let rest: [Placed; 5] = [
        (Slot::Centre, Box::new(viewport::Viewport::default())),
        (Slot::Overlay, Box::new(hint::Hint)),
        (Slot::Overlay, Box::new(notice::NoticePanel)),
        (Slot::Overlay, Box::new(help::Help)),
        (Slot::Overlay, Box::new(palette::Palette::default())),
    ];
    bars.into_iter().chain(sections).chain(rest).collect()
}

/// The text of a part of the window; blank where it has nothing to say.
pub fn text_of(world: &World<'_>, part: Part) -> String {
    match part {
        Part::Status => status::text(world),
        Part::Settings => world.settings.commands().into_iter().collect::<Lines>().text(),
        Part::Panel(name) => (about(name).text)(world),
    }
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
    let sides = Sides::of(ui, world);
    let mut rects = [None; 2];
    for window_side in WindowSide::ALL {
        let window = &mut Window { panels: &mut *panels, world, commands: &mut *commands };
        rects[window_side as usize] = one_side(ui, window, side, window_side, &sides);
    }
    let mut view = ui.available_rect_before_wrap();
    for (slot, panel) in panels.iter_mut() {
        if *slot == Slot::Centre {
            let shown = egui::CentralPanel::no_frame().show(ui, |ui| panel.ui(ui, world, commands));
            view = shown.response.rect;
        }
    }
    // After the view, which would otherwise take the half of each edge that lies on its side.
    for window_side in WindowSide::ALL {
        if let Some(rect) = rects[window_side as usize] {
            edge(ui, window_side, rect, &sides, world, commands);
        }
    }
    let mut over = ui.new_child(UiBuilder::new().max_rect(view));
    for (slot, panel) in panels.iter_mut() {
        if *slot == Slot::Overlay {
            panel.ui(&mut over, world, commands);
        }
    }
    hover::end(ui.ctx());
}
