//! `undo`, `quit` and others: the program as a whole.

use super::table::table;

table! {
    /// What concerns the program as a whole.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub enum SessionCommand in Session;

    commands {
        /// Takes back what was done last.
        Undo "undo";
        /// Does again what was taken back.
        Redo "redo";
        /// Connects now instead of waiting for the next attempt.
        Reconnect "reconnect";
        /// Closes the viewer.
        Quit "quit", Gives;
    }
}
