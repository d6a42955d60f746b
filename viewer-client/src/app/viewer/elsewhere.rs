//! Commands that go beyond the window: other daemons, links, pictures of the window, the filter.

use super::Viewer;
use crate::app::share;
use crate::command::{DeskCommand, HOME};
use crate::panel;
use crate::source::connection::Peer;
use crate::source::status::Status;

impl Viewer {
    /// Does what concerns more than the window.
    pub(super) fn go_beyond(&mut self, command: DeskCommand) {
        match command {
            DeskCommand::Connect(place) => {
                if let Err(problem) = self.connect(&place) {
                    self.status.say(Err(problem));
                }
            }
            DeskCommand::Share => {
                let selection = self.selection.as_ref();
                let link =
                    share::link(&self.status.address, &self.camera, &self.settings, selection);
                let said = if self.status.embedded {
                    "Copied a link to this view; it works while this viewer is open."
                } else {
                    "Copied a link to this view."
                };
                self.status.say(Ok(said.to_owned()));
                self.desk.copy(link);
            }
            DeskCommand::Copy(source) => {
                let text = panel::text_of(&self.world(), source);
                self.status.say(if text.trim().is_empty() {
                    Err("There is nothing to copy here yet.".to_owned())
                } else {
                    Ok(format!("Copied {} lines.", text.lines().count()))
                });
                if !text.trim().is_empty() {
                    self.desk.copy(text);
                }
            }
            DeskCommand::Screenshot(file) if self.desk.connect.is_some() => {
                self.desk.photograph(&file);
            }
            DeskCommand::Screenshot(_) => {
                let remedy = "There is no window; use --headless --screenshot-to OUT.png.";
                self.status.say(Err(remedy.to_owned()));
            }
        }
    }

    /// Leaves the daemon, and watches the one at HOST:PORT or where a link leads.
    fn connect(&mut self, place: &str) -> Result<(), String> {
        let (address, commands) = if place.starts_with(share::SCHEME) {
            let shared = share::read(place).map_err(|error| error.to_string())?;
            (shared.address, shared.commands)
        } else if place == HOME {
            let none = "There is no daemon inside this program: it was told to watch another.";
            (self.desk.home.clone().ok_or(none)?, Vec::new())
        } else {
            (place.to_owned(), Vec::new())
        };
        let connect = self.desk.connect.as_ref().ok_or("There is no window to connect for.")?;
        let link = connect(Peer::open(address.clone()))
            .map_err(|error| format!("Cannot connect to {address}: {error}"))?;
        self.link = None;
        let embedded = self.desk.home.as_ref() == Some(&address);
        self.status = Status::new(address, embedded);
        (self.filters, self.filter_in_force) = (0, 0);
        self.waiting.clear();
        self.forget_scene();
        self.set_link(link);
        self.run_script(commands);
        Ok(())
    }

    /// Tells the daemon which paths to send from now on; those before were others.
    pub(super) fn ask_for_paths(&mut self) {
        // Until the daemon answers, what is held shows what the filter does.
        self.judge();
        self.filters += 1;
        self.asked_for.clone_from(self.settings.filter.whole());
        if let Some(link) = &self.link
            && !link.set_filter(self.filters, self.asked_for.to_string())
        {
            let problem = "The filter was not sent: the daemon is busy; set it again.";
            self.status.say(Err(problem.to_owned()));
        }
    }
}

#[cfg(test)]
mod tests {
    use common::FilterReply;

    use super::*;
    use crate::source::connection::Delivery;
    use crate::synthetic::delivery;

    #[test]
    fn paths_of_the_filter_before_are_left_out() {
        let path: &[[f32; 3]] = &[[1.0, 2.0, 3.0], [4.0, 6.0, 3.0]];
        let mut viewer = Viewer::new(Status::new("127.0.0.1:50061".to_owned(), false));
        viewer.take(delivery(&[path, path]));
        viewer.receive();
        assert_eq!(viewer.store.len(), 2, "all paths");
        let refused = FilterReply {
            revision: 1,
            error: Some(common::FilterError { span: 0..1, message: "odd".to_owned() }),
            ..FilterReply::default()
        };
        viewer.take(Delivery { filter: Some(refused), ..Delivery::default() });
        assert_eq!(viewer.store.len(), 2, "a refused filter changes nothing");
        assert!(viewer.status.notice.as_ref().is_some_and(|n| n.is_bad), "but is told");
        let reply = FilterReply { revision: 2, ..FilterReply::default() };
        viewer.take(Delivery { filter: Some(reply), ..Delivery::default() });
        assert_eq!(viewer.store.len(), 0, "others are on their way");
        let late = Delivery { batches: delivery(&[path]).batches, ..Delivery::default() };
        viewer.take(late);
        viewer.receive();
        assert_eq!(viewer.store.len(), 0, "these were chosen before");
        viewer.filter_in_force = 0;
        viewer.take(Delivery { batches: delivery(&[path]).batches, ..Delivery::default() });
        viewer.receive();
        assert_eq!(viewer.store.len(), 1, "those of the filter in force are kept");
    }
}
