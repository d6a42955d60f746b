//! The bars along the window, its menus and its sheets.

use std::time::{Duration, Instant};

use egui_kittest::kittest::Queryable as _;

use super::{Stage, shows};
use crate::command::{CloudCommand, Command, LayoutCommand, Switch, ThemeName};
use crate::panel::{help, hint, menu, status};
use crate::status::LinkState;
use crate::synthetic::welcome;

#[test]
fn the_status_bar_tells_every_state() {
    let state = |link: LinkState| {
        let mut stage = Stage::new(status::StatusBar);
        stage.status.link = link;
        let mut harness = stage.harness();
        harness.run_steps(3);
        harness
    };
    assert!(shows(&state(LinkState::Connecting), "Connecting to 127.0.0.1:50061"), "connecting");
    assert!(shows(&state(LinkState::Connected), "Connected to 127.0.0.1:50061"), "connected");
    let retry_at = Instant::now() + Duration::from_secs(90);
    let mut lost = state(LinkState::Disconnected { reason: "gone".to_owned(), retry_at });
    assert!(shows(&lost, "Disconnected: gone; retrying in"), "lost, with its reason");
    lost.get_by_label("Now").click();
    lost.run_steps(3);
    assert_eq!(lost.state().said, [Command::Reconnect], "connect now");
}

#[test]
fn menus_hold_every_key() {
    let mut stage = Stage::new(menu::Menu::default());
    stage.status.welcome(welcome());
    let mut harness = stage.harness();
    harness.run();
    assert!(shows(&harness, "a room"), "the scene's name");
    harness.get_by_label("Light").click();
    harness.run();
    harness.get_by_label("Paths").click();
    harness.run();
    harness.get_by_label_contains("Forget every path").click();
    harness.run();
    let expected = [
        Command::Layout(LayoutCommand::Theme(ThemeName::Toggle)),
        Command::Cloud(CloudCommand::Clear),
    ];
    assert_eq!(harness.state().said, expected, "a button and a menu");
}

#[test]
fn the_connection_menu_leads_back_and_passes_on() {
    let mut stage = Stage::new(menu::Menu::default());
    stage.recent = vec!["render-box:50061".to_owned(), "127.0.0.1:50061".to_owned()];
    let mut harness = stage.harness();
    harness.run();
    for label in ["The built-in daemon", "render-box:50061", "Copy link to this view", "Screenshot"]
    {
        harness.get_by_label("Connection").click();
        harness.run();
        harness.get_by_label(label).click();
        harness.run();
    }
    let expected = ["connect home", "connect render-box:50061", "share", "screenshot lvis.png"];
    let said: Vec<String> = harness.state().said.iter().map(ToString::to_string).collect();
    assert_eq!(said, expected, "four entries");
}

#[test]
fn the_first_steps_go_when_they_are_known() {
    let mut stage = Stage::new(hint::Hint);
    let mut harness = stage.harness();
    harness.run();
    assert!(!shows(&harness, "Got it"), "not for those who know");
    stage = Stage::new(hint::Hint);
    stage.settings.layout.hint = true;
    stage.model = crate::model::Model::new(crate::synthetic::mesh());
    let mut harness = stage.harness();
    harness.run();
    harness.get_by_label("Got it").click();
    harness.run();
    let expected = [Command::Layout(LayoutCommand::Hint(Switch::Off))];
    assert_eq!(harness.state().said, expected, "one click");
}

#[test]
fn the_help_sheet_lists_every_key() {
    let mut stage = Stage::new(help::Help);
    stage.settings.layout.help = true;
    let mut harness = stage.harness();
    harness.run_steps(4);
    for binding in crate::keys::bindings(crate::keys::KeyPreset::Today) {
        assert!(shows(&harness, binding.help), "`{}` is missing", binding.help);
    }
}
