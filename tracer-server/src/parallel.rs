//! Spreading work over threads without making the result depend on them.

use std::ops::Range;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};
use std::thread;

/// Tells workers to leave what is not done yet; clones share it, and it is never taken back.
///
/// Workers look at it between pieces of work, so that work that was not stopped has the same bits as
/// work that nobody could have stopped.
#[derive(Clone, Debug, Default)]
pub struct Stop(Arc<AtomicBool>);

impl Stop {
    /// Tells everyone.
    pub fn set(&self) {
        self.0.store(true, Ordering::Relaxed);
    }

    /// True from the first [`Stop::set`] on.
    pub fn is_set(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }

    /// Does `work` so many `times` unless it is told to stop before; returns how often it was done.
    pub fn repeat(&self, times: u64, mut work: impl FnMut()) -> u64 {
        const BETWEEN_LOOKS: u64 = 1024;
        let mut done = 0;
        while done < times && !self.is_set() {
            let now = BETWEEN_LOOKS.min(times - done);
            (0..now).for_each(|_| work());
            done += now;
        }
        done
    }
}

/// What `work` makes of the numbers in `range`, in their order, by `threads` workers that each have
/// a state made by `start`.
pub fn map<T: Send, S: Send>(
    threads: usize,
    range: Range<u64>,
    start: impl Fn() -> S + Sync,
    work: impl Fn(&mut S, u64) -> T + Sync,
) -> Vec<T> {
    let mut slots: Vec<Option<T>> = range.clone().map(|_| None).collect();
    for_each(threads, range.zip(slots.iter_mut()), start, |state, (number, slot)| {
        *slot = Some(work(state, number));
    });
    slots.into_iter().flatten().collect()
}

/// Hands `items` to `threads` workers, each with a state made by `start`, until none is left;
/// returns the states.
///
/// Which worker gets which item is a matter of luck, so `work` must put its result into the item.
pub fn for_each<T, S: Send>(
    threads: usize,
    items: impl Iterator<Item = T> + Send,
    start: impl Fn() -> S + Sync,
    work: impl Fn(&mut S, T) + Sync,
) -> Vec<S> {
    let queue = Mutex::new(items);
    let worker = || {
        let mut state = start();
        while let Some(item) = queue.lock().ok().and_then(|mut queue| queue.next()) {
            work(&mut state, item);
        }
        state
    };
    if threads <= 1 {
        return vec![worker()];
    }
    thread::scope(|scope| {
        let workers: Vec<_> = (0..threads).map(|_| scope.spawn(worker)).collect();
        workers
            .into_iter()
            .map(|worker| worker.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)))
            .collect()
    })
}
