//! The explorer: one chain that the user seeds and steps, and what became of each of its steps.

mod film;
mod moment;
mod timeline;

use common::{
    ExplorerCommand, ExplorerState, LeaseRequest, Order, Pace, Role, Seed, SkipTo, StrategyId,
};
use egui::{Button, Color32, ComboBox, DragValue, RichText, TextStyle, Ui};

use super::hover::{self, Pointed};
use super::lines::Lines;
use super::widgets::{dot, empty_state, number, row, setting};
use super::{Panel, Section};
use crate::command::{Command, form};
use crate::keys::Group;
use crate::settings::WindowSettings;
use crate::value::PanelName;
use crate::value::format;
use crate::value::theme;
use crate::world::World;

/// Points that a strategy's dot and the frame of its name take.
const AROUND_NAME: f32 = 36.0;

/// The controls of the explorer.
#[derive(Debug)]
pub(super) struct ExplorerPanel {
    /// Steps a second that were asked for while it rests.
    rate: Option<f32>,
    /// Proposals of a fan.
    fan: u32,
    /// The strategy of fans and skips.
    strategy: u8,
    film: film::ExplorerFilm,
}

impl Default for ExplorerPanel {
    fn default() -> Self {
        Self { rate: None, fan: 32, strategy: 0, film: film::ExplorerFilm::default() }
    }
}

impl Panel for ExplorerPanel {
    fn ui(&mut self, ui: &mut Ui, world: &World<'_>, commands: &mut Vec<Command>) {
        lease(ui, world, commands);
        let drives = world.status.role() == Role::Driver;
        let mut order = |command| commands.push(Command::Order(Order::Explorer(command)));
        ui.add_enabled_ui(drives, |ui| seed(ui, world, &mut order));
        let state = &world.status.steering.explorer;
        if state.current.is_none() {
            empty_state(
                ui,
                "Nothing to explore yet",
                "Select a path in the view and press Enter: the daemon mutates it, and every \
                proposal is shown here.",
            );
            return;
        }
        ui.add_enabled_ui(drives, |ui| {
            self.transport(ui, world, &mut order);
            self.targeted(ui, world, &mut order);
            allowed(ui, world, state, &mut order);
        });
        tally(ui, state, world);
        timeline::show(ui, world, commands);
        if let Some(shown) = hover::moment(ui.ctx(), world) {
            moment::show(ui, world, shown, commands);
        }
        self.film.show(ui, world);
    }
}

impl Section for ExplorerPanel {
    const NAME: PanelName = PanelName::Explorer;
    const TITLE: &'static str = "Explorer";
    const HELP: &'static [&'static str] = &[
        "A chain of your own, which never affects the image: start it from a path and step it to \
        see what each mutation does.",
        "Only the driver can do this; the others watch.",
    ];
    const KEYS: &'static [Group] = &[Group::Explorer];

    fn applies(world: &World<'_>) -> bool {
        world.has_chains()
    }

    fn text(world: &World<'_>) -> String {
        let state = &world.status.steering.explorer;
        let mut lines = Lines::default();
        if let Some(path) = state.current {
            lines.put(format_args!("path\t{path}"));
        }
        lines.put(format_args!("steps\t{}\taccepted\t{}", state.steps, state.accepted));
        if let Some(moment) = world.moment {
            let step = &moment.step;
            let strategy = world.strategy_name(usize::from(step.strategy.0));
            lines.put(format_args!("step\t{}\t{strategy}\t{:?}", step.number, step.outcome));
            lines.put(format_args!("acceptance\t{:.6}", step.acceptance));
        }
        lines.text()
    }
}

/// Who drives, and how to become the driver.
fn lease(ui: &mut Ui, world: &World<'_>, commands: &mut Vec<Command>) {
    let steering = &world.status.steering;
    let mut ask = |ui: &mut Ui, label: &str, tip: &str, request| {
        if ui.button(label).on_hover_text(tip).clicked() {
            commands.push(Command::Order(Order::Lease(request)));
        }
    };
    ui.horizontal_wrapped(|ui| {
        if world.status.role() == Role::Driver {
            ui.label(RichText::new("You drive").color(theme::GOOD));
            ask(ui, "Stop driving", "Let another viewer drive", LeaseRequest::Release);
        } else {
            let text = match steering.presence.driver() {
                Some(driver) => format!("{} drives; you watch", driver.author.name),
                None => "Nobody drives; you watch".to_owned(),
            };
            ui.label(RichText::new(text).weak());
            ask(ui, "Ask to drive", "Only the driver can steer", LeaseRequest::Ask);
        }
    });
    let others: Vec<&str> = world.others().map(|viewer| viewer.author.name.as_str()).collect();
    if !others.is_empty() {
        ui.label(RichText::new(format!("Also here: {}", others.join(", "))).weak());
        setting(ui, world, &WindowSettings::seen(), commands);
    }
    if let Some(Ok(remark) | Err(remark)) = &steering.remark {
        let text = RichText::new(format::sentence(remark)).small().weak();
        ui.label(text).on_hover_text("The daemon's latest message");
    }
}

/// Where the explorer starts.
fn seed(ui: &mut Ui, world: &World<'_>, order: &mut impl FnMut(ExplorerCommand)) {
    ui.horizontal(|ui| {
        let selected = world.selection.map(|selection| selection.header.id);
        let button = Button::new("Explore the selected path");
        let tip = "Start the explorer from the selected path (Enter)";
        let clicked = ui.add_enabled(selected.is_some(), button).on_hover_text(tip).clicked();
        if let Some(id) = selected.filter(|_| clicked) {
            order(ExplorerCommand::Seed(Seed::Path(id)));
        }
        if ui
            .button("Newest")
            .on_hover_text("Start the explorer from the path that arrived last")
            .clicked()
        {
            order(ExplorerCommand::Seed(Seed::Newest));
        }
    });
}

impl ExplorerPanel {
    fn transport(
        &mut self,
        ui: &mut Ui,
        world: &World<'_>,
        order: &mut impl FnMut(ExplorerCommand),
    ) {
        let state = &world.status.steering.explorer;
        ui.horizontal(|ui| {
            if state.pace == Pace::Paused {
                if ui.button("Play").on_hover_text("Take steps continuously (K)").clicked() {
                    order(ExplorerCommand::Play(self.rate.unwrap_or(state.rate)));
                }
            } else if ui.button("Pause").on_hover_text("Pause (K)").clicked() {
                order(ExplorerCommand::Pause);
            }
            if ui.button("Step").on_hover_text("Make one proposal (N)").clicked() {
                order(ExplorerCommand::Step(1));
            }
            let tip = "Step until a proposal is accepted (Shift+N)";
            if ui.button("To acceptance").on_hover_text(tip).clicked() {
                order(ExplorerCommand::Skip(SkipTo::Acceptance));
            }
        });
        if state.pace == Pace::Playing {
            self.rate = None;
        }
        let rate = f64::from(self.rate.unwrap_or(state.rate));
        if let Some(rate) = number(ui, world, "Pace", form("explorer play"), rate) {
            let rate = rate as f32;
            self.rate = Some(rate);
            if state.pace == Pace::Playing {
                order(ExplorerCommand::Play(rate));
            }
        }
    }

    /// What concerns one strategy: a fan of its proposals, and its next step.
    fn targeted(
        &mut self,
        ui: &mut Ui,
        world: &World<'_>,
        order: &mut impl FnMut(ExplorerCommand),
    ) {
        let names = world.names().strategies;
        row(ui, "Of", "The strategy for Fan and Skip to", |ui| {
            let chosen = world.strategy_name(usize::from(self.strategy));
            ComboBox::from_id_salt("of")
                .width(92.0)
                .selected_text(chosen)
                .show_ui(ui, |ui| {
                    for (name, number) in names.iter().zip(0..) {
                        ui.selectable_value(&mut self.strategy, number, name);
                    }
                })
                .response
                .on_hover_text("Strategy for Fan and Skip to");
            let strategy = StrategyId(self.strategy);
            let tip = "Step until this strategy makes a proposal";
            if ui.button("Skip to").on_hover_text(tip).clicked() {
                order(ExplorerCommand::Skip(SkipTo::Strategy(strategy)));
            }
            let tip = "Show this many proposals of the strategy without moving";
            if ui.button("Fan").on_hover_text(tip).clicked() {
                order(ExplorerCommand::Fan { strategy, count: self.fan });
            }
            let counts = form("explorer fan").range().map_or(1.0..=1.0, |r| r.low..=r.high);
            ui.add(DragValue::new(&mut self.fan).range(counts)).on_hover_text("Proposals of a fan");
        });
    }
}

/// Which strategies may act.
fn allowed(
    ui: &mut Ui,
    world: &World<'_>,
    state: &ExplorerState,
    order: &mut impl FnMut(ExplorerCommand),
) {
    ui.horizontal_wrapped(|ui| {
        for (index, name) in world.names().strategies.iter().enumerate().take(64) {
            let strategy = StrategyId(index as u8);
            let is_in = state.allowed.contains(strategy);
            // A dot at the end of a line would stand apart from its name.
            let font = TextStyle::Small.resolve(ui.style());
            let letters = ui.painter().layout_no_wrap(name.clone(), font, Color32::WHITE);
            if ui.available_size_before_wrap().x < letters.size().x + AROUND_NAME {
                ui.end_row();
            }
            dot(ui, theme::strategy_color(index));
            let button = Button::selectable(is_in, RichText::new(name).small());
            let response =
                ui.add(button).on_hover_text("Whether the explorer may use this strategy");
            if response.contains_pointer() {
                hover::point(ui.ctx(), Pointed::Strategy(index));
            }
            if response.clicked() {
                order(ExplorerCommand::Allow(state.allowed.with(strategy, !is_in)));
            }
        }
    });
}

fn tally(ui: &mut Ui, state: &ExplorerState, world: &World<'_>) {
    let share = format::percent(state.accepted as f64, state.steps as f64);
    let missed = match world.status.steering.focus.missed {
        0 => String::new(),
        steps => format!(", {} missed", format::count(steps as f64)),
    };
    let text = format!(
        "{} since the seed, {} accepted ({share}){missed}",
        format::steps(state.steps),
        format::count(state.accepted as f64),
    );
    ui.label(RichText::new(text).weak());
}

#[cfg(test)]
mod tests;
