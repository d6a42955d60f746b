//! Which path is looked at, and which of its vertices.

use super::Viewer;
use crate::command::{CameraCommand, VertexStep};
use crate::pick::{self, Aim, Pickable};
use crate::selection::Selection;

impl Viewer {
    /// Selects the path under the cursor; where that is the selected one, the next one there.
    pub(super) fn pick(&mut self, aim: Aim) {
        let lens = self.camera.lens(1.0);
        let scene = &self.settings.scene;
        let clip = scene.clip_plane(self.camera.bounds());
        let mesh = self.model.as_ref().map(|model| &model.mesh).filter(|_| scene.covers());
        let surface = mesh
            .and_then(|mesh| pick::surface_at(mesh, &lens, aim.at, !scene.cutaway, clip))
            .map(|(depth, _)| depth);
        let newest = Pickable { newest: self.settings.cloud.shown as usize, clip };
        let hits = pick::paths_at(&self.store, &lens, aim, newest, surface);
        let again = self.pointed.is_some_and(|before| before.is_near(aim));
        let selected = self.selection.as_ref().filter(|_| again).map(|s| s.header.id);
        let found: Vec<Selection> = hits
            .iter()
            .filter_map(|hit| {
                let page = self.store.page(hit.page)?;
                let path = page.paths().get(hit.index)?;
                Some(Selection::new(path.header, page.vertices(path).to_vec()))
            })
            .collect();
        let last = found.iter().position(|s| Some(s.header.id) == selected);
        let next = last.map_or(0, |index| (index + 1) % found.len());
        let count = found.len();
        self.selection = found.into_iter().nth(next);
        if let Some(selection) = &mut self.selection {
            selection.place = (next + 1, count);
        }
        self.pointed = Some(aim);
    }

    pub(super) fn look_at_vertex(&mut self, step: VertexStep) {
        let Some(selection) = &mut self.selection else { return };
        selection.go(step);
        let vertex = selection.vertex.and_then(|index| selection.vertices.get(index));
        if let Some(vertex) = vertex {
            let near = 0.4 * self.camera.bounds().radius();
            self.camera.apply(CameraCommand::Focus(vertex.position, near));
        }
    }

    /// Selects one of the paths at which chains stayed longest; the longest has rank 0.
    pub(super) fn select_stay(&mut self, rank: u8) {
        let diagnostics = self.status.statistics.as_ref().and_then(|s| s.diagnostics.as_deref());
        let Some(batch) = diagnostics.and_then(|d| d.longest.as_ref()) else { return };
        let mut reader = batch.reader();
        for _ in 0..rank {
            reader.next();
        }
        let Some(path) = reader.next() else { return };
        let place = (usize::from(rank) + 1, batch.len());
        let selection = Selection::new(path.header, path.vertices.to_vec());
        self.selection = Some(Selection { place, ..selection });
    }
}
