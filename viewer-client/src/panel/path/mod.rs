//! Everything that is known of the selected path.

mod splits;
mod vertices;

use std::time::Duration;

use common::{ExplorerCommand, Order, Seed};
use egui::{Color32, Label, RichText, Sense, Ui, vec2};

use super::Panel;
use super::widgets::{dot, empty_state, row};
use crate::command::{Command, PathCommand, VertexStep};
use crate::format;
use crate::selection::{Detail, Names, Selection};
use crate::theme;
use crate::world::World;

/// A daemon that has not answered for so long does not know the question.
const PATIENCE: Duration = Duration::from_secs(5);

/// The selected path.
#[derive(Debug, Default)]
pub(super) struct PathPanel {
    columns: vertices::Columns,
}

impl Panel for PathPanel {
    fn ui(&mut self, ui: &mut Ui, world: &World<'_>, commands: &mut Vec<Command>) {
        let Some(selection) = world.selection else {
            empty_state(
                ui,
                "No path selected",
                "Click one in the view; click again for the next one under the cursor.",
            );
            return;
        };
        let names = world.names();
        headline(ui, selection, &names);
        figures(ui, world, selection, &names);
        ui.add_space(4.0);
        buttons(ui, selection, &names, commands);
        ui.add_space(4.0);
        vertices::show(ui, &mut self.columns, (selection, &names), commands);
        match selection.numbers() {
            Some(detail) => splits::show(ui, selection, detail),
            None => without_numbers(ui, world, selection),
        }
    }
}

fn headline(ui: &mut Ui, selection: &Selection, names: &Names<'_>) {
    ui.horizontal(|ui| {
        let class = RichText::new(selection.class()).monospace().strong().size(16.0);
        ui.add(Label::new(class))
            .on_hover_text("Light first: L light, D diffuse, S specular, E eye");
        let (place, of) = selection.place;
        if of > 1 {
            let text = RichText::new(format!("{place} of {of} here")).small().weak();
            ui.label(text).on_hover_text("Click again in the view for the next one there");
        }
    });
    ui.horizontal(|ui| {
        let strategy = usize::from(selection.header.strategy.0);
        dot(ui, theme::strategy_color(strategy));
        ui.label(names.strategy(&selection.header))
            .on_hover_text("The strategy whose proposal it was");
        let id = selection.header.id;
        let text = format!("chain {}, step {}", id.chain.0, format::count(id.step as f64));
        ui.label(RichText::new(text).weak()).on_hover_text(format!("Path {id}"));
    });
}

fn figures(ui: &mut Ui, world: &World<'_>, selection: &Selection, names: &Names<'_>) {
    let h = &selection.header;
    let length: f64 =
        (1..selection.vertices.len()).filter_map(|i| selection.edge_length(i, names)).sum();
    let mono = |text: String| RichText::new(text).monospace();
    row(ui, "Luminance", "The path's value to a bidirectional path tracer, 1 / S(x)", |ui| {
        ui.label(mono(format!("{:.4e}", h.luminance)))
    });
    row(ui, "Colour", "Red, green, blue at unit luminance: what every splat of it carries", |ui| {
        swatch(ui, h.rgb);
        let [r, g, b] = h.rgb;
        ui.label(mono(format!("{r:.3}  {g:.3}  {b:.3}")))
    });
    let [width, height] = world.film.size();
    let pixel = |share: f32, side: usize| (share * side as f32) as usize;
    let pixels = match (width, height) {
        (0, _) | (_, 0) => String::new(),
        _ => format!("  pixel {}, {}", pixel(h.film[0], width), pixel(h.film[1], height)),
    };
    let lines = [
        (
            "Film",
            format!("{:.4}  {:.4}{pixels}", h.film[0], h.film[1]),
            "Shares of width and height, from the upper left corner",
        ),
        ("Accepted at", format!("a = {:.4}", h.acceptance), "Of the proposal that made it"),
        (
            "Stayed",
            format::steps(u64::from(h.dwell)),
            "Steps that the chain stayed here while shown",
        ),
        ("Length", format!("{length:.4}"), "All edges together, in the units of the scene file"),
    ];
    for (label, value, tip) in lines {
        row(ui, label, tip, |ui| ui.label(mono(value)));
    }
}

/// The colour, as bright as it fits.
fn swatch(ui: &mut Ui, rgb: [f32; 3]) {
    let most = rgb.into_iter().fold(f32::MIN_POSITIVE, f32::max);
    let [r, g, b] = rgb.map(|channel| (channel / most).clamp(0.0, 1.0));
    let (rect, _) = ui.allocate_exact_size(vec2(14.0, 14.0), Sense::hover());
    ui.painter().rect_filled(rect, 2.0, Color32::from(egui::Rgba::from_rgb(r, g, b)));
}

fn buttons(ui: &mut Ui, selection: &Selection, names: &Names<'_>, commands: &mut Vec<Command>) {
    ui.horizontal_wrapped(|ui| {
        let mut step = |ui: &mut Ui, label: &str, tip: &str, step: VertexStep| {
            if ui.button(label).on_hover_text(tip).clicked() {
                commands.push(Command::Path(PathCommand::Vertex(step)));
            }
        };
        step(ui, "Vertex before", "Towards the light (Shift+V)", VertexStep::Previous);
        step(ui, "Vertex after", "Towards the camera (V)", VertexStep::Next);
        if ui.button("Explore").on_hover_text("Perturb it step by step (Enter)").clicked() {
            let seed = ExplorerCommand::Seed(Seed::Path(selection.header.id));
            commands.push(Command::Order(Order::Explorer(seed)));
        }
        if ui.button("Copy").on_hover_text("Copy all this as text").clicked() {
            ui.ctx().copy_text(selection.text(names));
        }
        if ui.button("Deselect").on_hover_text("Select no path (Escape)").clicked() {
            commands.push(Command::Path(PathCommand::Deselect));
        }
    });
}

/// Why densities, throughputs and geometry terms are not shown.
fn without_numbers(ui: &mut Ui, world: &World<'_>, selection: &Selection) {
    let text = match &selection.detail {
        Detail::Known(_) => return,
        Detail::Unasked => "Not asked for yet: select the path again.".to_owned(),
        Detail::Asked(at) => {
            let waited = world.now.saturating_duration_since(*at);
            if let Some(left) = PATIENCE.checked_sub(waited) {
                ui.ctx().request_repaint_after(left);
                "The daemon is asked.".to_owned()
            } else {
                "The daemon does not answer; it may be older than this viewer.".to_owned()
            }
        }
        Detail::Missing(why) => format!("Not known: {why}"),
    };
    ui.add_space(6.0);
    let title = "Densities, throughputs, geometry terms, weights of the splits";
    ui.label(RichText::new(title).small().weak());
    ui.label(text);
}
