//! The filter: asked of a daemon, and applied to the paths that are held.

use std::sync::Arc;

use common::{CompiledFilter, FilterTally, PathHeader, VertexRecord};

use super::{Origin, Shown, Source};
use crate::settings::Settings;

impl Source {
    /// Notes that the user has changed the filter. A daemon hears of it when the hand has rested.
    pub fn filter_changed(&mut self, settings: &Settings) {
        match &mut self.origin {
            Origin::Daemon(daemon) => daemon.filter_changed(),
            // Files are small, and nobody else has to be asked.
            Origin::Nothing | Origin::File(_) => self.judge(settings),
        }
    }

    /// Tells the daemon which paths to send from now on, once it is known what its scene is.
    pub(super) fn ask_for_paths(&mut self, settings: &Settings) {
        if self.status.welcome.is_none() || !self.shown.scene_came {
            return;
        }
        if let Origin::Daemon(daemon) = &mut self.origin
            && !daemon.ask_for_paths(settings.filter.whole())
        {
            let problem = "The filter was not sent, because the daemon is busy; apply it again.";
            self.status.say(Err(problem.to_owned()));
        }
    }

    /// Applies the filter to the paths that are held. Until a daemon has answered, they show what the
    /// filter does.
    pub fn judge(&mut self, settings: &Settings) {
        let filter = self.compiled(settings);
        let is_file = matches!(self.origin, Origin::File(_));
        if filter.is_none() && !is_file && !settings.cloud.frozen {
            // Only the daemon knows what these names mean, and sends what they want.
            self.shown.store.clear();
        }
        self.shown.store.set_filter(filter);
        self.tally();
    }

    /// Counts what the filter wants of a file of paths, all of which is here.
    pub(super) fn tally(&mut self) {
        self.shown.counted = None;
        let store = &self.shown.store;
        if let (Origin::File(_), Some(filter)) = (&self.origin, store.filter()) {
            let mut tally = FilterTally::new(0, filter);
            for page in store.pages() {
                for path in page.paths() {
                    count(&mut tally, filter, &path.header, page.vertices(path));
                }
            }
            self.shown.counted = Some(tally.counts());
        }
    }

    /// Leaves out of the filter what cannot be asked of this scene, and nothing before one is known.
    pub fn fit(&self, settings: &mut Settings) {
        let Shown { scene_came, filter_scene, .. } = &self.shown;
        settings.filter.fit(scene_came.then(|| Arc::clone(filter_scene)));
    }

    /// The filter bound to what is known of the scene; `None` where that is not enough.
    fn compiled(&self, settings: &Settings) -> Option<CompiledFilter> {
        settings.filter.whole().tree().ok()?.compile(&self.shown.filter_scene).ok()
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
