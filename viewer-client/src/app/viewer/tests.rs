//! What comes is kept, filtered, selected and played.

use std::sync::Arc;

use common::{DetailReply, FilterReply, Notice, PathDetail, PathId, TracerEvent, VertexDetail};

use super::*;
use crate::source::dump::PlayableDump;
use crate::source::dump::tests::{STEPS, playable};
use crate::source::playback::Playback;
use crate::source::selection::{Detail, Selection};
use crate::synthetic::{SyntheticSession, delivery};

/// A viewer of a daemon that nobody has connected to yet.
fn daemon() -> Viewer {
    Viewer::new(Source::daemon("127.0.0.1:50061".to_owned(), false))
}

/// Takes in what has come.
fn take_in(viewer: &mut Viewer, delivery: SyntheticSession) {
    delivery.put(viewer.inbox().expect("a daemon"));
    viewer.receive();
}

/// Takes in what the tracer says.
fn hear(viewer: &mut Viewer, event: TracerEvent) {
    viewer.inbox().expect("a daemon").put(event);
    viewer.receive();
}

/// A viewer of a file of paths.
fn file(playable: PlayableDump) -> Viewer {
    Viewer::new(Source::file("paths.txt", playable))
}

#[test]
fn what_was_left_out_and_cannot_be_done_is_said() {
    let warnings = ["the last record has no end", "two more"].map(str::to_owned).into();
    let mut viewer = file(PlayableDump { warnings, ..playable() });
    let said = |viewer: &Viewer| viewer.status().notice.clone().map(|notice| notice.text);
    let expected = "In paths.txt, the last record has no end (1 more in the Playback panel)";
    assert_eq!(said(&viewer).as_deref(), Some(expected), "in the window");
    viewer.apply("chains pause".parse().expect("a command"));
    assert!(said(&viewer).is_some_and(|text| text.contains("--scene")), "what to do");
    let mut viewer = daemon();
    viewer.apply("chains pause".parse().expect("a command"));
    assert_eq!(said(&viewer), None, "a daemon may be asked");
    viewer.apply("play to 0".parse().expect("a command"));
    assert!(
        said(&viewer).is_some_and(|text| text.contains("viewer-client FILE")),
        "but plays none"
    );
}

#[test]
fn all_of_a_file_is_in_the_picture() {
    let playable = playable();
    let lens = glam::Vec3::from(playable.paths[0].vertices[2].position);
    let viewer = file(playable);
    let bounds = viewer.bounds().expect("a scene");
    let is_within = lens.cmpge(bounds.min).all() && lens.cmple(bounds.max).all();
    assert!(is_within, "the lens at {lens} lies outside of {bounds:?}");
}

#[test]
fn a_file_is_shown_played_and_picked() {
    let mut viewer = file(playable());
    let mut run = |command: &str| {
        viewer.apply(command.parse().expect("a command"));
        (viewer.source.shown.store.len(), viewer.source.playback().map(Playback::place))
    };
    assert_eq!(run("play rate 5"), (2, Some((STEPS - 1, STEPS))), "all of it");
    assert_eq!(run("play to 0"), (1, Some((0, STEPS))), "the seed");
    assert_eq!(run("play by 2"), (1, Some((2, STEPS))), "rejected: the same path");
    assert_eq!(run("play accepted"), (2, Some((3, STEPS))), "one more");
    assert!(viewer.source.shown.model.is_some(), "the places that paths touch");
    let shown = viewer.source.status.steering.focus.current().map(|path| path.header.id.step);
    assert_eq!(shown, Some(3), "the current path is drawn");
}

#[test]
fn paths_of_the_filter_before_are_left_out() {
    let path: &[[f32; 3]] = &[[1.0, 2.0, 3.0], [4.0, 6.0, 3.0]];
    let mut viewer = daemon();
    take_in(&mut viewer, delivery(&[path, path]));
    assert_eq!(viewer.source.shown.store.len(), 2, "all paths");
    let refused = FilterReply {
        revision: 1,
        error: Some(common::FilterError { span: 0..1, message: "odd".to_owned() }),
        ..FilterReply::default()
    };
    hear(&mut viewer, TracerEvent::FilterReply(refused));
    assert_eq!(viewer.source.shown.store.len(), 2, "a refused filter changes nothing");
    assert!(viewer.source.status.notice.as_ref().is_some_and(|n| n.is_bad), "but is told");
    let reply = FilterReply { revision: 2, ..FilterReply::default() };
    hear(&mut viewer, TracerEvent::FilterReply(reply));
    assert_eq!(viewer.source.shown.store.len(), 0, "others are on their way");
    hear(&mut viewer, of_filter(1, path));
    assert_eq!(viewer.source.shown.store.len(), 0, "these were chosen before");
    hear(&mut viewer, of_filter(2, path));
    assert_eq!(viewer.source.shown.store.len(), 1, "those of the filter in force are kept");
}

#[test]
fn what_is_held_is_judged_by_the_filter() {
    let mut viewer = daemon();
    take_in(
        &mut viewer,
        delivery(&[&[[-400.0, 0.0, 0.0], [0.0, 0.0, 0.0]], &[[0.0, 300.0, 0.0], [50.0, 0.0, 0.0]]]),
    );
    let mut run = |command: &str| {
        viewer.apply(command.parse().expect("a command"));
        viewer.source.judge(&viewer.settings);
        (viewer.source.shown.store.matched(), viewer.source.shown.store.len())
    };
    assert_eq!(run("filter set any in sphere(0, 0, 0, 60)"), (2, 2), "both touch it");
    assert_eq!(run("filter set any in sphere(0, 0, 0, 40)"), (1, 2), "the other is dimmed");
    assert_eq!(run("filter invert on"), (1, 2), "the other one");
    assert_eq!(run("filter set any on material \"wall\""), (0, 2), "names are known");
    assert_eq!(run("filter clear"), (2, 2), "all match again");
    assert_eq!(run("filter set any on object \"room\""), (2, 2), "objects, too");
    assert_eq!(run("filter set any on object \"box\""), (2, 2), "what is not there is left out");
    assert!(viewer.source.status.notice.as_ref().is_some_and(|n| n.is_bad), "and this is told");
}

#[test]
fn a_file_of_paths_is_filtered_and_counted() {
    let mut viewer = file(playable());
    let mut run = |command: &str| {
        viewer.apply(command.parse().expect("a command"));
        viewer.source.shown.counted.as_ref().map(|c| (c.matched, c.seen, c.energy_share))
    };
    // The first path was the current one for three steps, the second for one.
    assert_eq!(run("filter set acceptance < 1"), Some((1, 2, 0.25)), "the second");
    assert_eq!(run("filter set lpe \"LSE\""), Some((2, 2, 1.0)), "both");
    assert_eq!(run("play to 0"), Some((1, 1, 1.0)), "only what was shown so far");
}

#[test]
fn numbers_are_kept_with_the_path_that_they_are_about() {
    let mut viewer = daemon();
    take_in(&mut viewer, delivery(&[&[[-400.0, 0.0, 0.0], [400.0, 0.0, 0.0]]]));
    let batch = crate::synthetic::batch(&[&[[-400.0, 0.0, 0.0], [400.0, 0.0, 0.0]]]);
    let mut reader = batch.reader();
    let path = reader.next().expect("a path");
    viewer.source.shown.selection = Some(Selection::new(path.header, path.vertices.to_vec()));
    viewer.apply("path vertex 1".parse().expect("a command"));
    let detail = |viewer: &Viewer| viewer.source.shown.selection.as_ref().map(|s| s.detail.clone());
    assert!(
        matches!(detail(&viewer), Some(Detail::Missing(why)) if why.contains("no daemon")),
        "there is nobody to ask"
    );
    let mut told = |path: PathId, found| {
        let reply = Box::new(DetailReply { path, found });
        hear(&mut viewer, TracerEvent::Notice(Notice::Detail(reply)));
        detail(&viewer)
    };
    let numbers = |count| PathDetail {
        vertices: vec![VertexDetail::default(); count],
        geometry: vec![1.0; count - 1],
        reciprocals: vec![1.0; count],
    };
    let other = PathId { step: 99, ..PathId::default() };
    assert!(matches!(told(other, Ok(numbers(3))), Some(Detail::Missing(_))), "for another path");
    let known = told(PathId::default(), Ok(numbers(3)));
    assert_eq!(known, Some(Detail::Known(Arc::new(numbers(3)))), "its own");
    let odd = told(PathId::default(), Ok(numbers(4)));
    assert!(matches!(odd, Some(Detail::Missing(_))), "of other vertices");
    let gone = told(PathId::default(), Err("it is gone".to_owned()));
    assert_eq!(gone, Some(Detail::Missing("it is gone".to_owned())), "why");
    let welcome = viewer.source.status.welcome.as_mut().expect("a daemon");
    welcome.frame.scale = 4.0;
    let reply = DetailReply { path: PathId::default(), found: Ok(numbers(3)) };
    hear(&mut viewer, TracerEvent::Notice(Notice::Detail(Box::new(reply))));
    let numbers = viewer.source.shown.selection.as_ref().and_then(Selection::numbers);
    let geometry = numbers.map(|numbers| numbers.geometry.as_slice());
    assert_eq!(geometry, Some([16.0; 2].as_slice()), "per square unit of the scene file");
}

/// One batch with a path, of the filter of this number.
fn of_filter(revision: u32, path: &[[f32; 3]]) -> TracerEvent {
    let batch = crate::synthetic::batch(&[path]);
    let origin = common::BatchOrigin { revision, ..*batch.origin() };
    TracerEvent::Paths(Arc::new(batch.with_origin(origin).expect("a sound origin")))
}
