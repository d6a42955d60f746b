//! What the chains do: rates, the image's mean, and every strategy's fate.

use common::{Statistics, StrategyStatistics};
use egui::{Align, Color32, Label, Layout, RichText, Sense, Ui, vec2};

use super::hover::{self, Pointed};
use super::lines::Lines;
use super::widgets::{dot, empty_state, mark, reading, sparkline};
use super::{Panel, Section};
use crate::command::Command;
use crate::value::PanelName;
use crate::value::format;
use crate::value::theme;
use crate::world::World;

/// Live counts.
#[derive(Debug, Default)]
pub(super) struct StatisticsPanel;

impl Panel for StatisticsPanel {
    fn ui(&mut self, ui: &mut Ui, world: &World<'_>, _commands: &mut Vec<Command>) {
        let Some(statistics) = &world.status.statistics else {
            empty_state(
                ui,
                "No statistics yet",
                "Rates and acceptance appear within a second of connecting to a daemon.",
            );
            return;
        };
        let rate = RichText::new(format::count(world.status.mutation_rate())).size(19.0).strong();
        ui.columns(2, |columns| {
            if let [left, right] = columns {
                reading(left, rate, "mutations per second");
                brightness(right, statistics);
            }
        });
        sparkline(ui, world.status.mutation_history.values(), 34.0);
        ui.add_space(6.0);
        strategies(ui, world, statistics);
        ui.add_space(6.0);
        totals(ui, world, statistics);
    }
}

impl Section for StatisticsPanel {
    const NAME: PanelName = PanelName::Statistics;
    const TITLE: &'static str = "Statistics";
    const HELP: &'static [&'static str] =
        &["Counts over all chains since the epoch began. For each strategy: how often it was \
        chosen, how often it produced a complete path, and how often the chain moved there."];

    fn applies(world: &World<'_>) -> bool {
        world.has_chains()
    }

    fn text(world: &World<'_>) -> String {
        let mut lines = Lines::default();
        let Some(statistics) = &world.status.statistics else { return lines.text() };
        lines.put(format_args!("mutations per second\t{:.0}", world.status.mutation_rate()));
        let (b, error) = (statistics.normalization, statistics.normalization_error);
        lines.put(format_args!("b\t{b:.8}\t±\t{error:.2e}"));
        lines.put(format_args!("strategy\tproposed\tgenerated\taccepted\tmean acceptance"));
        for (index, strategy) in statistics.strategies.iter().enumerate() {
            let mean = strategy.acceptance_sum / strategy.proposed.max(1) as f64;
            let name = world.strategy_name(index);
            let (proposed, generated) = (strategy.proposed, strategy.generated);
            lines.put(format_args!(
                "{name}\t{proposed}\t{generated}\t{}\t{mean:.5}",
                strategy.accepted
            ));
            for failure in &strategy.failures {
                let reason = world.failure_reason(usize::from(failure.reason));
                lines.put(format_args!("\t{}\t{reason}", failure.count));
            }
        }
        let totals = statistics.totals;
        lines.put(format_args!(
            "steps\t{}\trays\t{}\tshadow rays\t{}",
            totals.steps, totals.rays, totals.shadow_rays
        ));
        lines.put(format_args!(
            "not finite\t{}\tlongest stay\t{}",
            totals.not_finite, totals.longest_dwell
        ));
        lines.text()
    }
}

/// The estimate of the image's mean luminance, with its error.
fn brightness(ui: &mut Ui, statistics: &Statistics) {
    let b = statistics.normalization;
    let error = statistics.normalization_error;
    let share = format::percent(error, b);
    let text = RichText::new(format!("{b:.4} ± {share}")).size(19.0).strong();
    reading(ui, text, "b, mean luminance").on_hover_text(format!(
        "Mean luminance of the image, estimated once before the chains start: {b:.6} ± {error:.6} \
         (standard error). Every pixel is scaled by it."
    ));
}

/// Widths of the columns of numbers, in points.
const COLUMNS: [f32; 3] = [66.0, 62.0, 74.0];

fn strategies(ui: &mut Ui, world: &World<'_>, statistics: &Statistics) {
    let header = |text: &str| Label::new(RichText::new(text).small().weak()).selectable(false);
    let tips = [
        "Steps that chose the strategy",
        "Share of proposals that were complete paths and carry light",
        "Share of proposals that the chain moved to; hover for the share of those generated",
    ];
    ui.horizontal(|ui| {
        ui.add(header("strategy"));
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            let titles = ["proposed", "generated", "accepted"];
            for ((title, tip), width) in titles.iter().zip(tips).zip(COLUMNS).rev() {
                cell(ui, width, |ui| {
                    ui.add(header(title).sense(Sense::hover())).on_hover_text(tip);
                });
            }
        });
    });
    for (index, strategy) in statistics.strategies.iter().enumerate() {
        strategy_row(ui, world, index, strategy);
    }
}

fn cell(ui: &mut Ui, width: f32, add: impl FnOnce(&mut Ui)) {
    let size = vec2(width, ui.spacing().interact_size.y);
    ui.allocate_ui_with_layout(size, Layout::right_to_left(Align::Center), |ui| {
        ui.set_min_width(width);
        add(ui);
    });
}

fn strategy_row(ui: &mut Ui, world: &World<'_>, index: usize, strategy: &StrategyStatistics) {
    let name = world.strategy_name(index);
    let proposed = strategy.proposed as f64;
    let number = |text: String| Label::new(RichText::new(text).monospace()).selectable(false);
    let response = ui
        .horizontal(|ui| {
            dot(ui, theme::strategy_color(index));
            ui.add(Label::new(name).selectable(false).truncate());
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                let share = strategy.accepted as f64 / proposed.max(1.0);
                cell(ui, COLUMNS[2], |ui| {
                    bar(ui, share as f32, theme::strategy_color(index));
                    ui.add(number(format::percent(strategy.accepted as f64, proposed)));
                });
                cell(ui, COLUMNS[1], |ui| {
                    ui.add(number(format::percent(strategy.generated as f64, proposed)));
                });
                cell(ui, COLUMNS[0], |ui| {
                    ui.add(number(format::count(proposed)));
                });
            });
        })
        .response;
    if response.contains_pointer() {
        hover::point(ui.ctx(), Pointed::Strategy(index));
    } else if hover::is_strategy(ui.ctx(), index) {
        mark(ui, response.rect);
    }
    response.on_hover_ui(|ui| fate(ui, world, name, strategy));
}

/// A bar behind a number.
fn bar(ui: &Ui, share: f32, color: Color32) {
    let mut rect = ui.max_rect().shrink2(vec2(0.0, 3.0));
    ui.painter().rect_filled(rect, 2.0, ui.visuals().extreme_bg_color);
    rect.set_width(rect.width() * share.clamp(0.0, 1.0));
    ui.painter().rect_filled(rect, 2.0, color.gamma_multiply(0.38));
}

/// What became of a strategy's proposals.
fn fate(ui: &mut Ui, world: &World<'_>, name: &str, strategy: &StrategyStatistics) {
    let proposed = strategy.proposed as f64;
    ui.label(RichText::new(name).strong());
    egui::Grid::new("fate").num_columns(2).spacing([18.0, 2.0]).show(ui, |ui| {
        let mut line = |label: &str, value: String| {
            ui.label(label);
            ui.label(RichText::new(value).monospace());
            ui.end_row();
        };
        let generated = strategy.generated as f64;
        line("accepted of generated", format::percent(strategy.accepted as f64, generated));
        line("mean acceptance", format::percent(strategy.acceptance_sum, proposed));
        for failure in &strategy.failures {
            let reason = world.failure_reason(usize::from(failure.reason));
            line(&format!("failed: {reason}"), format::percent(failure.count as f64, proposed));
        }
    });
}

fn totals(ui: &mut Ui, world: &World<'_>, statistics: &Statistics) {
    let totals = &statistics.totals;
    let chains = world.status.welcome.as_ref().map_or(0, |w| w.chains);
    let seconds = statistics.elapsed_seconds;
    let lines = [
        ("Mutations", format::count(totals.steps as f64)),
        ("Rays", format::count(totals.rays as f64)),
        ("Shadow rays", format::count(totals.shadow_rays as f64)),
        ("Longest stay", format::steps(totals.longest_dwell)),
        ("Running for", format::duration(seconds)),
        ("Chains, threads", format!("{chains}, {}", statistics.threads)),
    ];
    egui::Grid::new("totals").num_columns(4).spacing([10.0, 3.0]).show(ui, |ui| {
        for pair in lines.chunks(2) {
            for (label, value) in pair {
                ui.label(RichText::new(*label).weak());
                ui.label(RichText::new(value).monospace());
            }
            ui.end_row();
        }
    });
    if totals.not_finite > 0 {
        let text = format!("{} proposals had numbers that were not finite", totals.not_finite);
        ui.colored_label(theme::BAD, text);
    }
}
