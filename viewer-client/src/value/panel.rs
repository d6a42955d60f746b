//! The sections at the sides of the window.

use super::choice::choices;

choices! {
    /// A section at the sides of the window, from the left of the window to the right.
    #[derive(PartialOrd, Ord)]
    pub enum PanelName {
        /// How paths are drawn.
        Cloud,
        /// Which paths are shown.
        Filter,
        /// How the scene is drawn.
        Scene,
        /// The progressive image.
        Image,
        /// The selected path.
        Path,
        /// The chain that the user steps.
        Explorer,
        /// The file of paths that is played.
        Playback,
        /// Counts and rates.
        Statistics,
        /// Whether the chains can be believed.
        Diagnostics,
    }
}

impl PanelName {
    /// True for those that are on the left side unless they were put elsewhere.
    pub fn is_usually_left(self) -> bool {
        matches!(self, Self::Cloud | Self::Filter | Self::Scene)
    }
}
