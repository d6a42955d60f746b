//! What a batch was made from, and how.

/// What a batch was made from, so that shares and sums can be told from a selection.
///
/// The counts are exact, whatever was left out to keep to a budget.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BatchOrigin {
    /// The filter that the batch was made with: the number its viewer gave it; 0 before any was set.
    pub revision: u32,
    /// Batches of the daemon behind this one: those numbered up to [`super::PathBatch::sequence`].
    pub source_batches: u32,
    /// Steps of a chain from one sample to the next; 0 where every path that matched is in the
    /// batch. A record's weight is the steps that its samples stand for.
    pub decimation: f32,
    /// Paths that the filter saw.
    pub seen: u64,
    /// Paths that it wanted.
    pub matched: u64,
    /// Steps that the paths seen stand for.
    pub seen_steps: f64,
    /// Steps that the wanted paths stand for.
    pub matched_steps: f64,
}
