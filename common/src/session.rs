//! What a tracer tells its viewers, other than paths.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::{Camera, Diagnostics, FilterCounts, FilterError, Rgb, SceneFrame};

/// What a viewer may do.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Role {
    /// Sees everything, steers nothing.
    #[default]
    Observer,
    /// Holds the lease that steers the chains.
    Driver,
}

/// The tracer's answer to a viewer's hello.
#[derive(Clone, Debug, PartialEq)]
pub struct Welcome {
    /// A number for this connection, unique while the daemon lives.
    pub session: u64,
    /// The daemon's version, for people.
    pub server_version: String,
    /// The scene's name, for people.
    pub scene_name: String,
    /// Hex digest of the scene's content; the key under which geometry may be cached.
    pub scene_hash: String,
    /// The relation of travelling coordinates to those of the file.
    pub frame: SceneFrame,
    /// The render camera, in scene units.
    pub camera: Camera,
    /// Names of the mutation strategies; a record's strategy is an index into them.
    pub strategies: Vec<String>,
    /// Reasons for a failed proposal; [`FailureCount::reason`] is an index into them.
    pub failure_reasons: Vec<String>,
    /// How many chains run.
    pub chains: u32,
    /// Longest path, in edges.
    pub max_edges: u32,
    /// The role that was granted.
    pub role: Role,
    /// What this viewer shows to take up its filter and its role again after its connection broke;
    /// blank where the daemon knows no such thing.
    pub resume: String,
}

/// How often proposals of one strategy failed for one reason.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct FailureCount {
    /// Index into the announced reasons.
    pub reason: u8,
    /// Proposals.
    pub count: u64,
}

/// Counts of one mutation strategy.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct StrategyStatistics {
    /// Steps that chose the strategy.
    pub proposed: u64,
    /// Proposals that were complete paths with light on them.
    pub generated: u64,
    /// Proposals that became the chain's state.
    pub accepted: u64,
    /// Sum of the acceptance probabilities over all proposals, failures counting zero.
    pub acceptance_sum: f64,
    /// Why the others failed; sums to `proposed - generated`.
    pub failures: Vec<FailureCount>,
}

/// Totals over all chains since the epoch began.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct ChainTotals {
    /// Mutations tried.
    pub steps: u64,
    /// Closest-hit rays.
    pub rays: u64,
    /// Shadow rays.
    pub shadow_rays: u64,
    /// Proposals refused because a number was NaN, infinite or negative.
    pub not_finite: u64,
    /// Longest run of steps that any chain stayed at one path.
    pub longest_dwell: u64,
}

/// What the tracer reports twice a second.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Statistics {
    /// The epoch the counts belong to.
    pub epoch: u32,
    /// Seconds of wall clock since the epoch began.
    pub elapsed_seconds: f64,
    /// Mutations a second over the last reporting interval, all threads.
    pub mutations_per_second: f64,
    /// Worker threads.
    pub threads: u32,
    /// Totals over all chains.
    pub totals: ChainTotals,
    /// One entry a strategy, in the announced order.
    pub strategies: Vec<StrategyStatistics>,
    /// Mean luminance of the image.
    pub normalization: f64,
    /// Standard error of [`Self::normalization`].
    pub normalization_error: f64,
    /// Resident memory of the daemon in bytes; zero where the system does not tell.
    pub memory_bytes: u64,
    /// Viewers connected.
    pub viewers: u32,
    /// Paths sent to this viewer since it came.
    pub paths_sent: u64,
    /// Paths dropped for this viewer since it came.
    pub paths_dropped: u64,
    /// Bytes waiting for this viewer.
    pub queued_bytes: u64,
    /// What waits between the chains and this viewer.
    pub queues: Vec<Queue>,
    /// What this viewer's filter saw since it was set.
    pub filter: FilterCounts,
    /// How well the chains explore; absent until enough is known.
    #[serde(skip)]
    pub diagnostics: Option<Arc<Diagnostics>>,
}

/// A queue of the daemon.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Queue {
    /// What waits in it, for people.
    pub name: String,
    /// Bytes that wait, about.
    pub bytes: u64,
    /// Most bytes that may wait; one piece that is larger than that still passes, alone.
    pub limit: u64,
    /// It is the viewer's own; others are shared by all.
    pub own: bool,
}

/// The tracer's answer to a filter that a viewer set.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct FilterReply {
    /// The number that the viewer gave the filter.
    pub revision: u32,
    /// The epoch in which it came into force.
    pub epoch: u32,
    /// The filter's text as the tracer understood it; empty where it was refused.
    pub text: String,
    /// The filter's conditions, in the order of [`FilterCounts::conditions`].
    pub conditions: Vec<String>,
    /// Why it was refused; the filter before it stays in force.
    pub error: Option<FilterError>,
}

/// Paths that were dropped for one viewer since it was last told, because it or its budget was too
/// small for them: paths of the daemon, before any filter.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Gap {
    /// Path batches.
    pub batches: u64,
    /// Records in them.
    pub paths: u64,
    /// Bytes of their columns.
    pub bytes: u64,
}

/// A block of whole rows of the progressive image.
#[derive(Clone, Debug, PartialEq)]
pub struct FilmTile {
    /// Which snapshot of the film the rows belong to; grows.
    pub sequence: u64,
    /// Film width in pixels.
    pub width: u32,
    /// Film height in pixels.
    pub height: u32,
    /// First row, from the top.
    pub first_row: u32,
    /// Mutations behind the snapshot.
    pub steps: u64,
    /// Radiance, row by row, three floats a pixel.
    pub rgb: Vec<f32>,
}

/// A whole snapshot of the progressive image.
#[derive(Clone, Debug, PartialEq)]
pub struct FilmFrame {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// Mutations behind it.
    pub steps: u64,
    /// Radiance, row by row from the top.
    pub pixels: Vec<Rgb>,
}
