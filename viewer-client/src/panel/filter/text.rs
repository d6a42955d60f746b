//! The text of the filter: checked while it is written, with what may come next.

use std::ops::Range;
use std::sync::Arc;

use common::{Filter, FilterError, Named, Rgb};
use egui::text::{CCursor, CCursorRange, LayoutJob, TextFormat};
use egui::{
    Button, EventFilter, FontId, Galley, Id, Key, Modifiers, Popup, PopupCloseBehavior, RectAlign,
    RichText, Stroke, TextBuffer, TextEdit, Ui,
};

use super::complete::{self, Completion, Vocabulary};
use crate::command::FilterCommand;
use crate::value::theme;
use crate::world::World;

/// Choices that are shown at most; typing finds the others.
const MOST: usize = 8;

/// Keys that the text keeps for itself; Escape would otherwise leave it before it is taken back.
const KEYS: EventFilter =
    EventFilter { tab: true, horizontal_arrows: true, vertical_arrows: true, escape: true };

/// What is being written, and the text in force when that began.
#[derive(Debug, Default)]
pub(super) struct Draft {
    text: String,
    of: String,
    /// The choice that Tab takes.
    line: usize,
    /// The choices were sent away until more is written.
    dismissed: bool,
}

impl Draft {
    pub(super) fn ui(
        &mut self,
        ui: &mut Ui,
        world: &World<'_>,
        filter: &mut impl FnMut(FilterCommand),
    ) {
        let current = &world.settings.filter.text;
        if self.of != *current {
            self.of.clone_from(current);
            self.text.clone_from(current);
        }
        let id = Id::unique("text of the filter");
        let completion = self.offers(ui, id, world);
        if let Some(completion) = &completion {
            self.choose(ui, id, completion);
        }
        let problem = Filter::parse(&self.text).err();
        let fault = problem.as_ref().map(|problem| problem.span.clone());
        let before = self.text.clone();
        let mut layouter = |ui: &Ui, text: &dyn TextBuffer, width: f32| {
            underlined(ui, text.as_str(), fault.clone(), width)
        };
        let edit = TextEdit::multiline(&mut self.text)
            .id(id)
            .hint_text("any on material \"glass\" and edges >= 4")
            .desired_rows(2)
            .desired_width(f32::INFINITY)
            .return_key(egui::KeyboardShortcut::new(Modifiers::SHIFT, Key::Enter))
            .layouter(&mut layouter)
            .code_editor()
            .event_filter(KEYS);
        let response = ui.add(edit).on_hover_text(
            "The filter's text. Enter sets it, Tab takes what is offered, Escape takes back.",
        );
        response.widget_info(|| {
            egui::WidgetInfo::labeled(egui::Role::TextInput, true, "Text of the filter")
        });
        if self.text != before {
            (self.line, self.dismissed) = (0, false);
        }
        let (enter, escape) = ui.input(|i| (i.key_pressed(Key::Enter), i.key_pressed(Key::Escape)));
        let over_offers = self.show_offers(ui, &response, completion);
        if response.has_focus() && escape {
            self.text.clone_from(current);
            response.surrender_focus();
            return;
        }
        if self.text == *current {
            return;
        }
        match Filter::parse(&self.text) {
            Err(error) => complaint(ui, &error, &self.text),
            Ok(_) if (response.lost_focus() && !over_offers) || (response.has_focus() && enter) => {
                filter(FilterCommand::text(self.text.trim().to_owned()));
            }
            Ok(_) => {
                ui.label(RichText::new("Enter sets it").small().weak());
            }
        }
    }

    /// What may come where the cursor is, if something is being written.
    fn offers(&self, ui: &Ui, id: Id, world: &World<'_>) -> Option<Completion> {
        if self.dismissed || !ui.memory(|memory| memory.has_focus(id)) {
            return None;
        }
        let state = TextEdit::load_state(ui.ctx(), id)?;
        let cursor = state.cursor.char_range()?;
        if !cursor.is_empty() {
            return None;
        }
        let byte = byte_of(&self.text, cursor.primary.index.0);
        let found = complete::complete(&self.text, byte, &vocabulary(world));
        (!found.choices.is_empty()).then_some(found)
    }

    /// Moves among the choices, takes one, or sends them away.
    fn choose(&mut self, ui: &Ui, id: Id, completion: &Completion) {
        let last = completion.choices.len().min(MOST) - 1;
        self.line = self.line.min(last);
        match key_for_choices(ui) {
            Some(Key::Tab) => self.take(ui, id, completion, self.line),
            Some(Key::ArrowDown) => self.line = (self.line + 1).min(last),
            Some(Key::ArrowUp) => self.line = self.line.saturating_sub(1),
            Some(_) => self.dismissed = true,
            None => {}
        }
    }

    /// Writes a choice into the text, and puts the cursor behind it.
    fn take(&mut self, ui: &Ui, id: Id, completion: &Completion, line: usize) {
        let Some(choice) = completion.choices.get(line) else { return };
        let Range { start, end } = completion.range;
        let (Some(before), Some(after)) = (self.text.get(..start), self.text.get(end..)) else {
            return;
        };
        let word = choice.text.ends_with(|c: char| c.is_alphanumeric() || c == '"' || c == '=');
        let in_quotes = before.matches('"').count() % 2 == 1 && !choice.text.starts_with('"');
        let blank = if word && !in_quotes && !after.starts_with(' ') { " " } else { "" };
        let written = format!("{before}{}{blank}", choice.text);
        let cursor = written.chars().count();
        self.text = format!("{written}{after}");
        self.line = 0;
        let mut state = TextEdit::load_state(ui.ctx(), id).unwrap_or_default();
        state.cursor.set_char_range(Some(CCursorRange::one(CCursor::new(cursor))));
        TextEdit::store_state(ui.ctx(), id, state);
        ui.memory_mut(|memory| memory.request_focus(id));
    }

    /// Shows the choices below the text; true while the user's hand is on them.
    fn show_offers(
        &mut self,
        ui: &Ui,
        response: &egui::Response,
        completion: Option<Completion>,
    ) -> bool {
        let Some(completion) = completion else { return false };
        let mut clicked = None;
        let shown = Popup::from_response(response)
            .id(Id::unique("what may come next"))
            .open(true)
            .align(RectAlign::BOTTOM_START)
            .close_behavior(PopupCloseBehavior::IgnoreClicks)
            .show(|ui| {
                ui.set_min_width(210.0);
                ui.spacing_mut().item_spacing.y = 1.0;
                for (number, choice) in completion.choices.iter().take(MOST).enumerate() {
                    let meaning = RichText::new(choice.meaning).small().weak();
                    let text = RichText::new(&choice.text).monospace();
                    let button = Button::selectable(number == self.line, text).right_text(meaning);
                    // The text keeps the focus.
                    if ui.add(button).is_pointer_button_down_on() {
                        clicked = Some(number);
                    }
                }
                let hint = match completion.choices.len().saturating_sub(MOST) {
                    0 => "Tab takes it, Escape closes".to_owned(),
                    more => format!("Tab takes it; {more} more by typing"),
                };
                ui.label(RichText::new(hint).small().weak());
            });
        let pressed = ui.input(|input| input.pointer.any_pressed());
        if let Some(number) = clicked.filter(|_| pressed) {
            self.take(ui, response.id, &completion, number);
        }
        shown.is_some_and(|shown| shown.response.contains_pointer())
    }
}

/// The key that is meant for the choices, taken from the text.
fn key_for_choices(ui: &Ui) -> Option<Key> {
    let keys = [Key::Tab, Key::ArrowUp, Key::ArrowDown, Key::Escape];
    ui.input_mut(|input| keys.into_iter().find(|key| input.consume_key(Modifiers::NONE, *key)))
}

/// What is wrong, and where.
fn complaint(ui: &mut Ui, error: &FilterError, text: &str) {
    let color = theme::bad(ui.visuals().dark_mode);
    let place = text.get(..error.span.start).map_or(0, |before| before.chars().count()) + 1;
    let text = format!("Character {place}: {}", error.message);
    ui.add(egui::Label::new(RichText::new(text).small().color(color)).wrap());
}

/// The text with a line below what is at fault, also where that is its end.
fn underlined(ui: &Ui, text: &str, fault: Option<Range<usize>>, width: f32) -> Arc<Galley> {
    let format = |stroke| TextFormat {
        underline: stroke,
        ..TextFormat::simple(FontId::monospace(12.0), ui.visuals().text_color())
    };
    let (plain, bad) = (format(Stroke::NONE), format(Stroke::new(2.0, theme::BAD)));
    let mut job = LayoutJob::default();
    job.wrap.max_width = width;
    let fault = fault.unwrap_or(text.len()..text.len());
    let start = text.floor_char_boundary(fault.start.min(text.len()));
    // What ends too early is at fault where it ends: its last letter is marked.
    let start = if start == text.len() && fault.start == fault.end && fault.end > 0 {
        text[..start].trim_end().char_indices().next_back().map_or(start, |(i, _)| i)
    } else {
        start
    };
    let end = text.ceil_char_boundary(fault.end.clamp(start, text.len()));
    let is_fault = Filter::parse(text).is_err();
    for (part, format) in [
        (&text[..start], &plain),
        (&text[start..end], if is_fault { &bad } else { &plain }),
        (&text[end..], &plain),
    ] {
        if !part.is_empty() {
            job.append(part, 0.0, format.clone());
        }
    }
    ui.fonts_mut(|fonts| fonts.layout_job(job))
}

/// The byte of a text at which its character of this number begins.
fn byte_of(text: &str, character: usize) -> usize {
    text.char_indices().nth(character).map_or(text.len(), |(byte, _)| byte)
}

/// The names that the scene has, as far as they have come.
pub(in crate::panel) fn vocabulary(world: &World<'_>) -> Vocabulary {
    let names = world.names();
    let Some(mesh) = names.mesh else {
        return Vocabulary { strategies: names.strategies.to_vec(), ..Vocabulary::default() };
    };
    let mut objects: Vec<String> = mesh.objects.iter().map(|o| o.name.clone()).collect();
    objects.sort_unstable();
    objects.dedup();
    objects.retain(|name| !name.is_empty());
    let materials = mesh.materials.iter();
    let lights = materials.clone().filter(|m| m.emission != Rgb::BLACK);
    Vocabulary {
        objects,
        materials: materials.map(|m| m.name.clone()).collect(),
        lights: lights.map(|m| m.name.clone()).collect(),
        strategies: names.strategies.to_vec(),
    }
}

impl Vocabulary {
    /// The names of a kind.
    pub(in crate::panel) fn named(&self, kind: Named) -> &[String] {
        match kind {
            Named::Object => &self.objects,
            Named::Material => &self.materials,
            Named::Light => &self.lights,
        }
    }
}
