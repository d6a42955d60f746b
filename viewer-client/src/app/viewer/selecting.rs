//! The path that is looked at.

use crate::command::{CameraCommand, PathCommand};
use crate::draw::pick::Sight;
use crate::source::selection::Selection;
use crate::value::Pointer;
use crate::value::VertexStep;

use super::Viewer;

impl Viewer {
    /// Follows a command about the path that is looked at.
    pub(super) fn select(&mut self, command: PathCommand) {
        match command {
            PathCommand::Pick(pointer) => self.pick(pointer),
            PathCommand::Deselect => self.source.shown.selection = None,
            PathCommand::Stay(rank) => self.source.select_stay(rank),
            PathCommand::Explored => self.source.select_explored(),
            PathCommand::Show(path) => {
                self.source.shown.selection = Some(Selection::new(path.header, path.vertices));
            }
            PathCommand::Vertex(step) => self.look_at_vertex(step),
        }
        self.source.inspect();
    }

    /// Selects the path under the cursor; where that is the selected one, the next one there.
    fn pick(&mut self, pointer: Pointer) {
        let shown = &mut self.source.shown;
        let sight = Sight {
            store: &shown.store,
            lens: &shown.camera.lens(1.0),
            bounds: shown.camera.bounds(),
            scene: &self.settings.scene,
            mesh: shown.model.as_ref().map(|model| &model.mesh),
            newest: self.settings.cloud.shown as usize,
        };
        let found = sight.paths(pointer);
        let again = shown.pointed.is_some_and(|before| before.is_near(pointer));
        let selected = shown.selection.as_ref().filter(|_| again).map(|s| s.header.id);
        let last = found.iter().position(|s| Some(s.header.id) == selected);
        let next = last.map_or(0, |index| (index + 1) % found.len());
        shown.selection = found.into_iter().nth(next);
        shown.pointed = Some(pointer);
    }

    fn look_at_vertex(&mut self, step: VertexStep) {
        let shown = &mut self.source.shown;
        let Some(selection) = &mut shown.selection else { return };
        selection.go(step);
        let vertex = selection.vertex.and_then(|index| selection.vertices.get(index));
        if let Some(vertex) = vertex {
            let near = 0.4 * shown.camera.bounds().radius();
            shown.camera.apply(CameraCommand::Focus(vertex.position, near));
        }
    }
}
