//! Which path is looked at, which of its vertices, and the numbers behind it.

use std::sync::Arc;
use std::time::Instant;

use common::{DetailReply, PathBatch, PathDetail};

use super::Viewer;
use crate::command::{CameraCommand, PathCommand, VertexStep};
use crate::draw::pick::{Aim, Sight};
use crate::source::selection::{Detail, Selection};
use crate::source::units;

impl Viewer {
    /// Follows a command about the path that is looked at.
    pub(super) fn select(&mut self, command: PathCommand) {
        match command {
            PathCommand::Pick(aim) => self.pick(aim),
            PathCommand::Deselect => self.selection = None,
            PathCommand::Stay(rank) => self.select_stay(rank),
            PathCommand::Explored => self.select_explored(),
            PathCommand::Show(header, vertices) => {
                self.selection = Some(Selection::new(*header, vertices));
            }
            PathCommand::Vertex(step) => self.look_at_vertex(step),
        }
        self.inspect();
    }

    /// Selects the path under the cursor; where that is the selected one, the next one there.
    fn pick(&mut self, aim: Aim) {
        let sight = Sight {
            store: &self.store,
            lens: &self.camera.lens(1.0),
            bounds: self.camera.bounds(),
            scene: &self.settings.scene,
            mesh: self.model.as_ref().map(|model| &model.mesh),
            newest: self.settings.cloud.shown as usize,
        };
        let found = sight.paths(aim);
        let again = self.pointed.is_some_and(|before| before.is_near(aim));
        let selected = self.selection.as_ref().filter(|_| again).map(|s| s.header.id);
        let last = found.iter().position(|s| Some(s.header.id) == selected);
        let next = last.map_or(0, |index| (index + 1) % found.len());
        self.selection = found.into_iter().nth(next);
        self.pointed = Some(aim);
    }

    fn look_at_vertex(&mut self, step: VertexStep) {
        let Some(selection) = &mut self.selection else { return };
        selection.go(step);
        let vertex = selection.vertex.and_then(|index| selection.vertices.get(index));
        if let Some(vertex) = vertex {
            let near = 0.4 * self.camera.bounds().radius();
            self.camera.apply(CameraCommand::Focus(vertex.position, near));
        }
    }

    /// Selects one of the paths at which chains stayed longest; the longest has rank 0.
    fn select_stay(&mut self, rank: u8) {
        let Some(batch) = self.longest_stays() else { return };
        let mut reader = batch.reader();
        for _ in 0..rank {
            reader.next();
        }
        let Some(path) = reader.next() else { return };
        let place = (usize::from(rank) + 1, batch.len());
        let selection = Selection::new(path.header, path.vertices.to_vec());
        self.selection = Some(Selection { place, ..selection });
    }

    /// The paths at which chains stayed longest, once the daemon has told of some.
    pub(super) fn longest_stays(&self) -> Option<&PathBatch> {
        let statistics = self.status.statistics.as_ref()?;
        statistics.diagnostics.as_deref()?.longest.as_ref()
    }

    /// Selects the path from which the step of the explorer that is shown was tried.
    fn select_explored(&mut self) {
        let focus = &self.status.steering.focus;
        let before = focus.moment(self.scrub).map(|moment| &moment.before);
        if let Some(path) = before.or_else(|| focus.current()) {
            self.selection = Some(Selection::new(path.header, path.vertices.clone()));
        }
    }

    /// Asks for the numbers behind the selected path, once.
    fn inspect(&mut self) {
        let Some(selection) = &mut self.selection else { return };
        if selection.detail != Detail::Unasked {
            return;
        }
        let missing = |why: &str| Detail::Missing(why.to_owned());
        selection.detail = match &self.link {
            _ if self.playback.is_some() => missing("A file of paths does not tell them."),
            Some(link) if link.inspect(selection.header.id) => Detail::Asked(Instant::now()),
            _ => missing("There is no daemon to ask; select the path again once there is."),
        };
    }

    /// Keeps the numbers behind the selected path, in the units of the scene file.
    pub(super) fn learn(&mut self, DetailReply { path, found }: DetailReply) {
        let found = found.and_then(|detail| self.in_file_units(detail));
        let Some(selection) = self.selection.as_mut().filter(|s| s.header.id == path) else {
            return;
        };
        selection.detail = match found {
            Ok(detail) if detail.vertices.len() == selection.vertices.len() => {
                Detail::Known(Arc::new(detail))
            }
            Ok(_) => Detail::Missing("The daemon told those of another path.".to_owned()),
            Err(why) => Detail::Missing(why),
        };
    }

    fn in_file_units(&self, detail: PathDetail) -> Result<PathDetail, String> {
        let light = self.selection.as_ref().and_then(|selection| selection.vertices.first());
        match light {
            Some(_) if self.model.is_none() => {
                Err("The scene has not come yet; select the path again once it has.".to_owned())
            }
            Some(light) => Ok(units::in_file_units(detail, light, &self.world().names())),
            None => Ok(detail),
        }
    }
}

#[cfg(test)]
mod tests {
    use common::{Notice, PathId, VertexDetail};

    use super::*;
    use crate::source::connection::Delivery;
    use crate::source::status::Status;
    use crate::synthetic::delivery;

    #[test]
    fn numbers_are_kept_with_the_path_that_they_are_about() {
        let mut viewer = Viewer::new(Status::new("here".to_owned(), false));
        viewer.take(delivery(&[&[[-400.0, 0.0, 0.0], [400.0, 0.0, 0.0]]]));
        viewer.receive();
        let batch = crate::synthetic::batch(&[&[[-400.0, 0.0, 0.0], [400.0, 0.0, 0.0]]]);
        let mut reader = batch.reader();
        let path = reader.next().expect("a path");
        viewer.selection = Some(Selection::new(path.header, path.vertices.to_vec()));
        viewer.apply("path vertex 1".parse().expect("a command"));
        let detail = |viewer: &Viewer| viewer.selection.as_ref().map(|s| s.detail.clone());
        assert!(
            matches!(detail(&viewer), Some(Detail::Missing(why)) if why.contains("no daemon")),
            "there is nobody to ask"
        );
        let mut told = |path: PathId, found| {
            let reply = Notice::Detail(Box::new(DetailReply { path, found }));
            viewer.take(Delivery { notices: [reply].into(), ..Delivery::default() });
            detail(&viewer)
        };
        let numbers = |count| PathDetail {
            vertices: vec![VertexDetail::default(); count],
            geometry: vec![1.0; count - 1],
            reciprocals: vec![1.0; count],
        };
        let other = PathId { step: 99, ..PathId::default() };
        assert!(matches!(told(other, Ok(numbers(3))), Some(Detail::Missing(_))), "of another path");
        let known = told(PathId::default(), Ok(numbers(3)));
        assert_eq!(known, Some(Detail::Known(Arc::new(numbers(3)))), "its own");
        let odd = told(PathId::default(), Ok(numbers(4)));
        assert!(matches!(odd, Some(Detail::Missing(_))), "of other vertices");
        let gone = told(PathId::default(), Err("it is gone".to_owned()));
        assert_eq!(gone, Some(Detail::Missing("it is gone".to_owned())), "why");
        let welcome = viewer.status.welcome.as_mut().expect("a daemon");
        welcome.frame.scale = 4.0;
        viewer.learn(DetailReply { path: PathId::default(), found: Ok(numbers(3)) });
        let numbers = viewer.selection.as_ref().and_then(Selection::numbers);
        let geometry = numbers.map(|numbers| numbers.geometry.as_slice());
        assert_eq!(geometry, Some([16.0; 2].as_slice()), "per square unit of the scene file");
    }
}
