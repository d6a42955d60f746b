//! `theme`, `scale`, `keys` and others: the window as a whole.

use super::table::{forms, limits, table};
use crate::value::{KeyPreset, MousePreset, Theme, range};

table! {
    /// What may be done to the window as a whole.
    #[derive(Copy)]
    pub enum WindowCommand in Window;

    /// How the window looks, and what it listens to.
    pub struct WindowSettings {
        /// Colours of the interface.
        Theme "theme" (theme: Theme) sets theme = Theme::Dark, "Colours", kept;
        /// Size of texts and buttons.
        Scale "scale" (percent: u16 [range(50, 300).unit("%")]) sets scale = 100, "Size", kept;
        /// Keys of today's programs, or of the Lvis of 2014.
        Keys "keys" (preset: KeyPreset) sets keys = KeyPreset::Today, "Keys", kept;
        /// What dragging does to the camera, as in these programs.
        Mouse "mouse" (preset: MousePreset) sets mouse = MousePreset::Rerun, "Mouse", kept;
        /// Lets others see where you look, and your filter.
        Seen "seen" (switch: bool) sets seen = false, "Seen by others";
        /// Shows the first steps.
        Hint "hint" (switch: bool) sets hint = false, "First steps", kept, passing;
        /// Shows the sheet of keys.
        Help "help" (switch: bool) sets help = false, "Keys and mouse", passing;
        /// Finds a command by typing.
        Palette "palette" (switch: bool) sets palette = false, "Find a command", passing;
    }

    commands {}
}
