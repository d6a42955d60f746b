//! Which key does what. The table is the help sheet, too.

mod classic;

use std::fmt;

use common::{ExplorerCommand, MIN_RATE, Order, Pace, Seed, SelectorKind, SkipTo};
use egui::{Key, KeyboardShortcut, Modifiers};

use crate::command::{
    Blend, CameraCommand, CloudCommand, ColorMode, Command, DeskCommand, Handles, ImageCommand,
    LayoutCommand, PanelName, PathCommand, PlayCommand, SceneCommand, Shading, Side, Switch,
    ThemeName, VertexStep,
};
use crate::settings::SCALES;
use crate::world::World;

/// A key and its command.
#[derive(Clone, Copy, Debug)]
pub struct Binding {
    /// The key with its modifiers.
    pub shortcut: KeyboardShortcut,
    /// What it is for.
    pub group: Group,
    /// What it does, for the help sheet.
    pub help: &'static str,
    /// What it does in this state of affairs.
    pub command: fn(&World<'_>) -> Command,
}

/// A part of the help sheet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Group {
    /// Moving the eye.
    Camera,
    /// Paths on screen.
    Paths,
    /// The chain that the user steps.
    Explorer,
    /// Surfaces, image and window.
    View,
}

impl Group {
    /// All, in the order of the help sheet.
    pub const ALL: [Self; 4] = [Self::Camera, Self::Paths, Self::Explorer, Self::View];

    /// The heading.
    pub fn title(self) -> &'static str {
        match self {
            Self::Camera => "Camera",
            Self::Paths => "Paths",
            Self::Explorer => "Explorer",
            Self::View => "Scene, image, window",
        }
    }
}

/// Which keys there are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum KeyPreset {
    /// Those of today's programs.
    #[default]
    Today,
    /// Those of the Lvis of 2014.
    Classic,
}

impl KeyPreset {
    /// All of them.
    pub const ALL: [Self; 2] = [Self::Today, Self::Classic];

    /// Keys that make a spherical selector under the cursor.
    pub fn selectors(self) -> [(Key, SelectorKind); 4] {
        use SelectorKind::{All, Any, End, Start};
        match self {
            Self::Today => [(Key::F2, Start), (Key::F3, End), (Key::F4, Any), (Key::F5, All)],
            Self::Classic => [(Key::Z, Start), (Key::X, End), (Key::V, Any), (Key::C, All)],
        }
    }

    /// The mouse, for the help sheet.
    pub fn mouse(self) -> &'static [(&'static str, &'static str)] {
        match self {
            Self::Today => MOUSE,
            Self::Classic => classic::MOUSE,
        }
    }
}

impl fmt::Display for KeyPreset {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Today => "today",
            Self::Classic => "classic",
        })
    }
}

/// What dragging with the mouse does to the camera.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum MousePreset {
    /// As in Rerun: left turns, right shifts.
    #[default]
    Rerun,
    /// As in Blender: the middle button turns, with Shift it shifts, with Ctrl it comes closer.
    Blender,
    /// As in Maya: all with Alt, left turns, middle shifts, right comes closer.
    Maya,
}

impl MousePreset {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Rerun, Self::Blender, Self::Maya];

    /// What dragging does, for the help sheet.
    pub fn drags(self) -> &'static [(&'static str, &'static str)] {
        match self {
            Self::Rerun => &[
                ("Left, middle drag", "turn round the pivot; look about while flying"),
                ("Right, Shift+drag", "shift the view"),
            ],
            Self::Blender => &[
                ("Middle drag", "turn round the pivot; look about while flying"),
                ("Shift+middle drag", "shift the view"),
                ("Ctrl+middle drag", "come closer"),
            ],
            Self::Maya => &[
                ("Alt+left drag", "turn round the pivot; look about while flying"),
                ("Alt+middle drag", "shift the view"),
                ("Alt+right drag", "come closer"),
            ],
        }
    }
}

impl fmt::Display for MousePreset {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Rerun => "rerun",
            Self::Blender => "blender",
            Self::Maya => "maya",
        })
    }
}

/// The bindings of a preset, in the order of the help sheet.
pub fn bindings(preset: KeyPreset) -> Vec<&'static Binding> {
    if preset == KeyPreset::Today {
        return BINDINGS.iter().collect();
    }
    let is_free = |binding: &&Binding| {
        let shortcut = binding.shortcut;
        let plain = shortcut.modifiers == Modifiers::NONE;
        !(plain && classic::is_taken(shortcut.logical_key))
            && classic::BINDINGS.iter().all(|other| other.shortcut != shortcut)
    };
    classic::BINDINGS.iter().chain(BINDINGS.iter().filter(is_free)).collect()
}

/// The mouse today; [`crate::panel`]'s viewport gives it this meaning.
const MOUSE: &[(&str, &str)] = &[
    ("Click", "select a path; again, the next one there"),
    ("F2 F3 F4 F5", "a sphere under the cursor: paths that start, end, pass any, pass all"),
    ("Delete", "remove the chosen sphere"),
    ("Wheel", "come closer to the point under the cursor"),
    ("W A S D, Q E", "while flying: move, down and up; Shift is faster"),
    ("Ctrl+C", "copy the section, or the pixel of the image, under the cursor"),
];

const fn plain(key: Key) -> KeyboardShortcut {
    KeyboardShortcut::new(Modifiers::NONE, key)
}

const fn ctrl(key: Key) -> KeyboardShortcut {
    KeyboardShortcut::new(Modifiers::CTRL, key)
}

const fn shift(key: Key) -> KeyboardShortcut {
    KeyboardShortcut::new(Modifiers::SHIFT, key)
}

const fn bind(
    shortcut: KeyboardShortcut,
    group: Group,
    help: &'static str,
    command: fn(&World<'_>) -> Command,
) -> Binding {
    Binding { shortcut, group, help, command }
}

/// Today's bindings, in the order of the help sheet.
const BINDINGS: &[Binding] = &[
    bind(plain(Key::F), Group::Camera, "fly, or orbit again", |_| {
        Command::Camera(CameraCommand::Fly(Switch::Toggle))
    }),
    bind(plain(Key::Num0), Group::Camera, "look through the render camera", |_| {
        Command::Camera(CameraCommand::Through(Switch::Toggle))
    }),
    bind(plain(Key::Home), Group::Camera, "show the whole scene", |_| {
        Command::Camera(CameraCommand::Frame)
    }),
    bind(plain(Key::Num1), Group::Camera, "from the front", |_| view(Side::Front)),
    bind(plain(Key::Num3), Group::Camera, "from the right", |_| view(Side::Right)),
    bind(plain(Key::Num7), Group::Camera, "from above", |_| view(Side::Top)),
    bind(ctrl(Key::Num1), Group::Camera, "from the back", |_| view(Side::Back)),
    bind(ctrl(Key::Num3), Group::Camera, "from the left", |_| view(Side::Left)),
    bind(ctrl(Key::Num7), Group::Camera, "from below", |_| view(Side::Bottom)),
    bind(plain(Key::Space), Group::Paths, "freeze the cloud, or let it go on", |_| {
        Command::Cloud(CloudCommand::Freeze(Switch::Toggle))
    }),
    bind(plain(Key::Backspace), Group::Paths, "forget every path", |_| {
        Command::Cloud(CloudCommand::Clear)
    }),
    bind(plain(Key::C), Group::Paths, "colour by the next property", |world| {
        let next = after(&ColorMode::ALL, world.settings.cloud.color);
        Command::Cloud(CloudCommand::Color(next))
    }),
    bind(plain(Key::M), Group::Paths, "paths cover, weigh, or add up", |world| {
        let next = after(&Blend::ALL, world.settings.cloud.blend);
        Command::Cloud(CloudCommand::Blend(next))
    }),
    bind(plain(Key::Minus), Group::Paths, "draw half as many paths", |world| {
        Command::Cloud(CloudCommand::Shown((world.settings.cloud.shown / 2).max(1)))
    }),
    bind(plain(Key::Equals), Group::Paths, "draw twice as many paths", |world| {
        let shown = world.settings.cloud.shown.max(1).saturating_mul(2);
        Command::Cloud(CloudCommand::Shown(shown.min(10_000_000)))
    }),
    bind(plain(Key::H), Group::Paths, "handles of selectors move, or scale", handles),
    bind(plain(Key::OpenBracket), Group::Paths, "thinner lines", |w| width(w, 1.0 / 1.25)),
    bind(plain(Key::CloseBracket), Group::Paths, "thicker lines", |w| width(w, 1.25)),
    bind(plain(Key::L), Group::Paths, "tint the light end and the camera end", |_| {
        Command::Cloud(CloudCommand::Ends(Switch::Toggle))
    }),
    bind(plain(Key::V), Group::Paths, "next vertex of the selected path", |_| {
        Command::Path(PathCommand::Vertex(VertexStep::Next))
    }),
    bind(shift(Key::V), Group::Paths, "previous vertex of the selected path", |_| {
        Command::Path(PathCommand::Vertex(VertexStep::Previous))
    }),
    bind(plain(Key::Escape), Group::Paths, "select no path", |_| {
        Command::Path(PathCommand::Deselect)
    }),
    bind(plain(Key::Enter), Group::Explorer, "explore the selected path, or the newest", seed),
    bind(plain(Key::K), Group::Explorer, "play or pause", play_or_pause),
    bind(plain(Key::N), Group::Explorer, "one step", |w| {
        in_file(w, PlayCommand::By(1)).unwrap_or_else(|| explore(ExplorerCommand::Step(1)))
    }),
    bind(shift(Key::N), Group::Explorer, "on to the next acceptance", |w| {
        let skip = explore(ExplorerCommand::Skip(SkipTo::Acceptance));
        in_file(w, PlayCommand::Accepted).unwrap_or(skip)
    }),
    bind(ctrl(Key::Z), Group::View, "undo", |_| Command::Undo),
    bind(ctrl(Key::Y), Group::View, "redo", |_| Command::Redo),
    bind(
        plain(Key::Z),
        Group::View,
        "next shading: shaded, plain, texture, edges, wireframe, off",
        |world| {
            let next = after(&Shading::ALL, world.settings.scene.shading);
            Command::Scene(SceneCommand::Shading(next))
        },
    ),
    bind(plain(Key::X), Group::View, "X-ray: see through surfaces", |world| {
        let solid = world.settings.scene.opacity > 0.99;
        Command::Scene(SceneCommand::Opacity(if solid { 0.3 } else { 1.0 }))
    }),
    bind(plain(Key::B), Group::View, "cut away surfaces seen from behind", |_| {
        Command::Scene(SceneCommand::Cutaway(Switch::Toggle))
    }),
    bind(plain(Key::G), Group::View, "grid", |_| {
        Command::Scene(SceneCommand::Grid(Switch::Toggle))
    }),
    bind(plain(Key::Comma), Group::View, "image half a stop darker", |w| exposure(w, -0.5)),
    bind(plain(Key::Period), Group::View, "image half a stop brighter", |w| exposure(w, 0.5)),
    bind(plain(Key::I), Group::View, "image panel", |_| panel(PanelName::Image)),
    bind(plain(Key::P), Group::View, "statistics panel", |_| panel(PanelName::Statistics)),
    bind(plain(Key::T), Group::View, "dark or light", |_| {
        Command::Layout(LayoutCommand::Theme(ThemeName::Toggle))
    }),
    bind(ctrl(Key::P), Group::View, "find a command by typing", |_| {
        Command::Layout(LayoutCommand::Palette(Switch::Toggle))
    }),
    bind(ctrl(Key::Plus), Group::View, "larger texts and buttons", |w| scale(w, 10)),
    bind(ctrl(Key::Minus), Group::View, "smaller texts and buttons", |w| scale(w, -10)),
    bind(ctrl(Key::L), Group::View, "copy a link to this view", |_| {
        Command::Desk(DeskCommand::Share)
    }),
    bind(plain(Key::R), Group::View, "connect now", |_| Command::Reconnect),
    bind(plain(Key::F1), Group::View, "keys and mouse; also ?", |_| help()),
    bind(ctrl(Key::Q), Group::View, "quit", |_| Command::Quit),
];

/// The command for a file of paths, where one is played.
fn in_file(world: &World<'_>, command: PlayCommand) -> Option<Command> {
    world.playback.map(|_| Command::Play(command))
}

/// Makes the selected path the explorer's, or the newest where none is selected.
fn seed(world: &World<'_>) -> Command {
    let seed = world.selection.map_or(Seed::Newest, |s| Seed::Path(s.header.id));
    explore(ExplorerCommand::Seed(seed))
}

fn handles(world: &World<'_>) -> Command {
    Command::Scene(SceneCommand::Handles(after(&Handles::ALL, world.settings.scene.handles)))
}

fn play_or_pause(world: &World<'_>) -> Command {
    if let Some(command) = in_file(world, PlayCommand::Run(Switch::Toggle)) {
        return command;
    }
    let state = &world.status.steering.explorer;
    let rate = state.rate.max(MIN_RATE);
    let paused = state.pace == Pace::Paused;
    explore(if paused { ExplorerCommand::Play(rate) } else { ExplorerCommand::Pause })
}

fn explore(command: ExplorerCommand) -> Command {
    Command::Order(Order::Explorer(command))
}

/// A key as it is printed on keyboards, with its modifiers.
pub fn key_name(shortcut: KeyboardShortcut) -> String {
    let key = match shortcut.logical_key {
        Key::OpenBracket => "[",
        Key::CloseBracket => "]",
        Key::Minus => "-",
        Key::Equals => "=",
        Key::Comma => ",",
        Key::Period => ".",
        other => other.name(),
    };
    match shortcut.modifiers {
        m if m.ctrl => format!("Ctrl+{key}"),
        m if m.shift => format!("Shift+{key}"),
        _ => key.to_owned(),
    }
}

/// The commands of the keys pressed since the last frame.
pub fn pressed(ctx: &egui::Context, world: &World<'_>, commands: &mut Vec<Command>) {
    // Escape closes a menu or a list, and then means nothing else.
    if ctx.egui_wants_keyboard_input() || egui::Popup::is_any_open(ctx) {
        return;
    }
    let is_over = ctx.memory(|memory| memory.top_modal_layer().is_some());
    if is_over && !world.settings.layout.help {
        return;
    }
    if ctx.input_mut(|input| input.consume_key(Modifiers::NONE, Key::Questionmark)) {
        commands.push(help());
    }
    if is_over {
        // The sheet of keys: what opened it closes it, and nothing behind it hears a key.
        if ctx.input_mut(|input| input.consume_key(Modifiers::NONE, Key::F1)) {
            commands.push(help());
        }
        return;
    }
    let preset = world.settings.layout.keys;
    // Those with modifiers first: without them, a key also fits its plain binding.
    let (plain, modified): (Vec<&Binding>, Vec<&Binding>) =
        bindings(preset).into_iter().partition(|b| b.shortcut.modifiers == Modifiers::NONE);
    for binding in modified.into_iter().chain(plain) {
        if ctx.input_mut(|input| input.consume_shortcut(&binding.shortcut)) {
            commands.push((binding.command)(world));
        }
    }
}

fn help() -> Command {
    Command::Layout(LayoutCommand::Help(Switch::Toggle))
}

fn view(side: Side) -> Command {
    Command::Camera(CameraCommand::View(side))
}

fn panel(name: PanelName) -> Command {
    Command::Layout(LayoutCommand::Panel(name, Switch::Toggle))
}

fn width(world: &World<'_>, factor: f32) -> Command {
    let width = (world.settings.cloud.width * factor).clamp(0.25, 20.0);
    Command::Cloud(CloudCommand::Width(width))
}

/// The interface larger by `percent`.
fn scale(world: &World<'_>, percent: i16) -> Command {
    let scale = world.settings.layout.scale.saturating_add_signed(percent);
    Command::Layout(LayoutCommand::Scale(scale.clamp(*SCALES.start(), *SCALES.end())))
}

fn exposure(world: &World<'_>, stops: f32) -> Command {
    let exposure = (world.settings.image.exposure + stops).clamp(-20.0, 20.0);
    Command::Image(ImageCommand::Exposure(exposure))
}

/// The choice after the present one, round and round.
fn after<T: Copy + PartialEq>(all: &[T], present: T) -> T {
    let next = all.iter().position(|c| *c == present).map_or(0, |i| (i + 1) % all.len());
    all.get(next).copied().unwrap_or(present)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_key_has_two_meanings() {
        for (i, a) in BINDINGS.iter().enumerate() {
            for b in &BINDINGS[i + 1..] {
                assert!(a.shortcut != b.shortcut, "`{}` and `{}` share a key", a.help, b.help);
            }
        }
    }

    #[test]
    fn choices_go_round() {
        assert_eq!(after(&[1, 2, 3], 1), 2, "the next");
        assert_eq!(after(&[1, 2, 3], 3), 1, "round");
    }
}
