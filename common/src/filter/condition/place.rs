//! Which vertices or segments of a path a condition is about.

use crate::filter::word::words;

words! {
    /// Which vertices or segments of a path a condition is about.
    #[derive(Default)]
    pub enum Place: "Which vertices or segments" {
        #[default]
        Any = "any", "at least one, the ends included";
        Start = "start", "the one at the light";
        End = "end", "the one at the camera";
        All = "all", "every vertex between the ends, or every segment; holds where there is none";
    }
}

/// The least of the gaps that can be measured.
pub(super) fn least(gaps: impl Iterator<Item = Option<f64>>) -> Option<f64> {
    gaps.flatten().reduce(f64::min)
}

/// The largest of the gaps, all of which must be measured.
pub(super) fn most(gaps: impl Iterator<Item = Option<f64>>) -> Option<f64> {
    gaps.reduce(|a, b| Some(a?.max(b?))).flatten()
}
