//! What a section at the sides of the window says of itself.

use super::Panel;
use crate::keys::Group;
use crate::value::PanelName;
use crate::world::World;

/// A section at the sides of the window, which the user may close, fold and put elsewhere.
pub trait Section: Panel + Default + 'static {
    /// What it is called in commands.
    const NAME: PanelName;
    /// Its heading.
    const TITLE: &'static str;
    /// What there is to know of it, for those who ask.
    const HELP: &'static [&'static str];
    /// Whose keys belong to it.
    const KEYS: &'static [Group] = &[];

    /// True where it has something to show, or will have.
    fn applies(_: &World<'_>) -> bool {
        true
    }

    /// What it says, as text for the clipboard; blank where it has nothing to say.
    fn text(world: &World<'_>) -> String;
}

/// A [`Section`] among others.
#[derive(Clone, Copy, Debug)]
pub struct About {
    /// See [`Section::NAME`].
    pub name: PanelName,
    /// See [`Section::TITLE`].
    pub title: &'static str,
    /// See [`Section::HELP`].
    pub help: &'static [&'static str],
    /// See [`Section::KEYS`].
    pub keys: &'static [Group],
    /// See [`Section::applies`].
    pub applies: fn(&World<'_>) -> bool,
    /// See [`Section::text`].
    pub text: fn(&World<'_>) -> String,
    /// A fresh one.
    pub make: fn() -> Box<dyn Panel>,
}

impl About {
    /// What a section says of itself.
    pub const fn of<S: Section>() -> Self {
        Self {
            name: S::NAME,
            title: S::TITLE,
            help: S::HELP,
            keys: S::KEYS,
            applies: S::applies,
            text: S::text,
            make: || Box::new(S::default()),
        }
    }
}
