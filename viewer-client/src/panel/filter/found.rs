//! What the daemon found, and what is the matter where that is nothing.

use common::{
    ExplorerCommand, Filter, FilterCounts, FilterText, NearestMiss, Order, Seed, Shortfall, Volume,
};
use egui::{FontFamily, Label, RichText, Ui};

use crate::command::{Command, FilterCommand};
use crate::panel::widgets::row;
use crate::settings::{FilterSettings, FilterSource};
use crate::value::Switch;
use crate::value::format;
use crate::value::theme;
use crate::world::World;

/// Shows counts and, where nothing matches, why and what to do.
pub(super) fn show(ui: &mut Ui, world: &World<'_>, commands: &mut Vec<Command>) {
    let Some(counts) = world.filter_counts() else { return };
    let reply = world.status.filter.as_ref();
    let bad = theme::bad(ui.visuals().dark_mode);
    if let Some(error) = reply.and_then(|reply| reply.error.as_ref()) {
        ui.add(Label::new(RichText::new(format!("Rejected: {}", error.message)).color(bad)).wrap());
    }
    let tip = "Since the filter was set; the daemon counts matching and seen paths";
    ui.add(Label::new(text(world, counts)).wrap()).on_hover_text(tip);
    row(ui, "Energy", "Share of the image's light carried by matching paths", |ui| {
        ui.label(RichText::new(energy(counts)).monospace().strong());
    });
    let conditions = match (world.playback, world.store.filter()) {
        (Some(_), Some(filter)) => filter.condition_texts(),
        _ => reply.map(|reply| reply.conditions.as_slice()).unwrap_or_default(),
    };
    if counts.matched == 0 && counts.seen > 0 && !conditions.is_empty() {
        nothing_found(ui, world, counts, conditions, commands);
    }
}

/// How many of how many paths.
pub(crate) fn text(world: &World<'_>, counts: &FilterCounts) -> String {
    let shown = (world.settings.cloud.shown as usize).min(world.store.matched());
    let [shown_text, matched, seen] =
        [shown as u64, counts.matched, counts.seen].map(|n| format::count(n as f64));
    if shown as u64 > counts.matched {
        // Some came before the filter, or after the daemon counted last.
        return format!(
            "{shown_text} shown; since the filter was set, {matched} of {seen} matched"
        );
    }
    format!("{shown_text} shown of {matched} matching of {seen} seen")
}

/// The share of the energy, with its error.
pub(crate) fn energy(counts: &FilterCounts) -> String {
    let error = match counts.energy_error {
        error if error.is_finite() && error > 0.0 => format!(" ± {:.2}", 100.0 * error),
        _ => String::new(),
    };
    format!("{:.2}{error} %", 100.0 * counts.energy_share)
}

/// How near paths came to matching, and what to do.
fn nothing_found(
    ui: &mut Ui,
    world: &World<'_>,
    counts: &FilterCounts,
    conditions: &[String],
    commands: &mut Vec<Command>,
) {
    ui.add_space(4.0);
    let busy = theme::busy(ui.visuals().dark_mode);
    ui.label(RichText::new("No path matches").strong().color(busy));
    if let Some(miss) = &counts.nearest {
        nearest(ui, world, miss, conditions, commands);
    }
    ui.horizontal_wrapped(|ui| {
        if !world.settings.filter.is_inverted()
            && ui.button("Invert").on_hover_text("Show the paths that are left out").clicked()
        {
            commands.push(Command::Filter(FilterCommand::Invert(Switch::On)));
        }
        if ui.button("Show all paths").on_hover_text("Switch the filter off").clicked() {
            commands.push(Command::Filter(FilterCommand::Enable(Switch::Off)));
        }
    });
    ui.label(RichText::new("Paths that meet each condition by itself:").small().weak());
    for (condition, &count) in conditions.iter().zip(&counts.conditions) {
        let share = format::percent(count as f64, counts.seen as f64);
        let text = RichText::new(format!("{share:>8}  {condition}"));
        let text = text.small().family(FontFamily::Monospace);
        let text = if count == 0 { text.strong() } else { text };
        ui.add(Label::new(text).truncate()).on_hover_text(condition);
    }
}

/// The path that came nearest, what it lacks, and what would let it through.
fn nearest(
    ui: &mut Ui,
    world: &World<'_>,
    miss: &NearestMiss,
    conditions: &[String],
    commands: &mut Vec<Command>,
) {
    ui.add(Label::new(explained(miss, conditions, &world.settings.filter)).wrap());
    let settings = &world.settings.filter;
    for failed in &miss.failed {
        ui.horizontal_wrapped(|ui| {
            for (label, tip, command) in remedies(settings, failed) {
                if ui.button(label).on_hover_text(tip).clicked() {
                    commands.push(Command::Filter(command));
                }
            }
        });
    }
    if world.playback.is_none() {
        let tip = "Start the explorer from this path, to step towards the paths you are looking \
            for";
        if ui.button("Explore from the nearest path").on_hover_text(tip).clicked() {
            let seed = ExplorerCommand::Seed(Seed::Path(miss.path));
            commands.push(Command::Order(Order::Explorer(seed)));
        }
    }
}

/// The nearest miss in words.
fn explained(miss: &NearestMiss, conditions: &[String], settings: &FilterSettings) -> String {
    if miss.failed.is_empty() {
        return "No path can match, because the filter is `false`.".to_owned();
    }
    let held = miss.asked.saturating_sub(miss.failed.len() as u32);
    let mut text = match miss.asked {
        1 => "The nearest path".to_owned(),
        asked => format!("{held} of {asked} conditions hold for the nearest path;"),
    };
    for (i, failed) in miss.failed.iter().enumerate() {
        let number = failed.condition as usize;
        let what = match settings.source(number) {
            Some(FilterSource::Sphere(number)) => format!("sphere {}", number + 1),
            _ => conditions.get(number).map_or_else(String::new, |text| format!("`{text}`")),
        };
        text.push_str(if i > 0 { ", and " } else { " " });
        let by = failed.by.map(|by| format!(" by {}", format::value(by as f32)));
        text.extend(["fails ", &what, by.as_deref().unwrap_or_default()]);
    }
    text.push('.');
    text
}

/// A button's label, its tip, and what it does.
type Remedy = (String, &'static str, FilterCommand);

/// What would let a path through that lacks this.
fn remedies(settings: &FilterSettings, failed: &Shortfall) -> Vec<Remedy> {
    let drop = "Remove this condition";
    match settings.source(failed.condition as usize) {
        Some(FilterSource::Sphere(number)) => {
            let name = format!("sphere {}", number + 1);
            let wider = failed.by.zip(settings.selectors().get(number)).and_then(|(by, sphere)| {
                let (_, Volume::Sphere { centre, radius }) = sphere.selector().volume.widened(by)
                else {
                    return None;
                };
                let place = [centre.x, centre.y, centre.z, radius];
                let tip = "Make it just large enough to include the nearest path";
                Some((format!("Widen {name}"), tip, FilterCommand::Move(number as u32, place)))
            });
            let delete = (format!("Delete {name}"), drop, FilterCommand::Delete(number as u32));
            wider.into_iter().chain([delete]).collect()
        }
        Some(FilterSource::Text(number)) => {
            let Ok(filter) = settings.text().tree() else { return Vec::new() };
            let set = |filter: Filter| FilterCommand::Set(FilterText::from(&filter));
            let leaf = filter.leaves().get(number).map(|leaf| (*leaf).clone());
            let wider = leaf.zip(failed.by).and_then(|(leaf, by)| {
                let (label, wide) = leaf.widened(by)?;
                let wider = filter.clone().with_leaf(number, |_| Some(wide));
                let tip = "Relax it just enough to include the nearest path";
                Some((label.to_owned(), tip, set(wider)))
            });
            let without = filter.clone().with_leaf(number, |_| None);
            let without = ("Drop this condition".to_owned(), drop, set(without));
            wider.into_iter().chain([without]).collect()
        }
        Some(FilterSource::Kept(number)) => {
            let Some(kept) = settings.kept().get(number) else { return Vec::new() };
            let off = FilterCommand::Use(Switch::Off, kept.name.clone());
            vec![(format!("Switch off {}", kept.name), "This is part of a kept filter", off)]
        }
        None => Vec::new(),
    }
}
