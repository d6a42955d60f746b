//! A file of paths: which step is shown, what became of it, and how to go on.

use egui::{FontFamily, Label, RichText, Sense, Slider, Ui};

use super::widgets::{dot, number, row};
use super::{Panel, Section};
use crate::command::{Command, PlayCommand, form};
use crate::keys::Group;
use crate::source::dump::{Outcome, PlayableDump, Step};
use crate::source::playback::Playback;
use crate::value::PanelName;
use crate::value::Switch;
use crate::value::format;
use crate::value::theme;
use crate::world::World;

/// Warnings that are shown.
const MOST_WARNINGS: usize = 5;

/// The controls of a file of paths; blank without one.
#[derive(Debug, Default)]
pub(super) struct PlaybackPanel;

impl Panel for PlaybackPanel {
    fn ui(&mut self, ui: &mut Ui, world: &World<'_>, commands: &mut Vec<Command>) {
        let Some(playback) = world.playback else { return };
        transport(ui, playback, commands);
        scrubber(ui, world, playback, commands);
        if let Some(step) = playback.step() {
            describe(ui, playback.dump(), step);
        }
        for warning in playback.dump().warnings.iter().take(MOST_WARNINGS) {
            let text = RichText::new(format::sentence(warning)).color(theme::BUSY).small();
            ui.add(Label::new(text).wrap());
        }
        ui.add_space(6.0);
        tally(ui, playback.dump());
    }
}

impl Section for PlaybackPanel {
    const NAME: PanelName = PanelName::Playback;
    const TITLE: &'static str = "Playback";
    const HELP: &'static [&'static str] =
        &["Plays the file of paths; drag the slider to go to any step."];
    const KEYS: &'static [Group] = &[Group::Explorer];

    fn applies(world: &World<'_>) -> bool {
        world.playback.is_some()
    }

    fn text(world: &World<'_>) -> String {
        world.playback.map_or_else(String::new, |playback| {
            let (step, steps) = playback.place();
            format!("step {step} of {steps}\n")
        })
    }
}

fn transport(ui: &mut Ui, playback: &Playback, commands: &mut Vec<Command>) {
    let (position, count) = playback.place();
    ui.horizontal(|ui| {
        let mut button = |ui: &mut Ui, label: &str, tip: &str, command| {
            if ui.button(label).on_hover_text(tip).clicked() {
                commands.push(Command::Play(command));
            }
        };
        button(ui, "First", "To the first step", PlayCommand::To(0));
        button(ui, "Back", "One step back", PlayCommand::By(-1));
        let (label, tip) =
            if playback.is_playing() { ("Pause", "Pause (K)") } else { ("Play", "Play (K)") };
        button(ui, label, tip, PlayCommand::Run(Switch::Toggle));
        button(ui, "Step", "One step (N)", PlayCommand::By(1));
        button(ui, "Accepted", "Go to the next accepted step (Shift+N)", PlayCommand::Accepted);
    });
    let word = playback.word();
    let text = format!("{word}, step {} of {count}", position + 1);
    ui.label(RichText::new(text).weak());
}

fn scrubber(ui: &mut Ui, world: &World<'_>, playback: &Playback, commands: &mut Vec<Command>) {
    let (position, count) = playback.place();
    let mut there = position;
    ui.spacing_mut().slider_width = (ui.available_width() - 8.0).max(60.0);
    let steps = Slider::new(&mut there, 0..=count.saturating_sub(1)).show_value(false);
    ui.add(steps).on_hover_text("Drag to any step");
    if there != position {
        commands.push(Command::Play(PlayCommand::To(u32::try_from(there).unwrap_or(u32::MAX))));
    }
    let rate = f64::from(playback.rate());
    if let Some(rate) = number(ui, world, "Pace", form("play rate"), rate) {
        commands.push(Command::Play(PlayCommand::Rate(rate as f32)));
    }
}

fn describe(ui: &mut Ui, playable: &PlayableDump, step: &Step) {
    ui.horizontal(|ui| {
        let strategy = playable.strategies.iter().position(|name| *name == step.mutation);
        if let Some(strategy) = strategy {
            dot(ui, theme::strategy_color(strategy));
            ui.label(&step.mutation);
        }
        let (text, color) = match step.outcome {
            Outcome::Seed => ("seed of the chain".to_owned(), theme::ACCENT),
            Outcome::Accepted(a) => (format!("accepted, a = {a:.4}"), theme::GOOD),
            Outcome::Rejected(a) => (format!("rejected, a = {a:.4}"), theme::BUSY),
            Outcome::Failed => ("failed: no proposal".to_owned(), theme::BAD),
            Outcome::Recorded => {
                ("the file does not say how it was made".to_owned(), theme::ACCENT)
            }
        };
        ui.label(RichText::new(text).color(color).strong());
    });
    let text = if step.outcome == Outcome::Recorded {
        format!("Record of line {}", step.line)
    } else {
        format!("Chain {}, step {}, line {}", step.chain, step.number, step.line)
    };
    ui.label(RichText::new(text).weak());
    if let Some([x, y]) = step.pixel {
        row(ui, "Pixel", "Where the proposal lands on the film", |ui| {
            ui.label(RichText::new(format!("{x:.2}  {y:.2}")).monospace())
        });
    }
    if !step.configuration.is_empty() {
        let tip = "E and C: the ends; e: on the light, S: on a surface, c: on the lens; d: cannot \
            be connected";
        row(ui, "Vertices", tip, |ui| {
            let text = RichText::new(&step.configuration).small().family(FontFamily::Monospace);
            ui.add(Label::new(text).wrap().sense(Sense::hover()))
        });
    }
}

/// What became of all steps, mutation by mutation.
fn tally(ui: &mut Ui, playable: &PlayableDump) {
    if !playable.annotated {
        let text = "The file holds only paths, not the chain, step and mutation that made each; \
            one with `#` lines has these, and rejected steps, too.";
        ui.add(Label::new(RichText::new(text).weak().small()).wrap());
        return;
    }
    for (index, name) in playable.strategies.iter().enumerate() {
        let of_name = || playable.steps.iter().filter(|step| step.mutation == *name);
        let count = |is: fn(Outcome) -> bool| of_name().filter(|step| is(step.outcome)).count();
        let accepted = count(|o| matches!(o, Outcome::Accepted(_)));
        let failed = count(|o| o == Outcome::Failed);
        let all = of_name().count();
        ui.horizontal(|ui| {
            dot(ui, theme::strategy_color(index));
            let share = format::percent(accepted as f64, all as f64);
            let text = format!("{name}: {share} of {all} accepted, {failed} failed");
            ui.label(RichText::new(text).small());
        });
    }
}
