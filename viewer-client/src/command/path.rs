//! `path ...`: the path that is looked at.

use super::table::table;
use crate::value::{Pointer, ShownPath, VertexStep, range};

table! {
    /// What may be done with a path.
    #[derive(Clone, Debug, PartialEq)]
    pub enum PathCommand in Path;

    commands {
        /// Selects the path at tangents from the view direction; again, the next one there.
        Pick "path pick" (aim: Pointer);
        /// Selects a path at which a chain stayed long; the longest stay is 0.
        Stay "path stay" (rank: u8 [range(0, u8::MAX)]);
        /// Selects a path that is written out, as in a link to a view, held or not.
        Show "path show" (path: ShownPath), Linked;
        /// Selects the explorer's path, before the step that is shown.
        Explored "path explored";
        /// Selects no path.
        Deselect "path none";
        /// Brings a vertex of the selected path into the middle of the view.
        Vertex "path vertex" (step: VertexStep);
    }
}
