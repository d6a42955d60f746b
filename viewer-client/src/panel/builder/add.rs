//! New conditions, from a menu.

use common::{Filter, Leaf, Proposal};
use egui::{ScrollArea, Ui};

use super::Context;
use crate::panel::widgets::capitalised;

/// A longer menu scrolls.
const HIGHEST: f32 = 320.0;

/// A button with every kind of condition; answers the one that was chosen.
pub(super) fn menu(ui: &mut Ui, label: &str, context: &Context<'_>) -> Option<Filter> {
    let menu = ui.menu_button(label, |ui| choices(ui, context));
    menu.response.on_hover_text("Add a condition");
    menu.inner.flatten()
}

/// The menu's lines.
pub(super) fn choices(ui: &mut Ui, context: &Context<'_>) -> Option<Filter> {
    lines(ui, Leaf::proposals(context.scene, context.spot)).map(Filter::Leaf)
}

/// The lines of a menu, some of them in menus of their own; answers what was chosen.
pub(super) fn lines<T>(ui: &mut Ui, mut proposals: Vec<Proposal<T>>) -> Option<T> {
    let mut chosen = None;
    while !proposals.is_empty() {
        let menu = proposals[0].menu;
        let Some(label) = menu else {
            // Every line is shown, whatever was chosen before it.
            let clicked = line(ui, proposals.remove(0));
            chosen = chosen.or(clicked);
            continue;
        };
        let (own, others) = proposals.into_iter().partition(|proposal| proposal.menu == menu);
        proposals = others;
        let list = |ui: &mut Ui| {
            let own: Vec<Proposal<T>> = own;
            own.into_iter().filter_map(|proposal| line(ui, proposal)).last()
        };
        let scrolled =
            |ui: &mut Ui| ScrollArea::vertical().max_height(HIGHEST).show(ui, list).inner;
        let clicked = ui.menu_button(label, scrolled).inner.flatten();
        chosen = chosen.or(clicked);
    }
    chosen
}

/// A line of a menu; a click answers it and closes the menu.
fn line<T>(ui: &mut Ui, proposal: Proposal<T>) -> Option<T> {
    let Proposal { label, meaning, made, .. } = proposal;
    let Some(made) = made else {
        ui.weak(label);
        return None;
    };
    let clicked = ui.button(label).on_hover_text(capitalised(meaning)).clicked();
    if clicked {
        ui.close();
    }
    clicked.then_some(made)
}
