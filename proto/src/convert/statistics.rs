//! Statistics.

use std::sync::Arc;

use common::{ChainTotals, FailureCount, Queue, Statistics, StrategyStatistics};

use super::{WireError, check};
use crate::v1;

/// Most queues that a daemon may speak of.
const MAX_QUEUES: usize = 16;

impl From<&Statistics> for v1::Statistics {
    fn from(s: &Statistics) -> Self {
        Self {
            epoch: s.epoch,
            elapsed_seconds: check::known_or_zero(s.elapsed_seconds),
            mutations_per_second: check::known_or_zero(s.mutations_per_second),
            threads: s.threads,
            totals: Some(s.totals.into()),
            strategies: s.strategies.iter().map(Into::into).collect(),
            normalization: check::known_or_zero(s.normalization),
            normalization_error: check::known_or_zero(s.normalization_error),
            memory_bytes: s.memory_bytes,
            viewers: s.viewers,
            paths_sent: s.paths_sent,
            paths_dropped: s.paths_dropped,
            queued_bytes: s.queued_bytes,
            queues: s.queues.iter().map(Into::into).collect(),
            filter: Some((&s.filter).into()),
            diagnostics: s.diagnostics.as_deref().map(Into::into),
        }
    }
}

impl TryFrom<v1::Statistics> for Statistics {
    type Error = WireError;

    fn try_from(wire: v1::Statistics) -> Result<Self, WireError> {
        check::length("statistics.strategies", wire.strategies.len(), check::MAX_NAMES)?;
        check::length("statistics.queues", wire.queues.len(), MAX_QUEUES)?;
        Ok(Self {
            epoch: wire.epoch,
            elapsed_seconds: check::finite("statistics.elapsed_seconds", wire.elapsed_seconds)?,
            mutations_per_second: check::finite(
                "statistics.mutations_per_second",
                wire.mutations_per_second,
            )?,
            threads: wire.threads,
            totals: wire.totals.unwrap_or_default().into(),
            strategies: wire
                .strategies
                .into_iter()
                .map(TryInto::try_into)
                .collect::<Result<_, WireError>>()?,
            normalization: check::finite("statistics.normalization", wire.normalization)?,
            normalization_error: check::finite(
                "statistics.normalization_error",
                wire.normalization_error,
            )?,
            memory_bytes: wire.memory_bytes,
            viewers: wire.viewers,
            paths_sent: wire.paths_sent,
            paths_dropped: wire.paths_dropped,
            queued_bytes: wire.queued_bytes,
            queues: wire
                .queues
                .into_iter()
                .map(TryInto::try_into)
                .collect::<Result<_, WireError>>()?,
            filter: wire.filter.unwrap_or_default().try_into()?,
            diagnostics: wire
                .diagnostics
                .map(|diagnostics| diagnostics.try_into().map(Arc::new))
                .transpose()?,
        })
    }
}

impl From<&Queue> for v1::Queue {
    fn from(Queue { name, bytes, limit, own }: &Queue) -> Self {
        Self { name: check::cut(name, check::MAX_NAME), bytes: *bytes, limit: *limit, own: *own }
    }
}

impl TryFrom<v1::Queue> for Queue {
    type Error = WireError;

    fn try_from(wire: v1::Queue) -> Result<Self, WireError> {
        let v1::Queue { name, bytes, limit, own } = wire;
        Ok(Self { name: check::text("queue.name", name, check::MAX_NAME)?, bytes, limit, own })
    }
}

impl From<ChainTotals> for v1::ChainTotals {
    fn from(totals: ChainTotals) -> Self {
        let ChainTotals { steps, rays, shadow_rays, not_finite, longest_dwell } = totals;
        Self { steps, rays, shadow_rays, not_finite, longest_dwell }
    }
}

impl From<v1::ChainTotals> for ChainTotals {
    fn from(wire: v1::ChainTotals) -> Self {
        let v1::ChainTotals { steps, rays, shadow_rays, not_finite, longest_dwell } = wire;
        Self { steps, rays, shadow_rays, not_finite, longest_dwell }
    }
}

impl From<&StrategyStatistics> for v1::StrategyStatistics {
    fn from(s: &StrategyStatistics) -> Self {
        let failures = s
            .failures
            .iter()
            .map(|f| v1::FailureCount { reason: f.reason.into(), count: f.count })
            .collect();
        Self {
            proposed: s.proposed,
            generated: s.generated,
            accepted: s.accepted,
            acceptance_sum: check::known_or_zero(s.acceptance_sum),
            failures,
        }
    }
}

impl TryFrom<v1::StrategyStatistics> for StrategyStatistics {
    type Error = WireError;

    fn try_from(wire: v1::StrategyStatistics) -> Result<Self, WireError> {
        check::length("strategy.failures", wire.failures.len(), check::MAX_NAMES)?;
        let failure = |f: v1::FailureCount| {
            let reason = check::within("failure.reason", f.reason, 0, u8::MAX.into())?;
            Ok(FailureCount { reason: reason as u8, count: f.count })
        };
        Ok(Self {
            proposed: wire.proposed,
            generated: wire.generated,
            accepted: wire.accepted,
            acceptance_sum: check::finite("strategy.acceptance_sum", wire.acceptance_sum)?,
            failures: wire.failures.into_iter().map(failure).collect::<Result<_, WireError>>()?,
        })
    }
}
