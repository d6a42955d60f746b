//! A viewer's data budget: a bucket of tokens, one a byte.

use std::time::Duration;

use tokio::time::Instant;

/// Least and most bytes a second that a viewer may ask for.
const RATES: (u64, u64) = (16 << 10, 1 << 30);
/// Seconds of budget that may be saved up while nothing is sent.
const BURST_SECONDS: f64 = 0.25;

/// A bucket that fills at the budget's rate. A message is sent whole as soon as the bucket is not
/// overdrawn; its size may overdraw it, and then the next one waits.
#[derive(Debug)]
pub(super) struct Budget {
    bytes_per_second: f64,
    tokens: f64,
    filled: Instant,
}

impl Budget {
    /// A full bucket of `bytes_per_second`, kept within sensible bounds.
    pub(super) fn new(bytes_per_second: u64, now: Instant) -> Self {
        let rate = bytes_per_second.clamp(RATES.0, RATES.1) as f64;
        Self { bytes_per_second: rate, tokens: rate * BURST_SECONDS, filled: now }
    }

    /// The rate, in bytes a second.
    pub(super) fn bytes_per_second(&self) -> f64 {
        self.bytes_per_second
    }

    /// `None` when something may be sent `now`; else the moment when it may.
    pub(super) fn wait(&mut self, now: Instant) -> Option<Instant> {
        let elapsed = now.saturating_duration_since(self.filled).as_secs_f64();
        let burst = self.bytes_per_second * BURST_SECONDS;
        self.tokens = (self.tokens + elapsed * self.bytes_per_second).min(burst);
        self.filled = now;
        if self.tokens >= 0.0 {
            return None;
        }
        let seconds = -self.tokens / self.bytes_per_second;
        // Rounded up to the timer's grain, so that the wake-up finds the debt paid.
        Some(now + Duration::from_secs_f64(seconds) + Duration::from_millis(1))
    }

    /// Takes the tokens of a message that was sent.
    pub(super) fn spend(&mut self, bytes: usize) {
        self.tokens -= bytes as f64;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_budget_holds_over_time() {
        let start = Instant::now();
        let rate = 1 << 20;
        let mut budget = Budget::new(rate, start);
        let (mut now, mut sent) = (start, 0_u64);
        while now < start + Duration::from_secs(10) {
            match budget.wait(now) {
                None => {
                    budget.spend(64 << 10);
                    sent += 64 << 10;
                }
                Some(later) => {
                    assert!(later > now, "a wait ends in the future");
                    now = later;
                }
            }
        }
        let allowed = rate * 10 + rate / 4;
        assert!(sent <= allowed + (128 << 10), "{sent} of {allowed} bytes");
        assert!(sent >= allowed * 9 / 10, "{sent} of {allowed} bytes");
    }

    #[test]
    fn absurd_rates_are_bounded() {
        let now = Instant::now();
        for rate in [0, 1, u64::MAX] {
            let mut budget = Budget::new(rate, now);
            budget.spend(1 << 20);
            let wait = budget.wait(now).map(|later| later - now);
            assert!(wait <= Some(Duration::from_secs(65)), "{rate} bytes a second wait {wait:?}");
        }
    }
}
