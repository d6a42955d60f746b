//! The vertices of the selected path: a table of all, and everything of one.

use common::{VertexKind, VertexRecord, decode_normal};
use egui::{Button, Grid, Label, Response, RichText, ScrollArea, Sense, Ui};

use super::align::{aligned, triples};
use super::table::{Described, Line, Table};
use super::{file, light};
use crate::command::{Command, PathCommand};
use crate::panel::hover::{self, Pointed};
use crate::panel::widgets::row;
use crate::source::selection::Names;
use crate::value::VertexStep;

/// Letters of a name in the table.
const LONGEST_NAME: usize = 13;

/// What the table shows of every vertex.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Columns {
    /// Event, material, object, position.
    #[default]
    Places,
    /// Throughput, densities, geometry term.
    Light,
}

/// Shows the table, and all of the vertex that is looked at; that of the others is in their tooltips.
pub(super) fn show(
    ui: &mut Ui,
    columns: &mut Columns,
    path: Described<'_>,
    commands: &mut Vec<Command>,
) {
    let detail = path.selection.numbers();
    let record = path.record.filter(|record| file::tells_numbers(record));
    ui.horizontal(|ui| {
        let tip = "What happens at each vertex, on what, and where";
        ui.selectable_value(columns, Columns::Places, "Places").on_hover_text(tip);
        let tip = if record.is_some() {
            "Densities and weights, as given in the file"
        } else {
            "Throughputs, densities and geometry terms, computed by the daemon"
        };
        ui.add_enabled_ui(detail.is_some() || record.is_some(), |ui| {
            ui.selectable_value(columns, Columns::Light, "Light")
                .on_hover_text(tip)
                .on_disabled_hover_text("The text below says why they are missing");
        });
    });
    // What is too wide for the side scrolls: it would widen the side with every frame.
    ScrollArea::horizontal().id_salt("vertices").show(ui, |ui| match (*columns, detail, record) {
        (Columns::Light, Some(detail), _) => numbers(ui, path, &light::table(detail), commands),
        (Columns::Light, None, Some(record)) => numbers(ui, path, &file::table(record), commands),
        _ => places(ui, path, commands),
    });
    if let Some(index) = path.selection.vertex {
        ui.add_space(6.0);
        card(ui, path, index);
    }
}

/// The name of a column, with what it means.
fn title(ui: &mut Ui, text: &str, tip: &str) {
    let title = Label::new(RichText::new(text).small().weak()).selectable(false);
    ui.add(title.sense(Sense::hover())).on_hover_text(tip);
}

/// The name of a vertex: a click looks at it, and pointing at it marks it in the view.
fn name(ui: &mut Ui, path: Described<'_>, i: usize, commands: &mut Vec<Command>) {
    let Some(vertex) = path.selection.vertices.get(i) else { return };
    let name = RichText::new(format!("{} x{i}", vertex.kind.letter())).monospace().strong();
    let marked = hover::pointed(ui.ctx()) == Some(Pointed::Vertex(i));
    let button = Button::new(name).frame(true).selected(path.selection.vertex == Some(i) || marked);
    let response = ui.add(button);
    if response.clicked() {
        let step = VertexStep::To(u8::try_from(i).unwrap_or(u8::MAX));
        commands.push(Command::Path(PathCommand::Vertex(step)));
    }
    point(response, path, i);
}

/// Marks a vertex in the view while something of it is pointed at, and tells all of it.
fn point(response: Response, path: Described<'_>, i: usize) {
    if response.contains_pointer() {
        hover::point(&response.ctx, Pointed::Vertex(i));
    }
    response.on_hover_ui(|ui| card(ui, path, i));
}

/// A row a vertex; the points of the numbers of a column stand below each other.
fn numbers(ui: &mut Ui, path: Described<'_>, table: &Table, commands: &mut Vec<Command>) {
    let Table { name: id, columns } = table;
    let grid = Grid::new(id).num_columns(1 + columns.len()).striped(true).spacing([9.0, 3.0]);
    grid.show(ui, |ui| {
        title(ui, "", "");
        for column in columns {
            title(ui, column.title, &column.tip);
        }
        ui.end_row();
        let columns: Vec<_> = columns.iter().map(|column| aligned(&column.values)).collect();
        for i in 0..path.selection.vertices.len() {
            name(ui, path, i, commands);
            for column in &columns {
                let text = column.get(i).map_or("", String::as_str);
                point(ui.label(RichText::new(text).monospace().size(11.0)), path, i);
            }
            ui.end_row();
        }
    });
}

fn places(ui: &mut Ui, path: Described<'_>, commands: &mut Vec<Command>) {
    let Described { selection, names, .. } = path;
    let position = |vertex: &VertexRecord| names.world(vertex.position).to_array();
    let rows: Vec<[f64; 3]> = selection.vertices.iter().map(position).collect();
    let positions = triples(&rows, 3);
    Grid::new("places").num_columns(4).striped(true).spacing([10.0, 3.0]).show(ui, |ui| {
        title(ui, "", "");
        title(ui, "event", "How the light is scattered there");
        title(ui, "on", "The object or, if it has no name, the material");
        title(ui, "position", "x, y and z in the units of the scene file");
        ui.end_row();
        for (i, (vertex, text)) in selection.vertices.iter().zip(positions).enumerate() {
            name(ui, path, i, commands);
            point(ui.label(vertex.event.name()), path, i);
            let on = Label::new(shortened(on(vertex, names))).sense(Sense::hover());
            point(ui.add(on), path, i);
            point(ui.label(RichText::new(text).monospace().size(11.0)), path, i);
            ui.end_row();
        }
    });
}

/// A name that fits into the table; the tooltip has the whole one.
fn shortened(name: &str) -> String {
    if name.chars().count() <= LONGEST_NAME {
        return name.to_owned();
    }
    name.chars().take(LONGEST_NAME - 1).chain(['…']).collect()
}

/// What a vertex lies on.
fn on<'a>(vertex: &VertexRecord, names: &'a Names<'_>) -> &'a str {
    match names.object(vertex) {
        Some(object) => object,
        None if vertex.kind == VertexKind::Eye => "lens",
        None => names.material(vertex),
    }
}

/// All that is known of one vertex.
fn card(ui: &mut Ui, path: Described<'_>, index: usize) {
    let Described { selection, names, record } = path;
    let Some(vertex) = selection.vertices.get(index) else { return };
    let normal = decode_normal(vertex.normal);
    let rows = [names.world(vertex.position), normal.as_dvec3()].map(|v| v.to_array());
    let mut rows = triples(&rows, 6).into_iter();
    let what = format!("Vertex x{index}: {}", vertex.kind.name());
    ui.label(RichText::new(what).strong());
    let mut next = || rows.next().unwrap_or_default();
    let mut lines: Vec<Line> = vec![
        ("Position", next(), "In the units of the scene file"),
        ("Normal", next(), "Geometric unit normal on the front side"),
        ("Event", vertex.event.name().to_owned(), "How the light is scattered"),
        ("Material", names.material(vertex).to_owned(), "Its name in the scene file"),
        ("Object", names.object(vertex).unwrap_or("–").to_owned(), "Its name in the scene file"),
    ];
    if let Some(length) = selection.edge_length(index, names) {
        let tip = "Length of the edge towards the light, in the units of the scene file";
        lines.push(("Edge before", format!("{length:.6}"), tip));
    }
    if vertex.primitive != u32::MAX {
        lines.push(("Primitive", vertex.primitive.to_string(), "Its number in the scene"));
    }
    if let Some(detail) = selection.numbers() {
        lines.extend(light::lines(path, detail, index));
    }
    if let Some(record) = record {
        lines.extend(file::lines(record, index));
    }
    for (label, value, tip) in lines {
        row(ui, label, tip, |ui| ui.label(RichText::new(value).monospace()));
    }
}
