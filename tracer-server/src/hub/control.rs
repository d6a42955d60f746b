//! What one viewer must get: nothing is dropped, so a viewer that lets it fill has to go.

use std::collections::VecDeque;

use common::TracerEvent;

/// What waits, bounded in messages and in bytes.
#[derive(Debug, Default)]
pub(super) struct ControlQueue {
    waiting: VecDeque<TracerEvent>,
    bytes: usize,
}

impl ControlQueue {
    /// Puts in what must not be lost; false where there is no more room. A state replaces the one
    /// before it that is not sent yet.
    #[must_use]
    pub(super) fn push(&mut self, event: TracerEvent, messages: usize, bytes: usize) -> bool {
        if let TracerEvent::Notice(notice) = &event {
            let is_void = |old: &TracerEvent| matches!(old, TracerEvent::Notice(old) if notice.makes_void(old));
            self.waiting.retain(|old| !is_void(old));
            self.bytes = self.waiting.iter().map(TracerEvent::byte_len).sum();
        }
        let size = event.byte_len();
        let fits = self.waiting.is_empty() || self.bytes + size <= bytes;
        if self.waiting.len() >= messages || !fits {
            return false;
        }
        self.bytes += size;
        self.waiting.push_back(event);
        true
    }

    /// Takes what came first.
    pub(super) fn pop(&mut self) -> Option<TracerEvent> {
        let event = self.waiting.pop_front()?;
        self.bytes -= event.byte_len();
        Some(event)
    }

    /// Messages that wait.
    pub(super) fn len(&self) -> usize {
        self.waiting.len()
    }

    /// Bytes that wait, about.
    pub(super) fn byte_len(&self) -> usize {
        self.bytes
    }
}

#[cfg(test)]
mod tests {
    use common::{Notice, OrderReply, Presence};

    use super::*;

    fn reply(length: usize) -> TracerEvent {
        let error = Some("x".repeat(length));
        TracerEvent::Notice(Notice::Reply(OrderReply { request: 1, error }))
    }

    #[test]
    fn bytes_and_messages_are_bounded_and_counted() {
        let mut queue = ControlQueue::default();
        assert!(queue.push(reply(5000), 8, 4000), "one that is alone passes");
        assert!(!queue.push(reply(1), 8, 4000), "then there is no more room");
        assert!(queue.pop().is_some() && queue.byte_len() == 0, "all of it is counted back");
        while queue.push(reply(10), 8, 100_000) {}
        assert_eq!(queue.len(), 8, "as many as may wait");
        while queue.pop().is_some() {}
        for _ in 0..100 {
            let presence = TracerEvent::Notice(Notice::Presence(Presence::default()));
            assert!(queue.push(presence, 8, 4000), "states replace each other");
        }
        assert_eq!(queue.len(), 1, "the newest");
    }
}
