//! Orders, and what is said of who steers.

use common::{
    Appearance, Attendee, Author, ChainCommand, ChainState, ExplorerCommand, ExplorerState, Gaze,
    LEAST_PRECISION, LeaseEvent, LeaseNotice, LeaseRequest, MAX_FAN, MAX_FILTER_BYTES, MAX_RATE,
    MAX_STEPS, MAX_WEIGHT, MIN_RATE, MOST_PRECISION, Order, OrderReply, Pace, Presence, Seed,
    SkipTo, StrategyId, StrategySet,
};

use super::focus::{from_point, to_point};
use super::role::role;
use super::{WireError, check};
use crate::v1;
use crate::v1::order::What;

/// Most viewers that a daemon may speak of.
const MAX_VIEWERS: usize = 1024;

/// An order under a viewer's number for it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NumberedOrder {
    /// The number that the reply bears.
    pub request: u32,
    /// What is asked for; `None` for something of a later version.
    pub order: Option<Order>,
}

impl From<NumberedOrder> for v1::Order {
    fn from(NumberedOrder { request, order }: NumberedOrder) -> Self {
        Self { request, what: order.map(what) }
    }
}

fn what(order: Order) -> What {
    const NOTHING: v1::Nothing = v1::Nothing {};
    match order {
        Order::Explorer(command) => match command {
            ExplorerCommand::Seed(seed) => What::ExplorerSeed(v1::ExplorerSeed {
                path: match seed {
                    Seed::Path(id) => Some(id.into()),
                    Seed::Newest => None,
                },
            }),
            ExplorerCommand::Play(rate) => What::ExplorerPlay(rate),
            ExplorerCommand::Pause => What::ExplorerPause(NOTHING),
            ExplorerCommand::Step(count) => What::ExplorerStep(count),
            ExplorerCommand::Skip(SkipTo::Acceptance) => What::ExplorerSkipToAcceptance(NOTHING),
            ExplorerCommand::Skip(SkipTo::Strategy(strategy)) => {
                What::ExplorerSkipToStrategy(strategy.0.into())
            }
            ExplorerCommand::Allow(set) => What::ExplorerAllow(set.0),
            ExplorerCommand::Fan { strategy, count } => {
                What::ExplorerFan(v1::ExplorerFan { strategy: strategy.0.into(), count })
            }
        },
        Order::Chains(command) => match command {
            ChainCommand::Pause => What::ChainsPause(NOTHING),
            ChainCommand::Resume => What::ChainsResume(NOTHING),
            ChainCommand::SetWeight { strategy, weight } => {
                What::ChainsWeight(v1::StrategyWeight { strategy: strategy.0.into(), weight })
            }
            ChainCommand::SetPrecision(precision) => What::ChainsPrecision(precision),
            ChainCommand::Restart { seed } => What::ChainsRestart(seed),
        },
        Order::Lease(request) => match request {
            LeaseRequest::Ask => What::LeaseAsk(NOTHING),
            LeaseRequest::Release => What::LeaseRelease(NOTHING),
            LeaseRequest::HandOver(session) => What::LeaseHandOver(session),
        },
    }
}

impl TryFrom<v1::Order> for NumberedOrder {
    type Error = WireError;

    fn try_from(wire: v1::Order) -> Result<Self, WireError> {
        let order = wire.what.map(order).transpose()?;
        Ok(Self { request: wire.request, order })
    }
}

/// Every order is named: a new one is understood before anything is made of it.
fn order(wire: What) -> Result<Order, WireError> {
    let explorer = Order::Explorer;
    Ok(match wire {
        What::LeaseAsk(_) => Order::Lease(LeaseRequest::Ask),
        What::LeaseRelease(_) => Order::Lease(LeaseRequest::Release),
        What::LeaseHandOver(session) => Order::Lease(LeaseRequest::HandOver(session)),
        What::ChainsPause(_) => Order::Chains(ChainCommand::Pause),
        What::ChainsResume(_) => Order::Chains(ChainCommand::Resume),
        What::ChainsRestart(seed) => Order::Chains(ChainCommand::Restart { seed }),
        What::ChainsWeight(v1::StrategyWeight { strategy, weight }) => {
            let weight = check::between("order.chains_weight", weight, 0.0, MAX_WEIGHT)?;
            Order::Chains(ChainCommand::SetWeight { strategy: strategy_id(strategy)?, weight })
        }
        What::ChainsPrecision(precision) => {
            let (least, most) = (LEAST_PRECISION, MOST_PRECISION);
            let precision = check::between("order.chains_precision", precision, least, most)?;
            Order::Chains(ChainCommand::SetPrecision(precision))
        }
        What::ExplorerSeed(v1::ExplorerSeed { path }) => {
            explorer(ExplorerCommand::Seed(path.map_or(Seed::Newest, |id| Seed::Path(id.into()))))
        }
        What::ExplorerPlay(rate) => {
            let (least, most) = (MIN_RATE.into(), MAX_RATE.into());
            check::between("order.explorer_play", rate.into(), least, most)?;
            explorer(ExplorerCommand::Play(rate))
        }
        What::ExplorerPause(_) => explorer(ExplorerCommand::Pause),
        What::ExplorerStep(count) => {
            let count = check::within("order.explorer_step", count, 1, MAX_STEPS)?;
            explorer(ExplorerCommand::Step(count))
        }
        What::ExplorerSkipToAcceptance(_) => explorer(ExplorerCommand::Skip(SkipTo::Acceptance)),
        What::ExplorerSkipToStrategy(strategy) => {
            explorer(ExplorerCommand::Skip(SkipTo::Strategy(strategy_id(strategy)?)))
        }
        What::ExplorerAllow(bits) => explorer(ExplorerCommand::Allow(StrategySet(bits))),
        What::ExplorerFan(v1::ExplorerFan { strategy, count }) => explorer(ExplorerCommand::Fan {
            strategy: strategy_id(strategy)?,
            count: check::within("order.explorer_fan", count, 1, MAX_FAN)?,
        }),
    })
}

fn strategy_id(index: u32) -> Result<StrategyId, WireError> {
    Ok(StrategyId(check::within("order.strategy", index, 0, 63)? as u8))
}

impl From<&OrderReply> for v1::OrderReply {
    fn from(reply: &OrderReply) -> Self {
        let error = check::cut(reply.error.as_deref().unwrap_or(""), check::MAX_REASON);
        Self { request: reply.request, error }
    }
}

impl TryFrom<v1::OrderReply> for OrderReply {
    type Error = WireError;

    fn try_from(wire: v1::OrderReply) -> Result<Self, WireError> {
        let error = check::text("order_reply.error", wire.error, check::MAX_REASON)?;
        Ok(Self { request: wire.request, error: (!error.is_empty()).then_some(error) })
    }
}

impl From<&Author> for v1::Author {
    fn from(Author { session, name }: &Author) -> Self {
        Self { session: *session, name: check::cut(name, check::MAX_NAME) }
    }
}

impl TryFrom<v1::Author> for Author {
    type Error = WireError;

    fn try_from(wire: v1::Author) -> Result<Self, WireError> {
        let name = check::text("author.name", wire.name, check::MAX_NAME)?;
        Ok(Self { session: wire.session, name })
    }
}

fn author(wire: Option<v1::Author>) -> Result<Option<Author>, WireError> {
    wire.map(TryInto::try_into).transpose()
}

impl From<&LeaseNotice> for v1::LeaseNotice {
    fn from(notice: &LeaseNotice) -> Self {
        use v1::lease_notice::Event;
        let event = match notice.event {
            LeaseEvent::Granted => Event::Granted,
            LeaseEvent::Lost => Event::Lost,
            LeaseEvent::Asked => Event::Asked,
        };
        Self { event: event.into(), by: notice.by.as_ref().map(Into::into) }
    }
}

impl TryFrom<v1::LeaseNotice> for LeaseNotice {
    type Error = WireError;

    fn try_from(wire: v1::LeaseNotice) -> Result<Self, WireError> {
        use v1::lease_notice::Event;
        let event = match Event::try_from(wire.event) {
            Ok(Event::Granted) => LeaseEvent::Granted,
            Ok(Event::Lost) => LeaseEvent::Lost,
            Ok(Event::Asked) => LeaseEvent::Asked,
            Ok(Event::Unspecified) | Err(_) => {
                return Err(WireError::Missing("lease_notice.event"));
            }
        };
        Ok(Self { event, by: author(wire.by)? })
    }
}

impl From<&Appearance> for v1::Appearance {
    fn from(appearance: &Appearance) -> Self {
        Self {
            eye: appearance.gaze.map(|gaze| to_point(gaze.eye)),
            target: appearance.gaze.map(|gaze| to_point(gaze.target)),
            filter: check::cut(&appearance.filter, MAX_FILTER_BYTES),
        }
    }
}

impl TryFrom<v1::Appearance> for Appearance {
    type Error = WireError;

    fn try_from(wire: v1::Appearance) -> Result<Self, WireError> {
        let gaze = match (wire.eye, wire.target) {
            (Some(eye), Some(target)) => Some(Gaze {
                eye: from_point("appearance.eye", eye)?,
                target: from_point("appearance.target", target)?,
            }),
            _ => None,
        };
        let filter = check::text("appearance.filter", wire.filter, MAX_FILTER_BYTES)?;
        Ok(Self { gaze, filter })
    }
}

impl From<&Presence> for v1::Presence {
    fn from(presence: &Presence) -> Self {
        let attendee = |viewer: &Attendee| v1::Attendee {
            author: Some((&viewer.author).into()),
            role: v1::Role::from(viewer.role).into(),
            asks: viewer.asks,
            appearance: Some((&viewer.appearance).into()),
        };
        Self { viewers: presence.viewers.iter().map(attendee).collect() }
    }
}

impl TryFrom<v1::Presence> for Presence {
    type Error = WireError;

    fn try_from(wire: v1::Presence) -> Result<Self, WireError> {
        check::length("presence.viewers", wire.viewers.len(), MAX_VIEWERS)?;
        let attendee = |wire: v1::Attendee| {
            Ok(Attendee {
                author: check::required("attendee.author", wire.author)?.try_into()?,
                role: role(wire.role),
                asks: wire.asks,
                appearance: wire.appearance.unwrap_or_default().try_into()?,
            })
        };
        let viewers = wire.viewers.into_iter().map(attendee).collect::<Result<_, WireError>>()?;
        Ok(Self { viewers })
    }
}

impl From<&ExplorerState> for v1::ExplorerState {
    fn from(state: &ExplorerState) -> Self {
        use v1::explorer_state::Pace as Wire;
        let pace = match state.pace {
            Pace::Paused => Wire::Paused,
            Pace::Playing => Wire::Playing,
            Pace::Skipping => Wire::Skipping,
        };
        Self {
            pace: pace.into(),
            rate: state.rate,
            allowed: state.allowed.0,
            current: state.current.map(Into::into),
            origin: state.origin.map(Into::into),
            steps: state.steps,
            accepted: state.accepted,
            next: state.next,
            by: state.by.as_ref().map(Into::into),
        }
    }
}

impl TryFrom<v1::ExplorerState> for ExplorerState {
    type Error = WireError;

    fn try_from(wire: v1::ExplorerState) -> Result<Self, WireError> {
        use v1::explorer_state::Pace as Wire;
        check::not_negative("explorer_state.rate", wire.rate.into())?;
        Ok(Self {
            pace: match Wire::try_from(wire.pace) {
                Ok(Wire::Playing) => Pace::Playing,
                Ok(Wire::Skipping) => Pace::Skipping,
                // A pace of a later version is none of those in which steps come.
                Ok(Wire::Paused | Wire::Unspecified) | Err(_) => Pace::Paused,
            },
            rate: wire.rate,
            allowed: StrategySet(wire.allowed),
            current: wire.current.map(Into::into),
            origin: wire.origin.map(Into::into),
            steps: wire.steps,
            accepted: wire.accepted,
            next: wire.next,
            by: author(wire.by)?,
        })
    }
}

impl From<&ChainState> for v1::ChainState {
    fn from(state: &ChainState) -> Self {
        Self {
            epoch: state.epoch,
            running: state.running,
            weights: state.weights.clone(),
            seed: state.seed,
            precision: check::known_or_zero(state.precision),
            change: check::cut(&state.change, check::MAX_REASON),
            by: state.by.as_ref().map(Into::into),
        }
    }
}

impl TryFrom<v1::ChainState> for ChainState {
    type Error = WireError;

    fn try_from(wire: v1::ChainState) -> Result<Self, WireError> {
        check::length("chain_state.weights", wire.weights.len(), check::MAX_NAMES)?;
        for &weight in &wire.weights {
            check::not_negative("chain_state.weights", weight)?;
        }
        Ok(Self {
            epoch: wire.epoch,
            running: wire.running,
            weights: wire.weights,
            seed: wire.seed,
            precision: check::not_negative("chain_state.precision", wire.precision)?,
            change: check::text("chain_state.change", wire.change, check::MAX_REASON)?,
            by: author(wire.by)?,
        })
    }
}
