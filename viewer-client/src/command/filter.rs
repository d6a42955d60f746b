//! `filter ...`: which paths are shown.

use common::FilterText;

use super::table::table;
use crate::value::{Line, MOST_SELECTORS, Range, Sphere, Switch, range};

/// Most kept filters.
pub const MOST_KEPT: usize = 32;
/// Numbers of selectors.
const NUMBER: Range<u32> = range(0, MOST_SELECTORS - 1);

table! {
    /// What may be done to the filter; `docs/FILTERS.md` has the grammar of its text.
    #[derive(Clone, Debug, PartialEq)]
    pub enum FilterCommand in Filter;

    commands {
        /// Shows the paths that match a filter, in addition to the selectors.
        Set "filter set" (text: FilterText), Linked;
        /// Shows all paths: removes the text and every selector.
        Clear "filter clear", Linked;
        /// Switches the filter on or off.
        Enable "filter enable" (switch: Switch), Linked;
        /// Shows the paths that the filter would leave out instead.
        Invert "filter invert" (switch: Switch), Linked;
        /// Adds a sphere that selects paths, in the units of the scene file.
        Add "filter add" (sphere: Sphere), Linked;
        /// Moves and resizes the selector of this number, counted from 0.
        Move "filter move" (number: u32 [NUMBER], place: [f64; 4] [Sphere::PLACE]);
        /// Shows the handles of the selector of this number.
        Choose "filter choose" (number: u32 [NUMBER]);
        /// Removes the selector of this number.
        Delete "filter delete" (number: u32 [NUMBER]);
        /// Removes every selector.
        DeleteAll "filter delete-all" | "filter bare";
        /// Keeps text and selectors under a name.
        Keep "filter keep" (name: String [Line::Name]);
        /// Switches a kept filter on or off, in addition to the others.
        Use "filter use" (switch: Switch, name: String [Line::Name]);
        /// Inverts a kept filter, or undoes that.
        Reverse "filter reverse" (switch: Switch, name: String [Line::Name]);
        /// Loads a kept filter into the text, replacing text and selectors.
        Load "filter load" (name: String [Line::Name]);
        /// Deletes a kept filter.
        Forget "filter forget" (name: String [Line::Name]);
    }
}
