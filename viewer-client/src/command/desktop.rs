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
        /// Connects to another daemon, opens a link, or returns to the built-in daemon.
        Connect "connect" (address: String [Line::Any("HOST:PORT|LINK|home")]);
        /// Opens a file of paths.
        Open "open" (file: String [Line::Any("FILE")]);
        /// Disconnects from the daemon, or closes the file of paths.
        Leave "leave";
        /// Copies a link that restores camera, filter, selection and display settings.
        Share "share", Gives;
        /// Saves the whole window as an image.
        Screenshot "screenshot" (file: String [Line::Any("FILE.png")]), Gives;
        /// Copies as text the contents of a panel, the state of the session, or all settings as
        /// commands.
        Copy "copy" (source: Part), Gives;
    }
}
