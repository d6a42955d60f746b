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
        /// Shows the paths that a filter wants, beside the selectors.
        Set "filter set" (text: FilterText), Linked;
        /// Shows all paths: neither a text nor a selector is left.
        Clear "filter clear", Linked;
        /// Whether the filter holds at all.
        Enable "filter enable" (switch: Switch), Linked;
        /// Shows the paths that the filter would leave out instead.
        Invert "filter invert" (switch: Switch), Linked;
        /// Selects paths by a sphere, in the file's units.
        Add "filter add" (sphere: Sphere), Linked;
        /// Moves a selector, counted from 0.
        Move "filter move" (number: u32 [NUMBER], place: [f64; 4] [Sphere::PLACE]);
        /// Shows the handles of a selector.
        Choose "filter choose" (number: u32 [NUMBER]);
        /// Removes a selector.
        Delete "filter delete" (number: u32 [NUMBER]);
        /// Removes every selector.
        DeleteAll "filter delete-all" | "filter bare";
        /// Keeps text and selectors under a name.
        Keep "filter keep" (name: String [Line::Name]);
        /// Whether a kept filter holds, beside the others.
        Use "filter use" (switch: Switch, name: String [Line::Name]);
        /// Whether the opposite of a kept filter holds.
        Reverse "filter reverse" (switch: Switch, name: String [Line::Name]);
        /// Writes a kept filter into the text, in the place of text and selectors.
        Load "filter load" (name: String [Line::Name]);
        /// Keeps a filter no longer.
        Forget "filter forget" (name: String [Line::Name]);
    }
}
