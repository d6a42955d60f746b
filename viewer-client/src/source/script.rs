//! What a command needs before it can be followed.

use super::{Origin, Source};
use crate::command::{Command, FilterCommand, ImageCommand, PathCommand};

impl Source {
    /// True for a command that must wait for something to come. Those for the camera wait for the
    /// scene, which would otherwise undo them, and filters for the scene's names; those that give the
    /// image away, or compare it, wait for the image; and those that need a daemon that listens, or a
    /// path to pick, wait for the first paths.
    pub fn makes_wait(&self, command: &Command) -> bool {
        let shown = &self.shown;
        match command {
            Command::Camera(_) | Command::Path(PathCommand::Show(..)) => shown.model.is_none(),
            // Only then it is known whether the scene has what it names.
            Command::Filter(FilterCommand::Set(_)) => {
                matches!(self.origin, Origin::Daemon(_)) && !shown.scene_came
            }
            Command::Path(PathCommand::Vertex(_)) => shown.selection.is_none(),
            Command::Path(PathCommand::Stay(_)) => self.longest_stays().is_none(),
            Command::Order(_) | Command::Path(_) => shown.store.is_empty(),
            Command::Image(
                ImageCommand::Save(_) | ImageCommand::Tev(_) | ImageCommand::Reference(_),
            ) => shown.image.film.size() == [0, 0],
            _ => false,
        }
    }
}
