//! Collecting paths into batches, as keyframes and diffs.

use super::{Kept, PathBatch, PathHeader, THROUGHPUT_UNKNOWN, VertexRecord};

/// How large a batch may grow.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BatchLimits {
    /// A batch is complete when it holds this many bytes.
    pub bytes: usize,
}

impl Default for BatchLimits {
    fn default() -> Self {
        Self { bytes: 64 * 1024 }
    }
}

/// A batch that [`BatchBuilder::push`] found complete, if any.
pub type Completed = Option<PathBatch>;

/// Collects paths into batches, as keyframes and diffs.
#[derive(Debug, Default)]
pub struct BatchBuilder {
    limits: BatchLimits,
    batch: PathBatch,
    /// Vertex count of the last path pushed of each chain in the open batch.
    last: Vec<(u32, usize)>,
    /// Vertices of all paths in the open batch, kept ones included.
    before: usize,
}

impl BatchBuilder {
    /// A builder of batches of about `limits` size.
    pub fn new(limits: BatchLimits) -> Self {
        Self { limits, ..Self::default() }
    }

    /// Adds a path of `vertices`.
    ///
    /// `kept` is the number of vertices that it shares, unchanged, with the path pushed before for
    /// the same chain, from the light end and from the lens end; `None` where nothing is known to
    /// be shared. Returns the previous batch when this path did not fit into it.
    pub fn push(
        &mut self,
        header: &PathHeader,
        vertices: &[VertexRecord],
        kept: Option<Kept>,
    ) -> Completed {
        self.push_with(header, vertices, &[], kept)
    }

    /// Adds a path of vertices with the throughput at each of them, as far as it is known; see
    /// [`Self::push`] and [`super::encode_throughput`].
    pub fn push_with(
        &mut self,
        header: &PathHeader,
        vertices: &[VertexRecord],
        throughput: &[u8],
        kept: Option<Kept>,
    ) -> Completed {
        let completed =
            if self.batch.byte_len() >= self.limits.bytes { self.finish() } else { None };
        let chain = header.id.chain.0;
        let slot = self.last.iter().position(|(known, _)| *known == chain);
        let kept = slot.and(kept).unwrap_or_default();
        let Kept { light, eye } = kept;
        match slot {
            Some(slot) => self.last[slot].1 = vertices.len(),
            None => self.last.push((chain, vertices.len())),
        }
        self.push_header(header, kept, vertices.len() - light - eye);
        for vertex in &vertices[light..vertices.len() - eye] {
            self.batch.vertices.push(vertex);
        }
        self.push_throughput(throughput, vertices.len());
        completed
    }

    /// Bytes of the open batch.
    pub fn byte_len(&self) -> usize {
        self.batch.byte_len()
    }

    /// The open batch, if it holds anything.
    pub fn finish(&mut self) -> Completed {
        self.last.clear();
        self.before = 0;
        let batch = std::mem::take(&mut self.batch);
        (!batch.is_empty()).then_some(batch)
    }

    /// The column is empty until the first throughput that is known; from then on it is whole.
    fn push_throughput(&mut self, throughput: &[u8], vertices: usize) {
        let column = &mut self.batch.throughput;
        let known = throughput.get(..vertices).unwrap_or(throughput);
        if !known.is_empty() {
            column.resize(self.before, THROUGHPUT_UNKNOWN);
            column.extend_from_slice(known);
        }
        self.before += vertices;
        if !column.is_empty() {
            column.resize(self.before, THROUGHPUT_UNKNOWN);
        }
    }

    fn push_header(&mut self, header: &PathHeader, kept: Kept, inserted: usize) {
        let p = &mut self.batch.paths;
        p.chain.push(header.id.chain.0);
        p.epoch.push(header.id.epoch);
        p.step.push(header.id.step);
        p.strategy.push(header.strategy.0);
        p.kept_light.push(kept.light as u8);
        p.kept_eye.push(kept.eye as u8);
        p.inserted.push(inserted as u8);
        p.dwell.push(header.dwell);
        p.weight.push(header.weight);
        p.acceptance.push(header.acceptance);
        p.film.push(header.film);
        p.luminance.push(header.luminance);
        p.rgb.push(header.rgb);
    }
}
