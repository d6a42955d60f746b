//! The filter applied to the paths that the viewer holds.

use common::{
    CompiledFilter, FilterScene, FilterTally, PathHeader, SceneFrame, SceneMesh, VertexRecord,
};

use super::Viewer;

impl Viewer {
    /// Applies the filter to the paths that are held.
    pub(super) fn judge(&mut self) {
        let filter = self.compiled();
        if filter.is_none() && self.playback.is_none() && !self.settings.cloud.frozen {
            // Only the daemon knows what these names mean, and sends what they want.
            self.store.clear();
        }
        self.store.set_filter(filter);
        self.tally();
    }

    /// Counts what the filter wants of a file of paths, all of which is here.
    pub(super) fn tally(&mut self) {
        self.counted = None;
        if let (Some(_), Some(filter)) = (&self.playback, self.store.filter()) {
            let mut tally = FilterTally::new(0, filter);
            for page in self.store.pages() {
                for path in page.paths() {
                    count(&mut tally, filter, &path.header, page.vertices(path));
                }
            }
            self.counted = Some(tally.counts());
        }
    }

    /// The filter bound to what is known of the scene; `None` where that is not enough.
    fn compiled(&self) -> Option<CompiledFilter> {
        let welcome = self.status.welcome.as_ref();
        let mesh = self.model.as_ref().map(|model| &model.mesh);
        let unknown = SceneFrame { centre: glam::DVec3::ZERO, scale: 1.0, light: 1.0 };
        let none = SceneMesh::default();
        let scene = FilterScene::new(
            welcome.map_or(unknown, |welcome| welcome.frame),
            mesh.unwrap_or(&none),
            welcome.map(|w| w.strategies.clone()).unwrap_or_default(),
        );
        self.settings.filter.whole().tree().ok()?.compile(&scene).ok()
    }
}

/// Counts one path, and how near it came.
fn count(
    tally: &mut FilterTally,
    filter: &CompiledFilter,
    header: &PathHeader,
    vertices: &[VertexRecord],
) {
    let conditions = filter.conditions(header, vertices);
    let wanted = filter.wants(conditions);
    tally.count(header, conditions, wanted);
    if !wanted {
        tally.count_miss(filter, header, vertices, conditions);
    }
}

#[cfg(test)]
mod tests {
    use super::super::Viewer;
    use crate::source::dump::tests::stage;
    use crate::source::status::Status;
    use crate::synthetic::delivery;

    #[test]
    fn what_is_held_is_judged_by_the_filter() {
        let mut viewer = Viewer::new(Status::new("here".to_owned(), false));
        viewer.take(delivery(&[
            &[[-400.0, 0.0, 0.0], [0.0, 0.0, 0.0]],
            &[[0.0, 300.0, 0.0], [50.0, 0.0, 0.0]],
        ]));
        viewer.receive();
        let mut run = |command: &str| {
            viewer.apply(command.parse().expect("a command"));
            viewer.judge();
            (viewer.store.matched(), viewer.store.len())
        };
        assert_eq!(run("filter set any in sphere(0, 0, 0, 60)"), (2, 2), "both touch it");
        assert_eq!(run("filter set any in sphere(0, 0, 0, 40)"), (1, 2), "the other is dimmed");
        assert_eq!(run("filter invert on"), (1, 2), "the other one");
        assert_eq!(run("filter set any on material \"wall\""), (0, 2), "names are known");
        assert_eq!(run("filter clear"), (2, 2), "all match again");
        assert_eq!(run("filter set any on object \"room\""), (2, 2), "objects, too");
        assert_eq!(run("filter set any on object \"box\""), (0, 0), "there is no such thing");
    }

    #[test]
    fn a_file_of_paths_is_filtered_and_counted() {
        let mut viewer = Viewer::new(Status::new("paths.txt".to_owned(), false));
        viewer.open_dump("paths.txt", stage());
        let mut run = |command: &str| {
            viewer.apply(command.parse().expect("a command"));
            viewer.counted.as_ref().map(|c| (c.matched, c.seen, c.energy_share))
        };
        // The first path was the current one for three steps, the second for one.
        assert_eq!(run("filter set acceptance < 1"), Some((1, 2, 0.25)), "the second");
        assert_eq!(run("filter set lpe \"LSE\""), Some((2, 2, 1.0)), "both");
        assert_eq!(run("play to 0"), Some((1, 1, 1.0)), "only what was shown so far");
    }
}
