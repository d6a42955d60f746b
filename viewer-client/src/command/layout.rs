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
        /// Leaves nothing but the heading of a panel, or shows it again.
        Fold "fold" (name: PanelName, switch: Switch);
        /// Puts a panel elsewhere.
        Arrange "arrange" (name: PanelName, place: Move);
        /// Sets the width of a side of the window.
        Width "width" (side: WindowSide, points: u16 [WIDTHS]);
        /// Puts all panels back where they usually are.
        Usual "reset-panels" | "usual";
    }
}
