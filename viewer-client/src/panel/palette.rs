//! The palette: everything that can be asked for, found by typing.

use egui::{Button, Frame, Id, Key, Label, Modal, RichText, ScrollArea, TextEdit, Ui};

use super::Panel;
use super::widgets::capitalised;
use crate::command::{Command, WindowCommand, forms};
use crate::keys::{bindings, key_name};
use crate::value::Switch;
use crate::value::theme;
use crate::world::World;

/// Width in points.
const WIDTH: f32 = 560.0;
/// Lines that are shown at most; typing finds the others.
const MOST: usize = 12;

/// Finds and gives commands.
#[derive(Debug, Default)]
pub(super) struct Palette {
    text: String,
    /// Which of the found lines Enter stands for.
    line: usize,
    was_open: bool,
}

/// Something that can be asked for.
struct Entry {
    name: String,
    note: String,
    choice: Choice,
}

/// What choosing an entry does.
enum Choice {
    Run(Command),
    /// A form that wants parameters: its words are put into the line of text.
    Complete(String),
}

impl Panel for Palette {
    fn ui(&mut self, ui: &mut Ui, world: &World<'_>, commands: &mut Vec<Command>) {
        let open = world.settings.window.palette;
        let opened = open && !self.was_open;
        self.was_open = open;
        if !open {
            return;
        }
        if opened {
            (self.text, self.line) = (String::new(), 0);
        }
        let frame = Frame::popup(ui.style()).inner_margin(14);
        let modal = Modal::new(Id::unique("palette")).frame(frame).show(ui.ctx(), |ui| {
            ui.set_width(WIDTH.min(ui.ctx().content_rect().width() - 40.0));
            self.search(ui, world)
        });
        let leaves = modal.should_close();
        let chosen = match modal.inner {
            Some(Choice::Complete(text)) => {
                (self.text, self.line) = (text, 0);
                None
            }
            Some(Choice::Run(command)) => Some(command),
            None => None,
        };
        if leaves || chosen.is_some() {
            commands.push(Command::Window(WindowCommand::Palette(Switch::Off)));
        }
        commands.extend(chosen);
    }
}

impl Palette {
    fn search(&mut self, ui: &mut Ui, world: &World<'_>) -> Option<Choice> {
        let (up, down, enter) = ui.input_mut(|input| {
            let mut pressed = |key| input.consume_key(egui::Modifiers::NONE, key);
            (pressed(Key::ArrowUp), pressed(Key::ArrowDown), pressed(Key::Enter))
        });
        let edit = TextEdit::singleline(&mut self.text)
            .hint_text("Type what you want to do, or a command such as `cloud width 3`")
            .desired_width(f32::INFINITY);
        let response = ui.add(edit).on_hover_text("Arrow keys choose a line, Enter runs it");
        response.request_focus();
        if response.changed() {
            self.line = 0;
        }
        let mut found = find(self.text.trim(), world);
        let last = found.len().saturating_sub(1).min(MOST - 1);
        self.line = (self.line + usize::from(down)).saturating_sub(usize::from(up)).min(last);
        let mut clicked = None;
        ui.add_space(6.0);
        ScrollArea::vertical().max_height(420.0).show(ui, |ui| {
            for (number, entry) in found.iter().take(MOST).enumerate() {
                let button = Button::selectable(number == self.line, entry.name.as_str())
                    .shortcut_text(RichText::new(entry.note.as_str()).weak());
                if ui.add_sized([ui.available_width(), 22.0], button).clicked() {
                    clicked = Some(number);
                }
            }
        });
        if found.is_empty() {
            let problem = self.text.parse::<Command>().err();
            let text = problem.map_or_else(|| "Nothing found".to_owned(), |p| p.to_string());
            ui.add(Label::new(RichText::new(text).color(theme::BUSY)).wrap());
        }
        let number = clicked.or_else(|| enter.then_some(self.line))?;
        (number < found.len()).then(|| found.swap_remove(number).choice)
    }
}

/// What fits `text`: the command that it is, then keys, then forms of commands.
fn find(text: &str, world: &World<'_>) -> Vec<Entry> {
    let mut found = Vec::new();
    if let Ok(command) = text.parse::<Command>() {
        let note = "this command".to_owned();
        found.push(Entry { name: text.to_owned(), note, choice: Choice::Run(command) });
    }
    let words: Vec<String> = text.split_whitespace().map(str::to_lowercase).collect();
    let fits = |name: &str| {
        let name = name.to_lowercase();
        words.iter().all(|word| name.contains(word.as_str()))
    };
    let keys = bindings(world.settings.window.keys);
    for binding in keys.into_iter().filter(|binding| fits(binding.help)) {
        let choice = Choice::Run(binding.command(world));
        let (name, note) = (capitalised(binding.help), key_name(binding.shortcut));
        found.push(Entry { name, note, choice });
    }
    for form in forms() {
        let (note, name) = (form.text(), form.help());
        if !fits(&format!("{note} {name}")) {
            continue;
        }
        let choice = match form.words.parse::<Command>() {
            Ok(command) => Choice::Run(command),
            Err(_) => Choice::Complete(format!("{} ", form.words)),
        };
        found.push(Entry { name, note, choice });
    }
    found
}

#[cfg(test)]
mod tests {
    use egui_kittest::kittest::Queryable as _;

    use super::*;
    use crate::command::CloudCommand;
    use crate::panel::tests::{Fixture, shows};

    /// What is asked for after this was typed and Enter was pressed.
    fn typed(text: &str) -> Vec<Command> {
        let mut fixture = Fixture::new(Palette::default());
        fixture.settings.window.palette = true;
        let mut harness = fixture.harness();
        harness.run_steps(3);
        harness.get_by_role(egui::accesskit::Role::TextInput).type_text(text);
        harness.run_steps(3);
        harness.key_press(Key::Enter);
        harness.run_steps(3);
        std::mem::take(&mut harness.state_mut().said)
    }

    #[test]
    fn keys_and_whole_commands_are_found_by_typing() {
        let closed = || Command::Window(WindowCommand::Palette(Switch::Off));
        let clear = Command::Cloud(CloudCommand::Clear);
        assert_eq!(typed("REMOVE path"), [closed(), clear], "a key by words of its meaning");
        let width = Command::Cloud(CloudCommand::Width(3.0));
        assert_eq!(typed("cloud width 3"), [closed(), width], "a command as it is");
        assert_eq!(typed("width of the lines"), [], "a form waits for its parameters");
        assert_eq!(typed("no such thing"), [], "nothing");
    }

    #[test]
    fn an_empty_line_shows_what_there_is() {
        let mut fixture = Fixture::new(Palette::default());
        fixture.settings.window.palette = true;
        let mut harness = fixture.harness();
        harness.run_steps(3);
        assert!(shows(&harness, "Look through the render camera"), "a key");
    }
}
