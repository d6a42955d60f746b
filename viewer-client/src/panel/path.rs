//! Everything that is known of the selected path.

use common::{ExplorerCommand, Order, Seed, decode_normal};
use egui::{Button, Grid, Label, RichText, Sense, Ui};

use super::Panel;
use super::widgets::{dot, empty_state, row};
use crate::command::{Command, PathCommand, VertexStep};
use crate::format;
use crate::selection::{Names, Selection};
use crate::theme;
use crate::world::World;

/// The selected path.
#[derive(Debug)]
pub(super) struct PathPanel;

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
        figures(ui, selection, &names);
        ui.add_space(4.0);
        buttons(ui, selection, &names, commands);
        ui.add_space(4.0);
        vertices(ui, selection, &names, commands);
        if let Some(vertex) = selection.vertex {
            details(ui, selection, vertex, &names);
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
            ui.label(RichText::new(format!("{place} of {of} here")).small().weak());
        }
    });
    ui.horizontal(|ui| {
        let strategy = usize::from(selection.header.strategy.0);
        dot(ui, theme::strategy_color(strategy));
        ui.label(names.strategy(&selection.header));
        let id = selection.header.id;
        let text = format!("chain {}, step {}", id.chain.0, format::count(id.step as f64));
        ui.label(RichText::new(text).weak()).on_hover_text(format!("Path {id}"));
    });
}

fn figures(ui: &mut Ui, selection: &Selection, names: &Names<'_>) {
    let h = &selection.header;
    let [r, g, b] = h.rgb;
    let length: f64 =
        (1..selection.vertices.len()).filter_map(|i| selection.edge_length(i, names)).sum();
    let lines = [
        ("Luminance", format!("{:.4e}", h.luminance), "The path's value, 1 / S(x)"),
        ("Colour", format!("{r:.3}  {g:.3}  {b:.3}"), "Red, green, blue at unit luminance"),
        ("Film", format!("{:.4}  {:.4}", h.film[0], h.film[1]), "From the upper left corner"),
        ("Accepted at", format!("a = {:.4}", h.acceptance), "Of the proposal that made it"),
        ("Stayed", format!("{} steps", h.dwell), "Steps that the chain stayed here"),
        ("Length", format!("{length:.4}"), "All edges together, in the units of the scene file"),
    ];
    for (label, value, tip) in lines {
        row(ui, label, tip, |ui| ui.label(RichText::new(value).monospace()));
    }
}

fn buttons(ui: &mut Ui, selection: &Selection, names: &Names<'_>, commands: &mut Vec<Command>) {
    ui.horizontal(|ui| {
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

fn vertices(ui: &mut Ui, selection: &Selection, names: &Names<'_>, commands: &mut Vec<Command>) {
    let faint = |text: &str| Label::new(RichText::new(text).small().weak()).selectable(false);
    Grid::new("vertices").num_columns(4).striped(true).spacing([10.0, 3.0]).show(ui, |ui| {
        for title in ["", "event", "material", "position"] {
            ui.add(faint(title));
        }
        ui.end_row();
        for (i, vertex) in selection.vertices.iter().enumerate() {
            let name = RichText::new(format!("{} x{i}", vertex.kind.letter())).monospace().strong();
            let button = Button::new(name).frame(true).selected(selection.vertex == Some(i));
            if ui.add(button).on_hover_text("Look at this vertex").clicked() {
                let step = VertexStep::To(u8::try_from(i).unwrap_or(u8::MAX));
                commands.push(Command::Path(PathCommand::Vertex(step)));
            }
            ui.label(vertex.event.name());
            ui.add(Label::new(names.material(vertex)).truncate().sense(Sense::hover()));
            let p = names.world(vertex.position);
            let text = format!("{:.3} {:.3} {:.3}", p.x, p.y, p.z);
            ui.label(RichText::new(text).monospace().size(11.0));
            ui.end_row();
        }
    });
}

fn details(ui: &mut Ui, selection: &Selection, index: usize, names: &Names<'_>) {
    let Some(vertex) = selection.vertices.get(index) else { return };
    let p = names.world(vertex.position);
    let n = decode_normal(vertex.normal);
    ui.add_space(6.0);
    ui.label(RichText::new(format!("Vertex x{index}")).strong());
    let numbers = |x: f64, y: f64, z: f64| format!("{x:.6}  {y:.6}  {z:.6}");
    let mut lines = vec![
        ("Position", numbers(p.x, p.y, p.z)),
        ("Normal", numbers(f64::from(n.x), f64::from(n.y), f64::from(n.z))),
    ];
    if let Some(length) = selection.edge_length(index, names) {
        lines.push(("Edge before", format!("{length:.6}")));
    }
    if vertex.primitive != u32::MAX {
        lines.push(("Primitive", vertex.primitive.to_string()));
    }
    for (label, value) in lines {
        row(ui, label, "", |ui| ui.label(RichText::new(value).monospace()));
    }
}
