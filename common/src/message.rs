//! What a tracer says to a viewer: one vocabulary from the hub over the wire to the screen.

use std::sync::Arc;

use crate::{
    DetailReply, FilmTile, FilterReply, FocusPath, FocusStep, Gap, Notice, PathBatch, Statistics,
    Welcome,
};

/// Something that a tracer says. What may be large is shared: all viewers get the same.
#[derive(Clone, Debug, PartialEq)]
pub enum TracerEvent {
    /// Answers the hello.
    Welcome(Box<Welcome>),
    /// Paths.
    Paths(Arc<PathBatch>),
    /// Rows of the progressive image.
    Film(FilmTile),
    /// Counts and rates, with this viewer's own.
    Statistics(Arc<Statistics>),
    /// Data that was dropped since the last gap.
    Gap(Gap),
    /// The snapshot after the welcome is complete.
    SnapshotEnd,
    /// Answers a filter.
    FilterReply(FilterReply),
    /// The explorer's current path.
    FocusPath(Arc<FocusPath>),
    /// A step of the explorer.
    FocusStep(Arc<FocusStep>),
    /// So many steps of the explorer are missing here.
    FocusGap(u64),
    /// Rows of the explorer's film.
    ExplorerFilm(FilmTile),
    /// Who steers, and what.
    Notice(Notice),
    /// The tracer ends the session, with a reason.
    Goodbye(String),
    /// Something of a later version, to be ignored.
    Unknown,
}

impl TracerEvent {
    /// Bytes that it takes while it waits, about: what may be long is counted.
    pub fn byte_len(&self) -> usize {
        size_of::<Self>()
            + match self {
                Self::Paths(batch) => batch.byte_len(),
                Self::Film(tile) | Self::ExplorerFilm(tile) => size_of_val(tile.rgb.as_slice()),
                Self::Statistics(statistics) => statistics_bytes(statistics),
                Self::FilterReply(reply) => {
                    let conditions: usize = reply.conditions.iter().map(String::len).sum();
                    let error = reply.error.as_ref().map_or(0, |error| error.message.len());
                    reply.text.len() + conditions + error
                }
                Self::FocusPath(path) => path.byte_len(),
                Self::FocusStep(step) => step.byte_len(),
                Self::Notice(notice) => notice_bytes(notice),
                Self::Goodbye(reason) => reason.len(),
                Self::Welcome(_)
                | Self::Gap(_)
                | Self::FocusGap(_)
                | Self::SnapshotEnd
                | Self::Unknown => 0,
            }
    }

    /// Steps of the explorer that a viewer misses where this is left out.
    pub fn focus_steps(&self) -> u64 {
        match self {
            Self::FocusStep(_) => 1,
            Self::FocusGap(steps) => *steps,
            _ => 0,
        }
    }
}

fn statistics_bytes(statistics: &Statistics) -> usize {
    let strategies = size_of_val(statistics.strategies.as_slice());
    let maps = statistics
        .diagnostics
        .as_ref()
        .map_or(0, |diagnostics| 5 * size_of::<f32>() * diagnostics.maps.acceptance.len());
    size_of::<Statistics>() + strategies + maps
}

fn notice_bytes(notice: &Notice) -> usize {
    match notice {
        Notice::Presence(presence) => {
            let viewers = presence.viewers.iter();
            viewers.map(|v| size_of_val(v) + v.author.name.len() + v.appearance.filter.len()).sum()
        }
        Notice::Chains(state) => state.change.len() + size_of_val(state.weights.as_slice()),
        Notice::Reply(reply) => reply.error.as_ref().map_or(0, String::len),
        Notice::Detail(reply) => detail_bytes(reply),
        Notice::Explorer(_) | Notice::Lease(_) => 0,
    }
}

fn detail_bytes(reply: &DetailReply) -> usize {
    match &reply.found {
        Ok(detail) => {
            size_of_val(detail.vertices.as_slice())
                + size_of_val(detail.geometry.as_slice())
                + size_of_val(detail.reciprocals.as_slice())
        }
        Err(why) => why.len(),
    }
}
