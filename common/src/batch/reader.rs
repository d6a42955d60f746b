//! Rebuilding each path of a batch from its predecessor.

use super::{PathBatch, PathHeader, VertexRecord};

/// Walks through a batch and rebuilds each path from its predecessor.
#[derive(Debug)]
pub struct PathReader<'a> {
    batch: &'a PathBatch,
    record: usize,
    vertex: usize,
    /// Vertices of all paths before, kept ones included.
    before: usize,
    chains: Vec<(u32, Vec<VertexRecord>)>,
}

/// One rebuilt path, borrowed from the reader.
#[derive(Clone, Copy, Debug)]
pub struct PathView<'a> {
    /// All but the vertices.
    pub header: PathHeader,
    /// Every vertex, from the light to the lens.
    pub vertices: &'a [VertexRecord],
    /// Codes of the throughputs at them, or nothing where they are not known.
    pub throughput: &'a [u8],
    /// True when the record carried the whole path.
    pub keyframe: bool,
    /// Index of the first new vertex.
    pub first_new: usize,
    /// Number of new vertices.
    pub new_count: usize,
}

impl<'a> PathReader<'a> {
    pub(super) fn new(batch: &'a PathBatch) -> Self {
        Self { batch, record: 0, vertex: 0, before: 0, chains: Vec::new() }
    }

    /// The next path, or `None` at the end. The view lives until the next call.
    #[expect(clippy::should_implement_trait, reason = "the view borrows from the reader")]
    pub fn next(&mut self) -> Option<PathView<'_>> {
        let i = self.record;
        let &chain = self.batch.paths.chain.get(i)?;
        let columns = &self.batch.paths;
        let kept_light = usize::from(columns.kept_light[i]);
        let kept_eye = usize::from(columns.kept_eye[i]);
        let new_count = usize::from(columns.inserted[i]);

        let batch = self.batch;
        let new = (self.vertex..self.vertex + new_count).map(|j| batch.vertex(j));
        self.record += 1;
        self.vertex += new_count;

        let known = self.chains.iter().position(|(known, _)| *known == chain);
        let slot = known.unwrap_or_else(|| {
            self.chains.push((chain, Vec::new()));
            self.chains.len() - 1
        });
        let path = &mut self.chains[slot].1;
        let eye_start = path.len() - kept_eye;
        path.splice(kept_light..eye_start, new);
        let begin = self.before;
        self.before += path.len();
        Some(PathView {
            header: batch.header(i),
            throughput: batch.throughput.get(begin..self.before).unwrap_or_default(),
            vertices: path,
            keyframe: kept_light + kept_eye == 0,
            first_new: kept_light,
            new_count,
        })
    }
}
