//! The last steps of the explorer, one bar each, to go back to.

use common::FocusOutcome;
use egui::{RichText, Role, Sense, Stroke, Ui, WidgetInfo, pos2, vec2};

use super::moment::fate;
use crate::command::Command;
use crate::panel::hover::{self, Pointed};
use crate::source::steering::Moment;
use crate::value::theme;
use crate::world::World;

/// Width of a bar with its gap, and height of the strip, in points.
const PITCH: f32 = 5.0;
const HEIGHT: f32 = 44.0;

/// Shows the timeline.
pub(super) fn show(ui: &mut Ui, world: &World<'_>, commands: &mut Vec<Command>) {
    let moments = world.status.steering.focus.moments();
    let size = vec2(ui.available_width(), HEIGHT);
    let (rect, response) = ui.allocate_exact_size(size, Sense::click_and_drag());
    response.widget_info(|| WidgetInfo::labeled(Role::Slider, true, "Last steps"));
    ui.painter().rect_filled(rect, 3.0, ui.visuals().extreme_bg_color);
    let room = (rect.width() / PITCH) as usize;
    let shown = world.moment.map(|moment| moment.step.number);
    let marked = hover::moment(ui.ctx(), world).map(|moment| moment.step.number);
    // What is looked at stays in sight.
    let last = match world.scrub {
        Some(number) => moments.partition_point(|m| m.step.number <= number + room as u64 / 2),
        None => moments.len(),
    };
    let first = last.saturating_sub(room);
    for (i, moment) in moments.range(first..last).enumerate() {
        let step = &moment.step;
        let x = rect.left() + (i as f32 + 0.5) * PITCH;
        let (_, color) = fate(world, step);
        let failed = matches!(step.outcome, FocusOutcome::Failed(_));
        let height = if failed { 5.0 } else { 7.0 + step.acceptance as f32 * (HEIGHT - 17.0) };
        let foot = rect.bottom() - 7.0;
        let stroke = Stroke::new(PITCH - 2.0, color);
        ui.painter().line_segment([pos2(x, foot), pos2(x, foot - height)], stroke);
        let strategy = theme::strategy_color(usize::from(step.strategy.0));
        ui.painter().circle_filled(pos2(x, rect.bottom() - 3.0), 1.8, strategy);
        if marked == Some(step.number) {
            let ink = ui.visuals().strong_text_color();
            let line = [pos2(x, rect.top()), pos2(x, rect.bottom())];
            ui.painter().line_segment(line, Stroke::new(1.0, ink));
        }
    }
    let at = |place: egui::Pos2| {
        let index = first + ((place.x - rect.left()) / PITCH).max(0.0) as usize;
        moments.get(index).filter(|_| index < last)
    };
    let held = response.interact_pointer_pos().filter(|_| response.is_pointer_button_down_on());
    if let Some(moment) = held.and_then(at) {
        commands.push(Command::Scrub(Some(moment.step.number)));
    }
    let pointed = response.hover_pos().and_then(at);
    if let Some(moment) = pointed {
        hover::point(ui.ctx(), Pointed::Step(moment.step.number));
    }
    response.on_hover_ui(|ui| explain(ui, world, pointed));
    ui.horizontal(|ui| {
        let mut scrub = |ui: &mut Ui, label: &str, tip: &str, to: Option<Option<u64>>| {
            let clicked = ui.add_enabled(to.is_some(), egui::Button::new(label).small());
            if let Some(to) = to.filter(|_| clicked.on_hover_text(tip).clicked()) {
                commands.push(Command::Scrub(to));
            }
        };
        let place = shown.map(|n| moments.partition_point(|m| m.step.number < n));
        let number = |index: Option<usize>| {
            index.and_then(|i| moments.get(i)).map(|moment| Some(moment.step.number))
        };
        scrub(ui, "Back", "The step before", number(place.and_then(|i| i.checked_sub(1))));
        scrub(ui, "Forward", "The step after", number(place.map(|i| i + 1)));
        scrub(ui, "Live", "Follow the latest step", world.scrub.map(|_| None));
    });
}

/// What a bar stands for, and how bars are to be read.
fn explain(ui: &mut Ui, world: &World<'_>, pointed: Option<&Moment>) {
    if let Some(Moment { step, .. }) = pointed {
        let (word, _) = fate(world, step);
        let strategy = world.strategy_name(usize::from(step.strategy.0));
        ui.label(RichText::new(format!("No. {}: {strategy}", step.number)).strong());
        ui.label(format!("{word}, a = {:.4}", step.acceptance));
    }
    let key = "The height of a bar is a, short stubs are failures, the colours of the dots are \
        strategies. Click or drag to hold a step.";
    ui.label(RichText::new(key).small().weak());
}
