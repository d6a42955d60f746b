//! The focus lane of one viewer: every step of the explorer, as long as the viewer keeps up.

use std::collections::VecDeque;
use std::sync::Arc;

use common::{FocusPath, FocusStep, TracerEvent};

/// Most bytes of steps that wait for a viewer: some five thousand of them.
pub(super) const FOCUS_BYTES: usize = 2 << 20;

/// What the explorer has done.
#[derive(Clone, Debug)]
pub struct FocusNews {
    /// The step; `None` where the explorer was put elsewhere.
    pub step: Option<Arc<FocusStep>>,
    /// Its current path after it.
    pub after: Arc<FocusPath>,
}

impl FocusNews {
    /// Bytes that it takes on its way, about.
    pub(super) fn byte_len(&self) -> usize {
        match &self.step {
            Some(step) => step.byte_len(),
            None => self.after.byte_len(),
        }
    }
}

/// The lane. Nothing is in it before a viewer has asked for it.
#[derive(Debug, Default)]
pub(super) struct FocusQueue {
    on: bool,
    items: VecDeque<TracerEvent>,
    bytes: usize,
}

impl FocusQueue {
    /// True when the viewer has asked for it.
    pub(super) fn is_on(&self) -> bool {
        self.on
    }

    /// Opens the lane with the explorer's current path, or closes it.
    pub(super) fn set(&mut self, on: bool, current: Option<Arc<FocusPath>>) {
        if on != self.on {
            *self = Self { on, ..Self::default() };
            if let Some(path) = current.filter(|_| on) {
                self.put(TracerEvent::FocusPath(path));
            }
        }
    }

    /// Puts in what the explorer did. Where too much waits, all of it makes room, the loss is told,
    /// and the current path begins anew.
    pub(super) fn push(&mut self, news: &FocusNews) {
        if !self.on {
            return;
        }
        let item = match &news.step {
            Some(step) => TracerEvent::FocusStep(Arc::clone(step)),
            None => TracerEvent::FocusPath(Arc::clone(&news.after)),
        };
        self.put(item);
        if self.bytes > FOCUS_BYTES {
            let lost = self.items.iter().map(TracerEvent::focus_steps).sum();
            self.items.clear();
            self.bytes = 0;
            self.put(TracerEvent::FocusGap(lost));
            self.put(TracerEvent::FocusPath(Arc::clone(&news.after)));
        }
    }

    /// Takes what comes first.
    pub(super) fn pop(&mut self) -> Option<TracerEvent> {
        let item = self.items.pop_front()?;
        self.bytes -= item.byte_len();
        Some(item)
    }

    /// Bytes that wait.
    pub(super) fn byte_len(&self) -> usize {
        self.bytes
    }

    fn put(&mut self, item: TracerEvent) {
        self.bytes += item.byte_len();
        self.items.push_back(item);
    }
}
