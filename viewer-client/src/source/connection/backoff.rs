//! How long to wait before connecting again.

use std::time::Duration;

/// The wait after the first failure.
const FIRST: Duration = Duration::from_millis(500);
/// The longest wait.
const LONGEST: Duration = Duration::from_secs(8);

/// The wait after `failures` failures in a row: it doubles, up to a limit.
pub fn delay(failures: u32) -> Duration {
    let doublings = failures.saturating_sub(1).min(16);
    FIRST.saturating_mul(1 << doublings).min(LONGEST)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_wait_doubles_up_to_its_limit() {
        let waits: Vec<u128> = (1..8).map(|n| delay(n).as_millis()).collect();
        assert_eq!(waits, [500, 1000, 2000, 4000, 8000, 8000, 8000], "waits in milliseconds");
        assert_eq!(delay(0), FIRST, "before any failure");
        assert_eq!(delay(u32::MAX), LONGEST, "after very many");
    }
}
