//! In which ways a bidirectional path tracer could have made the path, and what each would count.

use common::PathDetail;
use egui::{Rect, RichText, Role, Sense, Ui, WidgetInfo, pos2, vec2};

use super::table::Described;
use crate::panel::hover::{self, Pointed};
use crate::source::selection::Selection;
use crate::value::format;
use crate::value::theme;

/// Height of a bar and width of the words before it, in points.
const HEIGHT: f32 = 17.0;
const NUMBER: f32 = 58.0;
/// Classes with more letters are written without blanks.
const MOST_LETTERS: usize = 9;

/// Shows a bar a split, as long as its weight by the balance heuristic.
pub(super) fn show(ui: &mut Ui, path: Described<'_>, detail: &PathDetail) {
    ui.add_space(8.0);
    let title = RichText::new("Ways to make it, by weight").small().weak();
    ui.label(title).on_hover_text(
        "A split generates the vertices left of the bar from the light, those right of it from \
        the eye, and connects them. Its weight is 1 / C over the sum for all splits; C is its \
        contribution if it were the only way to generate the path.",
    );
    for light in 0..detail.reciprocals.len() {
        bar(ui, path, detail, light);
    }
}

/// The class with a bar where light side and eye side meet.
fn parted(selection: &Selection, light: usize) -> String {
    let letters: Vec<char> = selection.class().chars().filter(|c| !c.is_whitespace()).collect();
    let gap = if letters.len() > MOST_LETTERS { "" } else { " " };
    let side = |part: &[char]| part.iter().map(char::to_string).collect::<Vec<_>>().join(gap);
    let (a, b) = letters.split_at(light.min(letters.len()));
    if a.is_empty() { format!("| {}", side(b)) } else { format!("{} | {}", side(a), side(b)) }
}

fn bar(ui: &mut Ui, path: Described<'_>, detail: &PathDetail, light: usize) {
    let share = detail.share(light);
    let possible = detail.reciprocals.get(light).is_some_and(|&reciprocal| reciprocal > 0.0);
    let size = vec2(ui.available_width(), HEIGHT);
    let (rect, response) = ui.allocate_exact_size(size, Sense::hover());
    let class = parted(path.selection, light);
    let number = if possible { format::percent(share, 1.0) } else { "cannot".to_owned() };
    let words = format!("{class}  {number}");
    response.widget_info(|| WidgetInfo::labeled(Role::Label, true, &words));
    let visuals = ui.visuals();
    let ink = if possible { visuals.text_color() } else { visuals.weak_text_color() };
    let strong = visuals.strong_text_color();
    let trough =
        Rect::from_min_max(pos2(rect.left(), rect.top() + 1.0), rect.max - vec2(NUMBER, 1.0));
    let painter = ui.painter_at(rect);
    painter.rect_filled(trough, 2.0, visuals.extreme_bg_color);
    let filled =
        Rect::from_min_size(trough.min, vec2(trough.width() * share as f32, trough.height()));
    painter.rect_filled(filled, 2.0, theme::ACCENT.gamma_multiply(0.55));
    let edge = light.checked_sub(1);
    if edge.is_some_and(|edge| hover::pointed(ui.ctx()) == Some(Pointed::Edge(edge))) {
        let stroke = egui::Stroke::new(1.5, strong);
        painter.rect_stroke(trough, 2.0, stroke, egui::StrokeKind::Inside);
    }
    let font = egui::FontId::monospace(11.0);
    let left = trough.left_center() + vec2(6.0, 0.0);
    painter.text(left, egui::Align2::LEFT_CENTER, class, font.clone(), ink);
    painter.text(rect.right_center(), egui::Align2::RIGHT_CENTER, number, font, ink);
    if response.contains_pointer()
        && let Some(edge) = edge
    {
        hover::point(ui.ctx(), Pointed::Edge(edge));
    }
    response.on_hover_ui(|ui| explain(ui, detail, light));
}

fn explain(ui: &mut Ui, detail: &PathDetail, light: usize) {
    let k = detail.geometry.len();
    ui.label(match light {
        0 => "The walk from the eye hits the light".to_owned(),
        light if light == k => {
            "Everything but the lens is generated from the light, then connected to the lens"
                .to_owned()
        }
        light => {
            format!("x0 to x{} are generated from the light, then connected to x{light}", light - 1)
        }
    });
    let Some(&reciprocal) = detail.reciprocals.get(light) else { return };
    if reciprocal > 0.0 {
        let counts = format::exact(1.0 / reciprocal);
        let text = format!("C      {counts} in luminance of the image");
        ui.label(RichText::new(text).monospace());
        ui.label(RichText::new(format!("weight {:.6}", detail.share(light))).monospace());
    } else {
        ui.label(
            "This split cannot generate the path: an end of the connection is specular, or \
            has no size",
        );
    }
}
