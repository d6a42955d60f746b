//! Batches of paths that have come and are not taken in yet: how many, at most and at least.

use std::collections::VecDeque;
use std::sync::Arc;

use common::{Gap, PathBatch};

/// Bytes of batches that may wait.
const BYTES: usize = 16 << 20;

/// What waits, the oldest first.
#[derive(Debug)]
pub(super) struct Backlog {
    batches: VecDeque<Arc<PathBatch>>,
    paths: usize,
    bytes: usize,
    /// Paths that may wait.
    limit: usize,
    /// Enough has waited: all of it is taken in.
    draining: bool,
}

impl Default for Backlog {
    fn default() -> Self {
        let limit = usize::MAX;
        Self { batches: VecDeque::new(), paths: 0, bytes: 0, limit, draining: false }
    }
}

impl Backlog {
    /// Lets a batch wait. Where too much would, the oldest batches go, but never all; the answer is
    /// what went.
    pub(super) fn push(&mut self, batch: Arc<PathBatch>) -> Option<Gap> {
        self.paths += batch.len();
        self.bytes += batch.byte_len();
        self.batches.push_back(batch);
        self.make_room()
    }

    /// Changes how many paths may wait; the answer is what had to go.
    pub(super) fn set_limit(&mut self, paths: usize) -> Option<Gap> {
        self.limit = paths;
        self.make_room()
    }

    fn make_room(&mut self) -> Option<Gap> {
        let mut gone = Gap::default();
        while (self.paths > self.limit || self.bytes > BYTES) && self.batches.len() > 1 {
            let Some(oldest) = self.pop() else { break };
            gone.batches += 1;
            gone.paths += oldest.len() as u64;
            gone.bytes += oldest.byte_len() as u64;
        }
        (gone.batches > 0).then_some(gone)
    }

    /// True when anything is to be taken in: once `threshold` paths wait, all that do.
    pub(super) fn is_due(&mut self, threshold: usize) -> bool {
        self.draining = !self.batches.is_empty() && (self.draining || self.paths >= threshold);
        self.draining
    }

    /// The oldest batch, where it is to be taken in.
    pub(super) fn next(&mut self, threshold: usize) -> Option<Arc<PathBatch>> {
        if self.is_due(threshold) { self.pop() } else { None }
    }

    fn pop(&mut self) -> Option<Arc<PathBatch>> {
        let batch = self.batches.pop_front()?;
        self.paths -= batch.len().min(self.paths);
        self.bytes -= batch.byte_len().min(self.bytes);
        Some(batch)
    }

    /// Forgets what waits.
    pub(super) fn clear(&mut self) {
        *self = Self { limit: self.limit, ..Self::default() };
    }

    /// Paths that wait.
    pub(super) fn len(&self) -> usize {
        self.paths
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::synthetic::batch;

    fn of(paths: usize) -> Arc<PathBatch> {
        let path: &[[f32; 3]] = &[[0.0; 3], [1.0; 3]];
        Arc::new(batch(&vec![path; paths]))
    }

    #[test]
    fn the_oldest_go_when_too_many_wait() {
        let mut backlog = Backlog::default();
        assert_eq!(backlog.set_limit(10), None, "nothing waits");
        let mut lost = |paths| backlog.push(of(paths)).map_or(0, |gap| gap.paths);
        assert_eq!([lost(3), lost(4), lost(5)], [0, 0, 3], "the first batch went");
        assert_eq!(backlog.len(), 9, "the others wait");
        assert_eq!(backlog.set_limit(5).map(|gap| gap.paths), Some(4), "the limit is another");
        assert_eq!(backlog.push(of(6)).map(|gap| gap.paths), Some(5), "and then it goes, too");
        assert_eq!(backlog.len(), 6, "the newest stays, though it is too large");
        assert_eq!(backlog.next(0).map(|b| b.len()), Some(6), "it is taken in");
        assert_eq!(backlog.len(), 0, "nothing waits");
    }

    #[test]
    fn enough_must_wait_and_then_all_is_taken_in() {
        let mut backlog = Backlog::default();
        assert!(!backlog.is_due(0), "nothing waits");
        for paths in [3, 3] {
            assert_eq!(backlog.push(of(paths)), None, "room enough");
        }
        assert_eq!(backlog.next(7), None, "not enough waits");
        assert_eq!(backlog.push(of(1)), None, "room enough");
        let mut taken = 0;
        while let Some(batch) = backlog.next(7) {
            taken += batch.len();
        }
        assert_eq!(taken, 7, "all of it");
        assert_eq!(backlog.push(of(1)), None, "room enough");
        assert!(!backlog.is_due(7), "and it begins again");
    }
}
