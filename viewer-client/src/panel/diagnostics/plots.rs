//! Curves: acceptance over time, and correlation against the number of steps.

use common::Diagnostics;
use egui::Ui;
use egui_plot::{
    GridMark, HLine, HoverPosition, ItemId, Line, LineStyle, Plot, PlotPoints, Points,
};

use crate::panel::hover::{self, Pointed};
use crate::value::format;
use crate::value::theme;
use crate::world::World;

/// Height of a plot in points.
const HEIGHT: f32 = 118.0;
/// Strategies before colours are used with dashes.
const SOLID: usize = 4;

/// A plot that only shows: no zoom, no drag.
fn plot<'a>(name: &'static str) -> Plot<'a> {
    Plot::new(name)
        .height(HEIGHT)
        .allow_zoom(false)
        .allow_drag(false)
        .allow_scroll(false)
        .allow_boxed_zoom(false)
        .allow_axis_zoom_drag(false)
        .allow_double_click_reset(false)
        .show_background(false)
        .set_margin_fraction(egui::vec2(0.02, 0.06))
        .y_axis_min_width(30.0)
}

/// Marks at 0, a half and 1.
fn halves(_: egui_plot::GridInput) -> Vec<GridMark> {
    [0.0, 0.5, 1.0].map(|value| GridMark { value, step_size: 0.5 }).to_vec()
}

/// Three to six marks at round numbers of seconds.
fn moments(low: f64, high: f64) -> Vec<GridMark> {
    let step = [1.0, 2.0, 5.0, 10.0, 30.0, 60.0, 120.0, 300.0, 600.0, 1800.0, 3600.0]
        .into_iter()
        .find(|step| (high - low) / step <= 5.0)
        .unwrap_or(7200.0);
    let first = (low / step).ceil().max(0.0) as i64;
    let last = (high / step).floor() as i64;
    let mark = |i: i64| GridMark { value: i as f64 * step, step_size: step };
    (first..=last.min(first + 10)).map(mark).collect()
}

fn percent(mark: GridMark, _: &std::ops::RangeInclusive<f64>) -> String {
    format!("{:.0} %", 100.0 * mark.value)
}

/// Mean acceptance probability of each strategy against seconds.
pub(super) fn acceptance(ui: &mut Ui, world: &World<'_>) {
    let trends = &world.status.trends;
    let strategies = trends.readings().map(|r| r.acceptance.len()).max().unwrap_or(0);
    let lines: Vec<(String, Vec<[f64; 2]>)> = (0..strategies)
        .map(|index| {
            let points = trends.readings().filter_map(|reading| {
                let share = reading.acceptance.get(index).filter(|a| a.is_finite())?;
                Some([reading.seconds, *share])
            });
            (world.strategy_name(index).to_owned(), points.collect())
        })
        .collect();
    let label = |position: &HoverPosition<'_>| match position {
        HoverPosition::NearDataPoint { plot_name, position, .. } => Some(format!(
            "{plot_name}\n{:.1} % after {}",
            100.0 * position.y,
            format::duration(position.x)
        )),
        HoverPosition::Elsewhere { .. } => None,
    };
    let marked = match hover::pointed(ui.ctx()) {
        Some(Pointed::Strategy(index)) => Some(index),
        _ => None,
    };
    let shown = plot("acceptance")
        .include_y(0.0)
        .include_y(1.0)
        .y_grid_spacer(halves)
        .x_grid_spacer(|input| moments(input.bounds.0, input.bounds.1))
        .y_axis_formatter(percent)
        .x_axis_formatter(|mark, _| format::duration(mark.value))
        .label_formatter(label)
        .show(ui, |plot| {
            for (index, (name, points)) in lines.into_iter().enumerate() {
                let style =
                    if index < SOLID { LineStyle::Solid } else { LineStyle::dashed_loose() };
                let width = if marked == Some(index) { 3.4 } else { 1.6 };
                let color = theme::strategy_color(index);
                let faint = marked.is_some_and(|marked| marked != index);
                let color = if faint { color.gamma_multiply(0.3) } else { color };
                let line = Line::new(name, PlotPoints::from(points)).id(index);
                plot.line(line.color(color).width(width).style(style));
            }
        });
    let touched = (0..strategies).find(|&i| shown.hovered_plot_item == Some(ItemId::new(i)));
    if let Some(index) = touched.filter(|_| shown.response.contains_pointer()) {
        hover::point(ui.ctx(), Pointed::Strategy(index));
    }
}

/// Correlation between neighbouring blocks of steps against their length, by powers of two.
pub(super) fn memory(ui: &mut Ui, diagnostics: &Diagnostics) {
    if diagnostics.autocorrelation.is_empty() {
        ui.label("There are too few steps, or the luminance never changes.");
        return;
    }
    let points: Vec<[f64; 2]> = (0..)
        .zip(&diagnostics.autocorrelation)
        .map(|(k, &r)| [f64::from(k), f64::from(r)])
        .collect();
    let label = |position: &HoverPosition<'_>| match position {
        HoverPosition::NearDataPoint { position, .. } => Some(format!(
            "{:.3} between the means of neighbouring {} steps",
            position.y,
            format::count(position.x.exp2())
        )),
        HoverPosition::Elsewhere { .. } => None,
    };
    let ink = ui.visuals().weak_text_color();
    let dots: Vec<[f64; 2]> = points.clone();
    plot("memory")
        .include_y(0.0)
        .include_y(1.0)
        .y_grid_spacer(halves)
        .y_axis_formatter(|mark, _| format!("{:.1}", mark.value))
        .x_grid_spacer(|input| {
            let (low, high) = input.bounds;
            let first = (low.ceil() as i32).max(0);
            let mark = |k: i32| GridMark { value: f64::from(k), step_size: 4.0 };
            (first..=high.floor() as i32).filter(|k| k % 4 == 0).map(mark).collect()
        })
        .x_axis_formatter(|mark, _| format::count(mark.value.exp2()))
        .label_formatter(label)
        .show(ui, |plot| {
            plot.hline(HLine::new("", 0.0).color(ink).width(1.0));
            let line = Line::new("memory", PlotPoints::from(points));
            plot.line(line.color(theme::ACCENT).width(1.6));
            let dots = Points::new("memory", PlotPoints::from(dots));
            plot.points(dots.color(theme::ACCENT).radius(2.4));
        });
}
