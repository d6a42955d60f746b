//! How fast things come.

use std::collections::VecDeque;

/// A rate is an average over this many seconds.
const WINDOW_SECONDS: f64 = 2.0;
/// Readings of the history that are kept, at two a second: two minutes.
const HISTORY: usize = 240;

/// A running count, as a rate.
#[derive(Clone, Debug, Default)]
pub struct RateMeter {
    readings: VecDeque<(f64, u64)>,
}

impl RateMeter {
    /// Notes that `count` things had come by `time` (seconds).
    pub fn record(&mut self, time: f64, count: u64) {
        // Ten readings a second are enough, and bound the queue.
        let recent = self.readings.iter().rev().nth(1).is_some_and(|(t, _)| time - t < 0.1);
        if recent {
            self.readings.pop_back();
        }
        self.readings.push_back((time, count));
        while self.readings.front().is_some_and(|(t, _)| time - t > WINDOW_SECONDS)
            && self.readings.len() > 2
        {
            self.readings.pop_front();
        }
    }

    /// Things a second.
    pub fn per_second(&self) -> f64 {
        match (self.readings.front(), self.readings.back()) {
            (Some((t0, n0)), Some((t1, n1))) if t1 > t0 => {
                n1.saturating_sub(*n0) as f64 / (t1 - t0)
            }
            _ => 0.0,
        }
    }
}

/// The last readings of a quantity, for a small curve.
#[derive(Clone, Debug, Default)]
pub struct History {
    values: VecDeque<f32>,
}

impl History {
    /// Adds a reading.
    pub fn push(&mut self, value: f32) {
        if self.values.len() == HISTORY {
            self.values.pop_front();
        }
        self.values.push_back(value);
    }

    /// Forgets all readings.
    pub fn clear(&mut self) {
        self.values.clear();
    }

    /// The readings, oldest first.
    pub fn values(&self) -> impl ExactSizeIterator<Item = f32> {
        self.values.iter().copied()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_steady_stream_has_its_rate() {
        let mut meter = RateMeter::default();
        assert_eq!(meter.per_second(), 0.0, "nothing yet");
        for i in 0..10_000_u64 {
            meter.record(i as f64 / 60.0, 50 * i);
        }
        assert!((meter.per_second() - 3000.0).abs() < 1.0, "{}", meter.per_second());
        assert!(meter.readings.len() < 30, "the queue is bounded");
    }

    #[test]
    fn a_count_that_starts_again_is_no_negative_rate() {
        let mut meter = RateMeter::default();
        meter.record(0.0, 1000);
        meter.record(1.0, 3);
        assert_eq!(meter.per_second(), 0.0, "no rate");
    }

    #[test]
    fn the_history_is_bounded() {
        let mut history = History::default();
        for i in 0..1000 {
            history.push(i as f32);
        }
        assert_eq!(history.values().len(), HISTORY, "bounded");
        assert_eq!(history.values().last(), Some(999.0), "the newest is kept");
    }
}
