//! `connect`, `open`, `leave`, `share`, `screenshot`, `copy`: what goes beyond the window.

use super::table::table;
use crate::value::{Line, Part};

/// Stands for the address of the daemon inside this program.
pub const HOME: &str = "home";

table! {
    /// What goes beyond the window.
    #[derive(Clone, Debug, PartialEq, Eq)]
    pub enum DesktopCommand in Desktop;

    commands {
        /// Watches another daemon, follows a link, or goes back to the own daemon.
        Connect "connect" (address: String [Line::Any("HOST:PORT|LINK|home")]);
        /// Looks at a file of paths.
        Open "open" (file: String [Line::Any("FILE")]);
        /// Leaves what is looked at, and looks at nothing.
        Leave "leave";
        /// Copies a link that restores camera, filter, selection and looks.
        Share "share", Gives;
        /// Writes the whole window as an image.
        Screenshot "screenshot" (file: String [Line::Any("FILE.png")]), Gives;
        /// Copies as text what a panel says, the state of the session, or all settings as commands.
        Copy "copy" (source: Part), Gives;
    }
}
