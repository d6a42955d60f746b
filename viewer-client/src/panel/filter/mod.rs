//! Which paths are shown: presets, the text, its tree, spheres, kept filters, and what was found.

pub(crate) mod found;
mod kept;
mod text;

use common::{Filter, FilterText, Leaf, SelectorKind};
use egui::{Button, DragValue, Label, RichText, Ui};

use super::lines::Lines;
use super::widgets::{dot, toggle};
use super::{Panel, Section, builder};
use crate::command::{Command, FilterCommand};
use crate::keys;
use crate::value::PanelName;
use crate::value::kind_name;
use crate::value::theme;
use crate::world::World;

/// Light path expressions that people ask for most.
const PRESETS: [(&str, &str, &str); 5] = [
    ("All", "", "Every path"),
    ("Direct", "lpe \"CDL\"", "Direct light on something diffuse"),
    ("Indirect", "lpe \"CD{2,}L\"", "Light that travelled from one diffuse surface to another"),
    ("Caustics", "lpe \"C.*DS+L\"", "Light focused onto something diffuse by mirrors or glass"),
    ("SDS", "lpe \"CS+DS+L\"", "Caustics seen in a mirror or through glass"),
];

/// The filter.
#[derive(Debug, Default)]
pub(super) struct FilterPanel {
    draft: text::Draft,
    kept: kept::Kept,
}

impl Panel for FilterPanel {
    fn ui(&mut self, ui: &mut Ui, world: &World<'_>, commands: &mut Vec<Command>) {
        let mut filter = |command| commands.push(Command::Filter(command));
        presets(ui, world, &mut filter);
        self.draft.ui(ui, world, &mut filter);
        let leaves = world.settings.filter.text().tree().map(Filter::leaves).unwrap_or_default();
        if let Some(remark) = leaves.into_iter().find_map(Leaf::remark) {
            ui.add(Label::new(RichText::new(remark).small().weak()).wrap());
        }
        builder::ui(ui, world, &mut filter);
        selectors(ui, world, &mut filter);
        self.kept.ui(ui, world, &mut filter);
        switches(ui, world, &mut filter);
        found::show(ui, world, commands);
    }
}

impl Section for FilterPanel {
    const NAME: PanelName = PanelName::Filter;
    const TITLE: &'static str = "Filter";
    const HELP: &'static [&'static str] = &[
        "The daemon only sends paths that match the filter. Choose a preset, type the text, \
        combine conditions below it, or place spheres in the view: together they are one filter.",
        "Keep saves the filter under a name. The counts are exact; the energy is the share of the \
        image's light carried by matching paths.",
    ];

    fn text(world: &World<'_>) -> String {
        let mut lines = Lines::default();
        lines.put(format_args!("{}", world.settings.filter.whole()));
        let Some(counts) = world.filter_counts() else { return lines.text() };
        lines.put(format_args!("{}", found::text(world, counts)));
        lines.put(format_args!("energy\t{}", found::energy(counts)));
        let reply = world.status.filter.as_ref();
        let conditions = match (world.playback, world.store.filter()) {
            (Some(_), Some(filter)) => filter.condition_texts(),
            _ => reply.map(|reply| reply.conditions.as_slice()).unwrap_or_default(),
        };
        for (condition, count) in conditions.iter().zip(&counts.conditions) {
            lines.put(format_args!("{count}\t{condition}"));
        }
        lines.text()
    }
}

fn presets(ui: &mut Ui, world: &World<'_>, filter: &mut impl FnMut(FilterCommand)) {
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing.x = 2.0;
        for (name, text, meaning) in PRESETS {
            let chosen = world.settings.filter.text().text() == text;
            let tip =
                if text.is_empty() { meaning.to_owned() } else { format!("{meaning}: {text}") };
            if ui.add(Button::selectable(chosen, name)).on_hover_text(tip).clicked() {
                filter(FilterCommand::Set(FilterText::read(text)));
            }
        }
    });
}

fn switches(ui: &mut Ui, world: &World<'_>, filter: &mut impl FnMut(FilterCommand)) {
    let settings = &world.settings.filter;
    ui.horizontal_wrapped(|ui| {
        let tip = "If off, all paths are shown";
        if let Some(switch) = toggle(ui, "On", tip, !settings.is_off()) {
            filter(FilterCommand::Enable(switch));
        }
        let tip = "Show the paths that the text and spheres would leave out";
        if let Some(switch) = toggle(ui, "Invert", tip, settings.is_inverted()) {
            filter(FilterCommand::Invert(switch));
        }
        let clear = Button::new("Clear");
        let tip = "Show all paths: remove the text and the spheres";
        let any =
            !settings.whole().wants_all() || settings.is_off() || settings.complaint().is_some();
        if ui.add_enabled(any, clear).on_hover_text(tip).clicked() {
            filter(FilterCommand::Clear);
        }
        if ui.button("Copy").on_hover_text("Copy the whole filter as text").clicked() {
            ui.ctx().copy_text(settings.whole().text().to_owned());
        }
    });
}

/// The spheres, one a line.
fn selectors(ui: &mut Ui, world: &World<'_>, filter: &mut impl FnMut(FilterCommand)) {
    let settings = &world.settings.filter;
    if settings.selectors().is_empty() {
        let [start, end, any, all] =
            keys::selectors(world.settings.window.keys).map(|(key, _)| key.name());
        let text = format!(
            "Point at a surface and press {start} for a sphere in which paths start, {end} for \
            one in which they end, {any} for one in which they have a vertex, and {all} for one \
            that is required as well.",
        );
        ui.add(Label::new(RichText::new(text).small().weak()).wrap());
        return;
    }
    for (number, sphere) in settings.selectors().iter().enumerate() {
        let number32 = number as u32;
        ui.horizontal(|ui| {
            dot(ui, theme::selector_color(sphere.kind));
            let chosen = settings.chosen() == Some(number);
            let name = format!("{} {}", kind_name(sphere.kind), number + 1);
            let button = Button::selectable(chosen, name);
            if ui.add(button).on_hover_text(meaning(sphere.kind)).clicked() {
                filter(FilterCommand::Choose(number32));
            }
            let [x, y, z, mut radius] = sphere.place;
            let speed = radius * 0.01;
            let drag = DragValue::new(&mut radius)
                .speed(speed)
                .range(f64::MIN_POSITIVE..=1e12)
                .max_decimals(4)
                .prefix("r ");
            if ui.add(drag).on_hover_text("Radius, in the units of the scene file").changed() {
                filter(FilterCommand::Move(number32, [x, y, z, radius]));
            }
            if ui.button("Delete").on_hover_text("Remove this sphere").clicked() {
                filter(FilterCommand::Delete(number32));
            }
        });
    }
}

/// What a kind of selectors asks of paths.
pub(super) fn meaning(kind: SelectorKind) -> &'static str {
    match kind {
        SelectorKind::Start => "Paths that start, at the light, in any of these",
        SelectorKind::End => "Paths that end, at the camera, in any of these",
        SelectorKind::Any => "Paths with a vertex in any of these",
        SelectorKind::All => "Paths with a vertex in each of these",
    }
}

#[cfg(test)]
mod tests;
