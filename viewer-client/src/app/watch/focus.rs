//! The explorer's steps as lines of text, and orders from the command line.

use std::collections::VecDeque;

use anyhow::bail;
use common::{
    Author, ChainState, ExplorerState, FocusOutcome, FocusPath, FocusStep, LeaseEvent, LeaseNotice,
    Notice, Order, OrderReply, Pace, Presence, Role, StrategyId, TracerEvent,
};
use proto::{NumberedOrder, ViewerEvent};
use serde_json::{Value, json};

use super::{Names, inspect};

/// Statistics that come before orders are given although no path has come: about a second of them.
const PATIENCE: u32 = 3;

/// Orders that are given one after the other, each when the one before it is done.
#[derive(Debug)]
pub(super) struct Script {
    orders: VecDeque<Order>,
    given: u32,
    /// The reply to the last order is still to come.
    waits: bool,
    pace: Pace,
    /// The step that comes next, as the explorer says and as it was seen.
    next: (u64, u64),
    /// Something has come that can be picked.
    ready: bool,
    statistics: u32,
}

impl Script {
    pub(super) fn new(orders: &[Order]) -> Self {
        Self {
            orders: orders.iter().copied().collect(),
            given: 0,
            waits: false,
            pace: Pace::Paused,
            next: (0, 0),
            ready: false,
            statistics: 0,
        }
    }

    /// Takes note of an event; an order that was refused is an error.
    pub(super) fn hear(&mut self, event: &TracerEvent) -> anyhow::Result<()> {
        match event {
            TracerEvent::Paths(batch) => self.ready |= !batch.is_empty(),
            TracerEvent::Statistics(_) => {
                self.statistics += 1;
                self.ready |= self.statistics >= PATIENCE;
            }
            TracerEvent::FocusStep(step) => self.next.1 = step.number + 1,
            TracerEvent::FocusPath(path) => self.next.1 = path.next,
            TracerEvent::Notice(Notice::Explorer(state)) => {
                self.pace = state.pace;
                self.next.0 = state.next;
            }
            TracerEvent::Notice(Notice::Reply(OrderReply { request, error })) => {
                if let Some(error) = error {
                    bail!("order {request} was refused: {error}");
                }
                self.waits &= *request != self.given;
            }
            _ => {}
        }
        Ok(())
    }

    /// The order to give now.
    pub(super) fn next(&mut self) -> Option<ViewerEvent> {
        if !self.ready || self.is_busy() {
            return None;
        }
        let order = self.orders.pop_front()?;
        self.given += 1;
        self.waits = true;
        Some(ViewerEvent::Order(NumberedOrder { request: self.given, order: Some(order) }))
    }

    /// True when there were orders, all are done and seen, and nothing goes on by itself.
    pub(super) fn is_over(&self) -> bool {
        let seen = self.next.1 >= self.next.0 && self.pace == Pace::Paused;
        self.given > 0 && self.orders.is_empty() && !self.is_busy() && seen
    }

    fn is_busy(&self) -> bool {
        self.waits || self.pace == Pace::Skipping
    }
}

impl Names {
    fn mover(&self, strategy: StrategyId) -> &str {
        match strategy.0 {
            u8::MAX => "none",
            index => self.strategy(index),
        }
    }

    fn reason(&self, index: u8) -> &str {
        self.reasons.get(usize::from(index)).map_or("unknown reason", String::as_str)
    }

    pub(super) fn step_line(&self, step: &FocusStep) -> String {
        let kind = if step.fan { "fan " } else { "step" };
        let range = format!(
            "{} vertices, kept {} + {}, new {}",
            step.length,
            step.kept_light,
            step.kept_eye,
            step.inserted.len()
        );
        let head = format!(
            "{kind} {:>7} {:<16} {:<13}",
            step.number,
            step.id.step.to_string(),
            self.mover(step.strategy)
        );
        let f = step.factors;
        let tail = match step.outcome {
            FocusOutcome::Failed(reason) => {
                let at = step
                    .blocker
                    .map_or_else(String::new, |[x, y, z]| format!(" at ({x:.1}, {y:.1}, {z:.1})"));
                let eye = step.eye_side.len();
                format!("failed    {}{at}; {range} + {eye}", self.reason(reason))
            }
            outcome => format!(
                "{}  a {:.4} = min(1, {:.3e} / {:.3e} x {:.3} / {:.3} x {:.3e} / {:.3e}); {range}; film {:.4} {:.4}",
                if outcome == FocusOutcome::Accepted { "accepted" } else { "rejected" },
                step.acceptance,
                f.backward,
                f.forward,
                f.mixture_current,
                f.mixture_proposed,
                f.target_proposed,
                f.target_current,
                step.film[0],
                step.film[1]
            ),
        };
        format!("{head} {tail}")
    }

    pub(super) fn step_json(&self, step: &FocusStep) -> Value {
        let (outcome, reason) = match step.outcome {
            FocusOutcome::Accepted => ("accepted", None),
            FocusOutcome::Rejected => ("rejected", None),
            FocusOutcome::Failed(reason) => ("failed", Some(self.reason(reason))),
        };
        let points = |vertices: &[common::VertexRecord]| -> Vec<[f32; 3]> {
            vertices.iter().map(|vertex| vertex.position).collect()
        };
        json!({
            "event": if step.fan { "fan" } else { "step" },
            "number": step.number,
            "id": step.id.to_string(),
            "strategy": self.mover(step.strategy),
            "outcome": outcome,
            "reason": reason,
            "acceptance": step.acceptance,
            "forward": step.factors.forward,
            "backward": step.factors.backward,
            "mixture_current": step.factors.mixture_current,
            "mixture_proposed": step.factors.mixture_proposed,
            "target_current": step.factors.target_current,
            "target_proposed": step.factors.target_proposed,
            "length": step.length,
            "kept_light": step.kept_light,
            "kept_eye": step.kept_eye,
            "inserted": points(&step.inserted),
            "eye_side": points(&step.eye_side),
            "blocker": step.blocker,
            "film": step.film,
            "luminance": step.luminance,
            "rays": step.rays,
        })
    }
}

pub(super) fn path_line(path: &FocusPath) -> String {
    format!("path {:>7} {}  {} vertices", path.next, path.header.id, path.vertices.len())
}

pub(super) fn path_json(path: &FocusPath) -> Value {
    let points: Vec<[f32; 3]> = path.vertices.iter().map(|vertex| vertex.position).collect();
    json!({
        "event": "path",
        "id": path.header.id.to_string(),
        "next": path.next,
        "film": path.header.film,
        "points": points,
    })
}

/// The line for a notice; `None` for what is not worth one.
pub(super) fn notice_line(notice: &Notice) -> Option<String> {
    Some(match notice {
        Notice::Presence(presence) => presence_line(presence),
        Notice::Explorer(state) => explorer_line(state),
        Notice::Chains(state) => chains_line(state),
        Notice::Lease(LeaseNotice { event, by }) => {
            let by =
                by.as_ref().map_or_else(String::new, |author| format!(" by {}", named(author)));
            match event {
                LeaseEvent::Granted => format!("lease  granted{by}"),
                LeaseEvent::Lost => format!("lease  lost{by}"),
                LeaseEvent::Asked => format!("lease  asked for{by}"),
            }
        }
        Notice::Reply(OrderReply { request, error: None }) => format!("order {request}  done"),
        // The end says why; and nobody has asked.
        Notice::Reply(OrderReply { error: Some(_), .. }) | Notice::Detail(_) => return None,
    })
}

pub(super) fn notice_json(notice: &Notice) -> Value {
    match notice {
        Notice::Presence(presence) => {
            let viewer = |viewer: &common::Attendee| {
                json!({
                    "session": viewer.author.session,
                    "name": viewer.author.name,
                    "role": role(viewer.role),
                    "asks": viewer.asks,
                })
            };
            let viewers: Vec<Value> = presence.viewers.iter().map(viewer).collect();
            json!({ "event": "presence", "viewers": viewers })
        }
        Notice::Explorer(state) => json!({
            "event": "explorer",
            "pace": pace(state.pace),
            "rate": state.rate,
            "current": state.current.map(|id| id.to_string()),
            "origin": state.origin.map(|id| id.to_string()),
            "steps": state.steps,
            "accepted": state.accepted,
            "by": state.by.as_ref().map(|author| &author.name),
        }),
        Notice::Chains(state) => json!({
            "event": "chains",
            "epoch": state.epoch,
            "running": state.running,
            "weights": state.weights,
            "seed": state.seed,
            "precision": state.precision,
            "change": state.change,
            "by": state.by.as_ref().map(|author| &author.name),
        }),
        Notice::Lease(LeaseNotice { event, by }) => json!({
            "event": "lease",
            "what": match event {
                LeaseEvent::Granted => "granted",
                LeaseEvent::Lost => "lost",
                LeaseEvent::Asked => "asked",
            },
            "by": by.as_ref().map(|author| &author.name),
        }),
        Notice::Reply(OrderReply { request, error }) => {
            json!({ "event": "reply", "request": request, "error": error })
        }
        Notice::Detail(reply) => match &reply.found {
            Ok(detail) => inspect::detail_json(reply.path, detail),
            Err(error) => {
                json!({ "event": "path detail", "path": reply.path.to_string(), "error": error })
            }
        },
    }
}

fn presence_line(presence: &Presence) -> String {
    let viewer = |viewer: &common::Attendee| {
        let asks = if viewer.asks { ", asks for the lease" } else { "" };
        format!("{} ({}{asks})", named(&viewer.author), role(viewer.role))
    };
    let viewers: Vec<String> = presence.viewers.iter().map(viewer).collect();
    format!("there  {}", viewers.join(", "))
}

fn explorer_line(state: &ExplorerState) -> String {
    let Some(current) = state.current else { return "explorer  without a path".to_owned() };
    let from = state.origin.map_or_else(String::new, |id| format!(" from {id}"));
    format!(
        "explorer  {} at {current}{from}, {} steps, {} accepted",
        pace(state.pace),
        state.steps,
        state.accepted
    )
}

fn chains_line(state: &ChainState) -> String {
    let running = if state.running { "running" } else { "paused" };
    let change = match &state.by {
        Some(author) => format!("; {} {}", named(author), state.change),
        None => String::new(),
    };
    format!("chains  {running}, epoch {}, seed {}{change}", state.epoch, state.seed)
}

fn named(author: &Author) -> String {
    format!("{} #{}", author.name, author.session)
}

fn role(role: Role) -> &'static str {
    match role {
        Role::Driver => "driver",
        Role::Observer => "observer",
    }
}

fn pace(pace: Pace) -> &'static str {
    match pace {
        Pace::Paused => "paused",
        Pace::Playing => "playing",
        Pace::Skipping => "skipping",
    }
}
