//! Commands that concern more than the window: other daemons, links, pictures of the window.

use std::path::Path;

use super::Viewer;
use crate::app::background::{Outcome, TaskResult};
use crate::app::share;
use crate::command::{DesktopCommand, HOME};
use crate::panel;
use crate::source::connection::Peer;
use crate::source::dump::{self, PlayableDump};
use crate::source::{Origin, Source, file};

impl Viewer {
    /// Follows a command that concerns more than the window.
    pub(super) fn use_desktop(&mut self, command: DesktopCommand) {
        match command {
            DesktopCommand::Connect(place) => {
                if let Err(problem) = self.connect(&place) {
                    self.say(Err(problem));
                }
            }
            DesktopCommand::Open(file) => {
                let started = self.tasks.start(move || open(Path::new(&file)));
                if let Err(problem) = started {
                    self.say(Err(problem));
                }
            }
            DesktopCommand::Leave => self.look_at(Source::nothing()),
            DesktopCommand::Share => self.share(),
            DesktopCommand::Copy(part) => {
                let seen = self.source.suited(&self.settings);
                let text = panel::text_of(&self.world(&seen), part);
                self.say(if text.trim().is_empty() {
                    Err("There is nothing to copy yet.".to_owned())
                } else {
                    Ok(format!("Copied {} lines.", text.lines().count()))
                });
                if !text.trim().is_empty() {
                    self.desktop.copy(text);
                }
            }
            DesktopCommand::Screenshot(file) => self.desktop.photograph(&file),
        }
    }

    /// Copies a link to what is seen.
    fn share(&mut self) {
        let Source { origin, status, shown, .. } = &self.source;
        let said = match origin {
            Origin::Daemon(_) if status.embedded => {
                Ok("Copied a link to this view; it works while this viewer is open.".to_owned())
            }
            Origin::Daemon(_) => Ok("Copied a link to this view.".to_owned()),
            Origin::Nothing | Origin::File(_) => {
                Err("A link needs a daemon; connect to one first.".to_owned())
            }
        };
        if said.is_ok() {
            let selection = shown.selection.as_ref();
            let link = share::link(&status.address, &shown.camera, &self.settings, selection);
            self.desktop.copy(link);
        }
        self.say(said);
    }

    /// Watches the daemon at HOST:PORT, the one inside this program, or the one where a link leads.
    fn connect(&mut self, place: &str) -> Result<(), String> {
        let (address, commands) = if place.starts_with(share::SCHEME) {
            let shared = share::read(place).map_err(|error| error.to_string())?;
            (shared.address, shared.commands)
        } else if place == HOME {
            let none = "This program has no built-in daemon, because it was started with the \
                address of another one.";
            (self.desktop.home.clone().ok_or(none)?, Vec::new())
        } else {
            (place.to_owned(), Vec::new())
        };
        let connect = self.desktop.connect.as_ref().ok_or("Connecting needs a window.")?;
        let link = connect(Peer::open(address.clone()))
            .map_err(|error| format!("Cannot connect to {address}: {error}"))?;
        let embedded = self.desktop.home.as_ref() == Some(&address);
        self.look_at(Source::daemon(address, embedded).through(link));
        self.run_script(commands);
        Ok(())
    }
}

/// Reads a file of paths, without the surfaces of a scene.
fn open(file: &Path) -> Outcome {
    let read = dump::read(file).map_err(|error| error.to_string())?;
    let playable = Box::new(PlayableDump::new(read, None));
    Ok(TaskResult::Opened { name: file::name_of(file), playable })
}
