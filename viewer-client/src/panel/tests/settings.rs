//! Rows of settings are as their tables have them.

use egui::accesskit::Role as WidgetRole;
use egui_kittest::kittest::NodeT as _;

use super::*;
use crate::command::{CloudSettings, Form, forms};
use crate::panel::{cloud, scene, widgets};
use crate::value::{Choice as _, ClipSide, ColorMode, Range, Switch};

/// The least and the largest number of the slider with this label, if it is shown.
fn slider(harness: &Harness<'_, Fixture>, label: &str) -> Option<[Option<f64>; 2]> {
    let named = harness.query_all_by_label(label);
    let mut sliders = named.filter(|node| node.accesskit_node().role() == WidgetRole::Slider);
    let node = sliders.next()?;
    let node = node.accesskit_node();
    Some([node.min_numeric_value(), node.max_numeric_value()])
}

/// The forms of numbers that a group of commands sets.
fn numbers(group: &'static str) -> impl Iterator<Item = (&'static Form, Range<f64>)> {
    let settings = forms().filter(|form| form.is_setting());
    let of_group = settings.filter(move |form| form.words.split(' ').next() == Some(group));
    of_group.filter_map(|form| Some((form, form.range()?)))
}

#[test]
fn a_slider_ends_where_the_parser_does() {
    let mut count = 0;
    for (group, mut fixture) in
        [("cloud", Fixture::new(cloud::Cloud)), ("scene", Fixture::new(scene::Scene))]
    {
        fixture.settings.cloud.color = ColorMode::Length;
        fixture.settings.scene.clip = ClipSide::X;
        let mut harness = fixture.harness();
        harness.run();
        for (form, range) in numbers(group) {
            let Some(limits) = slider(&harness, form.label) else { continue };
            assert_eq!(limits, [Some(range.low), Some(range.high)], "{form:?}");
            count += 1;
        }
    }
    assert!(count >= 11, "{count} sliders");
}

/// Some rows, whatever panel has them.
#[derive(Debug)]
struct Rows;

impl Panel for Rows {
    fn ui(&mut self, ui: &mut Ui, world: &World<'_>, commands: &mut Vec<Command>) {
        widgets::setting(ui, world, &CloudSettings::width(), commands);
        widgets::setting(ui, world, &CloudSettings::blend(), commands);
        widgets::setting(ui, world, &CloudSettings::ends(), commands);
    }
}

/// A script may set more digits than a slider shows; looking at them changes nothing.
#[test]
fn a_slider_leaves_a_value_that_it_rounds_alone() {
    let mut fixture = Fixture::new(Rows);
    fixture.settings.cloud.width = 1.2345;
    let mut harness = fixture.harness();
    harness.run();
    assert_eq!(harness.state().said, [], "nobody touched it");
}

#[test]
fn a_row_explains_itself_with_its_keys() {
    let mut harness = Fixture::new(Rows).harness();
    harness.run();
    harness.get_by_role_and_label(WidgetRole::Slider, "Width").hover();
    harness.run_steps(30);
    assert!(
        shows(&harness, "independent of their distance (0.25 to 20 px)"),
        "what it is, and its range"
    );
    assert!(shows(&harness, "[  ]"), "its keys");
}

#[test]
fn a_row_gives_the_command_of_its_setting() {
    let mut harness = Fixture::new(Rows).harness();
    harness.run();
    harness.get_by_label("Tint start and end").click();
    harness.run();
    let ends = Command::Cloud(crate::command::CloudCommand::Ends(Switch::Off));
    assert_eq!(harness.state_mut().said.split_off(0), [ends], "a checkbox");
    harness.get_by_label("Crossing").click();
    harness.run();
    let add = crate::value::Blend::Add;
    harness.get_by_label(&add.label()).hover();
    harness.run_steps(30);
    assert!(shows(&harness, &add.meaning()), "what a choice means");
    harness.get_by_label(&add.label()).click();
    harness.run();
    let blend = Command::Cloud(crate::command::CloudCommand::Blend(add));
    assert_eq!(harness.state_mut().said.split_off(0), [blend], "a choice");
}
