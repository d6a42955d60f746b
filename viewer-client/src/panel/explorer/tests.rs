use common::{Attendee, Author, ExplorerCommand, FocusOutcome, FocusPath, Notice, Order, PathId};
use common::{Presence, Role, SkipTo};
use egui_kittest::kittest::Queryable as _;

use super::ExplorerPanel;
use crate::command::Command;
use crate::panel::tests::{Stage, shows};
use crate::steering::tests::{step, vertex};

#[test]
fn a_failed_step_says_why_and_buttons_steer() {
    let mut stage = Stage::new(ExplorerPanel::default());
    stage.status.welcome(crate::synthetic::welcome());
    let session = stage.status.welcome.as_ref().map_or(0, |w| w.session);
    let author = Author { session, name: "me".to_owned() };
    let me = |role| Attendee { author: author.clone(), role, ..Attendee::default() };
    let steering = &mut stage.status.steering;
    steering.take(Notice::Presence(Presence { viewers: vec![me(Role::Driver)] }));
    steering.explorer.current = Some(PathId::default());
    let vertices = (0..4).map(vertex).collect();
    steering.focus.take_path(FocusPath { vertices, next: 1, ..FocusPath::default() });
    steering.focus.take_step(step(1, FocusOutcome::Rejected, 4));
    steering.focus.take_step(step(2, FocusOutcome::Failed(0), 4));
    let mut harness = stage.harness();
    harness.run();
    assert!(shows(&harness, "Failed: occluded"), "why it failed");
    assert!(shows(&harness, "You drive"), "who steers");
    harness.get_by_label("To acceptance").click();
    harness.run();
    let wanted = Command::Order(Order::Explorer(ExplorerCommand::Skip(SkipTo::Acceptance)));
    assert!(harness.state().said.contains(&wanted), "{:?}", harness.state().said);
    harness.get_by_label("Back").click();
    harness.run();
    assert!(harness.state().said.contains(&Command::Scrub(Some(1))), "back by one");
}
