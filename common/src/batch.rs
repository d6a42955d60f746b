//! The unit of flow: a self-contained batch of paths in columns.
//!
//! A batch holds *records*, each one state of one chain. The first record of a chain in a batch is
//! a keyframe that carries the whole path; later ones carry only what changed against that chain's
//! previous record **in the same batch**. So losing a batch never corrupts another one.
//!
//! A record keeps `kept_light` vertices from the light end of the previous path and `kept_eye`
//! vertices from its lens end, and puts `inserted` new vertices between them. A keyframe keeps none.

use glam::Vec3;
use thiserror::Error;

use crate::{ChainId, Event, PathId, StrategyId, VertexKind};

/// Full scale of one octahedral normal component.
pub const NORMAL_SCALE: f32 = 32767.0;

/// No path has more vertices than this.
const MAX_VERTICES: usize = 65;

/// One vertex as it travels: 24 bytes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VertexRecord {
    /// Position in scene units (see [`crate::SceneFrame`]).
    pub position: [f32; 3],
    /// Geometric normal, octahedral; see [`decode_normal`].
    pub normal: [i16; 2],
    /// Heckbert's letter.
    pub kind: VertexKind,
    /// The lobe that scattered here.
    pub event: Event,
    /// Index of the material.
    pub material: u16,
    /// The primitive hit; `u32::MAX` on the lens.
    pub primitive: u32,
}

/// What a record says of its path besides the vertices.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PathHeader {
    /// Names the path for ever.
    pub id: PathId,
    /// The strategy whose proposal made it; [`Self::NO_STRATEGY`] for a seed.
    pub strategy: StrategyId,
    /// Steps that the chain stayed here while it was watched.
    pub dwell: u32,
    /// Steps that the record stands for, decimation included.
    pub weight: f32,
    /// Acceptance probability of the proposal that made it.
    pub acceptance: f32,
    /// Film point: `u` to the right and `v` downwards, both in [0, 1).
    pub film: [f32; 2],
    /// The path's value to a bidirectional path tracer: `1 / S(x)`, in units of film luminance.
    pub luminance: f32,
    /// Colour of the contribution, scaled to unit luminance.
    pub rgb: [f32; 3],
}

impl PathHeader {
    /// The strategy of a seed path, which no mutation made.
    pub const NO_STRATEGY: StrategyId = StrategyId(u8::MAX);
}

/// Columns with one entry a record.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PathColumns {
    /// Chain of each record.
    pub chain: Vec<u32>,
    /// Epoch of each record.
    pub epoch: Vec<u32>,
    /// Step of each record.
    pub step: Vec<u64>,
    /// Strategy index, 255 for a seed.
    pub strategy: Vec<u8>,
    /// Vertices kept from the light end of the chain's previous record.
    pub kept_light: Vec<u8>,
    /// Vertices kept from its lens end.
    pub kept_eye: Vec<u8>,
    /// New vertices between them.
    pub inserted: Vec<u8>,
    /// Steps stayed.
    pub dwell: Vec<u32>,
    /// Steps stood for.
    pub weight: Vec<f32>,
    /// Acceptance probability.
    pub acceptance: Vec<f32>,
    /// Film point.
    pub film: Vec<[f32; 2]>,
    /// `1 / S(x)`.
    pub luminance: Vec<f32>,
    /// Colour of unit luminance.
    pub rgb: Vec<[f32; 3]>,
}

/// Columns with one entry an inserted vertex, in the order of the records.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct VertexColumns {
    /// Positions in scene units.
    pub position: Vec<[f32; 3]>,
    /// Octahedral normals.
    pub normal: Vec<[i16; 2]>,
    /// Codes of [`VertexKind`].
    pub kind: Vec<u8>,
    /// Codes of [`Event`].
    pub event: Vec<u8>,
    /// Material indices.
    pub material: Vec<u16>,
    /// Primitive indices.
    pub primitive: Vec<u32>,
}

/// A self-contained batch of paths, checked: every record can be reconstructed.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PathBatch {
    sequence: u64,
    paths: PathColumns,
    vertices: VertexColumns,
}

/// Why columns make no batch.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum BatchError {
    /// Columns of different length.
    #[error("column `{column}` holds {found} entries where {expected} are due")]
    Length {
        /// The column's name.
        column: &'static str,
        /// Its length.
        found: usize,
        /// The length of its siblings.
        expected: usize,
    },
    /// The first record of a chain is not a keyframe.
    #[error("record {record} changes chain {chain}, which has no keyframe in this batch")]
    NoKeyframe {
        /// Index of the record.
        record: usize,
        /// The chain.
        chain: u32,
    },
    /// A record keeps more vertices than its predecessor has, or makes too few or too many.
    #[error(
        "record {record} keeps {kept} of {available} vertices and makes a path of {total}; \
         a path has 2 to {MAX_VERTICES} vertices"
    )]
    Splice {
        /// Index of the record.
        record: usize,
        /// Vertices it keeps.
        kept: usize,
        /// Vertices of the chain's previous path.
        available: usize,
        /// Vertices of the path it makes.
        total: usize,
    },
    /// A number that is NaN or infinite.
    #[error("column `{column}` holds a number that is not finite at entry {index}")]
    NotFinite {
        /// The column's name.
        column: &'static str,
        /// Index of the entry.
        index: usize,
    },
    /// A code that this version does not know.
    #[error("column `{column}` holds the unknown code {code} at entry {index}")]
    UnknownCode {
        /// The column's name.
        column: &'static str,
        /// The code.
        code: u8,
        /// Index of the entry.
        index: usize,
    },
}

impl PathBatch {
    /// Checks columns that come from elsewhere.
    pub fn from_columns(
        sequence: u64,
        paths: PathColumns,
        vertices: VertexColumns,
    ) -> Result<Self, BatchError> {
        check_lengths(&paths, &vertices)?;
        check_values(&paths, &vertices)?;
        check_splices(&paths)?;
        Ok(Self { sequence, paths, vertices })
    }

    /// Grows by one from batch to batch of a daemon, so that a viewer can see a gap.
    pub fn sequence(&self) -> u64 {
        self.sequence
    }

    /// The same batch under another sequence number.
    #[must_use]
    pub fn with_sequence(self, sequence: u64) -> Self {
        Self { sequence, ..self }
    }

    /// The record columns.
    pub fn paths(&self) -> &PathColumns {
        &self.paths
    }

    /// The vertex columns.
    pub fn vertices(&self) -> &VertexColumns {
        &self.vertices
    }

    /// Number of records.
    pub fn len(&self) -> usize {
        self.paths.chain.len()
    }

    /// True without records.
    pub fn is_empty(&self) -> bool {
        self.paths.chain.is_empty()
    }

    /// Bytes that the columns hold: what a batch costs in a queue or on the wire.
    pub fn byte_len(&self) -> usize {
        const PER_PATH: usize = 4 + 4 + 8 + 4 + 4 + 4 + 4 + 8 + 4 + 12;
        const PER_VERTEX: usize = 12 + 4 + 2 + 2 + 4;
        self.len() * PER_PATH + self.vertices.kind.len() * PER_VERTEX
    }

    /// Reads the paths in order.
    pub fn reader(&self) -> PathReader<'_> {
        PathReader { batch: self, record: 0, vertex: 0, chains: Vec::new() }
    }

    fn header(&self, i: usize) -> PathHeader {
        let p = &self.paths;
        PathHeader {
            id: PathId { chain: ChainId(p.chain[i]), epoch: p.epoch[i], step: p.step[i] },
            strategy: StrategyId(p.strategy[i]),
            dwell: p.dwell[i],
            weight: p.weight[i],
            acceptance: p.acceptance[i],
            film: p.film[i],
            luminance: p.luminance[i],
            rgb: p.rgb[i],
        }
    }

    fn vertex(&self, i: usize) -> VertexRecord {
        let v = &self.vertices;
        VertexRecord {
            position: v.position[i],
            normal: v.normal[i],
            // The codes were checked when the batch was made.
            kind: VertexKind::from_code(v.kind[i]).unwrap_or(VertexKind::Diffuse),
            event: Event::from_code(v.event[i]).unwrap_or(Event::End),
            material: v.material[i],
            primitive: v.primitive[i],
        }
    }
}

fn check_lengths(paths: &PathColumns, vertices: &VertexColumns) -> Result<(), BatchError> {
    let records = paths.chain.len();
    let inserted = paths.inserted.iter().map(|&n| usize::from(n)).sum();
    let lengths = [
        ("epoch", paths.epoch.len(), records),
        ("step", paths.step.len(), records),
        ("strategy", paths.strategy.len(), records),
        ("kept_light", paths.kept_light.len(), records),
        ("kept_eye", paths.kept_eye.len(), records),
        ("inserted", paths.inserted.len(), records),
        ("dwell", paths.dwell.len(), records),
        ("weight", paths.weight.len(), records),
        ("acceptance", paths.acceptance.len(), records),
        ("film", paths.film.len(), records),
        ("luminance", paths.luminance.len(), records),
        ("rgb", paths.rgb.len(), records),
        ("position", vertices.position.len(), inserted),
        ("normal", vertices.normal.len(), inserted),
        ("kind", vertices.kind.len(), inserted),
        ("event", vertices.event.len(), inserted),
        ("material", vertices.material.len(), inserted),
        ("primitive", vertices.primitive.len(), inserted),
    ];
    for (column, found, expected) in lengths {
        if found != expected {
            return Err(BatchError::Length { column, found, expected });
        }
    }
    Ok(())
}

fn check_values(paths: &PathColumns, vertices: &VertexColumns) -> Result<(), BatchError> {
    finite("weight", &paths.weight)?;
    finite("acceptance", &paths.acceptance)?;
    finite("film", paths.film.as_flattened())?;
    finite("luminance", &paths.luminance)?;
    finite("rgb", paths.rgb.as_flattened())?;
    finite("position", vertices.position.as_flattened())?;
    known("kind", &vertices.kind, |code| VertexKind::from_code(code).is_some())?;
    known("event", &vertices.event, |code| Event::from_code(code).is_some())
}

fn finite(column: &'static str, values: &[f32]) -> Result<(), BatchError> {
    match values.iter().position(|v| !v.is_finite()) {
        Some(index) => Err(BatchError::NotFinite { column, index }),
        None => Ok(()),
    }
}

fn known(column: &'static str, codes: &[u8], is_known: fn(u8) -> bool) -> Result<(), BatchError> {
    match codes.iter().position(|&code| !is_known(code)) {
        Some(index) => Err(BatchError::UnknownCode { column, code: codes[index], index }),
        None => Ok(()),
    }
}

fn check_splices(paths: &PathColumns) -> Result<(), BatchError> {
    let mut lengths: Vec<(u32, usize)> = Vec::new();
    for (record, &chain) in paths.chain.iter().enumerate() {
        let kept = usize::from(paths.kept_light[record]) + usize::from(paths.kept_eye[record]);
        let total = kept + usize::from(paths.inserted[record]);
        let slot = lengths.iter_mut().find(|(known, _)| *known == chain);
        let available = slot.as_ref().map_or(0, |(_, length)| *length);
        if slot.is_none() && kept > 0 {
            return Err(BatchError::NoKeyframe { record, chain });
        }
        if kept > available || !(2..=MAX_VERTICES).contains(&total) {
            return Err(BatchError::Splice { record, kept, available, total });
        }
        match slot {
            Some((_, length)) => *length = total,
            None => lengths.push((chain, total)),
        }
    }
    Ok(())
}

/// Walks through a batch and rebuilds each path from its predecessor.
#[derive(Debug)]
pub struct PathReader<'a> {
    batch: &'a PathBatch,
    record: usize,
    vertex: usize,
    chains: Vec<(u32, Vec<VertexRecord>)>,
}

/// One rebuilt path, borrowed from the reader.
#[derive(Clone, Copy, Debug)]
pub struct PathView<'a> {
    /// All but the vertices.
    pub header: PathHeader,
    /// Every vertex, from the light to the lens.
    pub vertices: &'a [VertexRecord],
    /// True when the record carried the whole path.
    pub keyframe: bool,
    /// Index of the first new vertex.
    pub first_new: usize,
    /// Number of new vertices.
    pub new_count: usize,
}

impl PathReader<'_> {
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
        Some(PathView {
            header: batch.header(i),
            vertices: path,
            keyframe: kept_light + kept_eye == 0,
            first_new: kept_light,
            new_count,
        })
    }
}

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
        kept: Option<(usize, usize)>,
    ) -> Completed {
        let completed =
            if self.batch.byte_len() >= self.limits.bytes { self.finish() } else { None };
        let chain = header.id.chain.0;
        let slot = self.last.iter().position(|(known, _)| *known == chain);
        let (light, eye) = match (slot, kept) {
            (Some(_), Some(kept)) => kept,
            _ => (0, 0),
        };
        match slot {
            Some(slot) => self.last[slot].1 = vertices.len(),
            None => self.last.push((chain, vertices.len())),
        }
        self.push_header(header, (light, eye), vertices.len() - light - eye);
        for vertex in &vertices[light..vertices.len() - eye] {
            self.push_vertex(vertex);
        }
        completed
    }

    /// The open batch, if it holds anything.
    pub fn finish(&mut self) -> Completed {
        self.last.clear();
        let batch = std::mem::take(&mut self.batch);
        (!batch.is_empty()).then_some(batch)
    }

    fn push_header(&mut self, header: &PathHeader, kept: (usize, usize), inserted: usize) {
        let p = &mut self.batch.paths;
        p.chain.push(header.id.chain.0);
        p.epoch.push(header.id.epoch);
        p.step.push(header.id.step);
        p.strategy.push(header.strategy.0);
        p.kept_light.push(kept.0 as u8);
        p.kept_eye.push(kept.1 as u8);
        p.inserted.push(inserted as u8);
        p.dwell.push(header.dwell);
        p.weight.push(header.weight);
        p.acceptance.push(header.acceptance);
        p.film.push(header.film);
        p.luminance.push(header.luminance);
        p.rgb.push(header.rgb);
    }

    fn push_vertex(&mut self, vertex: &VertexRecord) {
        let v = &mut self.batch.vertices;
        v.position.push(vertex.position);
        v.normal.push(vertex.normal);
        v.kind.push(vertex.kind as u8);
        v.event.push(vertex.event as u8);
        v.material.push(vertex.material);
        v.primitive.push(vertex.primitive);
    }
}

/// Packs a unit normal into two 16-bit octahedral coordinates [Cigolle et al. 2014].
pub fn encode_normal(n: Vec3) -> [i16; 2] {
    let sum = n.x.abs() + n.y.abs() + n.z.abs();
    if !(sum > 0.0) {
        return [0, 0];
    }
    let (mut x, mut y) = (n.x / sum, n.y / sum);
    if n.z < 0.0 {
        (x, y) = ((1.0 - y.abs()) * x.signum(), (1.0 - x.abs()) * y.signum());
    }
    [(x * NORMAL_SCALE).round() as i16, (y * NORMAL_SCALE).round() as i16]
}

/// Unpacks an octahedral normal to a unit vector.
pub fn decode_normal(packed: [i16; 2]) -> Vec3 {
    let (x, y) = (f32::from(packed[0]) / NORMAL_SCALE, f32::from(packed[1]) / NORMAL_SCALE);
    let z = 1.0 - x.abs() - y.abs();
    let fold = (-z).max(0.0);
    let unfold = |c: f32| if c >= 0.0 { c - fold } else { c + fold };
    Vec3::new(unfold(x), unfold(y), z).normalize_or(Vec3::Z)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn vertex(tag: u32) -> VertexRecord {
        VertexRecord {
            position: [tag as f32, 0.5, -1.0],
            normal: [0, 0],
            kind: VertexKind::Diffuse,
            event: Event::Diffuse,
            material: 0,
            primitive: tag,
        }
    }

    type Step = (u32, Vec<VertexRecord>, Option<(usize, usize)>);

    /// A chain's history: each step keeps a random prefix and suffix and inserts fresh vertices.
    fn history(steps: &[(u32, usize, usize, usize)]) -> Vec<Step> {
        let mut tag = 0;
        let mut paths: [Vec<VertexRecord>; 3] = Default::default();
        let mut out = Vec::new();
        for &(chain, light, eye, inserted) in steps {
            let path = &mut paths[chain as usize];
            let light = light.min(path.len());
            let eye = eye.min(path.len() - light);
            let known = !path.is_empty();
            let fresh: Vec<_> = (0..inserted.max(2)).map(|i| vertex(tag + i as u32)).collect();
            tag += fresh.len() as u32;
            let end = path.len() - eye;
            path.splice(light..end, fresh);
            out.push((chain, path.clone(), known.then_some((light, eye))));
        }
        out
    }

    proptest! {
        #[test]
        fn any_batch_alone_rebuilds_its_paths(
            steps in prop::collection::vec((0..3_u32, 0..5_usize, 0..5_usize, 2..6_usize), 1..60),
            bytes in 100..3000_usize,
        ) {
            let mut builder = BatchBuilder::new(BatchLimits { bytes });
            let mut batches = Vec::new();
            let history = history(&steps);
            for (i, (chain, path, kept)) in history.iter().enumerate() {
                let id = PathId { chain: ChainId(*chain), epoch: 0, step: i as u64 };
                let header = PathHeader { id, ..PathHeader::default() };
                batches.extend(builder.push(&header, path, *kept));
            }
            batches.extend(builder.finish());
            let mut seen = 0;
            for batch in batches {
                let checked = PathBatch::from_columns(7, batch.paths.clone(), batch.vertices.clone());
                prop_assert!(checked.is_ok(), "{checked:?}");
                let mut reader = batch.reader();
                while let Some(view) = reader.next() {
                    let expected = &history[view.header.id.step as usize].1;
                    prop_assert_eq!(view.vertices, expected.as_slice());
                    seen += 1;
                }
            }
            prop_assert_eq!(seen, history.len());
        }

        #[test]
        fn normals_survive_packing(x in -1.0..1.0_f32, y in -1.0..1.0_f32, z in -1.0..1.0_f32) {
            prop_assume!(x * x + y * y + z * z > 1e-4);
            let n = Vec3::new(x, y, z).normalize_or_zero();
            let error = (decode_normal(encode_normal(n)) - n).length();
            prop_assert!(error < 1e-4, "{n} moved by {error}");
        }
    }

    fn batch_of_two() -> PathBatch {
        let mut builder = BatchBuilder::default();
        let header = PathHeader::default();
        let path = [vertex(0), vertex(1), vertex(2)];
        assert!(builder.push(&header, &path, None).is_none(), "the batch is far from full");
        assert!(builder.push(&header, &path, Some((1, 1))).is_none(), "still far from full");
        builder.finish().expect("two records")
    }

    #[test]
    fn hostile_columns_are_refused() {
        let batch = batch_of_two();
        let check = |edit: fn(&mut PathColumns, &mut VertexColumns)| {
            let (mut paths, mut vertices) = (batch.paths.clone(), batch.vertices.clone());
            edit(&mut paths, &mut vertices);
            PathBatch::from_columns(0, paths, vertices).expect_err("must be refused")
        };
        assert!(matches!(check(|p, _| p.weight[1] = f32::NAN), BatchError::NotFinite { .. }));
        assert!(matches!(check(|p, _| p.kept_eye[1] = 9), BatchError::Splice { .. }));
        assert!(matches!(check(|p, _| p.kept_light[0] = 1), BatchError::NoKeyframe { .. }));
        assert!(matches!(check(|p, _| p.chain[1] = 9), BatchError::NoKeyframe { .. }));
        assert!(matches!(check(|p, _| p.inserted[1] = 200), BatchError::Length { .. }));
        assert!(matches!(check(|_, v| v.kind[0] = 99), BatchError::UnknownCode { .. }));
        assert!(matches!(
            check(|_, v| v.position[2][1] = f32::INFINITY),
            BatchError::NotFinite { .. }
        ));
    }
}
