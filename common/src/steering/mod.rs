//! Who steers, what can be steered, and what everyone is told about it.
//!
//! One viewer at a time holds the *lease* and is the driver; the others observe. Every order gets a
//! reply, and every change is announced to everybody with the name of whoever made it.

mod chains;
mod explorer;

use serde::{Deserialize, Serialize};

use crate::{DetailReply, Role};

pub use chains::{ChainCommand, ChainState, LEAST_PRECISION, MAX_WEIGHT, MOST_PRECISION};
pub use explorer::{
    ExplorerCommand, ExplorerState, FocusOutcome, FocusPath, FocusStep, MAX_FAN, MAX_RATE,
    MAX_STEPS, MIN_RATE, Pace, RatioFactors, Seed, SkipTo, StrategySet,
};

/// What a viewer asks of the daemon. Only the driver may give orders, except for the lease.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Order {
    /// Moves the explorer.
    Explorer(ExplorerCommand),
    /// Changes what the chains do.
    Chains(ChainCommand),
    /// Concerns who may give orders.
    Lease(LeaseRequest),
}

/// What a viewer may do about the lease.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LeaseRequest {
    /// Asks for it: a free lease is granted at once, another one when its holder lets go.
    Ask,
    /// Gives it back, or stops asking for it.
    Release,
    /// Gives it to the viewer of this session.
    HandOver(u64),
}

/// The answer to one order.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct OrderReply {
    /// The number that the viewer gave the order.
    pub request: u32,
    /// Why it was refused, and what to do about it; `None` where it was carried out.
    pub error: Option<String>,
}

/// Whoever did something.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Author {
    /// Number of the session.
    pub session: u64,
    /// The name that the viewer gave itself.
    pub name: String,
}

/// What a viewer is told about the lease.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LeaseNotice {
    /// What happened.
    pub event: LeaseEvent,
    /// By whom, where somebody else did it.
    pub by: Option<Author>,
}

/// What may happen to the lease.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LeaseEvent {
    /// This viewer is the driver now.
    Granted,
    /// This viewer is the driver no more.
    Lost,
    /// Another viewer asks the driver for the lease.
    Asked,
}

/// Where a viewer looks from, if it shares that.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Gaze {
    /// The eye, in scene units.
    pub eye: [f32; 3],
    /// What it looks at, in scene units.
    pub target: [f32; 3],
}

/// What a viewer shows of itself to the others.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Appearance {
    /// Where it looks from.
    pub gaze: Option<Gaze>,
    /// The filter or the selectors that it works with, in their text form; blank for nothing.
    pub filter: String,
}

/// One viewer, as the others see it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Attendee {
    /// Its session and its name.
    pub author: Author,
    /// What it may do now.
    pub role: Role,
    /// It waits for the lease.
    pub asks: bool,
    /// What it shows of itself.
    pub appearance: Appearance,
}

/// All viewers, in the order in which they came.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Presence {
    /// One entry a viewer.
    pub viewers: Vec<Attendee>,
}

impl Presence {
    /// The viewer that holds the lease.
    pub fn driver(&self) -> Option<&Attendee> {
        self.viewers.iter().find(|viewer| viewer.role == Role::Driver)
    }

    /// The viewer of a session.
    pub fn get(&self, session: u64) -> Option<&Attendee> {
        self.viewers.iter().find(|viewer| viewer.author.session == session)
    }
}

/// What viewers are told in addition to data: never dropped.
#[derive(Clone, Debug, PartialEq)]
pub enum Notice {
    /// Who is there.
    Presence(Presence),
    /// What the explorer is at.
    Explorer(ExplorerState),
    /// What the chains are at.
    Chains(ChainState),
    /// Something happened to the lease.
    Lease(LeaseNotice),
    /// The answer to an order.
    Reply(OrderReply),
    /// The answer to a question about a path.
    Detail(Box<DetailReply>),
}

impl Notice {
    /// True for a state that makes void the `old` one of its kind, which nobody has been told yet.
    pub fn makes_void(&self, old: &Self) -> bool {
        let is_state = matches!(self, Self::Presence(_) | Self::Explorer(_) | Self::Chains(_));
        is_state && std::mem::discriminant(self) == std::mem::discriminant(old)
    }
}
