//! The flow of light between classes of paths, as a strategy's proposals carry it.

use std::collections::BTreeMap;

use crate::path::ClassKey;

/// A quantity is judged when at least this many proposals moved it each way.
pub const MIN_MOVES: u64 = 200;

/// Two different classes, the smaller key first.
pub type Pair = (ClassKey, ClassKey);

/// The net flow between two classes.
#[derive(Clone, Copy, Debug, Default)]
pub struct Flow {
    /// Sum of the samples' net flows from the first to the second class.
    net: f64,
    /// Sum of their squares.
    squares: f64,
    /// Sum of the magnitudes of all parts.
    gross: f64,
    /// Moves from the first class to the second.
    pub forth: u64,
    /// Moves from the second class to the first.
    pub back: u64,
}

impl Flow {
    /// True when enough proposals went each way to judge by.
    pub fn is_judged(&self) -> bool {
        self.forth >= MIN_MOVES && self.back >= MIN_MOVES
    }

    /// How many standard errors the net flow of `samples` samples is away from balance.
    pub fn z(&self, samples: u64) -> f64 {
        let n = samples as f64;
        let variance = (self.squares - self.net * self.net / n) / (n - 1.0);
        self.net / (variance * n).sqrt()
    }

    /// Light that moves either way in one step of the strategy, as a mean over `samples` samples.
    pub fn mean_gross(&self, samples: u64) -> f64 {
        self.gross / samples as f64
    }
}

/// All flows of one run.
#[derive(Clone, Debug, Default)]
pub struct Flows {
    /// By pair of classes.
    pub pairs: BTreeMap<Pair, Flow>,
    /// Net flows of the sample that is being drawn.
    sample: Vec<(Pair, f64)>,
}

impl Flows {
    /// A move of `weight`, acceptance included, within the current sample.
    pub(super) fn add(&mut self, from: ClassKey, to: ClassKey, weight: f64) {
        if from == to {
            return;
        }
        let (pair, signed) = if from < to { ((from, to), weight) } else { ((to, from), -weight) };
        let flow = self.pairs.entry(pair).or_default();
        flow.gross += weight;
        flow.forth += u64::from(from < to);
        flow.back += u64::from(to < from);
        match self.sample.iter_mut().find(|(seen, _)| *seen == pair) {
            Some((_, net)) => *net += signed,
            None => self.sample.push((pair, signed)),
        }
    }

    /// Ends the current sample.
    pub(super) fn finish_sample(&mut self) {
        for (pair, net) in self.sample.drain(..) {
            let flow = self.pairs.entry(pair).or_default();
            flow.net += net;
            flow.squares += net * net;
        }
    }

    /// Adds the flows of another part of the run.
    pub(super) fn merge(&mut self, other: &Self) {
        for (pair, part) in &other.pairs {
            let flow = self.pairs.entry(*pair).or_default();
            flow.net += part.net;
            flow.squares += part.squares;
            flow.gross += part.gross;
            flow.forth += part.forth;
            flow.back += part.back;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn key(class: &str) -> ClassKey {
        ClassKey::of_letters(class.chars())
    }

    #[test]
    fn flows_that_balance_have_no_z_and_others_do() {
        let mut flows = Flows::default();
        for sample in 0..1000 {
            flows.add(key("LE"), key("LDE"), 1.0 + f64::from(sample % 3));
            flows.add(key("LDE"), key("LE"), 1.0 + f64::from((sample + 1) % 3));
            flows.add(key("LE"), key("LSE"), 1.0);
            flows.add(key("LE"), key("LE"), 100.0);
            if sample % 2 == 0 {
                flows.add(key("LSE"), key("LE"), 1.5);
            }
            flows.finish_sample();
        }
        let z: Vec<f64> = flows.pairs.values().map(|flow| flow.z(1000).abs()).collect();
        assert_eq!(z.len(), 2, "staying is no flow");
        let [small, large] = [z[0].min(z[1]), z[0].max(z[1])];
        assert!(small < 0.1 && large > 10.0, "{z:?}");
    }
}
