//! How paths are drawn, and how many are kept.

use egui::{Button, ProgressBar, RichText, Ui};

use super::lines::Lines;
use super::widgets::{row, setting};
use super::{Panel, Section};
use crate::command::{CloudCommand, CloudSettings, Command};
use crate::keys::Group;
use crate::value::PanelName;
use crate::value::{Switch, format};
use crate::world::World;

/// The settings of the cloud.
#[derive(Debug, Default)]
pub(super) struct Cloud;

impl Panel for Cloud {
    fn ui(&mut self, ui: &mut Ui, world: &World<'_>, commands: &mut Vec<Command>) {
        ui.horizontal(|ui| buttons(ui, world, commands));
        ui.add_space(4.0);
        appearance(ui, world, commands);
        ui.add_space(4.0);
        budget(ui, world, commands);
    }
}

impl Section for Cloud {
    const NAME: PanelName = PanelName::Cloud;
    const TITLE: &'static str = "Paths";
    const HELP: &'static [&'static str] = &[
        "Each line is a light path that the chains have found, from the light to the camera.",
        "The legend in the corner explains the colours. The budget limits the memory for paths; \
        the oldest are dropped first.",
    ];
    const KEYS: &'static [Group] = &[Group::Paths];

    fn text(world: &World<'_>) -> String {
        world.settings.cloud.commands().into_iter().collect::<Lines>().text()
    }
}

fn buttons(ui: &mut Ui, world: &World<'_>, commands: &mut Vec<Command>) {
    let frozen = world.settings.cloud.frozen;
    let label = if frozen { "Go on" } else { "Freeze" };
    let freeze = ui
        .add(Button::new(label).selected(frozen))
        .on_hover_text("Freeze the paths on screen; the chains go on (Space)");
    if freeze.clicked() {
        commands.push(Command::Cloud(CloudCommand::Freeze(Switch::to(!frozen))));
    }
    let clear = ui.button("Clear").on_hover_text("Remove every path from the view (Backspace)");
    if clear.clicked() {
        commands.push(Command::Cloud(CloudCommand::Clear));
    }
}

fn appearance(ui: &mut Ui, world: &World<'_>, commands: &mut Vec<Command>) {
    use CloudSettings as Cloud;
    setting(ui, world, &Cloud::color(), commands);
    if world.settings.cloud.color.has_scale() {
        setting(ui, world, &Cloud::scale(), commands);
    }
    setting(ui, world, &Cloud::marks(), commands);
    setting(ui, world, &Cloud::blend(), commands);
    setting(ui, world, &Cloud::width(), commands);
    setting(ui, world, &Cloud::opacity(), commands);
    setting(ui, world, &Cloud::hidden(), commands);
    setting(ui, world, &Cloud::cue(), commands);
    setting(ui, world, &Cloud::fade(), commands);
    setting(ui, world, &Cloud::dots(), commands);
    setting(ui, world, &Cloud::ends(), commands);
}

/// How many paths wait, are drawn and are kept: the limits, and where they stand.
fn budget(ui: &mut Ui, world: &World<'_>, commands: &mut Vec<Command>) {
    use CloudSettings as Cloud;
    let cloud = &world.settings.cloud;
    let store = world.store;
    ui.label(RichText::new("Budget").strong());
    setting(ui, world, &Cloud::shown(), commands);
    setting(ui, world, &Cloud::budget_mib(), commands);
    row(ui, "", "", |ui| {
        let share = store.byte_len() as f32 / store.budget().max(1) as f32;
        ui.add(ProgressBar::new(share).desired_height(5.0).desired_width(ui.available_width()))
            .on_hover_text("How much of the memory for paths is in use");
    });
    setting(ui, world, &Cloud::threshold(), commands);
    setting(ui, world, &Cloud::limit(), commands);
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

    use super::super::tests::{Fixture, shows};
    use super::*;
    use crate::value::ColorMode;

    #[test]
    fn the_budget_stands_below_the_look() {
        let mut fixture = Fixture::new(Cloud);
        let path: &[[f32; 3]] = &[[0.0; 3], [1.0; 3]];
        fixture.store.append(&crate::synthetic::batch(&[path; 3]));
        fixture.settings.cloud.shown = 2;
        let mut harness = fixture.harness();
        harness.run();
        for text in ["Budget", "Draw", "Keep", "Take in at", "Wait", "2 drawn, 3 kept", "0 waiting"]
        {
            assert!(shows(&harness, text), "`{text}` is missing");
        }
        harness.get_by_role_and_label(egui::accesskit::Role::Slider, "Take in at").hover();
        harness.run_steps(30);
        assert!(shows(&harness, "threshold of 2014"), "what it was called is told");
    }

    #[test]
    fn only_ramps_with_two_scales_offer_them() {
        for mode in ColorMode::ALL {
            let mut fixture = Fixture::new(Cloud);
            fixture.settings.cloud.color = mode;
            let mut harness = fixture.harness();
            harness.run();
            let offered = harness.query_by_label("Scale").is_some();
            assert_eq!(offered, mode.has_scale(), "{mode}");
        }
    }
}
