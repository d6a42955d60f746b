//! The unit of flow: a self-contained batch of paths in columns.
//!
//! A batch holds *records*, each one state of one chain. The first record of a chain in a batch is
//! a keyframe that carries the whole path; later ones carry only what changed against that chain's
//! previous record **in the same batch**. So losing a batch never corrupts another one.
//!
//! A record keeps `kept_light` vertices from the light end of the previous path and `kept_eye`
//! vertices from its lens end, and puts `inserted` new vertices between them. A keyframe keeps none.

mod builder;
mod check;
mod normal;
mod origin;
mod reader;
mod throughput;

use thiserror::Error;

use crate::{ChainId, Event, PathId, StrategyId, VertexKind};

pub use builder::{BatchBuilder, BatchLimits, Completed};
pub use normal::{NORMAL_SCALE, decode_normal, encode_normal};
pub use origin::BatchOrigin;
pub use reader::{PathReader, PathView};
pub use throughput::{THROUGHPUT_UNKNOWN, decode_throughput, encode_throughput};

/// No path has more vertices than this.
pub const MAX_VERTICES: usize = 65;

/// How many vertices two paths have in common at either end.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Kept {
    /// From the light end.
    pub light: usize,
    /// From the lens end.
    pub eye: usize,
}

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

/// What a record says about its path in addition to the vertices.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PathHeader {
    /// Identifies the path permanently.
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

impl VertexColumns {
    /// Appends a vertex.
    pub fn push(&mut self, vertex: &VertexRecord) {
        self.position.push(vertex.position);
        self.normal.push(vertex.normal);
        self.kind.push(vertex.kind as u8);
        self.event.push(vertex.event as u8);
        self.material.push(vertex.material);
        self.primitive.push(vertex.primitive);
    }

    /// The vertices of columns that come from elsewhere and have one length.
    pub fn records(&self) -> Result<Vec<VertexRecord>, BatchError> {
        check::vertices(self)?;
        Ok((0..self.kind.len()).map(|i| self.record(i)).collect())
    }

    /// Vertex number `i` of columns that were checked.
    fn record(&self, i: usize) -> VertexRecord {
        VertexRecord {
            position: self.position[i],
            normal: self.normal[i],
            kind: VertexKind::from_code(self.kind[i]).unwrap_or(VertexKind::Diffuse),
            event: Event::from_code(self.event[i]).unwrap_or(Event::End),
            material: self.material[i],
            primitive: self.primitive[i],
        }
    }
}

/// A self-contained batch of paths, checked: every record can be reconstructed.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PathBatch {
    sequence: u64,
    /// Apart, since batches are moved more often than anyone asks for it.
    origin: Box<BatchOrigin>,
    paths: PathColumns,
    vertices: VertexColumns,
    /// Codes of throughputs: one a vertex of every path, kept ones included; or nothing.
    throughput: Vec<u8>,
}

/// Why columns make no batch.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum BatchError {
    /// Columns of different length.
    #[error("column `{column}` holds {found} entries where {expected} are expected")]
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
    /// A batch that says impossible things of where it comes from.
    #[error("the batch's origin is impossible: {0}")]
    Origin(&'static str),
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
        check::lengths(&paths, &vertices)?;
        check::values(&paths, &vertices)?;
        check::splices(&paths)?;
        Ok(Self { sequence, origin: Box::default(), paths, vertices, throughput: Vec::new() })
    }

    /// The number of the newest batch of the daemon that is behind this one; see
    /// [`BatchOrigin::source_batches`].
    pub fn sequence(&self) -> u64 {
        self.sequence
    }

    /// What the batch was made from.
    pub fn origin(&self) -> &BatchOrigin {
        &self.origin
    }

    /// The same batch with another origin, which must be possible.
    pub fn with_origin(self, origin: BatchOrigin) -> Result<Self, BatchError> {
        check::origin(&origin)?;
        Ok(Self { origin: Box::new(origin), ..self })
    }

    /// The same batch with the throughput at every vertex of every path, kept ones included; see
    /// [`encode_throughput`]. An empty column says that nothing is known of it.
    pub fn with_throughput(self, throughput: Vec<u8>) -> Result<Self, BatchError> {
        let p = &self.paths;
        let kept =
            p.kept_light.iter().zip(&p.kept_eye).map(|(l, e)| usize::from(*l) + usize::from(*e));
        let expected = kept.sum::<usize>() + self.vertices.kind.len();
        if !throughput.is_empty() && throughput.len() != expected {
            let found = throughput.len();
            return Err(BatchError::Length { column: "throughput", found, expected });
        }
        Ok(Self { throughput, ..self })
    }

    /// The throughput column: one code a vertex of every path, kept ones included; or nothing.
    pub fn throughput(&self) -> &[u8] {
        &self.throughput
    }

    /// The same batch, which holds every record of one batch of the daemon.
    #[must_use]
    pub fn into_source(self) -> Self {
        let seen = self.len() as u64;
        let steps = self.paths.weight.iter().copied().map(f64::from).sum();
        let origin = BatchOrigin {
            source_batches: 1,
            seen,
            matched: seen,
            seen_steps: steps,
            matched_steps: steps,
            ..BatchOrigin::default()
        };
        Self { origin: Box::new(origin), ..self }
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
        self.len() * PER_PATH + self.vertices.kind.len() * PER_VERTEX + self.throughput.len()
    }

    /// Reads the paths in order.
    pub fn reader(&self) -> PathReader<'_> {
        PathReader::new(self)
    }

    /// What the records say in addition to the vertices, in order.
    pub fn headers(&self) -> impl Iterator<Item = PathHeader> {
        (0..self.len()).map(|i| self.header(i))
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
        self.vertices.record(i)
    }
}

#[cfg(test)]
mod tests;
