//! Small parts that panels share.

use std::fmt::Display;
use std::ops::RangeInclusive;

use egui::{
    Align, Color32, ComboBox, Label, Layout, Rect, Response, RichText, ScrollArea, Sense, Slider,
    Stroke, StrokeKind, TextWrapMode, Ui, WidgetText, pos2, vec2,
};

use crate::command::Switch;
use crate::value::theme;

/// Width of the labels of a form in points.
const LABEL_WIDTH: f32 = 74.0;
/// Height of the bar of menus, and of the rim of a menu, in points.
const ABOVE_MENU: f32 = 64.0;
/// What scrolls is never lower than this, in points.
const LOWEST: f32 = 80.0;

/// A label and what belongs to it, in one line.
pub(super) fn row<R>(ui: &mut Ui, label: &str, tip: &str, add: impl FnOnce(&mut Ui) -> R) -> R {
    ui.horizontal(|ui| {
        let size = vec2(LABEL_WIDTH, ui.spacing().interact_size.y);
        ui.allocate_ui_with_layout(size, Layout::left_to_right(Align::Center), |ui| {
            ui.set_min_width(LABEL_WIDTH);
            ui.add(Label::new(label).selectable(false).sense(Sense::hover())).on_hover_text(tip);
        });
        add(ui)
    })
    .inner
}

/// How a slider turns places into values.
#[derive(Clone, Debug)]
pub(super) struct Scale {
    pub(super) range: RangeInclusive<f32>,
    pub(super) logarithmic: bool,
    pub(super) decimals: usize,
    pub(super) suffix: &'static str,
}

impl Scale {
    pub(super) const fn linear(range: RangeInclusive<f32>, decimals: usize) -> Self {
        Self { range, logarithmic: false, decimals, suffix: "" }
    }

    pub(super) const fn logarithmic(range: RangeInclusive<f32>, decimals: usize) -> Self {
        Self { range, logarithmic: true, decimals, suffix: "" }
    }

    pub(super) const fn suffix(self, suffix: &'static str) -> Self {
        Self { suffix, ..self }
    }
}

/// A labelled slider; answers the new value when the user moved it.
pub(super) fn slider(ui: &mut Ui, label: &str, tip: &str, value: f32, scale: Scale) -> Option<f32> {
    let mut moved = value;
    let response = row(ui, label, tip, |ui| {
        // Long numbers take their room from the slider: a row that is too wide would widen its panel
        // with every frame.
        let letters = format!("{value:.*}", scale.decimals).len() + scale.suffix.len();
        let number = (8.0 * letters as f32 + 28.0).max(74.0);
        ui.spacing_mut().slider_width = (ui.available_width() - number).max(30.0);
        ui.add(
            Slider::new(&mut moved, scale.range)
                .logarithmic(scale.logarithmic)
                .fixed_decimals(scale.decimals)
                .suffix(scale.suffix),
        )
    });
    // A slider also rounds and clamps by itself; only the user's hand counts.
    let by_hand = response.changed() && moved != value;
    response.on_hover_text(tip);
    by_hand.then_some(moved)
}

/// A checkbox; answers the switch to throw when the user clicked it.
pub(super) fn toggle(ui: &mut Ui, label: &str, tip: &str, value: bool) -> Option<Switch> {
    let mut clicked = value;
    let response = ui.checkbox(&mut clicked, label).on_hover_text(tip);
    response.changed().then(|| Switch::to(clicked))
}

/// A labelled list of choices; answers the new one when the user chose it.
pub(super) fn choice<T: Copy + PartialEq + Display>(
    ui: &mut Ui,
    label: &str,
    tip: &str,
    value: T,
    choices: &[T],
) -> Option<T> {
    row(ui, label, tip, |ui| {
        let mut chosen = value;
        ComboBox::from_id_salt(label)
            .selected_text(capitalised(&value.to_string()))
            .width(ui.available_width() - 10.0)
            .show_ui(ui, |ui| {
                for choice in choices {
                    ui.selectable_value(&mut chosen, *choice, capitalised(&choice.to_string()));
                }
            })
            .response
            .on_hover_text(tip);
        (chosen != value).then_some(chosen)
    })
}

/// What a menu holds; it scrolls where the window is too low for it below the bar of menus.
pub(super) fn scrolling<R>(ui: &mut Ui, add: impl FnOnce(&mut Ui) -> R) -> R {
    let most = ui.ctx().content_rect().height() - ABOVE_MENU;
    scrolling_within(ui, most, |ui| {
        // The bar for scrolling takes its room from lines that were measured without it.
        ui.style_mut().wrap_mode = Some(TextWrapMode::Extend);
        add(ui)
    })
}

/// What is at most so many points high, and scrolls beyond that.
pub(super) fn scrolling_within<R>(ui: &mut Ui, most: f32, add: impl FnOnce(&mut Ui) -> R) -> R {
    let most = most.max(LOWEST);
    // Apart, since what stands above would else be drawn over.
    let apart = ui.scope(|ui| {
        // A popup would otherwise be no higher than in the frame before.
        ui.set_max_height(most);
        ScrollArea::vertical().max_height(most).show(ui, add).inner
    });
    apart.inner
}

/// The word with a capital.
pub(super) fn capitalised(word: &str) -> String {
    let mut letters = word.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

/// A number with its meaning below it.
pub(super) fn reading(ui: &mut Ui, value: impl Into<WidgetText>, meaning: &str) -> Response {
    ui.vertical(|ui| {
        ui.spacing_mut().item_spacing.y = 1.0;
        ui.add(Label::new(value).selectable(false));
        ui.add(Label::new(RichText::new(meaning).small().weak()).selectable(false));
    })
    .response
}

/// A filled circle as large as a letter.
pub(super) fn dot(ui: &mut Ui, color: Color32) -> Response {
    let (rect, response) = ui.allocate_exact_size(vec2(9.0, 14.0), Sense::hover());
    ui.painter().circle_filled(rect.center(), 4.0, color);
    response
}

/// Marks a row of which another panel tells, too.
pub(super) fn mark(ui: &Ui, row: Rect) {
    let stroke = Stroke::new(1.0, ui.visuals().strong_text_color());
    ui.painter().rect_stroke(row.expand2(vec2(3.0, 0.0)), 3.0, stroke, StrokeKind::Outside);
}

/// A text in the middle that says why there is nothing here, and what to do.
pub(super) fn empty_state(ui: &mut Ui, title: &str, text: &str) {
    ui.vertical_centered(|ui| {
        ui.add_space(10.0);
        ui.add(Label::new(RichText::new(title).strong()).selectable(false));
        ui.add(Label::new(RichText::new(text).weak()).selectable(false).wrap());
        ui.add_space(10.0);
    });
}

/// A small curve of readings, filled to its foot.
pub(super) fn sparkline(ui: &mut Ui, values: impl ExactSizeIterator<Item = f32>, height: f32) {
    let (rect, _) = ui.allocate_exact_size(vec2(ui.available_width(), height), Sense::hover());
    ui.painter().rect_filled(rect, 3.0, ui.visuals().extreme_bg_color);
    let values: Vec<f32> = values.collect();
    let top = values.iter().copied().fold(0.0_f32, f32::max) * 1.12;
    if values.len() < 2 || !(top > 0.0) {
        return;
    }
    let step = rect.width() / (values.len() - 1) as f32;
    let point = |(i, v): (usize, &f32)| {
        pos2(rect.left() + i as f32 * step, rect.bottom() - v / top * rect.height())
    };
    let curve: Vec<_> = values.iter().enumerate().map(point).collect();
    let fill = theme::ACCENT.gamma_multiply(0.16);
    for pair in curve.windows(2) {
        if let [a, b] = *pair {
            let foot = |p: egui::Pos2| pos2(p.x, rect.bottom());
            let shape =
                egui::Shape::convex_polygon(vec![a, b, foot(b), foot(a)], fill, Stroke::NONE);
            ui.painter().add(shape);
        }
    }
    ui.painter().line(curve, Stroke::new(1.3, theme::ACCENT));
}
