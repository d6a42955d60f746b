//! The filter's text as a tree of conditions that are put together by hand.

mod add;
mod edit;

use common::{Filter, FilterScene, FilterText, Spot, VertexTest};
use egui::{Align, Button, ComboBox, Label, Layout, RichText, Ui, vec2};

use crate::command::FilterCommand;
use crate::world::World;

/// Width of the menu at the end of a line and of the gap before it, in points.
const MORE_WIDTH: f32 = 36.0;

/// What conditions are about: names, and where a new region lies.
#[derive(Debug)]
pub(super) struct Context<'a> {
    scene: &'a FilterScene,
    spot: Spot,
}

impl<'a> Context<'a> {
    fn of(world: &World<'a>) -> Self {
        let bounds = world.camera.bounds();
        let names = world.names();
        let middle = 0.5 * (bounds.min + bounds.max);
        let scale = names.frame.map_or(1.0, |frame| frame.scale);
        let radius = f64::from(bounds.radius()) * 0.1 / scale;
        // Two digits of the radius: a text that people read.
        let grain = 10.0_f64.powf(radius.log10().floor() - 1.0);
        let neat = |x: f64| if grain > 0.0 { (x / grain).round() / (1.0 / grain) } else { x };
        let centre = names.world(middle.into()).map(neat);
        Self { scene: world.filter_scene, spot: Spot { centre, radius: neat(radius) } }
    }
}

/// What the user did with a part of the tree.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Edit {
    Nothing,
    Changed,
    Removed,
}

impl Edit {
    fn or(self, other: Self) -> Self {
        if self == Self::Nothing { other } else { self }
    }

    fn changed(changed: bool) -> Self {
        if changed { Self::Changed } else { Self::Nothing }
    }
}

/// Shows the tree of the text; changes make a new text.
pub(super) fn ui(ui: &mut Ui, world: &World<'_>, push: &mut impl FnMut(FilterCommand)) {
    let Ok(filter) = world.settings.filter.text().tree() else { return };
    let mut filter = filter.clone();
    let context = Context::of(world);
    let edit = if filter == Filter::Constant(true) {
        Edit::Nothing
    } else {
        ui.spacing_mut().item_spacing.x = 4.0;
        node(ui, &mut filter, &context, 0)
    };
    if edit == Edit::Removed {
        push(FilterCommand::Set(FilterText::default()));
        return;
    }
    let mut changed = edit == Edit::Changed;
    ui.horizontal(|ui| {
        let is_group = matches!(filter, Filter::And(_) | Filter::Or(_));
        if is_group {
            return;
        }
        if let Some(more) = add::menu(ui, "+ Condition", &context) {
            filter = match std::mem::take(&mut filter) {
                Filter::Constant(true) => more,
                first => Filter::And(vec![first, more]),
            };
            changed = true;
        }
    });
    if changed {
        push(FilterCommand::Set(FilterText::from(&filter)));
    }
}

/// A part of the tree, `depth` levels below its root.
fn node(ui: &mut Ui, filter: &mut Filter, context: &Context<'_>, depth: usize) -> Edit {
    match filter {
        Filter::And(_) | Filter::Or(_) => group(ui, filter, false, context, depth),
        Filter::Not(inner) if matches!(**inner, Filter::And(_) | Filter::Or(_)) => {
            let edit = group(ui, inner, true, context, depth);
            turn_if_asked(filter, edit)
        }
        Filter::Not(inner) => line(ui, inner, true, context).apply(filter),
        _ => {
            let mut own = std::mem::take(filter);
            let edit = line(ui, &mut own, false, context);
            *filter = own;
            edit.apply(filter)
        }
    }
}

/// What the user did with a line, which stands alone or below a `not`.
#[derive(Debug)]
struct LineEdit {
    edit: Edit,
    turned: bool,
    /// Another condition, and whether either is enough.
    more: Option<(Filter, bool)>,
}

impl LineEdit {
    fn apply(self, filter: &mut Filter) -> Edit {
        if self.turned {
            *filter = std::mem::take(filter).negated();
        }
        if let Some((more, either)) = self.more {
            let parts = vec![std::mem::take(filter), more];
            *filter = if either { Filter::Or(parts) } else { Filter::And(parts) };
            return Edit::Changed;
        }
        if self.turned { self.edit.or(Edit::Changed) } else { self.edit }
    }
}

/// A condition.
fn line(ui: &mut Ui, filter: &mut Filter, negative: bool, context: &Context<'_>) -> LineEdit {
    let mut done = LineEdit { edit: Edit::Nothing, turned: false, more: None };
    let row = vec2(ui.available_width(), ui.spacing().interact_size.y);
    ui.allocate_ui_with_layout(row, Layout::left_to_right(Align::Min), |ui| {
        // The parts wrap beside the menu, which stays at the end of the first line.
        let width = (row.x - MORE_WIDTH).max(0.0);
        ui.vertical(|ui| {
            ui.set_width(width);
            ui.horizontal_wrapped(|ui| parts(ui, &mut *filter, negative, context, &mut done));
        });
        done.more = more(ui, filter, context);
    });
    done
}

/// What can be chosen of a condition.
fn parts(
    ui: &mut Ui,
    filter: &mut Filter,
    negative: bool,
    context: &Context<'_>,
    done: &mut LineEdit,
) {
    if ui.small_button("×").on_hover_text("Remove this condition").clicked() {
        done.edit = Edit::Removed;
    }
    let not = Button::selectable(negative, "not").small();
    done.turned = ui.add(not).on_hover_text("Negate this").clicked();
    match filter {
        Filter::Leaf(leaf) => {
            let changed = edit::edit(ui, leaf, context);
            done.edit = done.edit.or(Edit::changed(changed));
        }
        other => {
            fixed(ui, other.to_string());
        }
    }
}

/// What else can be done with a condition: another one beside it, and whether either is enough.
fn more(ui: &mut Ui, filter: &Filter, context: &Context<'_>) -> Option<(Filter, bool)> {
    let menu = ui.menu_button("…", |ui| {
        let and = ui.menu_button("and …", |ui| add::choices(ui, context)).inner.flatten();
        let or = ui.menu_button("or …", |ui| add::choices(ui, context)).inner.flatten();
        if ui.button("Copy as text").clicked() {
            ui.ctx().copy_text(filter.to_string());
            ui.close();
        }
        and.map(|other| (other, false)).or_else(|| or.map(|other| (other, true)))
    });
    menu.response.on_hover_text("Combine it with another condition, or copy it");
    menu.inner.flatten()
}

/// Several parts, and how they are joined.
fn group(
    ui: &mut Ui,
    filter: &mut Filter,
    negative: bool,
    context: &Context<'_>,
    depth: usize,
) -> Edit {
    let mut either = matches!(filter, Filter::Or(_));
    let (Filter::And(mut parts) | Filter::Or(mut parts)) = std::mem::take(filter) else {
        return Edit::Nothing;
    };
    let mut edit = Edit::Nothing;
    let mut turned = false;
    ui.horizontal(|ui| {
        if ui.small_button("×").on_hover_text("Remove all of these").clicked() {
            edit = Edit::Removed;
        }
        let not = Button::selectable(negative, "not").small();
        turned = ui.add(not).on_hover_text("Negate all of this").clicked();
        let before = either;
        ComboBox::from_id_salt(("join", depth))
            .width(76.0)
            .selected_text(if either { "any of" } else { "all of" })
            .show_ui(ui, |ui| {
                ui.selectable_value(&mut either, false, "all of");
                ui.selectable_value(&mut either, true, "any of");
            })
            .response
            .on_hover_text("Whether a path must meet all of these conditions, or any of them");
        edit = edit.or(Edit::changed(before != either));
        if let Some(more) = add::menu(ui, "+", context) {
            parts.push(more);
            edit = edit.or(Edit::Changed);
        }
    });
    let mut gone = None;
    ui.indent(("parts", depth), |ui| {
        for (index, part) in parts.iter_mut().enumerate() {
            ui.push_id(index, |ui| match node(ui, part, context, depth + 1) {
                Edit::Removed => gone = Some(index),
                other => edit = edit.or(other),
            });
        }
    });
    if let Some(index) = gone {
        parts.remove(index);
        edit = edit.or(Edit::Changed);
    }
    *filter = match parts.len() {
        0 => return Edit::Removed,
        1 => parts.remove(0),
        _ if either => Filter::Or(parts),
        _ => Filter::And(parts),
    };
    if turned {
        *filter = Filter::Not(Box::new(std::mem::take(filter)));
        return edit.or(Edit::Changed);
    }
    edit
}

/// A group below a `not` that was turned is below two of them: neither is needed.
fn turn_if_asked(filter: &mut Filter, edit: Edit) -> Edit {
    if let Filter::Not(inner) = filter
        && let Filter::Not(twice) = inner.as_mut()
    {
        *filter = std::mem::take(twice);
    }
    edit
}

/// The tests of one vertex that are joined, each with its own line.
fn joined_tests(
    ui: &mut Ui,
    parts: &mut Vec<VertexTest>,
    either: &mut bool,
    context: &Context<'_>,
) -> bool {
    let mut changed = false;
    let mut gone = None;
    let mut test = |ui: &mut Ui, index: usize, part: &mut VertexTest| {
        if index > 0 {
            let word = if *either { "or" } else { "and" };
            let tip = "At the same vertex; click to switch between `and` and `or`";
            if ui.small_button(word).on_hover_text(tip).clicked() {
                *either = !*either;
                changed = true;
            }
        }
        changed |= edit::edit_test(ui, part, context);
        if ui.small_button("×").on_hover_text("Remove this test").clicked() {
            gone = Some(index);
        }
    };
    // Each begins at the left: what wraps in the middle of a line has no room to go on.
    ui.end_row();
    ui.vertical(|ui| {
        for (index, part) in parts.iter_mut().enumerate() {
            ui.push_id(index, |ui| ui.horizontal_wrapped(|ui| test(ui, index, part)));
        }
    });
    if let Some(index) = gone {
        parts.remove(index);
    }
    changed || gone.is_some()
}

/// A text that stands for something that cannot be edited here.
fn fixed(ui: &mut Ui, text: String) {
    ui.add(Label::new(RichText::new(text).monospace().size(11.0)).wrap());
}

#[cfg(test)]
mod tests;
