//! Orders on their way from the service to those who carry them out: bounded, and never in the way.

use std::sync::mpsc::{Receiver, SyncSender, TrySendError, sync_channel};

use common::{Author, ChainCommand, ExplorerCommand, PathId};
use thiserror::Error;

/// Orders that may wait for the explorer, and as many for the chains.
const WAITING: usize = 64;

/// An order, with its author.
#[derive(Clone, Debug)]
pub struct Envelope<C> {
    /// Whoever gave it.
    pub author: Author,
    /// The number that the reply bears.
    pub request: u32,
    /// What is to be done.
    pub command: C,
}

/// What the explorer's thread is woken by.
#[derive(Clone, Debug)]
pub enum ExplorerMail {
    /// An order.
    Order(Envelope<ExplorerCommand>),
    /// The viewer of this session asks for the numbers behind a path.
    Inspect(u64, PathId),
    /// Something that it waits for may have changed.
    Wake,
}

/// Where orders are given; cheap to clone.
#[derive(Clone, Debug)]
pub struct Steering {
    explorer: SyncSender<ExplorerMail>,
    chains: SyncSender<Envelope<ChainCommand>>,
}

/// Where orders arrive.
#[derive(Debug)]
pub struct Orders {
    /// Those for the explorer.
    pub explorer: Receiver<ExplorerMail>,
    /// Those for the chains.
    pub chains: Receiver<Envelope<ChainCommand>>,
}

/// Why an order was not accepted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum OrderRefused {
    /// Too many are waiting.
    #[error("{WAITING} orders are waiting already; send fewer at a time")]
    Busy,
    /// Nobody carries them out.
    #[error("this daemon does not carry out such orders")]
    Nobody,
}

/// Both ends.
pub fn channel() -> (Steering, Orders) {
    let (explorer, explorer_orders) = sync_channel(WAITING);
    let (chains, chain_orders) = sync_channel(WAITING);
    (Steering { explorer, chains }, Orders { explorer: explorer_orders, chains: chain_orders })
}

impl Steering {
    /// Orders something of the explorer.
    pub fn explore(&self, order: Envelope<ExplorerCommand>) -> Result<(), OrderRefused> {
        self.explorer.try_send(ExplorerMail::Order(order)).map_err(|error| why(&error))
    }

    /// Asks for the numbers behind a path, for the viewer of a session. The explorer's thread answers: it
    /// knows how to make paths again, and no chain waits for it.
    pub fn inspect(&self, session: u64, path: PathId) -> Result<(), OrderRefused> {
        self.explorer.try_send(ExplorerMail::Inspect(session, path)).map_err(|error| why(&error))
    }

    /// Orders something of the chains.
    pub fn change(&self, order: Envelope<ChainCommand>) -> Result<(), OrderRefused> {
        self.chains.try_send(order).map_err(|error| why(&error))
    }

    /// Lets the explorer see whether it is watched.
    pub fn wake_explorer(&self) {
        // Where the mailbox is full, it is awake.
        drop(self.explorer.try_send(ExplorerMail::Wake));
    }
}

fn why<T>(error: &TrySendError<T>) -> OrderRefused {
    match error {
        TrySendError::Full(_) => OrderRefused::Busy,
        TrySendError::Disconnected(_) => OrderRefused::Nobody,
    }
}
