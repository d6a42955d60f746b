//! The menu of connections: where to, where one was, and what to pass on.

use egui::{Align2, Button, RichText, TextEdit, Ui};

use crate::command::{Command, DesktopCommand, HOME};
use crate::world::World;

/// What the user has typed.
#[derive(Debug)]
pub(super) struct ConnectMenu {
    address: String,
    screenshot: String,
}

impl Default for ConnectMenu {
    fn default() -> Self {
        Self { address: String::new(), screenshot: "lvis.png".to_owned() }
    }
}

impl ConnectMenu {
    pub(super) fn show(&mut self, ui: &mut Ui, world: &World<'_>, commands: &mut Vec<Command>) {
        ui.set_min_width(250.0);
        let hint = "HOST:PORT, or a link";
        if let Some(address) = line(ui, &mut self.address, hint, "Connect") {
            commands.push(Command::Desktop(DesktopCommand::Connect(address)));
            ui.close();
        }
        if world.has_home && !world.status.embedded {
            let tip = "Return to the daemon inside this program";
            if ui.button("The built-in daemon").on_hover_text(tip).clicked() {
                commands.push(Command::Desktop(DesktopCommand::Connect(HOME.to_owned())));
                ui.close();
            }
        }
        if !world.recent.is_empty() {
            ui.label(RichText::new("Recent").small().weak());
        }
        for address in world.recent {
            let here = world.status.is_connected() && *address == world.status.address;
            if ui.add_enabled(!here, Button::new(address)).clicked() {
                commands.push(Command::Desktop(DesktopCommand::Connect(address.clone())));
                ui.close();
            }
        }
        ui.separator();
        let link = ui.button("Copy link to this view").on_hover_text(
            "Restores camera, filter, selection and display settings when opened \
                by viewer-client LINK",
        );
        if link.clicked() {
            commands.push(Command::Desktop(DesktopCommand::Share));
            ui.close();
        }
        if let Some(file) = line(ui, &mut self.screenshot, "file.png", "Screenshot") {
            commands.push(Command::Desktop(DesktopCommand::Screenshot(file)));
            ui.close();
        }
    }
}

/// A text and a button; the text when the button was clicked.
fn line(ui: &mut Ui, text: &mut String, hint: &str, button: &str) -> Option<String> {
    ui.horizontal(|ui| {
        // A line is higher than its text, which would otherwise stick to the upper edge.
        let edit = TextEdit::singleline(text).align(Align2::LEFT_CENTER);
        let edit = ui.add(edit.hint_text(hint).desired_width(140.0));
        let entered = edit.lost_focus() && ui.input(|i| i.key_pressed(egui::Key::Enter));
        let full = !text.trim().is_empty();
        let clicked = ui.add_enabled(full, Button::new(button)).clicked();
        (full && (clicked || entered)).then(|| text.trim().to_owned())
    })
    .inner
}
