//! Which paths are shown: spheres, presets and the text, and what the daemon found.

use common::{Filter, FilterCounts, SelectorKind};
use egui::{Button, DragValue, Label, RichText, TextEdit, Ui};

use super::Panel;
use super::conditions::Builder;
use super::widgets::{dot, row, toggle};
use crate::command::{Command, FilterCommand, kind_name};
use crate::format;
use crate::theme;
use crate::world::World;

/// Light path expressions that people ask for most.
const PRESETS: [(&str, &str, &str); 5] = [
    ("All", "", "Every path"),
    ("Direct", "lpe \"CDL\"", "Direct light on something diffuse"),
    ("Indirect", "lpe \"CD{2,}L\"", "Light that went from one diffuse surface to another"),
    ("Caustics", "lpe \"C.*DS+L\"", "Light that mirrors or glass threw on something diffuse"),
    ("SDS", "lpe \"CS+DS+L\"", "Caustics seen in a mirror or through glass"),
];

/// The filter.
#[derive(Debug, Default)]
pub(super) struct FilterPanel {
    /// What is being written, and the text in force when that began.
    draft: String,
    of: String,
    builder: Builder,
}

impl Panel for FilterPanel {
    fn ui(&mut self, ui: &mut Ui, world: &World<'_>, commands: &mut Vec<Command>) {
        let mut filter = |command| commands.push(Command::Filter(command));
        presets(ui, world, &mut filter);
        self.text(ui, world, &mut filter);
        self.builder.ui(ui, world, &mut filter);
        selectors(ui, world, &mut filter);
        ui.horizontal(|ui| {
            let settings = &world.settings.filter;
            let tip = "Without it, all paths are shown";
            if let Some(switch) = toggle(ui, "On", tip, !settings.off) {
                filter(FilterCommand::Enable(switch));
            }
            let tip = "Show what the filter would leave out";
            if let Some(switch) = toggle(ui, "Invert", tip, settings.inverted) {
                filter(FilterCommand::Invert(switch));
            }
            let clear = Button::new("Clear");
            let tip = "Show all paths, and forget text and spheres";
            let any = !settings.text.is_empty() || !settings.selectors.is_empty();
            if ui.add_enabled(any, clear).on_hover_text(tip).clicked() {
                filter(FilterCommand::Clear);
            }
            if ui.button("Copy").on_hover_text("Copy the whole filter as text").clicked() {
                ui.ctx().copy_text(settings.wanted());
            }
        });
        found(ui, world);
    }
}

fn presets(ui: &mut Ui, world: &World<'_>, filter: &mut impl FnMut(FilterCommand)) {
    ui.horizontal_wrapped(|ui| {
        for (name, text, meaning) in PRESETS {
            let chosen = world.settings.filter.text == text;
            if ui.add(Button::selectable(chosen, name)).on_hover_text(meaning).clicked() {
                filter(FilterCommand::text(text.to_owned()));
            }
        }
    });
}

impl FilterPanel {
    fn text(&mut self, ui: &mut Ui, world: &World<'_>, filter: &mut impl FnMut(FilterCommand)) {
        let current = &world.settings.filter.text;
        if self.of != *current {
            self.of.clone_from(current);
            self.draft.clone_from(current);
        }
        let edit = TextEdit::multiline(&mut self.draft)
            .hint_text("any on material \"glass\" and edges >= 4")
            .desired_rows(2)
            .desired_width(f32::INFINITY)
            .return_key(egui::KeyboardShortcut::new(egui::Modifiers::SHIFT, egui::Key::Enter))
            .code_editor();
        let response = ui.add(edit).on_hover_text(
            "The filter's text; docs/FILTERS.md has its grammar. Enter sets it, Escape takes back.",
        );
        response.widget_info(|| {
            egui::WidgetInfo::labeled(egui::Role::TextInput, true, "Text of the filter")
        });
        let (enter, escape) =
            ui.input(|i| (i.key_pressed(egui::Key::Enter), i.key_pressed(egui::Key::Escape)));
        if response.has_focus() && escape {
            self.draft.clone_from(current);
        }
        if self.draft == *current {
            return;
        }
        match Filter::parse(&self.draft) {
            Err(error) => {
                let text = RichText::new(error.pointed(&self.draft)).monospace().small();
                ui.label(text.color(theme::BAD));
            }
            Ok(_) if response.lost_focus() || (response.has_focus() && enter) => {
                filter(FilterCommand::text(self.draft.trim().to_owned()));
            }
            Ok(_) => {
                ui.label(RichText::new("Enter sets it").small().weak());
            }
        }
    }
}

/// The spheres, one a line.
fn selectors(ui: &mut Ui, world: &World<'_>, filter: &mut impl FnMut(FilterCommand)) {
    let settings = &world.settings.filter;
    if settings.selectors.is_empty() {
        let [start, end, any, all] =
            world.settings.layout.keys.selectors().map(|(key, _)| key.name());
        let text = format!(
            "Point at a surface and press {start} for a sphere in which paths start, {end} for one \
             in which they end, {any} for any and {all} for all through which they pass.",
        );
        ui.add(Label::new(RichText::new(text).small().weak()).wrap());
        return;
    }
    for (number, sphere) in settings.selectors.iter().enumerate() {
        let number32 = number as u32;
        ui.horizontal(|ui| {
            dot(ui, theme::selector_color(sphere.kind));
            let chosen = settings.chosen == Some(number);
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

/// What the daemon found, and what is the matter where that is nothing.
fn found(ui: &mut Ui, world: &World<'_>) {
    let of_daemon = || world.status.statistics.as_ref().map(|s| &s.filter);
    let Some(counts) = world.counted.or_else(of_daemon) else { return };
    let reply = world.status.filter.as_ref();
    if let Some(error) = reply.and_then(|reply| reply.error.as_ref()) {
        ui.label(RichText::new(format!("Refused: {error}")).color(theme::BAD));
    }
    let shown = (world.settings.cloud.shown as usize).min(world.store.matched());
    let count = |n: u64| format::count(n as f64);
    let text = format!(
        "{} shown of {} matching of {} seen",
        format::count(shown as f64),
        count(counts.matched),
        count(counts.seen),
    );
    ui.label(text).on_hover_text("Since the filter was set; matching and seen are the daemon's");
    row(ui, "Energy", "Share of the image's light that matching paths carry", |ui| {
        let error = match counts.energy_error {
            error if error.is_finite() => format!(" ± {:.2}", 100.0 * error),
            _ => String::new(),
        };
        let text = format!("{:.2}{error} %", 100.0 * counts.energy_share);
        ui.label(RichText::new(text).monospace().strong());
    });
    let conditions = match (world.playback, world.store.filter()) {
        (Some(_), Some(filter)) => filter.condition_texts(),
        _ => reply.map(|reply| reply.conditions.as_slice()).unwrap_or_default(),
    };
    if counts.matched == 0 && counts.seen > 0 && !conditions.is_empty() {
        nothing_found(ui, counts, conditions);
    }
}

/// How near paths came to matching: what each condition alone lets through.
fn nothing_found(ui: &mut Ui, counts: &FilterCounts, conditions: &[String]) {
    ui.label(RichText::new("No path matches. Alone, these would let through:").color(theme::BUSY));
    let rarest = counts.conditions.iter().min().copied().unwrap_or(0);
    for (condition, &count) in conditions.iter().zip(&counts.conditions) {
        let share = format::percent(count as f64, counts.seen as f64);
        let text = RichText::new(format!("{share:>8}  {condition}")).monospace().small();
        let text = if count == rarest { text.strong() } else { text };
        ui.add(Label::new(text).truncate()).on_hover_text(condition);
    }
    let advice = if rarest == 0 {
        "The one at 0 is never met: make its region larger, or remove it."
    } else {
        "They are met, but not by one path: join them with `or`, or wait for rarer paths."
    };
    ui.label(RichText::new(advice).small().weak());
}

#[cfg(test)]
mod tests {
    use common::{FilterReply, Statistics};
    use egui_kittest::kittest::Queryable as _;

    use super::*;
    use crate::command::{Sphere, Switch};
    use crate::panel::tests::{Stage, shows};

    #[test]
    fn an_empty_result_names_the_nearest_miss() {
        let mut stage = Stage::new(FilterPanel::default());
        let sphere = Sphere { kind: SelectorKind::Any, place: [0.0, 1.0, 0.0, 0.5] };
        stage.settings.filter.apply(&FilterCommand::Add(sphere));
        stage.settings.filter.apply(&FilterCommand::Set("edges >= 4".to_owned()));
        let wanted = stage.settings.filter.wanted();
        assert!(Filter::parse(&wanted).is_ok(), "{wanted}");
        assert!(wanted.contains("sphere") && wanted.contains("edges"), "{wanted}");
        let counts = FilterCounts { seen: 1000, conditions: vec![0, 250], ..Default::default() };
        stage.status.statistics(Statistics { filter: counts, ..Statistics::default() });
        let conditions = ["any in sphere(0, 1, 0, 0.5)", "edges >= 4"].map(str::to_owned).to_vec();
        stage.status.filter = Some(FilterReply { conditions, ..FilterReply::default() });
        let mut harness = stage.harness();
        harness.run();
        for text in ["0 matching of 1.00 k seen", "No path matches", "never met", "any 1"] {
            assert!(shows(&harness, text), "`{text}` is missing");
        }
        for label in ["Caustics", "Invert", "Delete"] {
            harness.get_by_label(label).click();
            harness.run();
        }
        let expected = [
            FilterCommand::Set("lpe \"C.*DS+L\"".to_owned()),
            FilterCommand::Invert(Switch::On),
            FilterCommand::Delete(0),
        ];
        assert_eq!(harness.state().said, expected.map(Command::Filter));
    }

    #[test]
    fn what_is_wanted_follows_every_switch() {
        let mut filter = crate::settings::FilterSettings::default();
        assert_eq!(filter.wanted(), "", "all paths");
        filter.apply(&FilterCommand::Invert(Switch::On));
        assert_eq!(filter.wanted(), "", "there is nothing to invert");
        filter.apply(&FilterCommand::Set("edges == 2".to_owned()));
        assert_eq!(filter.wanted(), "not edges == 2");
        filter.apply(&FilterCommand::Enable(Switch::Off));
        assert_eq!(filter.wanted(), "", "switched off");
        for (name, text, _) in PRESETS {
            assert!(Filter::parse(text).is_ok(), "{name}");
        }
    }
}
