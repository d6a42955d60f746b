//! Everything that is known of the selected path.

mod align;
mod file;
mod light;
mod splits;
mod table;
mod vertices;

use std::time::Duration;

use common::{ExplorerCommand, Order, PathHeader, Seed};
use egui::{Button, Color32, Label, RichText, Sense, Ui, vec2};

use self::file::UNKNOWN;
use self::table::Described;
use super::widgets::{dot, empty_state, row};
use super::{Panel, Section};
use crate::command::{Command, PathCommand};
use crate::keys::Group;
use crate::source::dump::Outcome;
use crate::source::selection::Detail;
use crate::value::PanelName;
use crate::value::VertexStep;
use crate::value::format;
use crate::value::theme;
use crate::world::World;

/// A daemon that has not answered for so long does not know the question.
const PATIENCE: Duration = Duration::from_secs(5);
/// Why a file of paths has a dash where a daemon has a number.
const NOT_IN_FILE: &str = "A file of paths does not give it";

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
                "Click a path in the view; click again for the next one under the cursor.",
            );
            return;
        };
        let names = world.names();
        let path = Described { selection, names: &names, record: file::record(world, selection) };
        headline(ui, world, path);
        figures(ui, world, path);
        ui.add_space(4.0);
        buttons(ui, world, path, commands);
        ui.add_space(4.0);
        vertices::show(ui, &mut self.columns, path, commands);
        match selection.numbers() {
            Some(detail) => splits::show(ui, path, detail),
            None => without_numbers(ui, world, path),
        }
    }
}

impl Section for PathPanel {
    const NAME: PanelName = PanelName::Path;
    const TITLE: &'static str = "Selected path";
    const HELP: &'static [&'static str] = &[
        "Everything known about the path selected in the view. Click there again for the next one \
        under the cursor.",
    ];
    const KEYS: &'static [Group] = &[Group::Paths];

    fn text(world: &World<'_>) -> String {
        world.selection.map_or_else(String::new, |selection| selection.text(&world.names()))
    }
}

fn headline(ui: &mut Ui, world: &World<'_>, path: Described<'_>) {
    let Described { selection, names, record } = path;
    ui.horizontal(|ui| {
        let class = RichText::new(selection.class()).monospace().strong().size(16.0);
        ui.add(Label::new(class))
            .on_hover_text("From the light: L light, D diffuse, S specular, E eye");
        let (place, of) = selection.place;
        if of > 1 {
            let text = RichText::new(format!("{place} of {of} here")).small().weak();
            ui.label(text).on_hover_text("Click again in the view for the next path there");
        }
    });
    let is_silent = record.is_none_or(|record| record.outcome == Outcome::Recorded);
    if world.playback.is_some() && is_silent {
        let line = record.map_or_else(|| UNKNOWN.to_owned(), |record| record.line.to_string());
        let text = format!("Record of line {line}");
        let tip = "The file does not say which strategy, chain and step produced it";
        ui.label(RichText::new(text).weak()).on_hover_text(tip);
        return;
    }
    ui.horizontal(|ui| {
        let header = &selection.header;
        dot(ui, theme::strategy_color(usize::from(header.strategy.0)));
        // A step of a file need not name its mutation.
        let is_seed = record.is_none_or(|record| record.outcome == Outcome::Seed);
        let is_nameless = header.strategy == PathHeader::NO_STRATEGY && !is_seed;
        let strategy = if is_nameless { UNKNOWN } else { names.strategy(header) };
        ui.label(strategy).on_hover_text("The strategy whose proposal it was");
        let id = header.id;
        let text = format!("chain {}, step {}", id.chain.0, format::count(id.step as f64));
        ui.label(RichText::new(text).weak()).on_hover_text(format!("Path {id}"));
    });
}

fn figures(ui: &mut Ui, world: &World<'_>, path: Described<'_>) {
    let Described { selection, names, record } = path;
    let h = &selection.header;
    let in_file = world.playback.is_some();
    let length: f64 =
        (1..selection.vertices.len()).filter_map(|i| selection.edge_length(i, names)).sum();
    let mono = |text: String| RichText::new(text).monospace();
    let (value, tip) = luminance(path, in_file);
    row(ui, "Luminance", tip, |ui| ui.label(mono(value)));
    if in_file {
        row(ui, "Colour", NOT_IN_FILE, |ui| ui.label(mono(UNKNOWN.to_owned())));
    } else {
        let tip = "Red, green and blue at unit luminance: the colour of every splat of this path";
        row(ui, "Colour", tip, |ui| {
            swatch(ui, h.rgb);
            let [r, g, b] = h.rgb;
            ui.label(mono(format!("{r:.3}  {g:.3}  {b:.3}")))
        });
    }
    let [width, height] = match world.playback.map(|playback| playback.dump().camera) {
        Some(camera) => [camera.width as usize, camera.height as usize],
        None => world.film.size(),
    };
    let pixel = |share: f32, side: usize| (share * side as f32) as usize;
    let pixels = match (width, height) {
        (0, _) | (_, 0) => String::new(),
        _ => format!("  pixel {}, {}", pixel(h.film[0], width), pixel(h.film[1], height)),
    };
    let (acceptance, stay) = if in_file {
        (file::acceptance(record), file::stay(record))
    } else {
        (format!("a = {:.4}", h.acceptance), format::steps(u64::from(h.dwell)))
    };
    let lines = [
        (
            "Film",
            format!("{:.4}  {:.4}{pixels}", h.film[0], h.film[1]),
            "Shares of width and height, from the upper left corner",
        ),
        ("Accepted at", acceptance, "Acceptance probability of the proposal that made it"),
        ("Stayed", stay, "Steps that the chain stayed here while it was shown"),
        (
            "Length",
            format!("{length:.4}"),
            "Total length of all edges, in the units of the scene file",
        ),
    ];
    for (label, value, tip) in lines {
        row(ui, label, tip, |ui| ui.label(mono(value)));
    }
}

/// The path's value with what it measures.
fn luminance(path: Described<'_>, in_file: bool) -> (String, &'static str) {
    if in_file {
        return (UNKNOWN.to_owned(), NOT_IN_FILE);
    }
    (
        format::exact(path.names.luminance(&path.selection.header)),
        "The path's contribution as one sample of a bidirectional path tracer, 1 / S(x), in the \
        unit of the image: the mean over all samples is b, the image's mean luminance. It is not \
        the value of its pixel, to which many paths contribute",
    )
}

/// The colour, as bright as it fits.
fn swatch(ui: &mut Ui, rgb: [f32; 3]) {
    let most = rgb.into_iter().fold(f32::MIN_POSITIVE, f32::max);
    let [r, g, b] = rgb.map(|channel| (channel / most).clamp(0.0, 1.0));
    let (rect, _) = ui.allocate_exact_size(vec2(14.0, 14.0), Sense::hover());
    ui.painter().rect_filled(rect, 2.0, Color32::from(egui::Rgba::from_rgb(r, g, b)));
}

fn buttons(ui: &mut Ui, world: &World<'_>, path: Described<'_>, commands: &mut Vec<Command>) {
    let Described { selection, names, .. } = path;
    ui.horizontal_wrapped(|ui| {
        let mut step = |ui: &mut Ui, label: &str, tip: &str, step: VertexStep| {
            if ui.button(label).on_hover_text(tip).clicked() {
                commands.push(Command::Path(PathCommand::Vertex(step)));
            }
        };
        step(ui, "Vertex before", "Towards the light (Shift+V)", VertexStep::Previous);
        step(ui, "Vertex after", "Towards the camera (V)", VertexStep::Next);
        let explore = ui
            .add_enabled(world.playback.is_none(), Button::new("Explore"))
            .on_hover_text("Mutate it step by step in the explorer (Enter)")
            .on_disabled_hover_text(
                "A file of paths has no daemon that could explore; open the scene itself with \
                --scene",
            );
        if explore.clicked() {
            let seed = ExplorerCommand::Seed(Seed::Path(selection.header.id));
            commands.push(Command::Order(Order::Explorer(seed)));
        }
        if ui.button("Copy").on_hover_text("Copy all of this as text").clicked() {
            ui.ctx().copy_text(selection.text(names));
        }
        if ui.button("Deselect").on_hover_text("Clear the selection (Escape)").clicked() {
            commands.push(Command::Path(PathCommand::Deselect));
        }
    });
}

/// Why densities, throughputs and geometry terms are not shown.
fn without_numbers(ui: &mut Ui, world: &World<'_>, path: Described<'_>) {
    let selection = path.selection;
    let text = match &selection.detail {
        Detail::Known(_) => return,
        Detail::Unasked => "Not requested yet: select the path again.".to_owned(),
        Detail::Asked(at) => {
            let waited = world.now.saturating_duration_since(*at);
            if let Some(left) = PATIENCE.checked_sub(waited) {
                ui.ctx().request_repaint_after(left);
                "Waiting for the daemon.".to_owned()
            } else {
                "The daemon does not answer; it may be older than this viewer.".to_owned()
            }
        }
        Detail::Missing(why) => format!("Unknown: {why}"),
    };
    ui.add_space(6.0);
    let title = if path.record.is_some_and(file::tells_numbers) {
        "Throughputs, geometry terms, weights of the splits"
    } else {
        "Densities, throughputs, geometry terms, weights of the splits"
    };
    ui.label(RichText::new(title).small().weak());
    ui.label(text);
}
