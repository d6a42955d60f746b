//! Counts and diagnostics of the chains.

use common::ChainState;
use egui_kittest::kittest::Queryable as _;

use super::image::image_stage;
use super::{Fixture, diagnosed, shows, statistics};
use crate::command::{Command, ImageCommand};
use crate::panel::hover::{self, Pointed};
use crate::panel::{diagnostics, statistics as counts};
use crate::source::status::LinkState;
use crate::synthetic::welcome;

#[test]
fn statistics_show_rates_and_fates() {
    let mut fixture = Fixture::new(counts::StatisticsPanel);
    fixture.status.welcome(welcome());
    fixture.status.statistics(statistics());
    fixture.status.link = LinkState::Connected;
    let mut harness = fixture.harness();
    harness.run();
    for text in [
        "1.23 M",
        "0.2500 ± 0.2 %",
        "bidirectional",
        "lens",
        "2.00 k",
        "75.0 %",
        "12.5 %",
        "74.0 %",
        "4.50 M",
    ] {
        assert!(shows(&harness, text), "`{text}` is missing");
    }
    let paused = ChainState { running: false, ..ChainState::default() };
    harness.state_mut().status.steering.chains = Some(paused);
    harness.run();
    assert!(!shows(&harness, "1.23 M"), "chains that rest make no mutations");
    harness.get_by_label("lens").hover();
    harness.run_steps(30);
    assert!(shows(&harness, "failed: off film"), "the reasons come with the pointer");
}

/// Diagnostics of chains that have found an image.
fn diagnosed_stage() -> Fixture {
    let mut fixture = Fixture::new(diagnostics::DiagnosticsPanel);
    fixture.film = image_stage(false).film;
    fixture.status.welcome(welcome());
    fixture.status.statistics(diagnosed());
    fixture
}

#[test]
fn chains_that_disagree_raise_an_alarm_that_leads_there() {
    let mut harness = diagnosed_stage().harness();
    harness.run();
    for text in [
        "Chains disagree in 0.3 % of the image, R-hat up to 1.37",
        "25.0 k",
        "steps for an independent one",
        "bidirectional",
        "off film",
        "DDD",
    ] {
        assert!(shows(&harness, text), "`{text}` is missing");
    }
    for label in ["Show where", "Paths to the worst tile", "Acceptance", "Explore", "Show"] {
        harness.get_by_label(label).click();
        harness.run();
    }
    let said = harness.state().said.as_slice();
    let [show, Command::Filter(crate::command::FilterCommand::Set(text)), map, explore, show_path] =
        said
    else {
        panic!("five clicks, not {said:?}");
    };
    let layer = |layer| Command::Image(ImageCommand::Show(layer));
    assert_eq!(*show, layer(crate::value::Layer::Disagreement), "the map");
    assert_eq!(*map, layer(crate::value::Layer::Acceptance), "another one");
    let [u0, v0, ..] = crate::settings::region::region_of(text).expect("a rectangle");
    assert!((u0 - 2.0 / 40.0).abs() < 1e-7 && (v0 - 4.0 / 30.0).abs() < 1e-7, "{text}");
    assert_eq!(explore.to_string(), "explorer seed 0.0.0", "the path where a chain stayed");
    assert_eq!(show_path.to_string(), "path stay 0", "and the same path in the view");
}

#[test]
fn what_is_pointed_at_is_marked_elsewhere() {
    let mut harness = diagnosed_stage().harness();
    harness.run();
    harness.get_by_label("DDD").hover();
    harness.run_steps(40);
    assert_eq!(hover::pointed(&harness.ctx), Some(Pointed::Stay(0)), "a long stay");
    assert!(shows(&harness, "highlighted in the view"), "the tooltip says so");
    harness.get_by_label("lens").hover();
    harness.run_steps(3);
    assert_eq!(hover::pointed(&harness.ctx), Some(Pointed::Strategy(1)), "a strategy");
    harness.get_by_label_contains("Chains disagree").hover();
    harness.run_steps(3);
    assert_eq!(hover::pointed(&harness.ctx), None, "neither");
    let mut counted = Fixture::new(counts::StatisticsPanel);
    counted.status.welcome(welcome());
    counted.status.statistics(statistics());
    let mut harness = counted.harness();
    harness.run();
    harness.get_by_label("lens").hover();
    harness.run_steps(3);
    assert_eq!(hover::pointed(&harness.ctx), Some(Pointed::Strategy(1)), "the same one");
}

#[test]
fn diagnostics_that_are_not_there_yet_say_so() {
    let mut fixture = Fixture::new(diagnostics::DiagnosticsPanel);
    fixture.status.welcome(welcome());
    let mut early = diagnosed();
    early.diagnostics = Some(std::sync::Arc::new(common::Diagnostics::default()));
    fixture.status.statistics(early);
    let mut harness = fixture.harness();
    harness.run();
    for text in ["It is too early to tell", "There are too few steps", "None yet"] {
        assert!(shows(&harness, text), "`{text}` is missing");
    }
    let mut fixture = Fixture::new(diagnostics::DiagnosticsPanel);
    fixture.status.statistics(statistics());
    let mut harness = fixture.harness();
    harness.run();
    assert!(shows(&harness, "a newer one does"), "an older daemon tells no diagnostics");
}
