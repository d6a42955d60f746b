//! The text of the filter: checked while it is written, with what may come next.

use std::ops::Range;
use std::sync::Arc;

use common::{Completion, FilterError, FilterText, complete};
use egui::text::{CCursor, CCursorRange, LayoutJob, TextFormat};
use egui::{
    Button, EventFilter, FontId, Galley, Id, Key, Modifiers, Popup, PopupCloseBehavior, RectAlign,
    RichText, Stroke, TextBuffer, TextEdit, Ui,
};

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
    /// What was read of it.
    read: FilterText,
    of: FilterText,
    /// The choice that Tab takes.
    line: usize,
    /// The choices were sent away until more is written.
    dismissed: bool,
    /// What may come at a byte of the text.
    offered: Option<(usize, Completion)>,
}

impl Draft {
    pub(super) fn ui(
        &mut self,
        ui: &mut Ui,
        world: &World<'_>,
        filter: &mut impl FnMut(FilterCommand),
    ) {
        let current = world.settings.filter.text();
        if self.of != *current {
            self.of.clone_from(current);
            self.text = current.to_string();
        }
        let id = Id::unique("text of the filter");
        let completion = self.offers(ui, id, world);
        if let Some(completion) = &completion {
            self.choose(ui, id, completion);
        }
        self.read_anew();
        let read = self.read.clone();
        let mut layouter = |ui: &Ui, text: &dyn TextBuffer, width: f32| {
            // While it is edited, it is ahead of what was read.
            let fault = read.error().filter(|_| read.text() == text.as_str());
            underlined(ui, text.as_str(), fault.map(|fault| &fault.span), width)
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
            "The text of the filter. Enter applies it, Tab accepts a completion, Escape discards \
            changes.",
        );
        response.widget_info(|| {
            egui::WidgetInfo::labeled(egui::Role::TextInput, true, "Text of the filter")
        });
        if self.text != self.read.text() {
            (self.line, self.dismissed) = (0, false);
        }
        let (enter, escape) = ui.input(|i| (i.key_pressed(Key::Enter), i.key_pressed(Key::Escape)));
        let over_offers = self.show_offers(ui, &response, completion);
        self.read_anew();
        if response.has_focus() && escape {
            self.text = current.to_string();
            response.surrender_focus();
            return;
        }
        if self.text == current.text() {
            misfit(ui, world);
            return;
        }
        let is_done = (response.lost_focus() && !over_offers) || (response.has_focus() && enter);
        match self.read.error() {
            Some(error) => complaint(ui, error, &self.text),
            None if is_done => filter(FilterCommand::Set(FilterText::read(self.text.trim()))),
            None => {
                ui.label(RichText::new("Press Enter to apply").small().weak());
            }
        }
    }

    /// Reads what was written since.
    fn read_anew(&mut self) {
        if self.read.text() != self.text {
            self.read = FilterText::read(self.text.as_str());
            self.offered = None;
        }
    }

    /// What may come where the cursor is, if something is being written.
    fn offers(&mut self, ui: &Ui, id: Id, world: &World<'_>) -> Option<Completion> {
        if self.dismissed || !ui.memory(|memory| memory.has_focus(id)) {
            return None;
        }
        let state = TextEdit::load_state(ui.ctx(), id)?;
        let cursor = state.cursor.char_range()?;
        if !cursor.is_empty() {
            return None;
        }
        let byte = byte_of(&self.text, cursor.primary.index.0);
        let offered = self.offered.take().filter(|(at, _)| *at == byte);
        let offered =
            offered.unwrap_or_else(|| (byte, complete(&self.text, byte, world.filter_scene)));
        let (_, found) = self.offered.insert(offered);
        (!found.choices.is_empty()).then(|| found.clone())
    }

    /// Moves among the choices, takes one, or sends them away.
    fn choose(&mut self, ui: &Ui, id: Id, completion: &Completion) {
        let last = completion.choices.len().min(MOST) - 1;
        self.line = self.line.min(last);
        match key_for_choices(ui) {
            Some(Key::Tab) => self.insert(ui, id, completion, self.line),
            Some(Key::ArrowDown) => self.line = (self.line + 1).min(last),
            Some(Key::ArrowUp) => self.line = self.line.saturating_sub(1),
            Some(_) => self.dismissed = true,
            None => {}
        }
    }

    /// Writes a choice into the text, and puts the cursor behind it.
    fn insert(&mut self, ui: &Ui, id: Id, completion: &Completion, line: usize) {
        let Some((text, cursor)) = completion.taken(&self.text, line) else { return };
        let cursor = text[..cursor].chars().count();
        self.text = text;
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
            .id(Id::unique("possible continuations"))
            .open(true)
            .align(RectAlign::BOTTOM_START)
            .close_behavior(PopupCloseBehavior::IgnoreClicks)
            .show(|ui| {
                ui.set_min_width(210.0);
                ui.spacing_mut().item_spacing.y = 1.0;
                for (number, choice) in completion.choices.iter().take(MOST).enumerate() {
                    let meaning = RichText::new(choice.meaning).small().weak();
                    let text = RichText::new(choice.text.trim_end()).monospace();
                    let button = Button::selectable(number == self.line, text).right_text(meaning);
                    // The text keeps the focus.
                    if ui.add(button).is_pointer_button_down_on() {
                        clicked = Some(number);
                    }
                }
                let hint = match completion.choices.len().saturating_sub(MOST) {
                    0 => "Tab accepts, Escape closes".to_owned(),
                    more => format!("Tab accepts; type for {more} more"),
                };
                ui.label(RichText::new(hint).small().weak());
            });
        let pressed = ui.input(|input| input.pointer.any_pressed());
        if let Some(number) = clicked.filter(|_| pressed) {
            self.insert(ui, response.id, &completion, number);
        }
        shown.is_some_and(|shown| shown.response.contains_pointer())
    }
}

/// The key that is meant for the choices, taken from the text.
fn key_for_choices(ui: &Ui) -> Option<Key> {
    let keys = [Key::Tab, Key::ArrowUp, Key::ArrowDown, Key::Escape];
    ui.input_mut(|input| keys.into_iter().find(|key| input.consume_key(Modifiers::NONE, *key)))
}

/// Why the text in force asks for nothing on this scene.
fn misfit(ui: &mut Ui, world: &World<'_>) {
    if let Some(error) = world.settings.filter.complaint() {
        let color = theme::bad(ui.visuals().dark_mode);
        let text = format!("Ignored: {}", error.message);
        let tip = "The text stays, and applies again on a scene that has what it names";
        let label = egui::Label::new(RichText::new(text).small().color(color)).wrap();
        ui.add(label).on_hover_text(tip);
    }
}

/// What is wrong, and where.
fn complaint(ui: &mut Ui, error: &FilterError, text: &str) {
    let color = theme::bad(ui.visuals().dark_mode);
    let place = text.get(..error.span.start).map_or(0, |before| before.chars().count()) + 1;
    let text = format!("Character {place}: {}", error.message);
    ui.add(egui::Label::new(RichText::new(text).small().color(color)).wrap());
}

/// The text with a line below what is at fault, also where that is its end.
fn underlined(ui: &Ui, text: &str, fault: Option<&Range<usize>>, width: f32) -> Arc<Galley> {
    let format = |stroke| TextFormat {
        underline: stroke,
        ..TextFormat::simple(FontId::monospace(12.0), ui.visuals().text_color())
    };
    let (plain, bad) = (format(Stroke::NONE), format(Stroke::new(2.0, theme::BAD)));
    let mut job = LayoutJob::default();
    job.wrap.max_width = width;
    let [start, end] = fault.map_or([text.len(); 2], |fault| {
        let start = text.floor_char_boundary(fault.start);
        // What ends too early is at fault where it ends: its last letter is marked.
        let last = text.trim_end().char_indices().next_back().map_or(0, |(i, _)| i);
        let start = if start == text.len() { last } else { start };
        [start, text.ceil_char_boundary(fault.end.clamp(start, text.len()))]
    });
    for (part, format) in
        [(&text[..start], &plain), (&text[start..end], &bad), (&text[end..], &plain)]
    {
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
