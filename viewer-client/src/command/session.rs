//! `undo`, `quit` and others: the program as a whole.

use super::table::table;

table! {
    /// What concerns the program as a whole.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub enum SessionCommand in Session;

    commands {
        /// Undoes the last change.
        Undo "undo";
        /// Redoes the last change that was undone.
        Redo "redo";
        /// Connects now instead of waiting for the next attempt.
        Reconnect "reconnect";
        /// Closes the viewer.
        Quit "quit", Gives;
    }
}
