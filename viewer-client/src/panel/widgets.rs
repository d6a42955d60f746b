//! Small parts that panels share.

use egui::{
    Align, Color32, ComboBox, Id, Label, Layout, Rect, Response, RichText, ScrollArea, Sense,
    Slider, Stroke, StrokeKind, TextWrapMode, Ui, WidgetText, pos2, vec2,
};

use crate::command::{Command, Form, Setting};
use crate::keys::keys_of;
use crate::settings::Group;
use crate::value::{Choice, Exposure, Number as _, Range, Settable, Switch, theme};
use crate::world::World;

/// Width of the labels of a form in points.
const LABEL_WIDTH: f32 = 74.0;
/// Height of the bar of menus, and of the rim of a menu, in points.
const ABOVE_MENU: f32 = 64.0;
/// What scrolls is never lower than this, in points.
const LOWEST: f32 = 80.0;

/// A label and what belongs to it, in one line.
pub(super) fn row<R>(ui: &mut Ui, label: &str, tip: &str, add: impl FnOnce(&mut Ui) -> R) -> R {
    row_explained(ui, label, |ui| drop(ui.label(tip)), |ui, _| add(ui))
}

/// A label with an explanation that is made when somebody points at it, and what belongs to it; the
/// label's id names that to those who do not see it.
fn row_explained<R>(
    ui: &mut Ui,
    label: &str,
    explain: impl FnOnce(&mut Ui),
    add: impl FnOnce(&mut Ui, Id) -> R,
) -> R {
    ui.horizontal(|ui| {
        let size = vec2(LABEL_WIDTH, ui.spacing().interact_size.y);
        let label = ui.allocate_ui_with_layout(size, Layout::left_to_right(Align::Center), |ui| {
            ui.set_min_width(LABEL_WIDTH);
            let label = Label::new(label).selectable(false).sense(Sense::hover());
            ui.add(label).on_hover_ui(explain).id
        });
        add(ui, label.inner)
    })
    .inner
}

/// A row for a setting, as its table has it; adds the command that the user's hand means.
pub(super) fn setting<G: Group, T: Control>(
    ui: &mut Ui,
    world: &World<'_>,
    setting: &Setting<G, T>,
    commands: &mut Vec<Command>,
) {
    let value = setting.value(world.settings);
    commands.extend(value.control(ui, setting.form, world).map(setting.set));
}

/// A number that is no setting, with the range and the explanation of the command that changes it.
pub(super) fn number(
    ui: &mut Ui,
    world: &World<'_>,
    label: &str,
    form: &'static Form,
    value: f64,
) -> Option<f64> {
    let range = form.range()?;
    slider(ui, label, value, &range, |ui| explain(ui, form, world))
}

/// What a command does, and the keys for it.
fn explain(ui: &mut Ui, form: &Form, world: &World<'_>) {
    ui.label(form.help());
    let keys = keys_of(form, world);
    if !keys.is_empty() {
        ui.label(RichText::new(keys.join("  ")).monospace().strong());
    }
}

/// A value that a row of a panel can show and change.
pub(super) trait Control: Settable {
    /// Shows it; answers the change when the user's hand made one.
    fn control(&self, ui: &mut Ui, form: &'static Form, world: &World<'_>) -> Option<Self::Change>;
}

macro_rules! numbers {
    ($($type:ty),+) => {$(
        impl Control for $type {
            fn control(&self, ui: &mut Ui, form: &'static Form, world: &World<'_>) -> Option<Self> {
                number(ui, world, form.label, form, self.to_f64()).map(Self::from_f64)
            }
        }
    )+};
}

numbers!(f32, u16, u32);

impl Control for Exposure {
    fn control(&self, ui: &mut Ui, form: &'static Form, world: &World<'_>) -> Option<f32> {
        self.stops().control(ui, form, world)
    }
}

impl Control for bool {
    fn control(&self, ui: &mut Ui, form: &'static Form, world: &World<'_>) -> Option<Switch> {
        let mut clicked = *self;
        let response = ui.checkbox(&mut clicked, form.label);
        let changed = response.changed();
        response.on_hover_ui(|ui| explain(ui, form, world));
        changed.then(|| Switch::to(clicked))
    }
}

impl<T: Choice + Settable<Change = T>> Control for T {
    fn control(&self, ui: &mut Ui, form: &'static Form, world: &World<'_>) -> Option<T> {
        let mut chosen = *self;
        row_explained(
            ui,
            form.label,
            |ui| explain(ui, form, world),
            |ui, label| {
                ComboBox::from_id_salt(form.words)
                    .selected_text(self.label())
                    .width(ui.available_width() - 10.0)
                    .show_ui(ui, |ui| {
                        for choice in T::VARIANTS {
                            ui.selectable_value(&mut chosen, *choice, choice.label())
                                .on_hover_text(choice.meaning());
                        }
                    })
                    .response
                    .labelled_by(label)
                    .on_hover_text(self.meaning());
            },
        );
        (chosen != *self).then_some(chosen)
    }
}

/// A checkbox for what is no setting; answers the switch to throw when the user clicked it.
pub(super) fn toggle(ui: &mut Ui, label: &str, tip: &str, value: bool) -> Option<Switch> {
    let mut clicked = value;
    let response = ui.checkbox(&mut clicked, label).on_hover_text(tip);
    response.changed().then(|| Switch::to(clicked))
}

/// A labelled slider; answers the new value when the user moved it.
fn slider(
    ui: &mut Ui,
    label: &str,
    value: f64,
    range: &Range<f64>,
    explain: impl Fn(&mut Ui),
) -> Option<f64> {
    let mut moved = value;
    let suffix = if range.unit.is_empty() { String::new() } else { format!(" {}", range.unit) };
    let response = row_explained(ui, label, &explain, |ui, label| {
        // Long numbers take their room from the slider: a row that is too wide would widen its panel
        // with every frame.
        let letters = format!("{value:.*}", range.decimals).len() + suffix.len();
        let number = (8.0 * letters as f32 + 28.0).max(74.0);
        ui.spacing_mut().slider_width = (ui.available_width() - number).max(30.0);
        ui.add(
            Slider::new(&mut moved, range.low..=range.high)
                .logarithmic(range.logarithmic)
                .fixed_decimals(range.decimals)
                .suffix(suffix),
        )
        .labelled_by(label)
    });
    // A slider also rounds and clamps by itself, and what it makes of a value is no wish of the user's.
    let shown = format!("{:.*}", range.decimals, value.clamp(range.low, range.high));
    let is_rounded = shown.parse::<f64>().is_ok_and(|shown| shown as f32 == moved as f32);
    let by_hand = response.changed() && moved as f32 != value as f32 && !is_rounded;
    response.on_hover_ui(explain);
    by_hand.then_some(moved)
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
