//! The keys of the Lvis of 2014, for hands that know them.
//!
//! Where a key of today is not among them, it keeps its meaning.

use egui::Key;

use super::Group::{Camera, Explorer, Paths, View};
use super::{Binding, find, handles, moved, plain, play_or_pause, say, seed, shading};
use crate::command::{CloudSettings, Command, Setting};
use crate::world::World;

/// Paths that a key press adds or takes away.
const TEN: f64 = 10.0;

/// The bindings that differ from today's. The camera moves by a fiftieth of the scene.
pub(super) const BINDINGS: &[Binding] = &[
    say(plain(Key::F), Camera, "camera fly toggle", "fly freely, or orbit again"),
    say(plain(Key::ArrowUp), Camera, "camera move 0.02 0 0", "forward"),
    say(plain(Key::ArrowDown), Camera, "camera move -0.02 0 0", "back"),
    say(plain(Key::ArrowLeft), Camera, "camera move 0 -0.02 0", "to the left"),
    say(plain(Key::ArrowRight), Camera, "camera move 0 0.02 0", "to the right"),
    say(plain(Key::W), Camera, "camera move 0 0 0.02", "up"),
    say(plain(Key::S), Camera, "camera move 0 0 -0.02", "down"),
    find(plain(Key::Enter), Explorer, seed, "make the selected path the active path"),
    say(plain(Key::Backspace), Paths, "cloud clear", "clear all paths"),
    say(plain(Key::Home), Paths, "filter delete-all", "delete all selectors"),
    find(plain(Key::A), Paths, handles, "handles of selectors move or scale"),
    find(
        plain(Key::F1),
        Paths,
        |w| less(w, &CloudSettings::limit()),
        "10 fewer paths may wait (limit)",
    ),
    find(
        plain(Key::F2),
        Paths,
        |w| more(w, &CloudSettings::limit()),
        "10 more paths may wait (limit)",
    ),
    find(
        plain(Key::F3),
        Paths,
        |w| less(w, &CloudSettings::shown()),
        "draw 10 fewer paths (draw limit)",
    ),
    find(
        plain(Key::F4),
        Paths,
        |w| more(w, &CloudSettings::shown()),
        "draw 10 more paths (draw limit)",
    ),
    find(
        plain(Key::F5),
        Paths,
        |w| less(w, &CloudSettings::threshold()),
        "take paths in when 10 fewer wait (threshold)",
    ),
    find(
        plain(Key::F6),
        Paths,
        |w| more(w, &CloudSettings::threshold()),
        "take paths in when 10 more wait (threshold)",
    ),
    say(plain(Key::F8), Explorer, "explorer step 1", "a single step"),
    find(plain(Key::F9), Explorer, play_or_pause, "pause or resume"),
    say(plain(Key::F10), Paths, "cloud freeze toggle", "hold new paths back, or let them in"),
    say(plain(Key::F11), Paths, "filter enable toggle", "apply the filter, or show all paths"),
    find(plain(Key::F12), View, shading, "next shading"),
];

fn less(world: &World<'_>, setting: &Setting<CloudSettings, u32>) -> Command {
    moved(world, setting, |paths| paths - TEN)
}

fn more(world: &World<'_>, setting: &Setting<CloudSettings, u32>) -> Command {
    moved(world, setting, |paths| paths + TEN)
}

/// The mouse, and the keys that need it.
pub(super) const MOUSE: &[(&str, &str)] = &[
    ("Click", "select a path; again for the next one there"),
    ("Z X C V", "a sphere under the cursor: paths that start, end, pass all, pass any"),
    ("Delete", "remove the chosen selector"),
    ("Left drag", "drag a handle of the chosen selector"),
    ("Right drag", "rotate the camera"),
    ("Shift+drag", "pan the view"),
    ("Wheel", "zoom to the point under the cursor"),
    ("Ctrl+C", "copy the section, or the image pixel, under the cursor"),
];

/// True for keys that are taken though no binding names them: the viewport has them.
pub(super) fn is_taken(key: Key) -> bool {
    matches!(key, Key::Z | Key::X | Key::C | Key::V)
}
