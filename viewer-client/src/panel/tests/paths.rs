//! One path, and files of paths.

use egui_kittest::kittest::Queryable as _;

use super::{Stage, shows};
use crate::command::{Command, PathCommand, VertexStep};
use crate::panel::{path, playback};
use crate::selection::Selection;
use crate::synthetic::welcome;

#[test]
fn the_path_panel_tells_all_of_a_path() {
    let mut stage = Stage::new(path::PathPanel);
    stage.status.welcome(welcome());
    let batch = crate::synthetic::batch(&[&[[1.0, 2.0, 3.0], [4.0, 6.0, 3.0]]]);
    let mut reader = batch.reader();
    let view = reader.next().expect("a path");
    let (header, vertices) = (view.header, view.vertices.to_vec());
    stage.selection = Some(Selection { header, vertices, vertex: Some(1), place: (2, 3) });
    let mut harness = stage.harness();
    harness.run();
    for text in ["D D D", "2 of 3 here", "bidirectional", "1.0000e0", "4.000 6.000 3.000"] {
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

#[test]
fn a_file_of_paths_is_stepped_and_told() {
    let mut stage = Stage::new(playback::PlaybackPanel);
    let mut file = crate::playback::Playback::new(crate::dump::tests::stage());
    file.apply(crate::command::PlayCommand::To(2));
    stage.playback = Some(file);
    let mut harness = stage.harness();
    harness.run();
    for text in
        ["Step 3 of 4", "rejected, a = 0.2500", "E - e - c", "lens: 0.0 % of 2 accepted, 1 failed"]
    {
        assert!(shows(&harness, text), "`{text}` is missing");
    }
    for button in ["Accepted", "Back", "Play"] {
        harness.get_by_label(button).click();
        harness.run();
    }
    let said: Vec<String> = harness.state().said.iter().map(ToString::to_string).collect();
    assert_eq!(said, ["play accepted", "play by -1", "play toggle"], "three clicks");
}
