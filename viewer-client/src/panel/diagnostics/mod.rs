//! Whether the chains can be believed: agreement, memory, acceptance, failures, and where they stay.

mod fates;
mod plots;
mod stays;

use common::{Diagnostics, Statistics};
use egui::{Label, RichText, Ui};

use super::image::layer_button;
use super::lines::Lines;
use super::widgets::{dot, empty_state, reading};
use super::{Panel, Section, reveal};
use crate::command::{Command, FilterCommand, ImageCommand};
use crate::settings::region::{self, Region};
use crate::value::format;
use crate::value::theme;
use crate::value::{Layer, PanelName};
use crate::world::World;

/// Potential scale reduction above which chains do not agree [Gelman and Rubin 1992].
const DISAGREEMENT: f32 = 1.1;
/// Share of the steps that a tile must hold for its disagreement to matter, relative to the mean.
const WORTH_A_LOOK: f32 = 0.05;

/// Diagnostics of the chains.
#[derive(Debug, Default)]
pub(super) struct DiagnosticsPanel;

impl Panel for DiagnosticsPanel {
    fn ui(&mut self, ui: &mut Ui, world: &World<'_>, commands: &mut Vec<Command>) {
        let Some(statistics) = &world.status.statistics else {
            empty_state(
                ui,
                "No chains yet",
                "Diagnostics appear within seconds of connecting to a daemon.",
            );
            return;
        };
        match &statistics.diagnostics {
            Some(diagnostics) => {
                verdict(ui, world, diagnostics, commands);
                samples(ui, statistics, diagnostics);
                caption(ui, "On the image");
                maps(ui, world, commands);
            }
            None => empty_state(
                ui,
                "Agreement of the chains is unknown",
                "This daemon does not report it; a newer one does.",
            ),
        }
        caption(ui, "Acceptance of each strategy over time");
        plots::acceptance(ui, world);
        caption(ui, "What became of the proposals");
        fates::show(ui, world, statistics);
        let Some(diagnostics) = &statistics.diagnostics else { return };
        caption(ui, "Memory: correlation of log luminance over steps");
        plots::memory(ui, diagnostics);
        caption(ui, "Longest stays");
        stays::show(ui, world, diagnostics, commands);
    }
}

impl Section for DiagnosticsPanel {
    const NAME: PanelName = PanelName::Diagnostics;
    const TITLE: &'static str = "Chains";
    const HELP: &'static [&'static str] = &[
        "Whether the image can be trusted, judged from every step of every chain. R-hat above 1.1 \
        means that the chains disagree; the maps show where.",
    ];

    fn applies(world: &World<'_>) -> bool {
        world.has_chains()
    }

    fn text(world: &World<'_>) -> String {
        let mut lines = Lines::default();
        let Some(diagnostics) = world.diagnostics() else { return lines.text() };
        lines.put(format_args!("R-hat\t{:.5}", diagnostics.r_hat));
        let worst = diagnostics.maps.r_hat.iter().copied().fold(0.0_f32, f32::max);
        lines.put(format_args!("R-hat of the worst tile\t{worst:.4}"));
        lines.put(format_args!("effective samples\t{:.0}", diagnostics.effective_samples));
        lines.put(format_args!("steps per effective sample\t{:.1}", diagnostics.correlation_steps));
        for (power, correlation) in diagnostics.autocorrelation.iter().enumerate() {
            lines.put(format_args!(
                "correlation of blocks of steps\t{}\t{correlation:.4}",
                1_u64 << power.min(63)
            ));
        }
        lines.text()
    }
}

fn caption(ui: &mut Ui, text: &str) {
    ui.add_space(6.0);
    ui.add(Label::new(RichText::new(text).small().weak()).selectable(false));
}

/// A tile where chains disagree.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Disagreement {
    tile: usize,
    r_hat: f32,
}

/// The tiles where chains disagree, the worst first. Tiles that hardly anything leads to are left out.
fn quarrels(diagnostics: &Diagnostics) -> Vec<Disagreement> {
    let maps = &diagnostics.maps;
    let pairs = maps.r_hat.iter().zip(&maps.visits).zip(&maps.dwell).enumerate();
    let mut found: Vec<Disagreement> = pairs
        .filter(|(_, ((r_hat, visits), dwell))| {
            **r_hat > DISAGREEMENT && **visits * dwell.max(1.0) > WORTH_A_LOOK
        })
        .map(|(tile, ((&r_hat, _), _))| Disagreement { tile, r_hat })
        .collect();
    found.sort_by(|a, b| b.r_hat.total_cmp(&a.r_hat));
    found
}

/// The part of the film that a tile covers.
fn region_of(diagnostics: &Diagnostics, tile: usize, size: [usize; 2]) -> Region {
    let from = diagnostics.grid.origin(tile).map(|side| side as usize);
    let side = diagnostics.grid.side as usize;
    let end = |i: usize| (from[i] + side).min(size[i]).saturating_sub(1);
    region::pixels(size, from, [end(0), end(1)])
}

/// Whether chains agree, and where they do not.
fn verdict(ui: &mut Ui, world: &World<'_>, diagnostics: &Diagnostics, commands: &mut Vec<Command>) {
    let quarrels = quarrels(diagnostics);
    let overall = diagnostics.r_hat as f32;
    let (color, text) = match quarrels.first() {
        _ if overall == 0.0 => {
            (theme::BUSY, "It is too early to tell whether the chains agree".to_owned())
        }
        Some(worst) => {
            let share = 100.0 * quarrels.len() as f32 / diagnostics.grid.len().max(1) as f32;
            let worst = worst.r_hat;
            (
                theme::BAD,
                format!("Chains disagree in {share:.1} % of the image, R-hat up to {worst:.2}"),
            )
        }
        None if overall > DISAGREEMENT => {
            (theme::BAD, format!("Chains disagree: R-hat {overall:.3}"))
        }
        None => (theme::GOOD, format!("Chains agree: R-hat {overall:.3}")),
    };
    let tip = "R-hat compares how much the chains differ from each other with how much each of \
        them varies. 1 means agreement; above 1.1 the image depends on where the chains started, \
        and may be wrong without looking noisy.";
    ui.horizontal(|ui| {
        dot(ui, color);
        ui.add(Label::new(RichText::new(text).strong()).wrap()).on_hover_text(tip);
    });
    let worst = quarrels.first();
    if worst.is_none() && overall <= DISAGREEMENT {
        return;
    }
    ui.horizontal(|ui| {
        let map =
            ui.button("Show where").on_hover_text("Show the map of disagreement on the image");
        if map.clicked() {
            commands.push(Command::Image(ImageCommand::Show(Layer::Disagreement)));
            reveal(ui, PanelName::Image, world, commands);
        }
        let Some(worst) = worst else { return };
        let paths = ui
            .button("Paths to the worst tile")
            .on_hover_text("Show only the paths to the tile with the largest R-hat");
        if paths.clicked() && world.film.size() != [0, 0] {
            let region = region_of(diagnostics, worst.tile, world.film.size());
            let text = region::with_region(world.settings.filter.text(), Some(region));
            commands.push(Command::Filter(FilterCommand::Set(text)));
        }
    });
}

/// What the steps are worth.
fn samples(ui: &mut Ui, statistics: &Statistics, diagnostics: &Diagnostics) {
    let big = |text: String| RichText::new(text).size(17.0).strong();
    let known = |value: f64| if value > 0.0 { format::count(value) } else { "–".to_owned() };
    ui.add_space(4.0);
    ui.columns(2, |columns| {
        let [left, right] = columns else { return };
        let steps = format::count(statistics.totals.steps as f64);
        reading(left, big(known(diagnostics.effective_samples)), "effective samples")
            .on_hover_text(format!(
                "How many independent samples {steps} steps are worth, for log luminance"
            ));
        let text = known(diagnostics.correlation_steps.ceil());
        reading(right, big(text), "steps for an independent one").on_hover_text(
            "Twice the integrated autocorrelation time of log luminance, from means over \
            increasingly long blocks of steps",
        );
    });
}

/// The maps of the image panel.
fn maps(ui: &mut Ui, world: &World<'_>, commands: &mut Vec<Command>) {
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing.x = 2.0;
        for layer in Layer::ALL.into_iter().filter(|layer| layer.is_map()) {
            layer_button(ui, world, layer, commands);
        }
    });
}

#[cfg(test)]
mod tests {
    use common::{TileGrid, TileMaps, UNKNOWN};

    use super::*;

    #[test]
    fn only_tiles_that_matter_raise_the_alarm() {
        let maps = TileMaps {
            r_hat: vec![1.5, 1.02, UNKNOWN, 3.0, 1.2],
            visits: vec![1.0, 1.0, 0.0, 0.001, 0.01],
            dwell: vec![1.0, 1.0, UNKNOWN, 2.0, 100.0],
            ..TileMaps::default()
        };
        let grid = TileGrid { side: 16, columns: 5, rows: 1 };
        let diagnostics = Diagnostics { grid, maps, ..Diagnostics::default() };
        let found: Vec<usize> = quarrels(&diagnostics).iter().map(|q| q.tile).collect();
        assert_eq!(found, [0, 4], "the worst first; dark corners are left out");
        let [u0, v0, u1, v1] = region_of(&diagnostics, 4, [72, 16]);
        assert!((u0 - 64.0 / 72.0).abs() < 1e-7 && v0 == 0.0, "{u0} {v0}");
        assert!((u1 - 1.0).abs() < 1e-6 && (v1 - 1.0).abs() < 1e-6, "the film ends there");
    }
}
