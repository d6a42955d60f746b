//! Looking over a chain's shoulder: windows of consecutive states, as batches.

use common::{BatchBuilder, BatchLimits, Kept, PathBatch, PathHeader, VertexRecord};

use super::{Chain, Outcome, Step};

/// Collects the states that chains pass through during a window of steps.
///
/// A window shows every state with the number of steps the chain stayed there; each step in it
/// stands for `decimation` steps of the chain. Watching draws no random numbers, so a watched chain
/// takes the same steps as one that is not.
#[derive(Debug)]
pub struct Watch {
    window: u64,
    decimation: f32,
    builder: BatchBuilder,
    completed: Vec<PathBatch>,
    seen: u64,
    header: PathHeader,
    kept: Option<Kept>,
    vertices: Vec<VertexRecord>,
    throughput: Vec<u8>,
}

impl Watch {
    /// Watches the first `window` of every `block` steps.
    pub fn new(window: u64, block: u64) -> Self {
        let window = window.clamp(1, block.max(1));
        Self {
            window,
            decimation: block as f32 / window as f32,
            builder: BatchBuilder::new(BatchLimits::default()),
            completed: Vec::new(),
            seen: 0,
            header: PathHeader::default(),
            kept: None,
            vertices: Vec::new(),
            throughput: Vec::new(),
        }
    }

    /// True while the window is open.
    #[inline]
    pub(super) fn is_open(&self) -> bool {
        self.seen < self.window
    }

    /// Opens a window on `chain`.
    pub(super) fn begin(&mut self, chain: &Chain) {
        self.seen = 0;
        self.take(chain, None);
    }

    /// Sees one step of the chain, after it was taken.
    pub(super) fn see(&mut self, chain: &Chain, step: &Step) {
        self.seen += 1;
        match step.outcome {
            Outcome::Accepted { kept_light, kept_eye } => {
                self.put();
                self.take(chain, Some(Kept { light: kept_light, eye: kept_eye }));
                self.header.dwell = 1;
            }
            Outcome::Failed(_) | Outcome::Rejected => self.header.dwell += 1,
        }
        if self.seen == self.window {
            self.put();
        }
    }

    /// The batches collected, the open one included.
    pub fn finish(mut self) -> Vec<PathBatch> {
        self.completed.extend(self.builder.finish());
        self.completed
    }

    fn take(&mut self, chain: &Chain, kept: Option<Kept>) {
        self.header = chain.header();
        self.kept = kept;
        chain.current().record_into(&mut self.vertices);
        chain.current().throughputs_into(&mut self.throughput);
    }

    fn put(&mut self) {
        self.header.weight = self.header.dwell as f32 * self.decimation;
        // A state that was left at once stands for no step, but the next one is a diff against it.
        let completed =
            self.builder.push_with(&self.header, &self.vertices, &self.throughput, self.kept);
        self.completed.extend(completed);
    }
}
