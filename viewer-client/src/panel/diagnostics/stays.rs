//! The paths at which chains stayed longest.

use common::{Diagnostics, ExplorerCommand, Order, PathHeader, PathId, Seed};
use egui::{Grid, RichText, Ui};

use crate::command::{Command, PathCommand};
use crate::panel::hover::{self, Pointed};
use crate::source::store::class_name;
use crate::value::format;
use crate::world::World;

/// Shows the longest stays.
pub(super) fn show(
    ui: &mut Ui,
    world: &World<'_>,
    diagnostics: &Diagnostics,
    commands: &mut Vec<Command>,
) {
    let Some(batch) = &diagnostics.longest else {
        ui.label("None yet.");
        return;
    };
    Grid::new("stays").num_columns(5).spacing([8.0, 3.0]).show(ui, |ui| {
        for (title, tip) in [
            (
                "steps",
                "How many steps a chain stayed here, because every proposal was rejected or failed",
            ),
            ("path", "The path's class: light, specular, diffuse, eye, starting at the light"),
            ("made by", "The strategy that proposed it"),
        ] {
            ui.label(RichText::new(title).small().weak()).on_hover_text(tip);
        }
        ui.end_row();
        let mut reader = batch.reader();
        let mut rank = 0;
        while let Some(path) = reader.next() {
            let header = path.header;
            let steps = RichText::new(format::count(f64::from(header.dwell))).monospace();
            let class = RichText::new(class_name(path.vertices)).monospace();
            let row = ui.label(steps).union(ui.label(class));
            let name = world.strategy_name(usize::from(header.strategy.0));
            let seed = header.strategy == PathHeader::NO_STRATEGY;
            let made_by = ui.label(if seed { "the seed" } else { name });
            let row = row.union(made_by);
            if row.contains_pointer() {
                hover::point(ui.ctx(), Pointed::Stay(rank.into()));
            }
            row.on_hover_text(format!(
                "Path {}; highlighted in the view and on the image",
                header.id
            ));
            jump(ui, rank, header.id, commands);
            ui.end_row();
            rank += 1;
        }
    });
}

/// Selects the path, or makes it the explorer's, to see what becomes of its proposals.
fn jump(ui: &mut Ui, rank: u8, id: PathId, commands: &mut Vec<Command>) {
    if ui.small_button("Show").on_hover_text("Select this path").clicked() {
        commands.push(Command::Path(PathCommand::Stay(rank)));
    }
    let tip = "Watch proposals from this path in the explorer";
    if ui.small_button("Explore").on_hover_text(tip).clicked() {
        let seed = ExplorerCommand::Seed(Seed::Path(id));
        commands.push(Command::Order(Order::Explorer(seed)));
    }
}
