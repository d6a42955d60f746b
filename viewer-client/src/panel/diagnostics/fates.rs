//! What became of each strategy's proposals, as stacked bars: accepted, rejected, or failed and why.

use std::collections::BTreeMap;

use common::{Statistics, StrategyStatistics};
use egui::{
    Color32, Label, Rect, Response, RichText, Role, Sense, TextStyle, Ui, WidgetInfo, pos2, vec2,
};

use crate::panel::hover::{self, Pointed};
use crate::panel::widgets::{dot, mark};
use crate::value::format;
use crate::value::theme;
use crate::world::World;

/// Height of a bar in points.
const HEIGHT: f32 = 13.0;
/// Width of the names.
const NAMES: f32 = 104.0;

/// A part of a bar.
struct Part {
    label: String,
    count: u64,
    color: Color32,
}

/// Shows a bar a strategy, and what the colours mean.
pub(super) fn show(ui: &mut Ui, world: &World<'_>, statistics: &Statistics) {
    let mut failures = BTreeMap::new();
    for (index, strategy) in statistics.strategies.iter().enumerate() {
        if strategy.proposed == 0 {
            continue;
        }
        for failure in &strategy.failures {
            *failures.entry(usize::from(failure.reason)).or_insert(0) += failure.count;
        }
        let parts = parts(ui, world, index, strategy);
        let row = ui.horizontal(|ui| {
            let size = vec2(NAMES, HEIGHT);
            ui.allocate_ui_with_layout(
                size,
                egui::Layout::left_to_right(egui::Align::Center),
                |ui| {
                    ui.set_min_width(NAMES);
                    dot(ui, theme::strategy_color(index));
                    let name = RichText::new(world.strategy_name(index)).small();
                    ui.add(Label::new(name).selectable(false).truncate());
                },
            );
            bar(ui, &parts).on_hover_ui(|ui| words(ui, &parts, strategy.proposed));
        });
        if row.response.contains_pointer() {
            hover::point(ui.ctx(), Pointed::Strategy(index));
        } else if hover::is_strategy(ui.ctx(), index) {
            mark(ui, row.response.rect);
        }
    }
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing.x = 2.0;
        entry(ui, "accepted: bright", ui.visuals().text_color());
        entry(ui, "rejected: dim", ui.visuals().weak_text_color().gamma_multiply(0.5));
        for reason in failures.into_keys() {
            entry(ui, world.failure_reason(reason), theme::reason_color(reason));
        }
    });
}

/// A dot and its meaning, never apart.
fn entry(ui: &mut Ui, text: &str, color: Color32) {
    let font = TextStyle::Small.resolve(ui.style());
    let ink = ui.visuals().text_color();
    let galley = ui.painter().layout_no_wrap(text.to_owned(), font, ink);
    let size = galley.size() + vec2(20.0, 2.0);
    let (rect, response) = ui.allocate_exact_size(size, Sense::hover());
    response.widget_info(|| WidgetInfo::labeled(Role::Label, true, text));
    ui.painter().circle_filled(rect.left_center() + vec2(4.5, 0.0), 4.0, color);
    ui.painter().galley(rect.min + vec2(12.0, 1.0), galley, ink);
}

fn parts(ui: &Ui, world: &World<'_>, index: usize, strategy: &StrategyStatistics) -> Vec<Part> {
    let color = theme::strategy_color(index);
    let dim = color.lerp_to_gamma(ui.visuals().extreme_bg_color, 0.68);
    let rejected = strategy.generated.saturating_sub(strategy.accepted);
    let part = |label: &str, count, color| Part { label: label.to_owned(), count, color };
    let mut parts =
        vec![part("accepted", strategy.accepted, color), part("rejected", rejected, dim)];
    let failed = strategy.failures.iter().map(|failure| {
        let reason = usize::from(failure.reason);
        part(world.failure_reason(reason), failure.count, theme::reason_color(reason))
    });
    parts.extend(failed);
    parts
}

fn bar(ui: &mut Ui, parts: &[Part]) -> Response {
    let size = vec2(ui.available_width(), HEIGHT);
    let (rect, response) = ui.allocate_exact_size(size, Sense::hover());
    let whole: u64 = parts.iter().map(|part| part.count).sum();
    let painter = ui.painter();
    painter.rect_filled(rect, 2.0, ui.visuals().extreme_bg_color);
    let mut left = rect.left();
    for part in parts.iter().filter(|part| part.count > 0) {
        let width = rect.width() * part.count as f32 / whole.max(1) as f32;
        let piece = Rect::from_min_max(pos2(left, rect.top()), pos2(left + width, rect.bottom()));
        painter.rect_filled(piece, 0.0, part.color);
        left += width;
        // A gap that shows where one part ends, whatever the colours.
        let edge = ui.visuals().panel_fill;
        painter.vline(left, rect.y_range(), egui::Stroke::new(1.0, edge));
    }
    response
}

fn words(ui: &mut Ui, parts: &[Part], proposed: u64) {
    egui::Grid::new("fates").num_columns(3).spacing([12.0, 2.0]).show(ui, |ui| {
        for part in parts.iter().filter(|part| part.count > 0) {
            dot(ui, part.color);
            ui.label(&part.label);
            let share = format::percent(part.count as f64, proposed as f64);
            ui.label(RichText::new(share).monospace());
            ui.end_row();
        }
    });
}
