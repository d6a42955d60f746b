//! Counting what a filter saw.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::miss::Lack;
use super::{CompiledFilter, NearestMiss};
use crate::{PathHeader, VertexRecord};

/// Chains are counted separately up to this many; further ones share an entry.
const MAX_CHAINS: u32 = 1 << 14;

/// What a filter saw since it was set.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct FilterCounts {
    /// Names the filter: the number that its viewer gave it; 0 before any was set.
    pub revision: u32,
    /// Paths seen.
    pub seen: u64,
    /// Paths that matched.
    pub matched: u64,
    /// Steps that the paths seen stand for.
    pub seen_steps: f64,
    /// Steps that the matching paths stand for.
    pub matched_steps: f64,
    /// Share of the image's energy that matching paths carry: a chain visits paths in proportion to
    /// their luminance, so it is the share of the steps.
    pub energy_share: f64,
    /// Standard error of [`Self::energy_share`], from the differences between chains; NaN with fewer
    /// than two.
    pub energy_error: f64,
    /// For each condition, how many of the paths seen meet it alone.
    pub conditions: Vec<u64>,
    /// The path that came nearest, while none matches.
    pub nearest: Option<NearestMiss>,
}

/// Counts what a filter sees, chain by chain.
#[derive(Clone, Debug, Default)]
pub struct FilterTally {
    revision: u32,
    seen: u64,
    matched: u64,
    conditions: Vec<u64>,
    /// Steps of matching paths and of all paths.
    chains: BTreeMap<u32, [f64; 2]>,
    nearest: Option<(Lack, NearestMiss)>,
}

impl FilterTally {
    /// An empty tally of the filter called `revision`.
    pub fn new(revision: u32, filter: &CompiledFilter) -> Self {
        let conditions = vec![0; filter.condition_texts().len()];
        Self { revision, conditions, ..Self::default() }
    }

    /// Counts a path that meets `conditions`, see [`CompiledFilter::conditions`].
    pub fn count(&mut self, header: &PathHeader, conditions: u64, matches: bool) {
        self.seen += 1;
        self.matched += u64::from(matches);
        for (i, count) in self.conditions.iter_mut().enumerate() {
            *count += conditions >> i & 1;
        }
        let weight = f64::from(header.weight);
        let [matched, seen] = self.chains.entry(header.id.chain.0 % MAX_CHAINS).or_default();
        *seen += weight;
        *matched += if matches { weight } else { 0.0 };
    }

    /// Looks whether a path that does not match came nearer than those before, as long as none has
    /// matched.
    pub fn count_miss(
        &mut self,
        filter: &CompiledFilter,
        header: &PathHeader,
        path: &[VertexRecord],
        conditions: u64,
    ) {
        if self.matched > 0 {
            return;
        }
        let lack = filter.lack(header, path, conditions);
        if self.nearest.as_ref().is_none_or(|(least, _)| lack.is_less_than(*least)) {
            self.nearest = Some((lack, filter.miss(header, path, conditions)));
        }
    }

    /// The counts so far.
    pub fn counts(&self) -> FilterCounts {
        let [matched_steps, seen_steps] = self
            .chains
            .values()
            .fold([0.0, 0.0], |sum, chain| [sum[0] + chain[0], sum[1] + chain[1]]);
        let energy_share = if seen_steps > 0.0 { matched_steps / seen_steps } else { 0.0 };
        FilterCounts {
            revision: self.revision,
            seen: self.seen,
            matched: self.matched,
            seen_steps,
            matched_steps,
            energy_share,
            energy_error: self.error_of(energy_share, seen_steps),
            conditions: self.conditions.clone(),
            nearest: self.nearest.as_ref().filter(|_| self.matched == 0).map(|n| n.1.clone()),
        }
    }

    /// The standard error of a ratio of sums over independent chains [Cochran 1977, chapter 6]:
    /// steps of one chain depend on each other, those of different chains do not.
    fn error_of(&self, ratio: f64, total: f64) -> f64 {
        let chains = self.chains.len() as f64;
        if chains < 2.0 || !(total > 0.0) {
            return f64::NAN;
        }
        let squares: f64 = self
            .chains
            .values()
            .map(|[matched, seen]| (matched - ratio * seen) * (matched - ratio * seen))
            .sum();
        (squares * chains / (chains - 1.0)).sqrt() / total
    }
}
