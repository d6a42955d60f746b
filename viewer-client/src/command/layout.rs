//! `panel`, `fold`, `arrange`, `width`, `reset-panels`: where panels are.

use super::table::table;
use crate::value::{Move, PanelName, Switch, WIDTHS, WindowSide};

table! {
    /// What may be done to the panels at the sides of the window.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub enum LayoutCommand in Layout;

    commands {
        /// Opens or closes a panel.
        Panel "panel" (name: PanelName, switch: Switch);
        /// Folds a panel to its heading, or unfolds it.
        Fold "fold" (name: PanelName, switch: Switch);
        /// Moves a panel.
        Arrange "arrange" (name: PanelName, place: Move);
        /// Sets the width of a side of the window.
        Width "width" (side: WindowSide, points: u16 [WIDTHS]);
        /// Restores the default layout of the panels.
        Usual "reset-panels" | "usual";
    }
}
