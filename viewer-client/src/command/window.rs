//! `theme`, `scale`, `keys` and others: the window as a whole.

use super::table::table;
use crate::value::{KeyPreset, MousePreset, Theme, range};

table! {
    /// What may be done to the window as a whole.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub enum WindowCommand in Window;

    /// How the window looks, and what it listens to.
    #[derive(Clone, Debug, PartialEq, Eq)]
    pub struct WindowSettings {
        /// Colours of the interface.
        Theme "theme" (theme: Theme) sets theme = Theme::Dark, "Colours", Kept;
        /// Size of text and buttons.
        Scale "scale" (percent: u16 [range(50, 300).unit("%")]) sets scale = 100, "Size", Kept;
        /// Modern keys, or those of the Lvis of 2014.
        Keys "keys" (preset: KeyPreset) sets keys = KeyPreset::Today, "Keys", Kept;
        /// What dragging does to the camera, as in one of these programs.
        Mouse "mouse" (preset: MousePreset) sets mouse = MousePreset::Rerun, "Mouse", Kept;
        /// Lets other viewers see where you look, and your filter.
        Seen "seen" (switch: bool) sets seen = false, "Show others where I look";
        /// Shows the first steps.
        Hint "hint" (switch: bool) sets hint = false, "First steps", Kept, Passing;
        /// Shows the list of keys.
        Help "help" (switch: bool) sets help = false, "Keys and mouse", Passing;
        /// Finds a command by typing.
        Palette "palette" (switch: bool) sets palette = false, "Find a command", Passing;
    }

    commands {}
}
