//! Everything that a user may ask of the viewer, as tables of commands with one text form each.
//!
//! Keys, menus, panels, scripts and links all end here. To add a command or a setting: its row in
//! the table of its group. `docs/EXTEND.md` walks through both.

mod camera;
mod cloud;
mod desktop;
mod filter;
mod form;
mod image;
mod layout;
mod path;
mod play;
mod scene;
mod session;
mod steer;
mod table;
mod window;

pub use camera::CameraCommand;
pub use cloud::{CloudCommand, CloudSettings};
pub use desktop::{DesktopCommand, HOME};
pub use filter::{FilterCommand, MOST_KEPT};
pub use form::{Form, Setting, Trait};
pub use image::{ImageCommand, ImageSettings};
pub use layout::LayoutCommand;
pub use path::PathCommand;
pub use play::PlayCommand;
pub use scene::{SceneCommand, SceneSettings};
pub use session::SessionCommand;

pub use window::{WindowCommand, WindowSettings};

use std::fmt;
use std::str::FromStr;

use common::Order;

use crate::value::{CommandError, Words};

/// One action.
#[derive(Clone, Debug, PartialEq)]
pub enum Command {
    /// Moves the camera.
    Camera(CameraCommand),
    /// Concerns the paths on screen.
    Cloud(CloudCommand),
    /// Concerns the surfaces and drawing aids.
    Scene(SceneCommand),
    /// Says which paths to show.
    Filter(FilterCommand),
    /// Concerns the progressive image.
    Image(ImageCommand),
    /// Concerns the window as a whole.
    Window(WindowCommand),
    /// Concerns the window's panels.
    Layout(LayoutCommand),
    /// Concerns the path that is looked at.
    Path(PathCommand),
    /// Plays a file of paths.
    Play(PlayCommand),
    /// Goes beyond the window.
    Desktop(DesktopCommand),
    /// Steers explorer and chains, or concerns who may.
    Order(Order),
    /// Shows a step of the explorer by its number, or the newest from now on.
    Scrub(Option<u64>),
    /// Concerns the program.
    Session(SessionCommand),
}

/// The tables, in the order of help texts.
const TABLES: [&[Form]; 12] = [
    camera::FORMS,
    cloud::FORMS,
    scene::FORMS,
    filter::FORMS,
    image::FORMS,
    window::FORMS,
    layout::FORMS,
    path::FORMS,
    play::FORMS,
    desktop::FORMS,
    steer::FORMS,
    session::FORMS,
];

/// Every form of commands, for help and documentation.
pub fn forms() -> impl Iterator<Item = &'static Form> {
    TABLES.into_iter().flatten()
}

/// The form that begins with these words; a promise between the tables and who names their rows.
pub fn form(words: &str) -> &'static Form {
    forms().find(|form| form.words == words).unwrap_or_else(|| panic!("no command is `{words}`"))
}

impl Command {
    /// The form that it has.
    pub fn form(&self) -> &'static Form {
        let of_group = forms().find(|form| form.is_of(self));
        of_group.unwrap_or_else(|| panic!("a command is in no table: {self:?}"))
    }
}

impl fmt::Display for Command {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let form = self.form();
        f.write_str(form.words)?;
        let parameters = (form.write)(self).unwrap_or_default();
        parameters.iter().try_for_each(|parameter| write!(f, " {parameter}"))
    }
}

impl FromStr for Command {
    type Err = CommandError;

    fn from_str(text: &str) -> Result<Self, CommandError> {
        let mut words = Words::new(text);
        let form = find(&mut words)?;
        let command = (form.read)(&mut words)?;
        words.end()?;
        Ok(command)
    }
}

/// The form that fits most of the first words, which are then read.
fn find(words: &mut Words<'_>) -> Result<&'static Form, CommandError> {
    let fitting = |form: &'static Form| {
        let names = form.aliases.iter().chain([&form.words]);
        let after = names.filter_map(|name| {
            let mut after = words.clone();
            after.skip(name).then_some((name.len(), after))
        });
        after.max_by_key(|(length, _)| *length).map(|(length, after)| (length, form, after))
    };
    let best = forms().filter_map(fitting).max_by_key(|(length, ..)| *length);
    let Some((_, form, after)) = best else { return Err(unknown(words.clone())) };
    *words = after;
    Ok(form)
}

/// The complaint about words that begin no command, with what they may have meant.
fn unknown(mut words: Words<'_>) -> CommandError {
    let Some(first) = words.word() else { return CommandError::Nothing };
    let is_group = forms().any(|form| form.words.starts_with(&format!("{first} ")));
    let found = match words.word().filter(|_| is_group) {
        Some(second) => format!("{first} {second}"),
        None => first.to_owned(),
    };
    let likeness = |form: &&Form| (1e6 * strsim::jaro_winkler(form.words, &found)) as u32;
    let near = forms().max_by_key(likeness).filter(|form| likeness(form) > 850_000);
    let help = || "`viewer-client --help` lists the commands".to_owned();
    let remedy = near.map_or_else(help, |form| format!("did you mean `{}`?", form.text()));
    CommandError::Unknown { found, remedy }
}

#[cfg(test)]
mod tests;
