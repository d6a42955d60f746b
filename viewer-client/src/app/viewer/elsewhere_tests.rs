//! Whoever goes elsewhere finds what someone finds who comes there first.

use std::collections::BTreeSet;
use std::sync::Arc;

use common::{
    ChainState, ExplorerState, FocusPath, Notice, PathHeader, PathId, Presence, Statistics,
    TracerEvent,
};
use egui_kittest::Harness;
use egui_kittest::kittest::NodeT as _;

use super::*;
use crate::imaging::Reference;
use crate::source::dump::tests::playable;
use crate::source::selection::Selection;
use crate::synthetic::{SyntheticSession, delivery};
use crate::value::{PanelName, Part};

const PATH: &[[f32; 3]] = &[[-400.0, 150.0, -400.0], [400.0, 150.0, -400.0]];

/// A kind of thing to look at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Place {
    BuiltIn,
    Remote,
    /// A daemon with another scene.
    OtherScene,
    File,
    Nothing,
}

impl Place {
    const ALL: [Self; 5] =
        [Self::BuiltIn, Self::Remote, Self::OtherScene, Self::File, Self::Nothing];

    fn source(self) -> Source {
        match self {
            Self::BuiltIn => Source::daemon("127.0.0.1:50001".to_owned(), true),
            Self::Remote => Source::daemon("box:50061".to_owned(), false),
            Self::OtherScene => Source::daemon("other:50061".to_owned(), false),
            Self::File => Source::file("paths.txt", playable()),
            Self::Nothing => Source::nothing(),
        }
    }

    /// What comes there.
    fn delivery(self) -> Option<SyntheticSession> {
        match self {
            Self::BuiltIn | Self::Remote => Some(session(delivery(&[PATH, PATH]))),
            Self::OtherScene => Some(session(other_scene())),
            Self::File | Self::Nothing => None,
        }
    }
}

/// A session in which this viewer drives and an explorer walks.
fn session(delivery: SyntheticSession) -> SyntheticSession {
    let header = PathHeader { id: PathId::default(), ..PathHeader::default() };
    let batch = crate::synthetic::batch(&[PATH]);
    let vertices = batch.reader().next().map(|path| path.vertices.to_vec()).unwrap_or_default();
    let statistics = Statistics {
        mutations_per_second: 1e6,
        normalization: 0.01,
        normalization_error: 1e-4,
        ..Statistics::default()
    };
    let more = vec![
        TracerEvent::Notice(Notice::Presence(Presence::default())),
        TracerEvent::Notice(Notice::Explorer(ExplorerState::default())),
        TracerEvent::Notice(Notice::Chains(ChainState { running: true, ..ChainState::default() })),
        TracerEvent::Statistics(Arc::new(statistics)),
        TracerEvent::FocusPath(Arc::new(FocusPath { header, vertices, next: 1 })),
        TracerEvent::ExplorerFilm(delivery.film.clone()),
    ];
    SyntheticSession { more, ..delivery }
}

fn other_scene() -> SyntheticSession {
    let mut delivery = delivery(&[PATH]);
    let SyntheticSession { welcome, scene, .. } = &mut delivery;
    "another".clone_into(&mut welcome.scene_hash);
    "another room".clone_into(&mut welcome.scene_name);
    welcome.strategies = vec!["caustic".to_owned()];
    welcome.max_edges = 7;
    "another".clone_into(&mut scene.hash);
    scene.mesh.positions.iter_mut().flatten().for_each(|x| *x *= 0.5);
    scene.mesh.materials.truncate(1);
    scene.mesh.triangle_materials.fill(0);
    delivery
}

type Window = Harness<'static, Viewer>;

fn open(place: Place) -> Window {
    let viewer = Viewer::new(place.source());
    let mut window = Harness::builder()
        .with_size(egui::vec2(1400.0, 5000.0))
        .build_ui_state(|ui, viewer: &mut Viewer| viewer.ui(ui), viewer);
    arrive(&mut window, place);
    window
}

/// Everything comes, and the window comes to rest.
fn arrive(window: &mut Window, place: Place) {
    let viewer = window.state_mut();
    if let Some(delivery) = place.delivery() {
        delivery.put(viewer.inbox().expect("a daemon"));
    }
    viewer.receive();
    window.run_steps(6);
}

/// Whatever may be left behind: a selected path, a place in a timeline, a reference, counts.
fn leave_traces(window: &mut Window) {
    let viewer = window.state_mut();
    let shown = &mut viewer.source.shown;
    let batch = crate::synthetic::batch(&[PATH]);
    let mut reader = batch.reader();
    let path = reader.next().expect("a path");
    shown.selection = Some(Selection::new(path.header, path.vertices.to_vec()));
    shown.pointed = Some(crate::value::Pointer { at: [0.0; 2], reach: 1.0 });
    shown.image.reference = Some(Reference {
        name: "reference.exr".to_owned(),
        width: 40,
        height: 30,
        pixels: vec![common::Rgb::WHITE; 1200],
    });
    viewer.source.status.steering.focus.scrub = Some(3);
    viewer.source.script.push("camera frame".parse().expect("a command"));
    for command in ["play to 0", "camera orbit 30 10", "camera fly on"] {
        viewer.apply(command.parse().expect(command));
    }
    window.run_steps(2);
}

/// What is shown and may be clicked, what every part says as text, and what commands answer.
fn offered(window: &mut Window) -> Vec<String> {
    let mut found: Vec<String> = Vec::new();
    let mut open = vec![window.root()];
    while let Some(node) = open.pop() {
        let access = node.accesskit_node();
        let (label, value) = (access.label(), access.value());
        if label.is_some() || value.is_some() {
            let role = access.role();
            found.push(format!("{role:?} {label:?} {value:?} disabled: {}", access.is_disabled()));
        }
        open.extend(node.children());
    }
    let viewer = window.state_mut();
    let seen = viewer.source.suited(&viewer.settings);
    let parts = PanelName::ALL.map(Part::Panel).into_iter().chain([Part::Status]);
    found.extend(parts.map(|part| panel::text_of(&viewer.world(&seen), part)));
    let applies = |about: &panel::About| (about.applies)(&viewer.world(&seen));
    let uses: Vec<bool> = panel::SECTIONS.iter().map(applies).collect();
    found.push(format!("{uses:?}"));
    found.push(format!("{:?}", viewer.settings));
    found.push(format!("{seen:?}"));
    found.push(format!("{:?}", viewer.source.shown.camera));
    for command in [
        "chains pause",
        "explorer step 1",
        "play by 1",
        "path explored",
        "path stay 0",
        "share",
        "copy explorer",
        "image save x.bmp",
        "image show flip",
    ] {
        viewer.source.status.notice = None;
        viewer.run_script(vec![command.parse().expect(command)]);
        let said = viewer.source.status.notice.as_ref().map(|notice| &notice.text);
        let waits = viewer.source.script.len();
        found.push(format!("{command}: {said:?}, {waits} wait"));
        viewer.source.script.clear();
    }
    found
}

/// Complains of everything that is not the same.
fn assert_same(found: &[String], expected: &[String], what: &str) {
    let (found, expected): (BTreeSet<_>, BTreeSet<_>) =
        (found.iter().collect(), expected.iter().collect());
    let more: Vec<_> = found.difference(&expected).collect();
    let less: Vec<_> = expected.difference(&found).collect();
    assert!(more.is_empty() && less.is_empty(), "{what}: left over {more:#?}, missing {less:#?}");
}

#[test]
fn nothing_of_what_was_looked_at_before_is_left() {
    for second in Place::ALL {
        let expected = offered(&mut open(second));
        for first in Place::ALL {
            let mut window = open(first);
            leave_traces(&mut window);
            window.state_mut().look_at(second.source());
            arrive(&mut window, second);
            assert_same(&offered(&mut window), &expected, &format!("{first:?}, then {second:?}"));
        }
    }
}

#[test]
fn places_differ_in_what_they_offer() {
    let places = Place::ALL.map(|place| offered(&mut open(place)));
    for (i, a) in places.iter().enumerate() {
        for b in &places[i + 1..] {
            assert_ne!(a, b, "or the test above proves nothing");
        }
    }
}

#[test]
fn a_daemon_that_comes_back_with_another_scene_shows_it() {
    let expected = offered(&mut open(Place::OtherScene));
    let mut window = open(Place::OtherScene);
    let viewer = window.state_mut();
    session(delivery(&[PATH, PATH])).put(viewer.inbox().expect("a daemon"));
    viewer.receive();
    leave_traces(&mut window);
    // A script waits for whatever comes, and a word to the user stays until it has been read.
    let source = &mut window.state_mut().source;
    source.script.clear();
    source.status.notice = None;
    arrive(&mut window, Place::OtherScene);
    // How often it came back is told.
    assert_eq!(window.state().status().reconnects, 2, "twice");
    window.state_mut().source.status.reconnects = 0;
    window.run_steps(2);
    assert_same(&offered(&mut window), &expected, "another scene");
}
