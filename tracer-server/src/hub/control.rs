//! What one viewer must get: nothing is dropped, so a viewer that lets it fill has to go.

use std::collections::VecDeque;
use std::sync::Arc;

use common::{FilterReply, Notice, Statistics};

/// Something that a viewer must get.
#[derive(Debug)]
pub(super) enum Control {
    Statistics(Arc<Statistics>),
    FilterReply(FilterReply),
    Notice(Notice),
}

/// What waits, bounded in messages and in bytes.
#[derive(Debug, Default)]
pub(super) struct ControlQueue {
    waiting: VecDeque<Control>,
    bytes: usize,
}

impl ControlQueue {
    /// Puts in what must not be lost; false where there is no more room. A state replaces the one
    /// before it that is not sent yet.
    #[must_use]
    pub(super) fn push(&mut self, control: Control, messages: usize, bytes: usize) -> bool {
        if let Control::Notice(notice) = &control {
            self.waiting.retain(|old| match old {
                Control::Notice(old) => !notice.makes_void(old),
                Control::Statistics(_) | Control::FilterReply(_) => true,
            });
            self.bytes = self.waiting.iter().map(Control::byte_len).sum();
        }
        let size = control.byte_len();
        let fits = self.waiting.is_empty() || self.bytes + size <= bytes;
        if self.waiting.len() >= messages || !fits {
            return false;
        }
        self.bytes += size;
        self.waiting.push_back(control);
        true
    }

    /// Takes what came first.
    pub(super) fn pop(&mut self) -> Option<Control> {
        let control = self.waiting.pop_front()?;
        self.bytes -= control.byte_len();
        Some(control)
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

impl Control {
    /// Bytes that it takes, about: what may be long is counted.
    fn byte_len(&self) -> usize {
        size_of::<Self>()
            + match self {
                Self::Statistics(statistics) => statistics_bytes(statistics),
                Self::FilterReply(reply) => {
                    let conditions: usize = reply.conditions.iter().map(String::len).sum();
                    let error = reply.error.as_ref().map_or(0, |error| error.message.len());
                    reply.text.len() + conditions + error
                }
                Self::Notice(notice) => notice_bytes(notice),
            }
    }
}

fn statistics_bytes(statistics: &Statistics) -> usize {
    let strategies = size_of_val(statistics.strategies.as_slice());
    let maps = statistics
        .diagnostics
        .as_ref()
        .map_or(0, |diagnostics| 5 * size_of::<f32>() * diagnostics.maps.acceptance.len());
    size_of::<Statistics>() + strategies + maps
}

fn notice_bytes(notice: &Notice) -> usize {
    match notice {
        Notice::Presence(presence) => {
            let viewers = presence.viewers.iter();
            viewers.map(|v| size_of_val(v) + v.author.name.len() + v.appearance.filter.len()).sum()
        }
        Notice::Chains(state) => state.change.len() + size_of_val(state.weights.as_slice()),
        Notice::Reply(reply) => reply.error.as_ref().map_or(0, String::len),
        Notice::Detail(reply) => match &reply.found {
            Ok(detail) => {
                size_of_val(detail.vertices.as_slice())
                    + size_of_val(detail.geometry.as_slice())
                    + size_of_val(detail.reciprocals.as_slice())
            }
            Err(why) => why.len(),
        },
        Notice::Explorer(_) | Notice::Lease(_) => 0,
    }
}

#[cfg(test)]
mod tests {
    use common::{OrderReply, Presence};

    use super::*;

    fn reply(length: usize) -> Control {
        let error = Some("x".repeat(length));
        Control::Notice(Notice::Reply(OrderReply { request: 1, error }))
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
            let presence = Control::Notice(Notice::Presence(Presence::default()));
            assert!(queue.push(presence, 8, 4000), "states replace each other");
        }
        assert_eq!(queue.len(), 1, "the newest");
    }
}
