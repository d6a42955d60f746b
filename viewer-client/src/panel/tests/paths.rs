//! One path, and files of paths.

use std::sync::Arc;
use std::time::{Duration, Instant};

use common::{PathDetail, Rgb, VertexDetail};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;

use super::{Fixture, shows};
use crate::command::{Command, PathCommand};
use crate::panel::hover::{self, Pointed};
use crate::panel::{path, playback};
use crate::source::selection::{Detail, Selection};
use crate::synthetic::welcome;
use crate::value::VertexStep;

/// A path of two edges on the room, with made-up numbers.
pub(super) fn selected(detail: Detail) -> Selection {
    let batch = crate::synthetic::batch(&[&[[1.0, 2.0, 3.0], [4.0, 6.0, 3.0]]]);
    let mut reader = batch.reader();
    let view = reader.next().expect("a path");
    let (header, vertices) = (view.header, view.vertices.to_vec());
    Selection { header, vertices, vertex: None, detail, place: (2, 3) }
}

pub(super) fn numbers() -> PathDetail {
    let vertex = |light_pdf: f64, eye_pdf: f64| VertexDetail {
        color: Rgb::grey(0.5),
        light_pdf,
        light_weight: 2.0,
        eye_pdf,
        eye_weight: 3.0,
        connection: 0.3,
    };
    PathDetail {
        vertices: vec![vertex(0.125, 0.25), vertex(0.0625, 1.0), vertex(0.0, 1.0)],
        geometry: vec![0.015, 1.25e-6],
        reciprocals: vec![0.0, 3.0, 1.0],
    }
}

fn path_panel(detail: Detail) -> Harness<'static, Fixture> {
    let mut fixture = Fixture::new(path::PathPanel::default());
    fixture.status.welcome(welcome());
    fixture.model = crate::source::model::Model::new(crate::synthetic::mesh());
    fixture.selection = Some(selected(detail));
    fixture.harness()
}

#[test]
fn every_vertex_has_throughputs_densities_and_geometry() {
    let mut harness = path_panel(Detail::Known(Arc::new(numbers())));
    harness.run();
    harness.get_by_label("Light").click();
    harness.run();
    // Densities, the geometry terms, and the throughputs 2, 2 * 2 * 0.5 and 3 * 3 * 3 * 0.5 * 0.5.
    for text in ["0.1250", "0.0625", "0.0150", "1.250e-6", "2.000", "6.750"] {
        assert!(shows(&harness, text), "`{text}` is missing");
    }
    harness.get_by_label("D x1").hover();
    harness.run_steps(40);
    for text in ["Vertex x1: diffuse", "p 0.0625 per sr", "G after", "room"] {
        assert!(shows(&harness, text), "`{text}` is missing from the tooltip");
    }
    let pointed = hover::pointed(&harness.ctx);
    assert_eq!(pointed, Some(Pointed::Vertex(1)), "it is marked in the view");
}

#[test]
fn the_ways_to_make_a_path_are_weighed() {
    let mut harness = path_panel(Detail::Known(Arc::new(numbers())));
    harness.run();
    for text in ["| D D D  cannot", "D | D D  75.0 %", "D D | D  25.0 %"] {
        assert!(shows(&harness, text), "`{text}` is missing");
    }
    harness.get_by_label_contains("D D | D").hover();
    harness.run_steps(40);
    assert_eq!(hover::pointed(&harness.ctx), Some(Pointed::Edge(1)), "its edge in the view");
    assert!(shows(&harness, "weight 0.250000"), "the number");
    assert!(shows(&harness, "connected to the lens"), "in words");
}

#[test]
fn numbers_that_are_not_there_are_explained() {
    let why = "the path 0.0.0 is gone: pick a newer one";
    let mut gone = path_panel(Detail::Missing(why.to_owned()));
    gone.run();
    assert!(shows(&gone, why), "why");
    gone.get_by_label("Light").click();
    gone.run();
    assert!(shows(&gone, "position"), "there is nothing else to show");
    let mut asked = path_panel(Detail::Asked(Instant::now()));
    asked.run_steps(3);
    assert!(shows(&asked, "Waiting for the daemon"), "on their way");
    let long_ago = Instant::now().checked_sub(Duration::from_mins(1)).expect("a minute ago");
    let mut silent = path_panel(Detail::Asked(long_ago));
    silent.run();
    assert!(shows(&silent, "does not answer"), "an older daemon");
}

#[test]
fn a_path_as_text_has_all_numbers() {
    let mesh = crate::synthetic::mesh();
    let names = crate::source::selection::Names { frame: None, strategies: &[], mesh: Some(&mesh) };
    let text = selected(Detail::Known(Arc::new(numbers()))).text(&names);
    for part in [
        "class D D D",
        "object room",
        "material wall",
        "x1 from light: pdf 6.250000000e-2",
        "G to x1 1.500000000e-2",
        "split 1 from light: C 3.333333333e-1 weight 0.750000000",
        "split 0 from light: cannot make it",
    ] {
        assert!(text.contains(part), "`{part}` is missing from\n{text}");
    }
    let without = selected(Detail::Unasked).text(&names);
    assert!(without.contains("x1 D") && !without.contains("pdf"), "what is known:\n{without}");
}

#[test]
fn the_path_panel_tells_all_of_a_path() {
    let mut fixture = Fixture::new(path::PathPanel::default());
    fixture.status.welcome(welcome());
    fixture.selection = Some(Selection { vertex: Some(1), ..selected(Detail::Unasked) });
    let mut harness = fixture.harness();
    harness.run();
    for text in ["D D D", "2 of 3 here", "bidirectional", "1.000", "4.000  6.000     3.000"] {
        assert!(shows(&harness, text), "`{text}` is missing");
    }
    assert!(shows(&harness, "5.000000"), "the edge before the vertex");
    harness.get_by_label("D x2").click();
    harness.run();
    harness.get_by_label("Deselect").click();
    harness.run();
    let expected = [PathCommand::Vertex(VertexStep::To(2)), PathCommand::Deselect];
    assert_eq!(harness.state().said, expected.map(Command::Path), "two clicks");
}

/// The panel of the path that a file shows last.
fn of_file(file: crate::source::dump::PlayableDump) -> Harness<'static, Fixture> {
    let mut fixture = Fixture::new(path::PathPanel::default());
    let path = file.paths.last().expect("a path");
    let detail = Detail::Missing("A file of paths does not give them.".to_owned());
    let selection = Selection::new(path.header, path.vertices.clone());
    fixture.selection = Some(Selection { detail, ..selection });
    fixture.playback = Some(crate::source::playback::Playback::new(file));
    fixture.harness()
}

#[test]
fn a_path_of_a_file_claims_what_the_file_tells() {
    let mut silent = of_file(crate::source::dump::tests::stage_with_numbers());
    silent.run();
    assert!(shows(&silent, "Record of line 1"), "where it is");
    for text in ["seed", "chain 0", "a = 1.0000", "0 steps"] {
        assert!(!shows(&silent, text), "`{text}` is made up");
    }
    silent.get_by_label("Explore").click();
    silent.run();
    assert!(silent.state().said.is_empty(), "there is nobody to explore");
    silent.get_by_label("Light").click();
    silent.run();
    for text in ["f/p light", "0.0100", "0.2200", "Throughputs, geometry terms"] {
        assert!(shows(&silent, text), "`{text}` is missing");
    }
    let mut annotated = of_file(crate::source::dump::tests::playable());
    annotated.run();
    for text in ["chain 4, step 3", "a = 0.5000", "0 steps", "Densities, throughputs"] {
        assert!(shows(&annotated, text), "`{text}` is missing");
    }
}

#[test]
fn a_file_of_paths_is_stepped_and_told() {
    let mut fixture = Fixture::new(playback::PlaybackPanel);
    let mut file = crate::source::playback::Playback::new(crate::source::dump::tests::playable());
    file.apply(crate::command::PlayCommand::To(2));
    fixture.playback = Some(file);
    let mut harness = fixture.harness();
    harness.run();
    for text in [
        "Paused, step 3 of 4",
        "rejected, a = 0.2500",
        "E - e - c",
        "lens: 0.0 % of 2 accepted, 1 failed",
    ] {
        assert!(shows(&harness, text), "`{text}` is missing");
    }
    for button in ["Accepted", "Back", "Play"] {
        harness.get_by_label(button).click();
        harness.run();
    }
    let said: Vec<String> = harness.state().said.iter().map(ToString::to_string).collect();
    assert_eq!(said, ["play accepted", "play by -1", "play toggle"], "three clicks");
}
