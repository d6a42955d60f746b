//! `viewer-client watch`: what a daemon sends, as lines of text.

mod focus;
mod inspect;

use std::io::{self, Write as _};

use anyhow::{Context as _, bail};
use common::{
    BatchOrigin, FilterCounts, FilterReply, Gap, PathBatch, PathId, Role, Statistics, TracerEvent,
    Welcome,
};
use proto::WantedFilter;
use serde_json::{Value, json};

use crate::app::cli::WatchArgs;
use crate::source::connection::{Greeting, Session, own_name};
use crate::value::format;
use focus::Script;

/// Prints what comes, until `--count` batches with paths (or steps) have come, the orders are carried
/// out, the daemon ends or the reader goes away.
pub fn run(args: &WatchArgs) -> anyhow::Result<()> {
    let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build()?;
    runtime.block_on(watch(args))
}

async fn watch(args: &WatchArgs) -> anyhow::Result<()> {
    let filter = args.filter.clone().map(|filter| WantedFilter { revision: 1, filter });
    let peer = args.trust.peer(args.address.clone())?;
    let role = if args.order.is_empty() { Role::Observer } else { Role::Driver };
    let name = own_name("Lvis watch");
    let greeting = Greeting { name, role, filter, focus: args.focus, ..Greeting::default() };
    let mut session = Session::open(&peer, greeting).await?;
    if let Some(path) = args.inspect {
        return inspect::print(session, path, args.json).await;
    }
    let mut names = Names { focus: args.focus, ..Names::default() };
    let mut script = Script::new(&args.order);
    let mut counted = 0;
    let mut out = io::stdout();
    while args.count.is_none_or(|count| counted < count) && !script.is_over() {
        if let Some(order) = script.next()
            && !session.say(order)
        {
            bail!("the daemon does not accept orders");
        }
        let event = tokio::select! {
            event = session.next() => event?,
            stop = tokio::signal::ctrl_c() => {
                stop.context("cannot wait for Ctrl-C")?;
                break;
            }
        };
        script.hear(&event)?;
        counted += u64::from(match &event {
            TracerEvent::Paths(batch) => !args.focus && !batch.is_empty(),
            TracerEvent::FocusStep(_) => true,
            _ => false,
        });
        let Some(line) = names.line(&event, args.json) else { continue };
        if let Err(error) = writeln!(out, "{line}") {
            // `watch | head` ends the reader; that is no mistake.
            if error.kind() == io::ErrorKind::BrokenPipe {
                break;
            }
            return Err(error).context("cannot write to the standard output");
        }
    }
    session.leave().await;
    Ok(())
}

/// Names announced in the welcome and in the answer to the filter.
#[derive(Debug, Default)]
struct Names {
    strategies: Vec<String>,
    reasons: Vec<String>,
    conditions: Vec<String>,
    /// The explorer is shown instead of paths.
    focus: bool,
}

impl Names {
    /// The line for an event; `None` for what is not worth one.
    fn line(&mut self, event: &TracerEvent, json: bool) -> Option<String> {
        match event {
            TracerEvent::Welcome(welcome) => {
                self.strategies.clone_from(&welcome.strategies);
                self.reasons.clone_from(&welcome.failure_reasons);
                Some(if json { welcome_json(welcome).to_string() } else { welcome_line(welcome) })
            }
            TracerEvent::Paths(_) | TracerEvent::Gap(_) | TracerEvent::Statistics(_)
                if self.focus =>
            {
                None
            }
            // A filter that wants nothing sends batches without paths; the statistics say so.
            TracerEvent::Paths(batch) if batch.is_empty() => None,
            TracerEvent::Paths(batch) => {
                let summary = Summary::of(batch);
                Some(if json {
                    self.batch_json(&summary).to_string()
                } else {
                    self.batch_line(&summary)
                })
            }
            TracerEvent::Gap(gap) => {
                Some(if json { gap_json(*gap).to_string() } else { gap_line(*gap) })
            }
            TracerEvent::Statistics(statistics) => Some(if json {
                self.statistics_json(statistics).to_string()
            } else {
                self.statistics_line(statistics)
            }),
            TracerEvent::FilterReply(reply) => {
                self.conditions.clone_from(&reply.conditions);
                Some(if json { reply_json(reply).to_string() } else { reply_line(reply) })
            }
            TracerEvent::FocusStep(step) => {
                Some(if json { self.step_json(step).to_string() } else { self.step_line(step) })
            }
            TracerEvent::FocusPath(path) => {
                Some(if json { focus::path_json(path).to_string() } else { focus::path_line(path) })
            }
            TracerEvent::FocusGap(steps) => Some(if json {
                json!({ "event": "focus gap", "steps": steps }).to_string()
            } else {
                format!("gap  {steps} steps were dropped")
            }),
            TracerEvent::Notice(_) if !self.focus => None,
            TracerEvent::Notice(notice) if json => Some(focus::notice_json(notice).to_string()),
            TracerEvent::Notice(notice) => focus::notice_line(notice),
            TracerEvent::Film(_)
            | TracerEvent::ExplorerFilm(_)
            | TracerEvent::SnapshotEnd
            | TracerEvent::Goodbye(_)
            | TracerEvent::Unknown => None,
        }
    }

    fn strategy(&self, index: u8) -> &str {
        match self.strategies.get(usize::from(index)) {
            Some(name) => name,
            None if index == u8::MAX => "seed",
            None => "unknown",
        }
    }

    fn batch_line(&self, s: &Summary) -> String {
        let strategies: Vec<String> =
            s.strategies.iter().map(|(i, n)| format!("{} {n}", self.strategy(*i))).collect();
        let last = s.last.map_or_else(String::new, |id| id.to_string());
        format!(
            "batch {:>8}  {:>5} of {:>5} paths  {:>6} new vertices  {:>6} bytes  acceptance {:.3}  {}  last {last}",
            s.sequence,
            s.paths,
            s.origin.seen,
            s.new_vertices,
            s.bytes,
            s.mean_acceptance,
            strategies.join(", ")
        )
    }

    fn batch_json(&self, s: &Summary) -> Value {
        let strategies: serde_json::Map<String, Value> =
            s.strategies.iter().map(|(i, n)| (self.strategy(*i).to_owned(), json!(n))).collect();
        json!({
            "event": "batch",
            "sequence": s.sequence,
            "revision": s.origin.revision,
            "decimation": s.origin.decimation,
            "seen": s.origin.seen,
            "matched": s.origin.matched,
            "seen_steps": s.origin.seen_steps,
            "matched_steps": s.origin.matched_steps,
            "paths": s.paths,
            "new_vertices": s.new_vertices,
            "bytes": s.bytes,
            "mean_acceptance": s.mean_acceptance,
            "last": s.last.map(|id| id.to_string()),
            "strategies": strategies,
        })
    }

    fn statistics_line(&self, s: &Statistics) -> String {
        let strategies: Vec<String> = s
            .strategies
            .iter()
            .enumerate()
            .map(|(i, t)| {
                let accepted = format::percent(t.accepted as f64, t.proposed as f64);
                format!("{} {accepted}", self.strategy(i as u8))
            })
            .collect();
        format!(
            "statistics  {} mutations  {}/s  b {:.5} +- {:.1e}  accepted: {}{}",
            format::count(s.totals.steps as f64),
            format::count(s.mutations_per_second),
            s.normalization,
            s.normalization_error,
            strategies.join(", "),
            self.counts_line(&s.filter)
        )
    }

    /// What the filter saw, on lines of its own; nothing without a filter.
    fn counts_line(&self, counts: &FilterCounts) -> String {
        if counts.revision == 0 {
            return String::new();
        }
        let mut lines = vec![format!(
            "\nfilter  {} of {} paths match, {:.3} % +- {:.3} % of the image's energy",
            counts.matched,
            counts.seen,
            100.0 * counts.energy_share,
            100.0 * counts.energy_error
        )];
        for (condition, &count) in self.conditions.iter().zip(&counts.conditions) {
            let share = format::percent(count as f64, counts.seen as f64);
            lines.push(format!("    {share} meet  {condition}"));
        }
        lines.join("\n")
    }

    fn statistics_json(&self, s: &Statistics) -> Value {
        let strategies: Vec<Value> = s
            .strategies
            .iter()
            .enumerate()
            .map(|(i, t)| {
                json!({
                    "name": self.strategy(i as u8),
                    "proposed": t.proposed,
                    "generated": t.generated,
                    "accepted": t.accepted,
                })
            })
            .collect();
        json!({
            "event": "statistics",
            "steps": s.totals.steps,
            "mutations_per_second": s.mutations_per_second,
            "normalization": s.normalization,
            "normalization_error": s.normalization_error,
            "viewers": s.viewers,
            "memory_bytes": s.memory_bytes,
            "paths_sent": s.paths_sent,
            "paths_dropped": s.paths_dropped,
            "queued_bytes": s.queued_bytes,
            "queues": s.queues,
            "strategies": strategies,
            "filter": {
                "revision": s.filter.revision,
                "seen": s.filter.seen,
                "matched": s.filter.matched,
                "energy_share": s.filter.energy_share,
                "energy_error": s.filter.energy_error,
                "conditions": s.filter.conditions,
            },
        })
    }
}

fn reply_line(reply: &FilterReply) -> String {
    match &reply.error {
        None => format!("filter  {}", reply.text),
        Some(error) => format!("filter refused  {error}"),
    }
}

fn reply_json(reply: &FilterReply) -> Value {
    json!({
        "event": "filter",
        "revision": reply.revision,
        "epoch": reply.epoch,
        "text": reply.text,
        "conditions": reply.conditions,
        "error": reply.error.as_ref().map(ToString::to_string),
    })
}

fn welcome_line(w: &Welcome) -> String {
    format!(
        "welcome  session {}  scene {}  {} x {} pixels  {} chains  paths of up to {} edges",
        w.session, w.scene_name, w.camera.width, w.camera.height, w.chains, w.max_edges
    )
}

fn welcome_json(w: &Welcome) -> Value {
    json!({
        "event": "welcome",
        "session": w.session,
        "scene": w.scene_name,
        "scene_hash": w.scene_hash,
        "width": w.camera.width,
        "height": w.camera.height,
        "chains": w.chains,
        "max_edges": w.max_edges,
        "strategies": w.strategies,
        "failure_reasons": w.failure_reasons,
    })
}

fn gap_line(gap: Gap) -> String {
    format!("gap  {} batches  {} paths  {} bytes dropped", gap.batches, gap.paths, gap.bytes)
}

fn gap_json(gap: Gap) -> Value {
    json!({ "event": "gap", "batches": gap.batches, "paths": gap.paths, "bytes": gap.bytes })
}

/// A batch in figures.
#[derive(Debug, PartialEq)]
struct Summary {
    sequence: u64,
    origin: BatchOrigin,
    paths: usize,
    new_vertices: usize,
    bytes: usize,
    mean_acceptance: f64,
    /// The last path, by which it can be asked for.
    last: Option<PathId>,
    /// Paths a strategy, by index.
    strategies: Vec<(u8, usize)>,
}

impl Summary {
    fn of(batch: &PathBatch) -> Self {
        let columns = batch.paths();
        let acceptance: f64 = columns.acceptance.iter().map(|a| f64::from(*a)).sum();
        let mut counts = [0; 256];
        for strategy in &columns.strategy {
            counts[usize::from(*strategy)] += 1;
        }
        Self {
            sequence: batch.sequence(),
            origin: *batch.origin(),
            paths: batch.len(),
            new_vertices: batch.vertices().kind.len(),
            bytes: batch.byte_len(),
            mean_acceptance: acceptance / batch.len().max(1) as f64,
            last: batch.headers().last().map(|header| header.id),
            strategies: (0..=u8::MAX).zip(counts).filter(|(_, n)| *n > 0).collect(),
        }
    }
}
