//! Filters that have names: switched on and off, turned round, written into the text.

use egui::{Align, Button, Label, Layout, RichText, TextEdit, Ui};

use crate::command::{FilterCommand, MOST_KEPT};
use crate::settings::KeptFilter;
use crate::value::{Switch, name, theme};
use crate::world::World;

/// Keeps filters.
#[derive(Debug, Default)]
pub(super) struct Kept {
    /// The name that is being written.
    name: String,
}

impl Kept {
    pub(super) fn ui(
        &mut self,
        ui: &mut Ui,
        world: &World<'_>,
        filter: &mut impl FnMut(FilterCommand),
    ) {
        let settings = &world.settings.filter;
        for kept in settings.kept() {
            line(ui, kept, filter);
        }
        let any = !settings.text().text().is_empty() || !settings.selectors().is_empty();
        if !any {
            if settings.kept().is_empty() {
                let text = "Keep a filter under a name to switch it on again later.";
                ui.add(Label::new(RichText::new(text).small().weak()).wrap());
            }
            return;
        }
        ui.horizontal(|ui| {
            let width = (ui.available_width() - 62.0).max(60.0);
            let edit = TextEdit::singleline(&mut self.name).hint_text("Name").desired_width(width);
            let edit = ui.add(edit);
            edit.widget_info(|| {
                egui::WidgetInfo::labeled(egui::Role::TextInput, true, "Name of the filter")
            });
            let entered = edit.lost_focus() && ui.input(|i| i.key_pressed(egui::Key::Enter));
            let name = name(&self.name);
            let is_new = |name: &String| settings.kept().iter().all(|kept| kept.name != *name);
            let full = settings.kept().len() >= MOST_KEPT && name.as_ref().is_some_and(is_new);
            let keep = ui.add_enabled(name.is_some() && !full, Button::new("Keep"));
            let keep = keep
                .on_hover_text("Keep the text and spheres under this name")
                .on_disabled_hover_text(if full {
                    "No more filters can be kept; delete one first"
                } else {
                    "Enter a name of at most 40 characters"
                });
            if let Some(name) = name.filter(|_| keep.clicked() || (entered && !full)) {
                filter(FilterCommand::Keep(name));
                self.name.clear();
            }
        });
    }
}

/// A kept filter.
fn line(ui: &mut Ui, kept: &KeptFilter, filter: &mut impl FnMut(FilterCommand)) {
    let name = || kept.name.clone();
    ui.horizontal(|ui| {
        let mut on = kept.on;
        let tip = format!("Apply it in addition to the filter above\n{}", kept.text());
        if ui.checkbox(&mut on, "").on_hover_text(tip).changed() {
            filter(FilterCommand::Use(Switch::to(on), name()));
        }
        let not = Button::selectable(kept.inverted, "not").small();
        if ui.add(not).on_hover_text("Negate this").clicked() {
            filter(FilterCommand::Reverse(Switch::Toggle, name()));
        }
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            let forget = ui.small_button("×").on_hover_text(format!("Delete {}", kept.name));
            let tip = "Load it into the text above to change it";
            let edit = ui.small_button("Edit").on_hover_text(tip);
            if forget.clicked() {
                filter(FilterCommand::Forget(name()));
            }
            if edit.clicked() {
                filter(FilterCommand::Load(name()));
            }
            ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
                let name = RichText::new(&kept.name);
                let (name, tip) = match kept.complaint() {
                    Some(error) => {
                        let color = theme::bad(ui.visuals().dark_mode);
                        let tip = format!("Ignored: {}\n{}", error.message, kept.text());
                        (name.color(color).strikethrough(), tip)
                    }
                    None => (name, kept.text().to_string()),
                };
                ui.add(Label::new(name).truncate()).on_hover_text(tip);
            });
        });
    });
}
