//! Numbers that nothing else in the process has: what bears the same one is the same.

use std::sync::atomic::{AtomicU64, Ordering};

static NEXT: AtomicU64 = AtomicU64::new(1);

/// A number larger than all before it.
pub fn fresh() -> u64 {
    NEXT.fetch_add(1, Ordering::Relaxed)
}
