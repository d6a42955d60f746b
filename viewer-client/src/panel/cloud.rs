//! How paths are drawn, and how many are kept.

use egui::{Button, ProgressBar, RichText, Ui};

use super::Panel;
use super::widgets::{Scale, choice, row, slider, toggle};
use crate::command::{Blend, CloudCommand, ColorMode, ColorScale, Command, Marks, Switch};
use crate::value::format;
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
        budget(ui, world, &mut push);
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
    let tip = "Newest: it covers the others. Weighted: each counts by its opacity, near ones more, in \
               whatever order they came. Add: like light, for dark ground (M)";
    if let Some(blend) = choice(ui, "Crossing", tip, cloud.blend, &Blend::ALL) {
        push(CloudCommand::Blend(blend));
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

/// How many paths wait, are drawn and are kept: the limits, and where they stand.
fn budget(ui: &mut Ui, world: &World<'_>, push: &mut impl FnMut(CloudCommand)) {
    let cloud = &world.settings.cloud;
    let store = world.store;
    ui.label(RichText::new("Budget").strong());
    let many = || Scale::logarithmic(1.0..=1e6, 0);
    let tip = "How many of the newest paths are drawn at once (- and =; draw limit of 2014)";
    if let Some(paths) = slider(ui, "Draw", tip, cloud.shown as f32, many()) {
        push(CloudCommand::Shown(paths.round() as u32));
    }
    let tip = "Memory for paths; when it is full, the oldest go";
    let scale = Scale::logarithmic(8.0..=8192.0, 0).suffix(" MiB");
    if let Some(mebibytes) = slider(ui, "Keep", tip, cloud.budget_mib as f32, scale) {
        push(CloudCommand::Budget(mebibytes.round() as u32));
    }
    row(ui, "", "", |ui| {
        let share = store.byte_len() as f32 / store.budget().max(1) as f32;
        ui.add(ProgressBar::new(share).desired_height(5.0).desired_width(ui.available_width()))
            .on_hover_text("How full the memory for paths is");
    });
    let tip = "How many paths must wait before they are taken in and filtered, all at once; \
               0 takes each as it comes (threshold of 2014)";
    let scale = Scale::logarithmic(0.0..=1e6, 0);
    if let Some(paths) = slider(ui, "Take in at", tip, cloud.threshold as f32, scale) {
        push(CloudCommand::Threshold(paths.round() as u32));
    }
    let tip = "How many paths may wait to be taken in; when more do, the oldest go, and the status \
               bar counts them as lost (limit of 2014)";
    let scale = Scale::logarithmic(10.0..=1e6, 0);
    if let Some(paths) = slider(ui, "Wait", tip, cloud.limit as f32, scale) {
        push(CloudCommand::Limit(paths.round() as u32));
    }
    let count = |paths: usize| format::count(paths as f64);
    let drawn = (cloud.shown as usize).min(store.len());
    let standing = format!(
        "{} drawn, {} kept in {}, {} waiting",
        count(drawn),
        count(store.len()),
        format::bytes(store.byte_len() as u64),
        count(world.waiting)
    );
    ui.label(RichText::new(standing).small().weak());
}

#[cfg(test)]
mod tests {
    use egui_kittest::kittest::Queryable as _;

    use super::super::tests::{Stage, shows};
    use super::*;

    #[test]
    fn the_budget_stands_below_the_look() {
        let mut stage = Stage::new(Cloud);
        let path: &[[f32; 3]] = &[[0.0; 3], [1.0; 3]];
        stage.store.append(&crate::synthetic::batch(&[path; 3]));
        stage.settings.cloud.shown = 2;
        let mut harness = stage.harness();
        harness.run();
        for text in ["Budget", "Draw", "Keep", "Take in at", "Wait", "2 drawn, 3 kept", "0 waiting"]
        {
            assert!(shows(&harness, text), "`{text}` is missing");
        }
        harness.get_by_label("Take in at").hover();
        harness.run_steps(30);
        assert!(shows(&harness, "threshold of 2014"), "what it was called is told");
    }

    #[test]
    fn only_ramps_with_two_scales_offer_them() {
        for mode in ColorMode::ALL {
            let mut stage = Stage::new(Cloud);
            stage.settings.cloud.color = mode;
            let mut harness = stage.harness();
            harness.run();
            let offered = harness.query_by_label("Scale").is_some();
            assert_eq!(offered, mode.has_scale(), "{mode}");
        }
    }
}
