//! How often news is shown: often, but never so often that the mouse has to wait.

use std::time::{Duration, Instant};

/// News is shown this often at most.
pub const FRAME: Duration = Duration::from_millis(33);
/// And this often where the cloud stands still, and nobody waits for it.
pub const CALM: Duration = Duration::from_secs(1);
/// Drawing news may take one part in this many of the time; the rest is for the user's hand.
const SHARE: u32 = 3;

/// When to take in news, from how long it took to draw the last.
#[derive(Clone, Copy, Debug, Default)]
pub struct Pace {
    last: Option<Instant>,
    /// The frame that began at `last` is not known to have ended.
    drawing: bool,
    cost: Duration,
}

impl Pace {
    /// How long to wait before news may be taken in; called when a frame begins.
    pub fn wait(&mut self, now: Instant) -> Option<Duration> {
        let since = now.saturating_duration_since(self.last?);
        if std::mem::take(&mut self.drawing) {
            self.cost = since;
        }
        let due = FRAME.max(self.cost * SHARE);
        due.checked_sub(since).filter(|wait| !wait.is_zero())
    }

    /// The frame that begins now shows news.
    pub fn news(&mut self, now: Instant) {
        self.last = Some(now);
        self.drawing = true;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn news_waits_for_its_share_of_the_time() {
        let start = Instant::now();
        let at = |milliseconds| start + Duration::from_millis(milliseconds);
        let mut pace = Pace::default();
        assert_eq!(pace.wait(start), None, "the first news is shown at once");
        pace.news(start);
        assert_eq!(pace.wait(at(5)), Some(Duration::from_millis(28)), "a fast frame");
        assert_eq!(pace.wait(at(33)), None, "thirty times a second");
        pace.news(at(100));
        assert_eq!(pace.wait(at(300)), Some(Duration::from_millis(400)), "a slow frame");
        assert_eq!(pace.wait(at(650)), Some(Duration::from_millis(50)), "its cost is known");
        assert_eq!(pace.wait(at(700)), None, "and then news");
    }
}
