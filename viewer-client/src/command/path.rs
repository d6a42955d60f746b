//! `path ...`: the path that is looked at.

use super::table::table;
use crate::value::{Pointer, ShownPath, VertexStep, range};

table! {
    /// What may be done with a path.
    #[derive(Clone, Debug, PartialEq)]
    pub enum PathCommand in Path;

    commands {
        /// Selects the path in a direction, given as tangents from the view direction; again, the
        /// next one there.
        Pick "path pick" (aim: Pointer);
        /// Selects a path at which a chain stayed long; the longest stay is 0.
        Stay "path stay" (rank: u8 [range(0, u8::MAX)]);
        /// Selects a path that is written out, as in a link to a view, whether or not the viewer
        /// holds it.
        Show "path show" (path: ShownPath), Linked;
        /// Selects the explorer's path, before the step that is shown.
        Explored "path explored";
        /// Selects no path.
        Deselect "path none";
        /// Centres the view on a vertex of the selected path.
        Vertex "path vertex" (step: VertexStep);
    }
}
