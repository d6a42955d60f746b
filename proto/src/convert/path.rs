//! Path batches.

use common::{BatchOrigin, PathBatch, PathColumns, VertexColumns};

use super::{WireError, check, column};
use crate::v1;

/// Most bytes that the columns of one batch may hold.
const MAX_BATCH_BYTES: usize = 1 << 20;

impl From<&PathBatch> for v1::PathBatch {
    fn from(batch: &PathBatch) -> Self {
        let (p, v) = (batch.paths(), batch.vertices());
        Self {
            sequence: batch.sequence(),
            record_count: p.chain.len() as u32,
            vertex_count: v.kind.len() as u32,
            revision: batch.origin().revision,
            source_batches: batch.origin().source_batches,
            decimation: batch.origin().decimation,
            seen: batch.origin().seen,
            matched: batch.origin().matched,
            seen_steps: batch.origin().seen_steps,
            matched_steps: batch.origin().matched_steps,
            chain: column::encode(&p.chain),
            epoch: column::encode(&p.epoch),
            step: column::encode(&p.step),
            strategy: column::encode(&p.strategy),
            kept_light: column::encode(&p.kept_light),
            kept_eye: column::encode(&p.kept_eye),
            inserted: column::encode(&p.inserted),
            dwell: column::encode(&p.dwell),
            weight: column::encode(&p.weight),
            acceptance: column::encode(&p.acceptance),
            film: column::encode(&p.film),
            luminance: column::encode(&p.luminance),
            rgb: column::encode(&p.rgb),
            position: column::encode(&v.position),
            normal: column::encode(&v.normal),
            kind: column::encode(&v.kind),
            event: column::encode(&v.event),
            material: column::encode(&v.material),
            primitive: column::encode(&v.primitive),
            throughput: column::encode(batch.throughput()),
        }
    }
}

impl TryFrom<v1::PathBatch> for PathBatch {
    type Error = WireError;

    fn try_from(wire: v1::PathBatch) -> Result<Self, WireError> {
        // Before any count is believed: the columns that are really there bound everything.
        let bytes = wire.step.len() + wire.rgb.len() + wire.position.len() + wire.primitive.len();
        check::length("path_batch", bytes + wire.throughput.len(), MAX_BATCH_BYTES)?;
        let records = wire.record_count as usize;
        let paths = PathColumns {
            chain: column::decode("chain", &wire.chain, records)?,
            epoch: column::decode("epoch", &wire.epoch, records)?,
            step: column::decode("step", &wire.step, records)?,
            strategy: column::decode("strategy", &wire.strategy, records)?,
            kept_light: column::decode("kept_light", &wire.kept_light, records)?,
            kept_eye: column::decode("kept_eye", &wire.kept_eye, records)?,
            inserted: column::decode("inserted", &wire.inserted, records)?,
            dwell: column::decode("dwell", &wire.dwell, records)?,
            weight: column::decode("weight", &wire.weight, records)?,
            acceptance: column::decode("acceptance", &wire.acceptance, records)?,
            film: column::decode("film", &wire.film, records)?,
            luminance: column::decode("luminance", &wire.luminance, records)?,
            rgb: column::decode("rgb", &wire.rgb, records)?,
        };
        let count = wire.vertex_count as usize;
        let vertices = VertexColumns {
            position: column::decode("position", &wire.position, count)?,
            normal: column::decode("normal", &wire.normal, count)?,
            kind: column::decode("kind", &wire.kind, count)?,
            event: column::decode("event", &wire.event, count)?,
            material: column::decode("material", &wire.material, count)?,
            primitive: column::decode("primitive", &wire.primitive, count)?,
        };
        let origin = BatchOrigin {
            revision: wire.revision,
            source_batches: wire.source_batches,
            decimation: wire.decimation,
            seen: wire.seen,
            matched: wire.matched,
            seen_steps: wire.seen_steps,
            matched_steps: wire.matched_steps,
        };
        let batch = Self::from_columns(wire.sequence, paths, vertices)?;
        Ok(batch.with_throughput(wire.throughput.to_vec())?.with_origin(origin)?)
    }
}
