//! One step of the explorer: what was changed, how probable its acceptance was, and its fate.

use common::{FocusOutcome, FocusStep, VertexRecord};
use egui::{
    Align2, Color32, FontId, Rect, RichText, Role, Sense, Stroke, StrokeKind, Ui, WidgetInfo, pos2,
    vec2,
};

use crate::command::{Command, PathCommand};
use crate::panel::widgets::{dot, row};
use crate::source::steering::Moment;
use crate::value::format;
use crate::value::theme;
use crate::world::World;

/// Powers of ten from the middle of a factor's bar to its end.
const DECADES: f64 = 3.0;

/// Shows a step.
pub(super) fn show(ui: &mut Ui, world: &World<'_>, moment: &Moment, commands: &mut Vec<Command>) {
    let step = &moment.step;
    ui.add_space(4.0);
    ui.horizontal(|ui| {
        dot(ui, theme::strategy_color(usize::from(step.strategy.0)));
        ui.label(RichText::new(world.strategy_name(usize::from(step.strategy.0))).strong());
        let fan = if step.fan { "fan, " } else { "" };
        ui.label(RichText::new(format!("{fan}no. {}", step.number)).weak());
        let tip = "Select the path before the step; Selected path shows all its numbers";
        if ui.small_button("Inspect x").on_hover_text(tip).clicked() {
            commands.push(Command::Path(PathCommand::Explored));
        }
    });
    let (word, color) = fate(world, step);
    ui.label(RichText::new(word).color(color).strong());
    acceptance_bar(ui, step.acceptance as f32, color);
    classes(ui, moment);
    if step.is_complete() {
        factors(ui, moment);
    }
    row(ui, "Rays", "Rays traced for the proposal", |ui| {
        ui.label(RichText::new(step.rays.to_string()).monospace())
    });
}

/// What became of a step, in words and a colour; the words say it all.
pub(super) fn fate(world: &World<'_>, step: &FocusStep) -> (String, Color32) {
    // A fan moves nowhere.
    let word = |word, would_be: &str| if step.fan { would_be } else { word }.to_owned();
    match step.outcome {
        FocusOutcome::Accepted => (word("Accepted", "Would be accepted"), theme::GOOD),
        FocusOutcome::Rejected => (word("Rejected", "Would be rejected"), theme::BUSY),
        FocusOutcome::Failed(reason) => {
            let reason = world.failure_reason(usize::from(reason));
            (format!("Failed: {reason}"), theme::BAD)
        }
    }
}

/// The acceptance probability as a bar and a number.
fn acceptance_bar(ui: &mut Ui, a: f32, color: Color32) {
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), 20.0), Sense::hover());
    let painter = ui.painter();
    painter.rect_filled(rect, 3.0, ui.visuals().extreme_bg_color);
    let mut filled = rect;
    filled.set_width(rect.width() * a.clamp(0.0, 1.0));
    painter.rect_filled(filled, 3.0, color.gamma_multiply(0.55));
    let line = ui.visuals().widgets.noninteractive.bg_stroke;
    painter.rect_stroke(rect, 3.0, line, StrokeKind::Inside);
    let text = format!("a = {a:.4}");
    response.widget_info(|| WidgetInfo::labeled(Role::Label, true, &text));
    let ink = ui.visuals().strong_text_color();
    painter.text(rect.center(), Align2::CENTER_CENTER, text, FontId::monospace(12.0), ink);
    response.on_hover_text("Probability that the chain moves from the path x to the proposal y");
}

/// The path before and after, letter by letter, with what was deleted and what is new.
fn classes(ui: &mut Ui, moment: &Moment) {
    let step = &moment.step;
    let before = &moment.before.vertices;
    let kept_from = before.len().saturating_sub(step.kept_eye);
    let is_kept = |i: usize| i < step.kept_light || i >= kept_from;
    row(
        ui,
        "Deleted",
        "The path before the step; what the proposal replaces is struck out",
        |ui| {
            letters(ui, before, |i| if is_kept(i) { Mark::Kept } else { Mark::Deleted });
        },
    );
    if let Some(after) = moment.proposal() {
        let new_to = after.len().saturating_sub(step.kept_eye);
        let is_new = |i: usize| i >= step.kept_light && i < new_to;
        row(ui, "Proposed", "The proposed path; what is new is framed", |ui| {
            letters(ui, &after, |i| if is_new(i) { Mark::New } else { Mark::Kept });
        });
    } else {
        let made = [step.inserted.as_slice(), step.eye_side.as_slice()].concat();
        row(ui, "Got as far as", "The vertices generated before it failed", |ui| {
            letters(ui, &made, |_| Mark::New);
        });
    }
}

/// How a letter is shown: never by its colour alone.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Mark {
    Kept,
    Deleted,
    New,
}

fn letters(ui: &mut Ui, vertices: &[VertexRecord], mark: impl Fn(usize) -> Mark) {
    ui.spacing_mut().item_spacing.x = 3.0;
    if vertices.is_empty() {
        ui.label(RichText::new("nothing").weak());
    }
    for (i, vertex) in vertices.iter().enumerate() {
        let letter = RichText::new(vertex.kind.letter().to_string()).monospace();
        match mark(i) {
            Mark::Kept => ui.label(letter),
            Mark::Deleted => ui.label(letter.strikethrough().color(theme::DELETED)),
            Mark::New => {
                let response = ui.label(letter.strong().color(theme::PROPOSED));
                let frame = response.rect.expand2(vec2(1.5, 0.0));
                let stroke = Stroke::new(1.0, theme::PROPOSED);
                ui.painter().rect_stroke(frame, 2.0, stroke, StrokeKind::Outside);
                response
            }
        };
    }
}

/// What the acceptance probability is made of.
fn factors(ui: &mut Ui, moment: &Moment) {
    let f = &moment.step.factors;
    let number = |value: f64| format!("{value:.4e}");
    let lines = [
        (
            "Q(y | x)",
            number(f.forward),
            "Density of proposing y from x, divided by the luminance of y",
        ),
        ("Q(x | y)", number(f.backward), "The same for the reverse move"),
    ];
    for (label, value, tip) in lines {
        row(ui, label, tip, |ui| ui.label(RichText::new(value).monospace()));
    }
    let way = quotient(f.backward, f.forward);
    let mixture = quotient(f.mixture_current, f.mixture_proposed);
    let target = quotient(f.target_proposed, f.target_current);
    let ratios = [
        (
            "Q back / forth",
            way,
            "Q(x | y) over Q(y | x): above 1 if the reverse move is the more likely one",
        ),
        ("Z(x) / Z(y)", mixture, "Total weight of the strategies that apply to x, over that for y"),
        (
            "rho(y) / rho(x)",
            target,
            "How much more often y is to be visited than x, relative to its light: light that \
            base samples find well is left to them",
        ),
        ("r", way * mixture * target, "The product of all three; a is the smaller of r and 1"),
    ];
    for (label, value, tip) in ratios {
        row(ui, label, tip, |ui| balance(ui, value));
    }
}

/// Zero where there is no way back.
fn quotient(over: f64, under: f64) -> f64 {
    if under > 0.0 { over / under } else { 0.0 }
}

/// A factor as a number, and as a bar from the middle: to the right above 1, to the left below; a third
/// of half the bar is a power of ten.
fn balance(ui: &mut Ui, factor: f64) {
    let text = if factor > 0.0 { format::exact(factor) } else { "0: no reverse move".to_owned() };
    let size = vec2(ui.available_width(), 16.0);
    let (rect, response) = ui.allocate_exact_size(size, Sense::hover());
    response.widget_info(|| WidgetInfo::labeled(Role::Label, true, &text));
    let painter = ui.painter();
    painter.rect_filled(rect, 2.0, ui.visuals().extreme_bg_color);
    let share = (factor.log10() / DECADES).clamp(-1.0, 1.0) as f32;
    let middle = rect.center();
    let end = middle + vec2(share * 0.5 * rect.width(), 0.0);
    let filled =
        Rect::from_two_pos(pos2(middle.x, rect.top() + 1.0), pos2(end.x, rect.bottom() - 1.0));
    let color = if share < 0.0 { theme::BUSY } else { theme::GOOD };
    painter.rect_filled(filled, 0.0, color.gamma_multiply(0.5));
    let line = ui.visuals().widgets.noninteractive.fg_stroke;
    painter.vline(middle.x, rect.y_range(), Stroke::new(1.0, line.color));
    let ink = ui.visuals().strong_text_color();
    let place = rect.left_center() + vec2(6.0, 0.0);
    painter.text(place, Align2::LEFT_CENTER, text, FontId::monospace(12.0), ink);
}
