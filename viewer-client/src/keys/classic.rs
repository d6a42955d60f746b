//! The keys of the Lvis of 2014, for hands that know them.
//!
//! Where a key of today is not among them, it keeps its meaning.

use common::ExplorerCommand;
use egui::Key;

use super::{Binding, Group, after, bind, explore, handles, plain, play_or_pause, seed};
use crate::command::{
    CameraCommand, CloudCommand, Command, FilterCommand, SceneCommand, Shading, Switch,
};

/// How far a key press moves the eye, in sizes of the scene.
const STEP: f32 = 0.02;
/// Paths that a key press adds or takes away.
const TEN: u32 = 10;
/// The most paths that a limit may let through.
const MOST: u32 = 10_000_000;

/// The bindings that differ from today's.
pub(super) const BINDINGS: &[Binding] = &[
    bind(plain(Key::F), Group::Camera, "free camera, or round the scene again", |_| {
        Command::Camera(CameraCommand::Fly(Switch::Toggle))
    }),
    bind(plain(Key::ArrowUp), Group::Camera, "forward", |_| step([STEP, 0.0, 0.0])),
    bind(plain(Key::ArrowDown), Group::Camera, "back", |_| step([-STEP, 0.0, 0.0])),
    bind(plain(Key::ArrowLeft), Group::Camera, "to the left", |_| step([0.0, -STEP, 0.0])),
    bind(plain(Key::ArrowRight), Group::Camera, "to the right", |_| step([0.0, STEP, 0.0])),
    bind(plain(Key::W), Group::Camera, "up", |_| step([0.0, 0.0, STEP])),
    bind(plain(Key::S), Group::Camera, "down", |_| step([0.0, 0.0, -STEP])),
    bind(plain(Key::Enter), Group::Explorer, "make the selected path the active path", seed),
    bind(plain(Key::Backspace), Group::Paths, "clear all paths", |_| {
        Command::Cloud(CloudCommand::Clear)
    }),
    bind(plain(Key::Home), Group::Paths, "delete all selectors", |_| {
        Command::Filter(FilterCommand::DeleteAll)
    }),
    bind(plain(Key::A), Group::Paths, "handles of selectors move, or scale", handles),
    bind(plain(Key::F1), Group::Paths, "let 10 paths less wait (limit)", |w| {
        Command::Cloud(CloudCommand::Limit(w.settings.cloud.limit.saturating_sub(TEN).max(TEN)))
    }),
    bind(plain(Key::F2), Group::Paths, "let 10 paths more wait (limit)", |w| {
        Command::Cloud(CloudCommand::Limit((w.settings.cloud.limit + TEN).min(MOST)))
    }),
    bind(plain(Key::F3), Group::Paths, "draw 10 paths less (draw limit)", |w| {
        Command::Cloud(CloudCommand::Shown(w.settings.cloud.shown.saturating_sub(TEN)))
    }),
    bind(plain(Key::F4), Group::Paths, "draw 10 paths more (draw limit)", |w| {
        Command::Cloud(CloudCommand::Shown((w.settings.cloud.shown + TEN).min(MOST)))
    }),
    bind(plain(Key::F5), Group::Paths, "filter when 10 paths less wait (threshold)", |w| {
        Command::Cloud(CloudCommand::Threshold(w.settings.cloud.threshold.saturating_sub(TEN)))
    }),
    bind(plain(Key::F6), Group::Paths, "filter when 10 paths more wait (threshold)", |w| {
        Command::Cloud(CloudCommand::Threshold((w.settings.cloud.threshold + TEN).min(MOST)))
    }),
    bind(plain(Key::F8), Group::Explorer, "a single step", |_| explore(ExplorerCommand::Step(1))),
    bind(plain(Key::F9), Group::Explorer, "pause, or go on", play_or_pause),
    bind(plain(Key::F10), Group::Paths, "let new paths wait, or come", |_| {
        Command::Cloud(CloudCommand::Freeze(Switch::Toggle))
    }),
    bind(plain(Key::F11), Group::Paths, "filter, or show all paths", |_| {
        Command::Filter(FilterCommand::Enable(Switch::Toggle))
    }),
    bind(plain(Key::F12), Group::View, "next shading", |world| {
        let next = after(&Shading::ALL, world.settings.scene.shading);
        Command::Scene(SceneCommand::Shading(next))
    }),
];

fn step(step: [f32; 3]) -> Command {
    Command::Camera(CameraCommand::Move(step))
}

/// The mouse, and the keys that need it.
pub(super) const MOUSE: &[(&str, &str)] = &[
    ("Click", "select a path; again, the next one there"),
    ("Z X C V", "a sphere under the cursor: paths that start, end, pass all, pass any"),
    ("Delete", "remove the chosen selector"),
    ("Left drag", "pull a handle of the chosen selector"),
    ("Right drag", "turn the camera"),
    ("Shift+drag", "shift the view"),
    ("Wheel", "come closer to the point under the cursor"),
    ("Ctrl+C", "copy the section, or the pixel of the image, under the cursor"),
];

/// True for keys that are taken though no binding names them: the viewport has them.
pub(super) fn is_taken(key: Key) -> bool {
    matches!(key, Key::Z | Key::X | Key::C | Key::V)
}

#[cfg(test)]
mod tests {
    use crate::keys::{KeyPreset, bindings};

    #[test]
    fn no_key_has_two_meanings() {
        for preset in KeyPreset::ALL {
            let all = bindings(preset);
            for (i, binding) in all.iter().enumerate() {
                let other = all.iter().skip(i + 1).find(|b| b.shortcut == binding.shortcut);
                assert!(other.is_none(), "{preset}: {} and {other:?}", binding.help);
            }
            assert!(all.len() > 30, "{preset}: {} keys", all.len());
        }
    }
}
