//! Filters, which travel as text, and what is said of them.

use common::{
    FilterCounts, FilterError, FilterReply, FilterText, MAX_FILTER_BYTES, MAX_LEAVES, NearestMiss,
    Shortfall,
};

use super::{WireError, check};
use crate::v1;

/// A filter as it is printed may be longer than its author wrote it.
const MAX_PRINTED: usize = 4 * MAX_FILTER_BYTES;

/// A filter that a viewer asks for. What is wrong with it is for the tracer to say.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct WantedFilter {
    /// The viewer's number for it, at least 1.
    pub revision: u32,
    /// What it wants; blank for every path.
    pub filter: FilterText,
}

impl From<WantedFilter> for v1::SetFilter {
    fn from(WantedFilter { revision, filter }: WantedFilter) -> Self {
        Self { revision, text: filter.to_string() }
    }
}

impl TryFrom<v1::SetFilter> for WantedFilter {
    type Error = WireError;

    fn try_from(wire: v1::SetFilter) -> Result<Self, WireError> {
        let revision = check::within("set_filter.revision", wire.revision, 1, u32::MAX)?;
        let text = check::text("set_filter.text", wire.text, MAX_FILTER_BYTES)?;
        Ok(Self { revision, filter: FilterText::read(text) })
    }
}

impl From<&FilterReply> for v1::FilterReply {
    fn from(reply: &FilterReply) -> Self {
        let error = reply.error.as_ref().map(|error| v1::FilterError {
            start: error.span.start as u32,
            end: error.span.end as u32,
            message: check::cut(&error.message, check::MAX_REASON),
        });
        let printed = |text: &String| check::cut(text, MAX_PRINTED);
        Self {
            revision: reply.revision,
            epoch: reply.epoch,
            text: printed(&reply.text),
            conditions: reply.conditions.iter().map(printed).collect(),
            error,
        }
    }
}

impl TryFrom<v1::FilterReply> for FilterReply {
    type Error = WireError;

    fn try_from(wire: v1::FilterReply) -> Result<Self, WireError> {
        check::length("filter_reply.conditions", wire.conditions.len(), MAX_LEAVES)?;
        let printed = |text| check::text("filter_reply.conditions", text, MAX_PRINTED);
        Ok(Self {
            revision: wire.revision,
            epoch: wire.epoch,
            text: check::text("filter_reply.text", wire.text, MAX_PRINTED)?,
            conditions: wire.conditions.into_iter().map(printed).collect::<Result<_, _>>()?,
            error: wire.error.map(error).transpose()?,
        })
    }
}

fn error(wire: v1::FilterError) -> Result<FilterError, WireError> {
    let message = check::text("filter_error.message", wire.message, check::MAX_REASON)?;
    let most = MAX_FILTER_BYTES as u32;
    let end = check::within("filter_error.end", wire.end, 0, most)?;
    let start = check::within("filter_error.start", wire.start, 0, end)?;
    Ok(FilterError { span: start as usize..end as usize, message })
}

impl From<&FilterCounts> for v1::FilterCounts {
    fn from(counts: &FilterCounts) -> Self {
        Self {
            revision: counts.revision,
            seen: counts.seen,
            matched: counts.matched,
            seen_steps: check::known_or_zero(counts.seen_steps),
            matched_steps: check::known_or_zero(counts.matched_steps),
            energy_share: check::known_or_zero(counts.energy_share),
            energy_error: check::known_or_zero(counts.energy_error),
            conditions: counts.conditions.clone(),
            nearest: counts.nearest.as_ref().map(Into::into),
        }
    }
}

impl From<&NearestMiss> for v1::NearestMiss {
    fn from(miss: &NearestMiss) -> Self {
        let failed = miss.failed.iter().map(|&Shortfall { condition, by }| v1::Shortfall {
            condition,
            by: by.filter(|by| by.is_finite()),
        });
        Self { path: Some(miss.path.into()), asked: miss.asked, failed: failed.collect() }
    }
}

impl TryFrom<v1::NearestMiss> for NearestMiss {
    type Error = WireError;

    fn try_from(wire: v1::NearestMiss) -> Result<Self, WireError> {
        check::length("nearest_miss.failed", wire.failed.len(), MAX_LEAVES)?;
        let failed = wire.failed.into_iter().map(|v1::Shortfall { condition, by }| {
            let by = by.map(|by| check::not_negative("shortfall.by", by)).transpose()?;
            Ok(Shortfall { condition, by })
        });
        Ok(Self {
            path: check::required("nearest_miss.path", wire.path)?.into(),
            asked: wire.asked,
            failed: failed.collect::<Result<_, WireError>>()?,
        })
    }
}

impl TryFrom<v1::FilterCounts> for FilterCounts {
    type Error = WireError;

    fn try_from(wire: v1::FilterCounts) -> Result<Self, WireError> {
        check::length("filter_counts.conditions", wire.conditions.len(), MAX_LEAVES)?;
        Ok(Self {
            revision: wire.revision,
            seen: wire.seen,
            matched: wire.matched,
            seen_steps: check::finite("filter_counts.seen_steps", wire.seen_steps)?,
            matched_steps: check::finite("filter_counts.matched_steps", wire.matched_steps)?,
            energy_share: check::finite("filter_counts.energy_share", wire.energy_share)?,
            energy_error: check::finite("filter_counts.energy_error", wire.energy_error)?,
            conditions: wire.conditions,
            nearest: wire.nearest.map(TryInto::try_into).transpose()?,
        })
    }
}
