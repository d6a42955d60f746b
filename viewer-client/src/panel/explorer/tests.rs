//! The explorer's panel: what every state shows, and what every button says.

use common::{
    Attendee, Author, ExplorerCommand, FilmTile, FocusOutcome, FocusPath, FocusStep, Notice, Order,
    Pace, PathId, Presence, RatioFactors, Role, SkipTo, StrategyId, StrategySet,
};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;

use super::ExplorerPanel;
use crate::command::{Command, PathCommand};
use crate::panel::hover::{self, Pointed};
use crate::panel::tests::{Fixture, shows};
use crate::source::steering::tests::{step, vertex};

/// A driver's panel over an explorer that has a path.
fn driven() -> Fixture {
    let mut fixture = Fixture::new(ExplorerPanel::default());
    fixture.status.welcome(crate::synthetic::welcome());
    let session = fixture.status.welcome.as_ref().map_or(0, |w| w.session);
    let author = Author { session, name: "me".to_owned() };
    let me = Attendee { author, role: Role::Driver, ..Attendee::default() };
    let steering = &mut fixture.status.steering;
    steering.accept(Notice::Presence(Presence { viewers: vec![me] }));
    steering.explorer.current = Some(PathId::default());
    steering.explorer.rate = 2.0;
    let vertices = (0..4).map(vertex).collect();
    steering.focus.set_path(FocusPath { vertices, next: 1, ..FocusPath::default() });
    fixture
}

fn click(harness: &mut Harness<'_, Fixture>, label: &str) {
    harness.get_by_label(label).click();
    harness.run();
}

fn orders(harness: &Harness<'_, Fixture>) -> Vec<ExplorerCommand> {
    let order = |command: &Command| match command {
        Command::Order(Order::Explorer(command)) => Some(*command),
        _ => None,
    };
    harness.state().said.iter().filter_map(order).collect()
}

#[test]
fn every_button_steers() {
    let mut harness = driven().harness();
    harness.run();
    assert!(shows(&harness, "You drive"), "who steers");
    for label in ["Newest", "Play", "Step", "To acceptance", "Skip to", "Fan", "lens"] {
        click(&mut harness, label);
    }
    let wanted = [
        ExplorerCommand::Seed(common::Seed::Newest),
        ExplorerCommand::Play(2.0),
        ExplorerCommand::Step(1),
        ExplorerCommand::Skip(SkipTo::Acceptance),
        ExplorerCommand::Skip(SkipTo::Strategy(StrategyId(0))),
        ExplorerCommand::Fan { strategy: StrategyId(0), count: 32 },
        ExplorerCommand::Allow(StrategySet::ALL.with(StrategyId(1), false)),
    ];
    assert_eq!(orders(&harness), wanted, "seven clicks");
    harness.state_mut().status.steering.explorer.pace = Pace::Playing;
    harness.run();
    click(&mut harness, "Pause");
    assert_eq!(orders(&harness).last(), Some(&ExplorerCommand::Pause));
}

#[test]
fn observers_watch_and_may_ask() {
    let mut fixture = driven();
    fixture.status.steering.presence = Presence::default();
    let mut harness = fixture.harness();
    harness.run();
    click(&mut harness, "Step");
    assert_eq!(orders(&harness), [], "it does not steer");
    assert!(shows(&harness, "Nobody drives; you watch"), "why");
    click(&mut harness, "Ask to drive");
    assert_eq!(harness.state().said.len(), 1, "but may ask");
}

#[test]
fn a_failed_step_says_why() {
    let mut fixture = driven();
    let focus = &mut fixture.status.steering.focus;
    focus.add_step(step(1, FocusOutcome::Rejected, 4));
    focus.add_step(step(2, FocusOutcome::Failed(0), 4));
    let mut harness = fixture.harness();
    harness.run();
    assert!(shows(&harness, "Failed: occluded"), "why it failed");
    click(&mut harness, "Back");
    assert!(harness.state().said.contains(&Command::Scrub(Some(1))), "back by one");
    harness.state_mut().status.steering.focus.scrub = Some(1);
    harness.run();
    assert!(shows(&harness, "Rejected"), "the step before");
    click(&mut harness, "Live");
    assert_eq!(harness.state().said.last(), Some(&Command::Scrub(None)), "and the newest again");
}

#[test]
fn an_acceptance_is_taken_apart() {
    let mut fixture = driven();
    let factors = RatioFactors {
        forward: 4.0,
        backward: 1.0,
        mixture_current: 3.0,
        mixture_proposed: 2.0,
        target_current: 0.5,
        target_proposed: 0.25,
    };
    let told = FocusStep { factors, acceptance: 0.1875, ..step(1, FocusOutcome::Rejected, 4) };
    fixture.status.steering.focus.add_step(told);
    let mut harness = fixture.harness();
    harness.run();
    for text in ["a = 0.1875", "4.0000e0", "1.0000e0", "0.2500", "1.500", "0.5000", "0.1875"] {
        assert!(shows(&harness, text), "`{text}` is missing");
    }
    click(&mut harness, "Inspect x");
    let wanted = Command::Path(PathCommand::Explored);
    assert_eq!(harness.state().said, [wanted], "all its numbers");
    let one_way = FocusStep {
        factors: RatioFactors { mixture_proposed: 0.0, ..factors },
        acceptance: 0.0,
        ..step(2, FocusOutcome::Rejected, 4)
    };
    harness.state_mut().status.steering.focus.add_step(one_way);
    harness.run();
    assert!(shows(&harness, "0: no reverse move"), "in words");
}

#[test]
fn a_step_under_the_cursor_is_shown_without_a_click() {
    let mut fixture = driven();
    let focus = &mut fixture.status.steering.focus;
    focus.add_step(step(1, FocusOutcome::Failed(1), 4));
    focus.add_step(step(2, FocusOutcome::Rejected, 4));
    let mut harness = fixture.harness();
    harness.run();
    let strip = harness.get_by_label("Last steps").rect();
    harness.hover_at(strip.left_center() + egui::vec2(3.0, 0.0));
    harness.run_steps(40);
    assert_eq!(hover::pointed(&harness.ctx), Some(Pointed::Step(1)), "the first");
    assert!(shows(&harness, "Failed: off film"), "the panel shows it");
    assert!(shows(&harness, "No. 1: bidirectional"), "and so does the tooltip");
    assert_eq!(harness.state().said, [], "to look is no command");
    harness.hover_at(strip.left_center() + egui::vec2(8.0, 0.0));
    harness.drag_at(strip.left_center() + egui::vec2(8.0, 0.0));
    harness.run_steps(2);
    assert!(harness.state().said.contains(&Command::Scrub(Some(2))), "a press stays there");
}

#[test]
fn the_exploration_has_a_film_that_nobody_takes_for_the_image() {
    let mut fixture = driven();
    let rgb = [0.1, 0.3, 0.6].repeat(40 * 30);
    let tile = FilmTile { sequence: 1, width: 40, height: 30, first_row: 0, steps: 2400, rgb };
    let mut harness = {
        let mut bare = driven().harness();
        bare.run();
        assert!(!shows(&bare, "This is exploration"), "there is none before the first step");
        assert!(fixture.status.steering.film.accept(&tile), "a sound tile");
        fixture.harness()
    };
    harness.run();
    assert!(
        shows(&harness, "This is exploration, not the image: 2.40 k steps"),
        "it says what it is"
    );
    harness.get_by_label("Film of the exploration");
}
