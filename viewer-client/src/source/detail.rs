//! The path that is looked at, where it does not come from under the cursor, and the numbers behind it.

use std::sync::Arc;
use std::time::Instant;

use common::{DetailReply, PathBatch, PathDetail};

use super::selection::{Detail, Selection};
use super::{Origin, Source, units};

impl Source {
    /// Selects one of the paths at which chains stayed longest; the longest has rank 0.
    pub fn select_stay(&mut self, rank: u8) {
        let Some(batch) = self.longest_stays() else { return };
        let mut reader = batch.reader();
        for _ in 0..rank {
            reader.next();
        }
        let Some(path) = reader.next() else { return };
        let place = (usize::from(rank) + 1, batch.len());
        let selection = Selection::new(path.header, path.vertices.to_vec());
        self.shown.selection = Some(Selection { place, ..selection });
    }

    /// The paths at which chains stayed longest, once the daemon has reported some.
    pub fn longest_stays(&self) -> Option<&PathBatch> {
        let statistics = self.status.statistics.as_ref()?;
        statistics.diagnostics.as_deref()?.longest.as_ref()
    }

    /// Selects the path from which the step of the explorer that is shown was tried.
    pub fn select_explored(&mut self) {
        let focus = &self.status.steering.focus;
        let before = focus.moment().map(|moment| &moment.before);
        if let Some(path) = before.or_else(|| focus.current()) {
            self.shown.selection = Some(Selection::new(path.header, path.vertices.clone()));
        }
    }

    /// Asks for the numbers behind the selected path, once.
    pub fn inspect(&mut self) {
        let Some(selection) = &mut self.shown.selection else { return };
        if selection.detail != Detail::Unasked {
            return;
        }
        let missing = |why: &str| Detail::Missing(why.to_owned());
        selection.detail = match &self.origin {
            Origin::File(_) => missing("A file of paths does not give them."),
            Origin::Daemon(daemon) if daemon.inspect(selection.header.id) => {
                Detail::Asked(Instant::now())
            }
            Origin::Daemon(_) | Origin::Nothing => {
                missing("There is no daemon to ask; select the path again once there is.")
            }
        };
    }

    /// Keeps the numbers behind the selected path, in the units of the scene file.
    pub(super) fn accept_detail(&mut self, DetailReply { path, found }: DetailReply) {
        let found = found.and_then(|detail| self.in_file_units(detail));
        let Some(selection) = self.shown.selection.as_mut().filter(|s| s.header.id == path) else {
            return;
        };
        selection.detail = match found {
            Ok(detail) if detail.vertices.len() == selection.vertices.len() => {
                Detail::Known(Arc::new(detail))
            }
            Ok(_) => Detail::Missing("The daemon answered for another path.".to_owned()),
            Err(why) => Detail::Missing(why),
        };
    }

    fn in_file_units(&self, detail: PathDetail) -> Result<PathDetail, String> {
        let light = self.shown.selection.as_ref().and_then(|selection| selection.vertices.first());
        match light {
            Some(_) if self.shown.model.is_none() => {
                Err("The scene has not arrived yet; select the path again once it has.".to_owned())
            }
            Some(light) => Ok(units::in_file_units(detail, light, &self.names())),
            None => Ok(detail),
        }
    }
}
