//! The bar at the foot: connection, rates, losses, memory.

use std::time::Duration;

use common::{Queue, Role, Statistics};
use egui::{Align, Label, Layout, RichText, Sense, Ui};

use super::Panel;
use super::lines::Lines;
use super::widgets::dot;
use crate::command::{Command, DesktopCommand, SessionCommand, WindowCommand};
use crate::source::status::{LinkState, SILENCE, Status};
use crate::value::format;
use crate::value::theme;
use crate::value::{Part, Switch};
use crate::world::World;

/// The state of the connection in one line.
#[derive(Debug)]
pub(super) struct StatusBar;

impl Panel for StatusBar {
    fn ui(&mut self, ui: &mut Ui, world: &World<'_>, commands: &mut Vec<Command>) {
        let bar = ui.horizontal(|ui| {
            connection(ui, world, commands);
            let answers = world.status.silence().is_none();
            if world.status.is_connected() && answers && world.playback.is_none() {
                session(ui, world);
            }
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                let keys =
                    ui.button("F1  Keys").on_hover_text("List all keys and mouse buttons (F1, ?)");
                if keys.clicked() {
                    commands.push(Command::Window(WindowCommand::Help(Switch::Toggle)));
                }
                // What was true when the daemon spoke last.
                ui.add_enabled_ui(answers, |ui| figures(ui, world));
            });
        });
        bar.response.interact(Sense::click()).context_menu(|ui| {
            if ui.button("Copy as text").clicked() {
                commands.push(Command::Desktop(DesktopCommand::Copy(Part::Status)));
                ui.close();
            }
        });
    }
}

fn connection(ui: &mut Ui, world: &World<'_>, commands: &mut Vec<Command>) {
    let status = world.status;
    let place = place(status);
    match &status.link {
        LinkState::Idle => {
            dot(ui, ui.visuals().weak_text_color());
            ui.add(Label::new("Nothing is open").selectable(false));
        }
        LinkState::Connected => {
            let playing = world.playback.is_some();
            if !playing {
                ui.ctx().request_repaint_after(SILENCE);
            }
            let silence = status.silence().filter(|_| !playing);
            dot(ui, if silence.is_some() { theme::BUSY } else { theme::GOOD });
            let text = match (silence, playing) {
                (Some(silence), _) => {
                    ui.ctx().request_repaint_after(Duration::from_secs(1));
                    format!("No answer from {place} for {:.0} s", silence.as_secs_f32())
                }
                (None, true) => format!("File {place}"),
                (None, false) => format!("Connected to {place}"),
            };
            let tip = status.welcome.as_ref().map_or_else(String::new, |w| {
                format!(
                    "Session {}, daemon {}, reconnected {} times",
                    w.session, w.server_version, status.reconnects
                )
            });
            ui.add(Label::new(text).selectable(false)).on_hover_text(tip);
        }
        LinkState::Connecting => {
            dot(ui, theme::BUSY);
            ui.add(Label::new(format!("Connecting to {place} …")).selectable(false));
        }
        LinkState::Disconnected { reason, retry_at } => {
            dot(ui, theme::BAD);
            let seconds = retry_at.saturating_duration_since(world.now).as_secs_f32().ceil();
            let text = format!("Disconnected: {reason}; retrying in {seconds:.0} s");
            ui.add(Label::new(text).selectable(false).truncate());
            if ui.small_button("Now").on_hover_text("Connect now (R)").clicked() {
                commands.push(Command::Session(SessionCommand::Reconnect));
            }
        }
    }
}

/// What the chains are at, and who steers them.
fn session(ui: &mut Ui, world: &World<'_>) {
    let steering = &world.status.steering;
    let dark = ui.visuals().dark_mode;
    if let Some(chains) = &steering.chains {
        ui.add_space(6.0);
        let (text, color) = if chains.running {
            ("Chains running", ui.visuals().weak_text_color())
        } else {
            ("Chains paused", theme::busy(dark))
        };
        let tip = format!("Epoch {}, run {}. {}", chains.epoch, chains.seed, chains.change);
        ui.add(Label::new(RichText::new(text).color(color)).selectable(false)).on_hover_text(tip);
    }
    let driver = steering.presence.driver();
    let own = world.status.welcome.as_ref().map(|welcome| welcome.session);
    let (text, tip) = match driver {
        Some(driver) if Some(driver.author.session) == own => {
            ("You drive".to_owned(), "You can pause and steer; the others watch")
        }
        Some(driver) => {
            (format!("{} drives", driver.author.name), "Use Ask to drive in the Explorer panel")
        }
        None => ("Nobody drives".to_owned(), "Use Ask to drive in the Explorer panel"),
    };
    ui.add_space(6.0);
    ui.add(Label::new(RichText::new(text).weak()).selectable(false)).on_hover_text(tip);
}

/// Where the daemon is, in words.
fn place(status: &Status) -> String {
    if status.embedded { "the built-in daemon".to_owned() } else { status.address.clone() }
}

/// Figures from right to left.
fn figures(ui: &mut Ui, world: &World<'_>) {
    let counts = world.store.counts();
    let statistics = world.status.statistics.as_ref();
    if let Some(statistics) = statistics.filter(|s| s.memory_bytes > 0) {
        let (name, tip) = if world.status.embedded {
            ("program", "Memory used by this program, which is both viewer and daemon")
        } else {
            ("daemon", "Memory used by the daemon")
        };
        figure(ui, name, &format::bytes(statistics.memory_bytes), tip);
    }
    let held = format::bytes(world.store.byte_len() as u64);
    figure(ui, "viewer", &held, "Memory for paths in this viewer, graphics memory included");
    let lost = statistics.map_or(0, |s| s.paths_dropped).max(counts.dropped);
    let tip = format!(
        "Paths that this viewer never received, in {} gaps; {} more were skipped while the view \
        was frozen",
        counts.gaps, counts.skipped
    );
    figure(ui, "dropped", &format::count(lost as f64), &tip);
    if let Some(statistics) = statistics {
        let waiting = format::bytes(statistics.queued_bytes);
        figure(ui, "waiting", &waiting, &waiting_where(statistics));
    }
    let bytes = format::bytes(world.store.byte_rate() as u64);
    let paths = format::count(world.store.path_rate());
    figure(ui, "paths/s", &paths, &format!("Paths received per second, {bytes}/s"));
    if let Some(latency) = world.status.latency.filter(|_| world.status.is_connected()) {
        let milliseconds = 1e3 * latency.as_secs_f32();
        let value = format!("{} ms", format::value(milliseconds));
        figure(ui, "latency", &value, "Round-trip time to the daemon");
    }
    let mutations = format::count(world.status.mutation_rate());
    figure(ui, "mutations/s", &mutations, "Steps per second of all chains");
}

/// Every queue of the daemon, with its bound.
fn waiting_where(statistics: &Statistics) -> String {
    let line = |queue: &Queue| {
        let (bytes, limit) = (format::bytes(queue.bytes), format::bytes(queue.limit));
        let whose = if queue.own { "" } else { ", for all viewers" };
        format!("\n{}: {bytes} of at most {limit}{whose}", queue.name)
    };
    let lines: String = statistics.queues.iter().map(line).collect();
    format!("Data waiting at the daemon for this viewer{lines}")
}

/// A figure, where there is room for it.
fn figure(ui: &mut Ui, name: &str, value: &str, tip: &str) {
    const LETTER: f32 = 7.0;
    let letters = name.chars().count() + value.chars().count();
    if ui.available_width() < LETTER * letters as f32 + 24.0 {
        return;
    }
    ui.add_space(4.0);
    ui.add(Label::new(RichText::new(value).monospace()).selectable(false)).on_hover_text(tip);
    ui.add(Label::new(RichText::new(name).weak()).selectable(false)).on_hover_text(tip);
}

/// The state of the session, as text for the clipboard.
pub(super) fn text(world: &World<'_>) -> String {
    let status = world.status;
    let mut lines = Lines::default();
    lines.put(format_args!("daemon\t{}", status.address));
    match &status.link {
        LinkState::Idle => lines.put(format_args!("state\tidle")),
        LinkState::Connected => lines.put(format_args!("state\tconnected")),
        LinkState::Connecting => lines.put(format_args!("state\tconnecting")),
        LinkState::Disconnected { reason, .. } => {
            lines.put(format_args!("state\tdisconnected: {reason}"));
        }
    }
    if let Some(welcome) = &status.welcome {
        lines.put(format_args!("scene\t{}\t{}", welcome.scene_name, welcome.scene_hash));
        lines.put(format_args!("session\t{}\tdaemon {}", welcome.session, welcome.server_version));
        let role = if status.role() == Role::Driver { "driver" } else { "observer" };
        lines.put(format_args!("role\t{role}"));
    }
    if let Some(latency) = status.latency {
        lines.put(format_args!("latency\t{:.2} ms", 1e3 * latency.as_secs_f64()));
    }
    if let Some(statistics) = &status.statistics {
        lines.put(format_args!("mutations per second\t{:.0}", status.mutation_rate()));
        lines.put(format_args!("paths dropped\t{}", statistics.paths_dropped));
        lines.put(format_args!("daemon's memory\t{}", format::bytes(statistics.memory_bytes)));
    }
    lines.put(format_args!(
        "viewer's memory for paths\t{}",
        format::bytes(world.store.byte_len() as u64)
    ));
    lines.text()
}
