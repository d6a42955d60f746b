//! Scripts: commands that are followed in their order, each as soon as it can be.

use super::Viewer;
use crate::command::{Command, ImageCommand, Trait};

impl Viewer {
    /// Follows the commands of a script in their order, each as soon as what it needs has come and what
    /// the one before began is done.
    pub fn run_script(&mut self, commands: Vec<Command>) {
        for command in commands {
            let is_next = self.source.script.is_empty() && !self.is_at_work();
            let must_wait =
                self.source.makes_wait(&command) || self.holds_back && gives_away(&command);
            if is_next && !must_wait {
                self.apply(command);
            } else {
                self.source.script.push(command);
            }
        }
    }

    /// Whether commands of a script that give something away wait: until all of it has come.
    pub fn hold_back(&mut self, holds_back: bool) {
        self.holds_back = holds_back;
    }

    /// Commands of a script that are still to be followed.
    pub fn commands_left(&self) -> usize {
        self.source.script.len()
    }

    /// The next of them.
    pub fn next_command(&self) -> Option<&Command> {
        self.source.script.first()
    }

    /// True while something that a command began is not done.
    pub(super) fn is_at_work(&self) -> bool {
        self.tasks.is_busy() || self.desktop.is_waiting()
    }

    /// True when nothing is left to do of what was asked for.
    pub fn is_idle(&self) -> bool {
        self.source.script.is_empty() && !self.is_at_work()
    }

    /// Goes on with what is under way, without taking in what has come. True when anything was done.
    pub fn work_on(&mut self) -> bool {
        let finished = self.finish_tasks();
        if let Some(problem) = self.source.shown.image.drop_misfit(&mut self.settings.image) {
            self.say(Err(problem));
        }
        if !self.source.script.is_empty() {
            self.go_on();
        }
        finished
    }

    /// True where the next command of the script waits for something to come.
    pub fn wants_more(&self) -> bool {
        self.next_command().is_some_and(|command| self.source.makes_wait(command))
    }

    /// Goes on with the script as far as what has come allows.
    pub(super) fn go_on(&mut self) {
        let commands = std::mem::take(&mut self.source.script);
        self.run_script(commands);
    }
}

/// True for commands whose result leaves the viewer.
fn gives_away(command: &Command) -> bool {
    match command {
        Command::Image(ImageCommand::Show(layer)) => layer.compares(),
        _ => command.form().is(Trait::Gives),
    }
}
