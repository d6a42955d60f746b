//! A daemon as it is watched: the connection, what was asked of it, and what waits to be taken in.

use std::sync::Arc;
use std::time::{Duration, Instant};

use common::{Appearance, FilterReply, FilterText, Order, PathBatch, PathId};

use super::connection::{Inbox, Link};

/// The other viewers are told about a new viewpoint at most this often.
const APPEARANCE: Duration = Duration::from_millis(500);

/// A daemon, with or without a connection to it.
#[derive(Debug, Default)]
pub struct Daemon {
    link: Option<Link>,
    /// Where what comes waits to be taken in.
    inbox: Arc<Inbox>,
    /// Orders given so far: the number of the last one.
    orders: u32,
    /// Which paths it was asked for.
    wanted: WantedPaths,
    /// What the others were shown of this viewer last, and when.
    appearance: Option<(Appearance, Instant)>,
}

/// Which paths a daemon was asked for.
#[derive(Debug, Default)]
struct WantedPaths {
    /// Filters set so far: the number of the last one.
    revision: u32,
    /// The filter that was asked for last.
    filter: FilterText,
    /// When the user changed the filter since.
    changed: Option<Instant>,
    /// The filter that the daemon last answered.
    answered: u32,
    /// The filter that the daemon last said it follows.
    in_force: u32,
}

impl Daemon {
    /// Takes over a connection.
    pub(super) fn attach(&mut self, link: Link) {
        self.inbox = Arc::clone(link.inbox());
        self.link = Some(link);
    }

    /// Where what comes waits to be taken in.
    pub fn inbox(&self) -> &Inbox {
        &self.inbox
    }

    /// Ends the wait for the next attempt to connect.
    pub fn retry_now(&self) {
        if let Some(link) = &self.link {
            link.retry_now();
        }
    }

    /// Gives an order. False where it cannot be sent.
    pub fn order(&mut self, order: Order) -> bool {
        self.orders += 1;
        self.link.as_ref().is_some_and(|link| link.order(self.orders, order))
    }

    /// Asks for the numbers behind a path. False where there is nobody to ask.
    pub(super) fn inspect(&self, path: PathId) -> bool {
        self.link.as_ref().is_some_and(|link| link.inspect(path))
    }

    /// Shows the others where this viewer looks, when that has changed.
    pub fn appear(&mut self, appearance: impl FnOnce() -> Appearance) {
        let last = self.appearance.as_ref();
        if last.is_some_and(|(_, at)| at.elapsed() < APPEARANCE) {
            return;
        }
        let appearance = appearance();
        let is_known = match last {
            Some((shown, _)) => *shown == appearance,
            None => appearance == Appearance::default(),
        };
        if !is_known && self.link.as_ref().is_some_and(|link| link.show(appearance.clone())) {
            self.appearance = Some((appearance, Instant::now()));
        }
    }

    /// A session begins, in which nobody has seen this viewer.
    pub(super) fn begin_session(&mut self) {
        self.appearance = None;
    }

    /// Notes that the user has changed the filter: it is asked for when the hand has rested.
    pub(super) fn filter_changed(&mut self) {
        self.wanted.changed = Some(Instant::now());
    }

    /// True while the user's hand is changing the filter.
    pub fn filter_is_changing(&self) -> bool {
        self.wanted.changed.is_some()
    }

    /// True once when the hand has rested for `rest` since it changed the filter to another filter.
    pub(super) fn filter_is_due(&mut self, rest: Duration, filter: &FilterText) -> bool {
        let is_due = self.wanted.changed.is_some_and(|at| at.elapsed() >= rest);
        if is_due {
            self.wanted.changed = None;
        }
        is_due && self.wanted.filter != *filter
    }

    /// True where the daemon may follow another filter than this one in a new session.
    pub(super) fn must_hear(&self, filter: &FilterText) -> bool {
        self.wanted.revision > 0 || *filter != FilterText::default()
    }

    /// Tells the daemon which paths to send from now on; those before were others. False where that
    /// could not be said.
    pub(super) fn ask_for_paths(&mut self, filter: &FilterText) -> bool {
        self.wanted.revision += 1;
        self.wanted.filter.clone_from(filter);
        let link = self.link.as_ref();
        link.is_none_or(|link| link.set_filter(self.wanted.revision, filter.clone()))
    }

    /// The daemon follows a filter from now on, or refuses it.
    pub(super) fn accept_filter(&mut self, reply: &FilterReply) {
        self.wanted.answered = reply.revision;
        if reply.error.is_none() {
            self.wanted.in_force = reply.revision;
        }
    }

    /// True when the daemon has answered the filter that the user wants.
    pub fn agrees_on_paths(&self) -> bool {
        self.wanted.changed.is_none() && self.wanted.answered == self.wanted.revision
    }

    /// The next batch of the filter in force, once `threshold` paths have waited for it.
    pub(super) fn next_batch(&self, threshold: usize) -> Option<Arc<PathBatch>> {
        let mut batches = std::iter::from_fn(|| self.inbox.next_batch(threshold));
        batches.find(|batch| batch.origin().revision >= self.wanted.in_force)
    }
}
