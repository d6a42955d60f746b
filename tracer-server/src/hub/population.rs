//! What one viewer is shown of the chains: the paths that its filter wants, thinned to its budget.
//!
//! This runs in the viewer's own task, and only while the viewer takes what it is sent. So a viewer
//! pays for its own filter, and one that does not read costs nothing.

use std::collections::{BTreeMap, VecDeque};
use std::sync::Arc;
use std::time::Duration;

use common::{
    BatchBuilder, BatchLimits, BatchOrigin, CompiledFilter, FilterCounts, FilterTally, Gap, Kept,
    PathBatch, PathView, Queue,
};
use tokio::time::Instant;

use super::backlog::{add, gap_of};
use super::sampler::Sampler;

/// A batch is complete at this size.
const BATCH_BYTES: usize = 64 << 10;
/// Paths wait no longer than this for their batch to become full.
const PATIENCE: Duration = Duration::from_millis(100);
/// How often the decimation is looked at.
const CONTROL_PERIOD: Duration = Duration::from_millis(250);
/// The decimation grows by at most this factor at a time.
const MAX_GROWTH: f64 = 4.0;
/// And shrinks by this one while the budget has room.
const SHRINKING: f64 = 0.8;

/// Filters, thins and packs paths for one viewer.
#[derive(Debug)]
pub(super) struct Population {
    filter: Option<Arc<CompiledFilter>>,
    revision: u32,
    tally: FilterTally,
    sampler: Sampler,
    open: Open,
    ready: VecDeque<Ready>,
    ready_bytes: usize,
    control: Control,
    paths_sent: u64,
    paths_dropped: u64,
}

/// What is ready to be sent.
#[derive(Debug)]
enum Ready {
    Gap(Gap),
    Batch(Arc<PathBatch>),
}

/// The batch that is being filled.
#[derive(Debug)]
struct Open {
    builder: BatchBuilder,
    origin: BatchOrigin,
    sequence: u64,
    since: Option<Instant>,
    /// For each chain, how much a path of it now shares with its last one in the batch.
    shared: BTreeMap<u32, Kept>,
}

/// What the decimation is controlled by.
#[derive(Debug)]
struct Control {
    since: Option<Instant>,
    /// Bytes that became ready.
    produced: usize,
    /// Bytes that were sent.
    sent: usize,
}

impl Population {
    /// All paths; `key` picks where the sampling starts.
    pub(super) fn new(key: u64) -> Self {
        Self {
            filter: None,
            revision: 0,
            tally: FilterTally::default(),
            sampler: Sampler::new(key),
            open: Open::new(),
            ready: VecDeque::new(),
            ready_bytes: 0,
            control: Control { since: None, produced: 0, sent: 0 },
            paths_sent: 0,
            paths_dropped: 0,
        }
    }

    /// Changes the filter: what was seen before belongs to the old one.
    pub(super) fn set_filter(&mut self, revision: u32, filter: Arc<CompiledFilter>, limit: usize) {
        self.close(limit);
        self.tally = FilterTally::new(revision, &filter);
        self.revision = revision;
        self.filter = Some(filter);
    }

    /// What the filter saw since it was set.
    pub(super) fn counts(&self) -> FilterCounts {
        self.tally.counts()
    }

    /// Paths sent and paths dropped since the viewer came.
    pub(super) fn traffic(&self) -> (u64, u64) {
        (self.paths_sent, self.paths_dropped)
    }

    /// What waits to be sent, of at most about `limit` bytes.
    pub(super) fn queue(&self, limit: usize) -> Queue {
        Queue {
            name: "filtered paths".to_owned(),
            bytes: (self.ready_bytes + self.open.builder.byte_len()) as u64,
            limit: limit as u64,
            own: true,
        }
    }

    /// Takes in what is missing. Nothing is packed across it.
    pub(super) fn miss(&mut self, gap: Gap, limit: usize) {
        if gap == Gap::default() {
            return;
        }
        self.close(limit);
        self.paths_dropped += gap.paths;
        match self.ready.back_mut() {
            Some(Ready::Gap(last)) => add(last, gap),
            Some(Ready::Batch(_)) | None => self.ready.push_back(Ready::Gap(gap)),
        }
    }

    /// Takes in a batch of the chains. At most about `limit` bytes wait to be sent.
    pub(super) fn see(&mut self, batch: &Arc<PathBatch>, limit: usize, now: Instant) {
        if self.filter.is_none() && self.sampler.distance() == 0.0 {
            for header in batch.headers() {
                self.tally.count(&header, 0, true);
            }
            self.close(limit);
            self.push(Arc::clone(batch), limit);
            return;
        }
        let mut reader = batch.reader();
        while let Some(path) = reader.next() {
            self.judge(&path);
        }
        self.open.origin.source_batches += 1;
        self.open.sequence = batch.sequence();
        self.open.since.get_or_insert(now);
        if self.open.builder.byte_len() >= BATCH_BYTES {
            self.close(limit);
        }
    }

    fn judge(&mut self, path: &PathView<'_>) {
        let (conditions, wanted) = match &self.filter {
            None => (0, true),
            Some(filter) => {
                let conditions = filter.conditions(&path.header, path.vertices);
                (conditions, filter.wants(conditions))
            }
        };
        self.tally.count(&path.header, conditions, wanted);
        if let Some(filter) = self.filter.as_ref().filter(|_| !wanted) {
            self.tally.count_miss(filter, &path.header, path.vertices, conditions);
        }
        let weight = if wanted {
            let chain = path.header.id.chain.0;
            self.sampler.draw(chain, path.header.weight)
        } else {
            None
        };
        self.open.add(path, wanted, weight);
    }

    /// Completes the open batch if it has waited long enough, and adapts the decimation.
    pub(super) fn tend(&mut self, limit: usize, now: Instant) {
        if self.deadline().is_some_and(|deadline| now >= deadline) {
            self.close(limit);
        }
        let since = *self.control.since.get_or_insert(now);
        if now.saturating_duration_since(since) >= CONTROL_PERIOD {
            self.adapt(limit, now);
        }
    }

    /// When the open batch is due.
    pub(super) fn deadline(&self) -> Option<Instant> {
        self.open.since.map(|since| since + PATIENCE)
    }

    /// Sends fewer paths while they pile up, and more while they do not.
    fn adapt(&mut self, limit: usize, now: Instant) {
        let Control { produced, sent, .. } = self.control;
        self.control = Control { since: Some(now), produced: 0, sent: 0 };
        let distance = self.sampler.distance();
        let counts = self.tally.counts();
        let mean_weight = counts.matched_steps / counts.matched.max(1) as f64;
        let piles_up = self.ready_bytes > BATCH_BYTES;
        let next = if piles_up && produced > sent && sent > 0 {
            let growth = produced as f64 / sent as f64;
            distance.max(mean_weight) * growth.min(MAX_GROWTH)
        } else if piles_up {
            distance
        } else if distance <= mean_weight {
            0.0
        } else {
            distance * SHRINKING
        };
        if next != distance {
            // A batch is made with one decimation.
            self.close(limit);
            self.sampler.set_distance(next);
        }
    }

    /// True when a batch is ready, whether or not a gap stands before it.
    pub(super) fn has_batch(&self) -> bool {
        self.ready.iter().any(|ready| matches!(ready, Ready::Batch(_)))
    }

    /// Takes the gap that stands first.
    pub(super) fn pop_gap(&mut self) -> Option<Gap> {
        let gap = match self.ready.front() {
            Some(Ready::Gap(gap)) => *gap,
            Some(Ready::Batch(_)) | None => return None,
        };
        self.ready.pop_front();
        Some(gap)
    }

    /// Takes the batch that stands first.
    pub(super) fn pop_batch(&mut self) -> Option<Arc<PathBatch>> {
        let batch = match self.ready.front() {
            Some(Ready::Batch(batch)) => Arc::clone(batch),
            Some(Ready::Gap(_)) | None => return None,
        };
        self.ready.pop_front();
        self.ready_bytes -= batch.byte_len();
        self.control.sent += batch.byte_len();
        self.paths_sent += batch.len() as u64;
        Some(batch)
    }

    /// Makes the open batch ready, even if it holds no path: what it saw is to be told.
    fn close(&mut self, limit: usize) {
        if self.open.origin.source_batches == 0 {
            return;
        }
        let decimation = self.sampler.distance() as f32;
        if let Some(batch) = self.open.finish(self.revision, decimation) {
            self.push(Arc::new(batch), limit);
        }
    }

    fn push(&mut self, batch: Arc<PathBatch>, limit: usize) {
        self.control.produced += batch.byte_len();
        self.ready_bytes += batch.byte_len();
        self.ready.push_back(Ready::Batch(batch));
        while self.ready_bytes > limit && self.ready.len() > 1 {
            let Some(first) = self.ready.iter().position(|r| matches!(r, Ready::Batch(_))) else {
                return;
            };
            let Some(Ready::Batch(oldest)) = self.ready.remove(first) else { return };
            self.ready_bytes -= oldest.byte_len();
            self.drop_into_gap(first, gap_of(&oldest));
        }
    }

    /// Puts a gap at place `at`, joined with those on both sides of it.
    fn drop_into_gap(&mut self, at: usize, mut gap: Gap) {
        self.paths_dropped += gap.paths;
        if let Some(Ready::Gap(after)) = self.ready.get(at) {
            add(&mut gap, *after);
            self.ready.remove(at);
        }
        match at.checked_sub(1).and_then(|before| self.ready.get_mut(before)) {
            Some(Ready::Gap(before)) => add(before, gap),
            Some(Ready::Batch(_)) | None => self.ready.insert(at, Ready::Gap(gap)),
        }
    }
}

impl Open {
    fn new() -> Self {
        Self {
            // Batches are cut where those of the chains end, so that each is behind one only.
            builder: BatchBuilder::new(BatchLimits { bytes: usize::MAX }),
            origin: BatchOrigin::default(),
            sequence: 0,
            since: None,
            shared: BTreeMap::new(),
        }
    }

    /// Counts a path, and puts it in if it has a weight.
    fn add(&mut self, path: &PathView<'_>, wanted: bool, weight: Option<f32>) {
        let steps = f64::from(path.header.weight);
        self.origin.seen += 1;
        self.origin.seen_steps += steps;
        if wanted {
            self.origin.matched += 1;
            self.origin.matched_steps += steps;
        }
        let chain = path.header.id.chain.0;
        // What two paths share is what every change between them left alone.
        let eye = path.vertices.len() - path.first_new - path.new_count;
        if let Some(shared) = self.shared.get_mut(&chain) {
            shared.light = shared.light.min(path.first_new);
            shared.eye = shared.eye.min(eye);
        }
        let Some(weight) = weight else { return };
        let header = common::PathHeader { weight, ..path.header };
        let kept = self.shared.get(&chain).copied();
        let full = self.builder.push_with(&header, path.vertices, path.throughput, kept);
        debug_assert!(full.is_none(), "the batch has no limit of its own");
        self.shared.insert(chain, Kept { light: usize::MAX, eye: usize::MAX });
    }

    /// The batch, after which a new one is open.
    fn finish(&mut self, revision: u32, decimation: f32) -> Option<PathBatch> {
        let batch = self.builder.finish().unwrap_or_default().with_sequence(self.sequence);
        let origin = BatchOrigin { revision, decimation, ..self.origin };
        self.origin = BatchOrigin::default();
        self.since = None;
        self.shared.clear();
        // Every weight is a finite number: the chains' own.
        batch.with_origin(origin).inspect_err(|error| tracing::error!("{error}")).ok()
    }
}
