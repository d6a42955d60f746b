//! Batches of paths that have come and are not taken in yet: how many, at most and at least.

use std::collections::VecDeque;

use common::PathBatch;

/// What waits, the oldest first.
#[derive(Debug, Default)]
pub(crate) struct Backlog {
    batches: VecDeque<PathBatch>,
    paths: usize,
    /// Enough has waited: all of it is taken in.
    draining: bool,
}

impl Backlog {
    /// Lets more wait. Where more than `limit` paths would, the oldest batches go, but never all;
    /// the answer is how many paths went.
    pub(crate) fn extend(
        &mut self,
        batches: impl IntoIterator<Item = PathBatch>,
        limit: usize,
    ) -> usize {
        for batch in batches {
            self.paths += batch.len();
            self.batches.push_back(batch);
        }
        let mut gone = 0;
        while self.paths > limit && self.batches.len() > 1 {
            gone += self.pop().map_or(0, |batch| batch.len());
        }
        gone
    }

    /// True when anything is to be taken in: once `threshold` paths wait, all that do.
    pub(crate) fn is_due(&mut self, threshold: usize) -> bool {
        self.draining = !self.batches.is_empty() && (self.draining || self.paths >= threshold);
        self.draining
    }

    /// The oldest batch.
    pub(crate) fn pop(&mut self) -> Option<PathBatch> {
        let batch = self.batches.pop_front()?;
        self.paths -= batch.len().min(self.paths);
        Some(batch)
    }

    /// Forgets what waits.
    pub(crate) fn clear(&mut self) {
        *self = Self::default();
    }

    /// Paths that wait.
    pub(crate) fn paths(&self) -> usize {
        self.paths
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::synthetic::batch;

    fn of(paths: usize) -> PathBatch {
        let path: &[[f32; 3]] = &[[0.0; 3], [1.0; 3]];
        batch(&vec![path; paths])
    }

    #[test]
    fn the_oldest_go_when_too_many_wait() {
        let mut backlog = Backlog::default();
        assert_eq!(backlog.extend([of(3), of(4), of(5)], 10), 3, "the first batch went");
        assert_eq!(backlog.paths(), 9, "the others wait");
        assert_eq!(backlog.extend([of(6)], 5), 9, "and then they go, too");
        assert_eq!(backlog.paths(), 6, "the newest stays, though it is too large");
        assert_eq!(backlog.pop().map(|b| b.len()), Some(6), "it is taken in");
        assert_eq!(backlog.paths(), 0, "nothing waits");
    }

    #[test]
    fn enough_must_wait_and_then_all_is_taken_in() {
        let mut backlog = Backlog::default();
        assert!(!backlog.is_due(0), "nothing waits");
        assert_eq!(backlog.extend([of(3), of(3)], 100), 0, "room enough");
        assert!(!backlog.is_due(7), "not enough waits");
        assert_eq!(backlog.extend([of(1)], 100), 0, "room enough");
        let mut taken = 0;
        while backlog.is_due(7) {
            taken += backlog.pop().map_or(0, |b| b.len());
        }
        assert_eq!(taken, 7, "all of it");
        assert_eq!(backlog.extend([of(1)], 100), 0, "room enough");
        assert!(!backlog.is_due(7), "and it begins again");
    }
}
