//! The bars along the window, its menus and its sheets.

use std::time::{Duration, Instant};

use egui::accesskit::Role as WidgetRole;
use egui::{Rect, Ui, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;

use super::{Fixture, shows};
use crate::command::{CloudCommand, Command, LayoutCommand, SessionCommand, WindowCommand};
use crate::panel::{self, Panel, Placed, help, hint, menu, status};
use crate::source::status::LinkState;
use crate::synthetic::welcome;
use crate::value::{Switch, ThemeChange, WindowSide};
use crate::world::World;

/// Everything, as in the window.
#[derive(Debug)]
struct Whole(Vec<Placed>);

impl Panel for Whole {
    fn ui(&mut self, ui: &mut Ui, world: &World<'_>, commands: &mut Vec<Command>) {
        panel::show(&mut self.0, ui, world, commands);
    }
}

/// A window of this size in points.
fn window(fixture: Fixture, width: f32, height: f32) -> Harness<'static, Fixture> {
    let mut harness = fixture.harness();
    harness.set_size(vec2(width, height));
    harness.run_steps(4);
    harness
}

fn whole(width: f32) -> Harness<'static, Fixture> {
    window(Fixture::new(Whole(panel::all())), width, 480.0)
}

/// Where the view lies.
fn view(harness: &Harness<'_, Fixture>) -> Rect {
    harness.get_by_role_and_label(WidgetRole::Canvas, "Viewport").rect()
}

#[test]
fn the_view_keeps_room_in_a_small_window() {
    // A window of 1280 pixels at 100, 150 and 200 per cent.
    for width in [1280.0, 853.0, 640.0] {
        let harness = whole(width);
        let view = view(&harness);
        assert!(view.width() >= 230.0, "{width}: the view has {}", view.width());
        let strips = harness.query_all_by_label("«").count();
        assert_eq!(strips, usize::from(width < 800.0), "{width}: a side is folded, if any must be");
    }
    let mut harness = whole(640.0);
    assert!(!shows(&harness, "No image yet"), "the right side is folded");
    harness.get_by_label("«").click();
    harness.run_steps(4);
    assert!(shows(&harness, "No image yet"), "it is opened");
    assert!(harness.query_by_label("»").is_some(), "for the other one");
    assert!(view(&harness).width() >= 230.0, "and the view keeps its room");
    assert_eq!(harness.state().said, [], "what is remembered stays");
}

#[test]
fn the_edge_of_a_side_is_dragged_from_both_sides_of_it() {
    for (name, side, outwards) in [
        ("Edge of the left side", WindowSide::Left, 1.0),
        ("Edge of the right side", WindowSide::Right, -1.0),
    ] {
        for off in [-3.0, 3.0] {
            let mut harness = whole(1280.0);
            let before = harness.state().settings.layout.width(side);
            let edge = harness.get_by_role_and_label(WidgetRole::Splitter, name).rect();
            let from = edge.center() + vec2(off, 0.0);
            let to = from + vec2(40.0 * outwards, 0.0);
            harness.hover_at(from);
            harness.run_steps(1);
            harness.drag_at(from);
            harness.run_steps(1);
            harness.hover_at(to);
            harness.run_steps(3);
            harness.drop_at(to);
            harness.run_steps(2);
            let expected = LayoutCommand::Width(side, before + 40);
            let said = &harness.state().said;
            assert_eq!(*said, [Command::Layout(expected)], "{name}, from {off}");
        }
    }
}

#[test]
fn menus_and_the_sheet_fit_a_low_window() {
    let height = 360.0;
    let mut harness = window(Fixture::new(menu::Menu::default()), 640.0, height);
    harness.get_by_label("View").click();
    harness.run_steps(4);
    let bar = harness.get_by_label("View").rect();
    let line = harness.get_by_label("Filter").rect();
    assert!(line.top() >= bar.bottom(), "the bar is not covered");
    assert!(harness.query_by_label_contains("Quit").is_some(), "the last line is there");
    let mut fixture = Fixture::new(help::Help);
    fixture.settings.window.help = true;
    let mut harness = window(fixture, 640.0, height);
    for label in ["Keys and mouse", "Close"] {
        let rect = harness.get_by_label(label).rect();
        assert!(rect.top() >= 0.0 && rect.bottom() <= height, "{label} is visible: {rect:?}");
    }
    let words = harness.get_by_label("look through the render camera").rect();
    assert!(words.height() < 45.0, "no column of single words: {words:?}");
    let heading = harness.get_by_label("Keys and mouse").rect();
    let list = harness.get_by_label("Mouse").rect();
    assert!(list.top() >= heading.bottom(), "the lists begin below the heading");
    harness.get_by_label("Close").click();
    harness.run_steps(3);
    let expected = [Command::Window(WindowCommand::Help(Switch::Off))];
    assert_eq!(harness.state().said, expected, "closed");
}

#[test]
fn the_status_bar_tells_every_state() {
    let state = |link: LinkState| {
        let mut fixture = Fixture::new(status::StatusBar);
        fixture.status.link = link;
        let mut harness = fixture.harness();
        harness.run_steps(3);
        harness
    };
    assert!(shows(&state(LinkState::Connecting), "Connecting to 127.0.0.1:50061"), "connecting");
    assert!(shows(&state(LinkState::Connected), "Connected to 127.0.0.1:50061"), "connected");
    let mut silent = Fixture::new(status::StatusBar);
    silent.status.link = LinkState::Connected;
    silent.status.statistics(common::Statistics::default());
    let start = Instant::now();
    for (heard, seconds, is_told) in [(true, 0, false), (false, 2, false), (false, 7, true)] {
        silent.status.listen(heard, start + Duration::from_secs(seconds));
        assert_eq!(silent.status.silence().is_some(), is_told, "after {seconds} s");
    }
    let mut silent = silent.harness();
    silent.run_steps(3);
    assert!(shows(&silent, "No answer from 127.0.0.1:50061 for 7 s"), "it does not answer");
    let retry_at = Instant::now() + Duration::from_secs(90);
    let mut lost = state(LinkState::Disconnected { reason: "gone".to_owned(), retry_at });
    assert!(shows(&lost, "Disconnected: gone; retrying in"), "lost, with its reason");
    lost.get_by_label("Now").click();
    lost.run_steps(3);
    assert_eq!(lost.state().said, [Command::Session(SessionCommand::Reconnect)], "connect now");
}

#[test]
fn menus_hold_every_key() {
    let mut fixture = Fixture::new(menu::Menu::default());
    fixture.status.welcome(welcome());
    let mut harness = fixture.harness();
    harness.run();
    assert!(shows(&harness, "a room"), "the scene's name");
    harness.get_by_label("Light").click();
    harness.run();
    harness.get_by_label("Paths").click();
    harness.run();
    harness.get_by_label_contains("Remove every path from the view").click();
    harness.run();
    let expected = [
        Command::Window(WindowCommand::Theme(ThemeChange::Toggle)),
        Command::Cloud(CloudCommand::Clear),
    ];
    assert_eq!(harness.state().said, expected, "a button and a menu");
}

#[test]
fn the_connection_menu_leads_back_and_passes_on() {
    let mut fixture = Fixture::new(menu::Menu::default());
    fixture.recent = vec!["render-box:50061".to_owned(), "127.0.0.1:50061".to_owned()];
    let mut harness = fixture.harness();
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
    let mut fixture = Fixture::new(hint::Hint);
    let mut harness = fixture.harness();
    harness.run();
    assert!(!shows(&harness, "Got it"), "not for those who know");
    fixture = Fixture::new(hint::Hint);
    fixture.settings.window.hint = true;
    fixture.model = crate::source::model::Model::new(crate::synthetic::mesh());
    let mut harness = fixture.harness();
    harness.run();
    harness.get_by_label("Got it").click();
    harness.run();
    let expected = [Command::Window(WindowCommand::Hint(Switch::Off))];
    assert_eq!(harness.state().said, expected, "one click");
}

#[test]
fn the_help_sheet_lists_every_key() {
    let mut fixture = Fixture::new(help::Help);
    fixture.settings.window.help = true;
    let mut harness = fixture.harness();
    harness.run_steps(4);
    for binding in crate::keys::bindings(crate::value::KeyPreset::Today) {
        assert!(shows(&harness, binding.help), "`{}` is missing", binding.help);
    }
}
