//! How paths are drawn, and how many are kept.

use egui::{Button, ProgressBar, RichText, Ui};

use super::Panel;
use super::widgets::{Scale, choice, row, slider, toggle};
use crate::command::{CloudCommand, ColorMode, ColorScale, Command, Marks, Switch};
use crate::format;
use crate::world::World;

/// The settings of the cloud.
#[derive(Debug)]
pub(super) struct Cloud;

impl Panel for Cloud {
    fn ui(&mut self, ui: &mut Ui, world: &World<'_>, commands: &mut Vec<Command>) {
        let mut push = |command| commands.push(Command::Cloud(command));
        ui.horizontal(|ui| buttons(ui, world, &mut push));
        ui.add_space(4.0);
        look(ui, world, &mut push);
        ui.add_space(4.0);
        amount(ui, world, &mut push);
    }
}

fn buttons(ui: &mut Ui, world: &World<'_>, push: &mut impl FnMut(CloudCommand)) {
    let frozen = world.settings.cloud.frozen;
    let label = if frozen { "Go on" } else { "Freeze" };
    let freeze = ui
        .add(Button::new(label).selected(frozen))
        .on_hover_text("Hold the cloud still; the chains go on (Space)");
    if freeze.clicked() {
        push(CloudCommand::Freeze(Switch::to(!frozen)));
    }
    let clear = ui.button("Clear").on_hover_text("Forget every path (Backspace)");
    if clear.clicked() {
        push(CloudCommand::Clear);
    }
}

fn look(ui: &mut Ui, world: &World<'_>, push: &mut impl FnMut(CloudCommand)) {
    let cloud = &world.settings.cloud;
    let tip = "What the colour of a path says; the legend explains it (C)";
    if let Some(mode) = choice(ui, "Colour", tip, cloud.color, &ColorMode::ALL) {
        push(CloudCommand::Color(mode));
    }
    if cloud.color.has_scale() {
        let tip = "Equal factors or equal differences make equal steps of colour";
        if let Some(scale) = choice(ui, "Scale", tip, cloud.scale, &ColorScale::ALL) {
            push(CloudCommand::Scale(scale));
        }
    }
    let tip = "Whole paths, their vertices alone, or only the vertex on the light and the one seen";
    if let Some(marks) = choice(ui, "Draw", tip, cloud.marks, &Marks::ALL) {
        push(CloudCommand::Marks(marks));
    }
    let tip = "Width of the lines on screen, whatever their distance ( [ and ] )";
    let scale = Scale::logarithmic(0.25..=20.0, 2).suffix(" px");
    if let Some(pixels) = slider(ui, "Width", tip, cloud.width, scale) {
        push(CloudCommand::Width(pixels));
    }
    let tip = "Opacity of the newest, brightest path";
    if let Some(x) = slider(ui, "Opacity", tip, cloud.opacity, Scale::linear(0.0..=1.0, 2)) {
        push(CloudCommand::Opacity(x));
    }
    let tip = "How much is seen of the parts that lie behind surfaces";
    if let Some(x) = slider(ui, "Hidden", tip, cloud.hidden, Scale::linear(0.0..=1.0, 2)) {
        push(CloudCommand::Hidden(x));
    }
    let tip = "How much distance dims paths, so that near ones stand out";
    if let Some(x) = slider(ui, "Depth cue", tip, cloud.cue, Scale::linear(0.0..=1.0, 2)) {
        push(CloudCommand::Cue(x));
    }
    let tip = "After how many newer paths a path has faded";
    let scale = Scale::logarithmic(1.0..=1e6, 0);
    if let Some(paths) = slider(ui, "Fade after", tip, cloud.fade, scale) {
        push(CloudCommand::Fade(paths));
    }
    let tip = "Radius of the dots at inner vertices; 0 for none";
    let scale = Scale::linear(0.0..=8.0, 1).suffix(" px");
    if let Some(pixels) = slider(ui, "Dots", tip, cloud.dots, scale) {
        push(CloudCommand::Dots(pixels));
    }
    let tip = "Amber at the start, on the light; blue at the end, towards the camera (L)";
    if let Some(switch) = toggle(ui, "Tint start and end", tip, cloud.ends) {
        push(CloudCommand::Ends(switch));
    }
}

fn amount(ui: &mut Ui, world: &World<'_>, push: &mut impl FnMut(CloudCommand)) {
    let cloud = &world.settings.cloud;
    let tip = "How many of the newest paths are drawn";
    let scale = Scale::logarithmic(1.0..=1e6, 0);
    if let Some(paths) = slider(ui, "Shown", tip, cloud.shown as f32, scale) {
        push(CloudCommand::Shown(paths.round() as u32));
    }
    let tip = "Memory for paths; when it is full, the oldest go";
    let scale = Scale::logarithmic(8.0..=8192.0, 0).suffix(" MiB");
    if let Some(mebibytes) = slider(ui, "Keep", tip, cloud.budget_mib as f32, scale) {
        push(CloudCommand::Budget(mebibytes.round() as u32));
    }
    let store = world.store;
    row(ui, "", "", |ui| {
        let share = store.byte_len() as f32 / store.budget().max(1) as f32;
        ui.add(ProgressBar::new(share).desired_height(5.0).desired_width(ui.available_width()))
            .on_hover_text("How full the memory for paths is");
    });
    let held = format!(
        "{} paths kept, {}",
        format::count(store.len() as f64),
        format::bytes(store.byte_len() as u64)
    );
    row(ui, "", "", |ui| ui.label(RichText::new(held).small().weak()));
}
