//! The stream to one viewer: messages, and then one last word that never waits for room.

use std::pin::Pin;
use std::task::{Context, Poll};

use proto::v1::TracerMessage;
use tokio::sync::{mpsc, oneshot};
use tokio_stream::Stream;
use tonic::Status;

/// The end that the session holds.
#[derive(Debug)]
pub(super) struct Sender {
    /// Holds one message: queues are the hub's business.
    pub(super) messages: mpsc::Sender<TracerMessage>,
    /// Sent after every message, even to a viewer that does not read.
    pub(super) last: oneshot::Sender<Result<TracerMessage, Status>>,
}

/// The end that tonic reads.
#[derive(Debug)]
pub(super) struct Outbound {
    messages: mpsc::Receiver<TracerMessage>,
    last: Option<oneshot::Receiver<Result<TracerMessage, Status>>>,
}

/// A stream and its sender.
pub(super) fn channel() -> (Sender, Outbound) {
    let (messages, message_queue) = mpsc::channel(1);
    let (last, last_word) = oneshot::channel();
    (Sender { messages, last }, Outbound { messages: message_queue, last: Some(last_word) })
}

impl Stream for Outbound {
    type Item = Result<TracerMessage, Status>;

    fn poll_next(mut self: Pin<&mut Self>, cx: &mut Context<'_>) -> Poll<Option<Self::Item>> {
        if let Some(message) = std::task::ready!(self.messages.poll_recv(cx)) {
            return Poll::Ready(Some(Ok(message)));
        }
        let Some(last) = &mut self.last else { return Poll::Ready(None) };
        let word = std::task::ready!(Pin::new(last).poll(cx));
        self.last = None;
        // A session that says nothing in the end leaves a stream that just ends.
        Poll::Ready(word.ok())
    }
}
