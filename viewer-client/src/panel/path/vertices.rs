//! The vertices of the selected path: a table of all, and everything of one.

use common::{PathDetail, VertexKind, VertexRecord, decode_normal};
use egui::{Button, Grid, Label, Response, RichText, Sense, Ui};

use crate::command::{Command, PathCommand, VertexStep};
use crate::format;
use crate::panel::hover::{self, Pointed};
use crate::panel::widgets::row;
use crate::selection::{Names, Selection};

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
    (selection, names): (&Selection, &Names<'_>),
    commands: &mut Vec<Command>,
) {
    let detail = selection.numbers();
    ui.horizontal(|ui| {
        let tip = "What happens at each vertex, on what, and where";
        ui.selectable_value(columns, Columns::Places, "Places").on_hover_text(tip);
        let tip = "Throughputs, densities and geometry terms, as the daemon knows them";
        ui.add_enabled_ui(detail.is_some(), |ui| {
            ui.selectable_value(columns, Columns::Light, "Light").on_hover_text(tip);
        });
    });
    match (*columns, detail) {
        (Columns::Light, Some(detail)) => light(ui, (selection, names), detail, commands),
        _ => places(ui, (selection, names), commands),
    }
    if let Some(index) = selection.vertex {
        ui.add_space(6.0);
        card(ui, selection, index, names);
    }
}

fn title(ui: &mut Ui, text: &str, tip: &str) {
    let title = Label::new(RichText::new(text).small().weak()).selectable(false);
    ui.add(title.sense(Sense::hover())).on_hover_text(tip);
}

/// A path with what its vertices are called.
type Described<'a> = (&'a Selection, &'a Names<'a>);

/// The name of a vertex: a click looks at it, and pointing at it marks it in the view.
fn name(ui: &mut Ui, path: Described<'_>, i: usize, commands: &mut Vec<Command>) {
    let (selection, _) = path;
    let Some(vertex) = selection.vertices.get(i) else { return };
    let name = RichText::new(format!("{} x{i}", vertex.kind.letter())).monospace().strong();
    let marked = hover::pointed(ui.ctx()) == Some(Pointed::Vertex(i));
    let button = Button::new(name).frame(true).selected(selection.vertex == Some(i) || marked);
    let response = ui.add(button);
    if response.clicked() {
        let step = VertexStep::To(u8::try_from(i).unwrap_or(u8::MAX));
        commands.push(Command::Path(PathCommand::Vertex(step)));
    }
    point(response, path, i);
}

/// Marks a vertex in the view while something of it is pointed at, and tells all of it.
fn point(response: Response, (selection, names): Described<'_>, i: usize) {
    if response.contains_pointer() {
        hover::point(&response.ctx, Pointed::Vertex(i));
    }
    response.on_hover_ui(|ui| card(ui, selection, i, names));
}

fn places(ui: &mut Ui, path: Described<'_>, commands: &mut Vec<Command>) {
    let (selection, names) = path;
    Grid::new("places").num_columns(4).striped(true).spacing([10.0, 3.0]).show(ui, |ui| {
        title(ui, "", "");
        title(ui, "event", "What scatters the light there");
        title(ui, "on", "The object, or else the material");
        title(ui, "position", "In the units of the scene file");
        ui.end_row();
        for (i, vertex) in selection.vertices.iter().enumerate() {
            name(ui, path, i, commands);
            point(ui.label(vertex.event.name()), path, i);
            let on = Label::new(shortened(on(vertex, names))).sense(Sense::hover());
            point(ui.add(on), path, i);
            let p = names.world(vertex.position);
            let text = format!("{:.3} {:.3} {:.3}", p.x, p.y, p.z);
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

fn light(ui: &mut Ui, path: Described<'_>, detail: &PathDetail, commands: &mut Vec<Command>) {
    Grid::new("light").num_columns(6).striped(true).spacing([9.0, 3.0]).show(ui, |ui| {
        title(ui, "", "");
        title(ui, "β light", "Luminance that a walk from the light carries when it has come here");
        title(ui, "β eye", "Luminance that a walk from the eye carries when it has come here");
        title(ui, "p light", "Density of making the vertex from the light side");
        title(ui, "p eye", "Density of making the vertex from the eye side");
        title(ui, "G", "Geometry term of the edge to the next vertex, in scene units");
        ui.end_row();
        for (i, vertex) in detail.vertices.iter().enumerate() {
            name(ui, path, i, commands);
            let walked = |density: f64, throughput: f64| {
                if density > 0.0 { format::exact(throughput) } else { "–".to_owned() }
            };
            let or_dash = |x: f64| if x > 0.0 { format::exact(x) } else { "–".to_owned() };
            let texts = [
                walked(vertex.light_pdf, detail.light_throughput(i).luminance()),
                walked(vertex.eye_pdf, detail.eye_throughput(i).luminance()),
                or_dash(vertex.light_pdf),
                or_dash(vertex.eye_pdf),
                detail.geometry.get(i).map_or(String::new(), |g| format::exact(*g)),
            ];
            for text in texts {
                point(ui.label(RichText::new(text).monospace().size(11.0)), path, i);
            }
            ui.end_row();
        }
    });
}

/// All that is known of one vertex.
fn card(ui: &mut Ui, selection: &Selection, index: usize, names: &Names<'_>) {
    let Some(vertex) = selection.vertices.get(index) else { return };
    let p = names.world(vertex.position);
    let n = decode_normal(vertex.normal);
    let what = format!("Vertex x{index}: {}", vertex.kind.name());
    ui.label(RichText::new(what).strong());
    let numbers = |x: f64, y: f64, z: f64| format!("{x:.6}  {y:.6}  {z:.6}");
    let mut lines = vec![
        ("Position", numbers(p.x, p.y, p.z), "In the units of the scene file"),
        ("Normal", numbers(n.x.into(), n.y.into(), n.z.into()), "Geometric, on the front side"),
        ("Event", vertex.event.name().to_owned(), "What scatters the light"),
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
        lines.extend(card_of_numbers(detail, index));
    }
    for (label, value, tip) in lines {
        row(ui, label, tip, |ui| ui.label(RichText::new(value).monospace()));
    }
}

type Line = (&'static str, String, &'static str);

fn card_of_numbers(detail: &PathDetail, index: usize) -> Vec<Line> {
    let Some(vertex) = detail.vertices.get(index) else { return Vec::new() };
    let walk = |pdf: f64, weight: f64| {
        if pdf > 0.0 {
            format!("p {pdf:.4e}   f/p {weight:.4e}")
        } else {
            "no walk makes it".to_owned()
        }
    };
    let color = |c: common::Rgb| format!("{:.3e}  {:.3e}  {:.3e}", c.r, c.g, c.b);
    let mut lines = vec![
        (
            "From light",
            walk(vertex.light_pdf, vertex.light_weight),
            "Density of making it from the light side, and value over density without colour",
        ),
        (
            "From eye",
            walk(vertex.eye_pdf, vertex.eye_weight),
            "Density of making it from the eye side, and value over density without colour",
        ),
    ];
    if vertex.light_pdf > 0.0 {
        let tip = "Throughput of a walk from the light that has come here: red, green, blue";
        lines.push(("β light", color(detail.light_throughput(index)), tip));
    }
    if vertex.eye_pdf > 0.0 {
        let tip = "Throughput of a walk from the eye that has come here: red, green, blue";
        lines.push(("β eye", color(detail.eye_throughput(index)), tip));
    }
    lines.push((
        "Colour",
        color(vertex.color),
        "What it gives to the path's colour: emission, reflectance or transmittance",
    ));
    if let Some(geometry) = detail.geometry.get(index) {
        let tip = "Geometry term of the edge to the next vertex, in scene units: cos cos / r²";
        lines.push(("G after", format!("{geometry:.6e}"), tip));
    }
    lines
}
