//! Batches that wait for one viewer's session, as they came from the chains.

use std::collections::VecDeque;
use std::sync::Arc;

use common::{Gap, PathBatch};

/// What waits, in the order in which it came.
#[derive(Debug, Default)]
pub(super) struct Backlog {
    /// Each batch with what is missing before it.
    batches: VecDeque<(Gap, Arc<PathBatch>)>,
    /// What is missing after the last one.
    trailing: Gap,
    bytes: usize,
}

impl Backlog {
    /// Puts in a batch; the oldest ones make room where more than `limit` bytes wait.
    pub(super) fn push(&mut self, batch: Arc<PathBatch>, limit: usize) {
        self.bytes += batch.byte_len();
        self.batches.push_back((std::mem::take(&mut self.trailing), batch));
        while self.bytes > limit && self.batches.len() > 1 {
            let Some((before, oldest)) = self.batches.pop_front() else { break };
            self.bytes -= oldest.byte_len();
            let gap = self.batches.front_mut().map_or(&mut self.trailing, |(gap, _)| gap);
            add(gap, before);
            add(gap, gap_of(&oldest));
        }
    }

    /// Notes what never came.
    pub(super) fn push_lost(&mut self, lost: Gap) {
        add(&mut self.trailing, lost);
    }

    /// Takes what comes next: what is missing, and the batch after it, if any.
    pub(super) fn pop(&mut self) -> Option<(Gap, Option<Arc<PathBatch>>)> {
        if let Some((gap, batch)) = self.batches.pop_front() {
            self.bytes -= batch.byte_len();
            return Some((gap, Some(batch)));
        }
        let gap = std::mem::take(&mut self.trailing);
        (gap != Gap::default()).then_some((gap, None))
    }

    /// Bytes that wait.
    pub(super) fn byte_len(&self) -> usize {
        self.bytes
    }
}

/// Adds `more` to `gap`.
pub(super) fn add(gap: &mut Gap, more: Gap) {
    gap.batches += more.batches;
    gap.paths += more.paths;
    gap.bytes += more.bytes;
}

/// The gap that a batch leaves: it may stand for several batches of the daemon.
pub(super) fn gap_of(batch: &PathBatch) -> Gap {
    Gap {
        batches: batch.origin().source_batches.into(),
        paths: batch.origin().seen,
        bytes: batch.byte_len() as u64,
    }
}
