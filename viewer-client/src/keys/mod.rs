//! Which key does what. The table is the help sheet, too.

mod classic;

use common::{ExplorerCommand, MIN_RATE, Order, Pace, Seed, SelectorKind, SkipTo};
use egui::{Key, KeyboardShortcut, Modifiers};

use crate::command::{
    CloudSettings, Command, Form, ImageCommand, ImageSettings, PlayCommand, SceneCommand,
    SceneSettings, Setting, WindowCommand, WindowSettings,
};
use crate::settings::Group as Settings;
use crate::value::{Choice, KeyPreset, MousePreset, Number, Settable, Switch};
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
    action: Action,
}

/// What a key does.
#[derive(Clone, Copy, Debug)]
enum Action {
    /// Always this command.
    Say(&'static str),
    /// What suits the state of affairs.
    Find(fn(&World<'_>) -> Command),
}

impl Binding {
    /// What it does in this state of affairs.
    pub fn command(&self, world: &World<'_>) -> Command {
        match self.action {
            Action::Find(find) => find(world),
            Action::Say(text) => text.parse().unwrap_or_else(|error| panic!("`{text}`: {error}")),
        }
    }
}

/// The keys that give commands of this form, as they are printed on keyboards.
pub fn keys_of(form: &Form, world: &World<'_>) -> Vec<String> {
    let all = bindings(world.settings.window.keys).into_iter();
    let fitting = all.filter(|binding| form.is_of(&binding.command(world)));
    fitting.map(|binding| key_name(binding.shortcut)).collect()
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

/// Keys that make a spherical selector under the cursor.
pub fn selectors(preset: KeyPreset) -> [(Key, SelectorKind); 4] {
    use SelectorKind::{All, Any, End, Start};
    match preset {
        KeyPreset::Today => [(Key::F2, Start), (Key::F3, End), (Key::F4, Any), (Key::F5, All)],
        KeyPreset::Classic => [(Key::Z, Start), (Key::X, End), (Key::V, Any), (Key::C, All)],
    }
}

/// The mouse, for the help sheet.
pub fn mouse(preset: KeyPreset) -> &'static [(&'static str, &'static str)] {
    match preset {
        KeyPreset::Today => MOUSE,
        KeyPreset::Classic => classic::MOUSE,
    }
}

/// What dragging does, for the help sheet.
pub fn drags(preset: MousePreset) -> &'static [(&'static str, &'static str)] {
    match preset {
        MousePreset::Rerun => &[
            ("Left, middle drag", "orbit around the pivot; look around while flying"),
            ("Right, Shift+drag", "pan the view"),
        ],
        MousePreset::Blender => &[
            ("Middle drag", "orbit around the pivot; look around while flying"),
            ("Shift+middle drag", "pan the view"),
            ("Ctrl+middle drag", "zoom"),
        ],
        MousePreset::Maya => &[
            ("Alt+left drag", "orbit around the pivot; look around while flying"),
            ("Alt+middle drag", "pan the view"),
            ("Alt+right drag", "zoom"),
        ],
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
    ("Click", "select a path; again for the next one there"),
    ("F2 F3 F4 F5", "a sphere under the cursor: paths that start, end, pass any, pass all"),
    ("Delete", "remove the chosen sphere"),
    ("Wheel", "zoom to the point under the cursor"),
    ("W A S D, Q E", "while flying: move, down and up; Shift is faster"),
    ("Ctrl+C", "copy the section, or the image pixel, under the cursor"),
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

/// A key that always gives the same command.
const fn say(
    shortcut: KeyboardShortcut,
    group: Group,
    command: &'static str,
    help: &'static str,
) -> Binding {
    Binding { shortcut, group, help, action: Action::Say(command) }
}

/// A key whose command depends on the state of affairs.
const fn find(
    shortcut: KeyboardShortcut,
    group: Group,
    command: fn(&World<'_>) -> Command,
    help: &'static str,
) -> Binding {
    Binding { shortcut, group, help, action: Action::Find(command) }
}

use Group::{Camera, Explorer, Paths, View};

/// Today's bindings, in the order of the help sheet.
const BINDINGS: &[Binding] = &[
    say(plain(Key::F), Camera, "camera fly toggle", "fly, or orbit again"),
    say(plain(Key::Num0), Camera, "camera through toggle", "look through the render camera"),
    say(plain(Key::Home), Camera, "camera frame", "show the whole scene"),
    say(plain(Key::Num1), Camera, "camera view front", "from the front"),
    say(plain(Key::Num3), Camera, "camera view right", "from the right"),
    say(plain(Key::Num7), Camera, "camera view top", "from above"),
    say(ctrl(Key::Num1), Camera, "camera view back", "from the back"),
    say(ctrl(Key::Num3), Camera, "camera view left", "from the left"),
    say(ctrl(Key::Num7), Camera, "camera view bottom", "from below"),
    say(plain(Key::Space), Paths, "cloud freeze toggle", "freeze the paths on screen, or go on"),
    say(plain(Key::Backspace), Paths, "cloud clear", "remove every path from the view"),
    find(
        plain(Key::C),
        Paths,
        |w| next(w, &CloudSettings::color()),
        "colour paths by the next property",
    ),
    find(
        plain(Key::M),
        Paths,
        |w| next(w, &CloudSettings::blend()),
        "next blending of crossing paths: newest, weighted, add",
    ),
    find(plain(Key::Minus), Paths, |w| drawn(w, 0.5), "draw half as many paths"),
    find(plain(Key::Equals), Paths, |w| drawn(w, 2.0), "draw twice as many paths"),
    find(plain(Key::H), Paths, handles, "handles of selectors move or scale"),
    find(plain(Key::OpenBracket), Paths, |w| width(w, 1.0 / 1.25), "thinner lines"),
    find(plain(Key::CloseBracket), Paths, |w| width(w, 1.25), "thicker lines"),
    say(plain(Key::L), Paths, "cloud ends toggle", "tint the light end and the camera end"),
    say(plain(Key::V), Paths, "path vertex next", "next vertex of the selected path"),
    say(shift(Key::V), Paths, "path vertex previous", "previous vertex of the selected path"),
    say(plain(Key::Escape), Paths, "path none", "clear the selection"),
    find(plain(Key::Enter), Explorer, seed, "explore the selected path, or the newest"),
    find(plain(Key::K), Explorer, play_or_pause, "play or pause"),
    find(plain(Key::N), Explorer, step, "one step"),
    find(shift(Key::N), Explorer, skip, "step to the next acceptance"),
    say(ctrl(Key::Z), View, "undo", "undo"),
    say(ctrl(Key::Y), View, "redo", "redo"),
    find(
        plain(Key::Z),
        View,
        shading,
        "next shading: shaded, plain, texture, edges, wireframe, off",
    ),
    find(plain(Key::X), View, x_ray, "X-ray: see through surfaces"),
    say(plain(Key::B), View, "scene cutaway toggle", "cut away surfaces seen from behind"),
    say(plain(Key::G), View, "scene grid toggle", "grid"),
    find(plain(Key::Comma), View, |w| brighter(w, -0.5), "image half a stop darker"),
    find(plain(Key::Period), View, |w| brighter(w, 0.5), "image half a stop brighter"),
    say(plain(Key::I), View, "panel image toggle", "image panel"),
    say(plain(Key::P), View, "panel statistics toggle", "statistics panel"),
    say(plain(Key::T), View, "theme toggle", "dark or light"),
    say(ctrl(Key::P), View, "palette toggle", "find a command by typing"),
    find(ctrl(Key::Plus), View, |w| larger(w, 10.0), "larger text and buttons"),
    find(ctrl(Key::Minus), View, |w| larger(w, -10.0), "smaller text and buttons"),
    say(ctrl(Key::L), View, "share", "copy a link to this view"),
    say(plain(Key::R), View, "reconnect", "connect now"),
    say(plain(Key::F1), View, "help toggle", "list of keys; also ?"),
    say(ctrl(Key::Q), View, "quit", "quit"),
];

/// The choice after the present one.
fn next<G: Settings, T: Choice + Settable<Change = T>>(
    world: &World<'_>,
    setting: &Setting<G, T>,
) -> Command {
    (setting.set)(setting.value(world.settings).next())
}

/// The number that `step` makes of the present one, within its range.
fn moved<G: Settings, T: Number + Settable<Change = T>>(
    world: &World<'_>,
    setting: &Setting<G, T>,
    step: impl Fn(f64) -> f64,
) -> Command {
    let wished = step(setting.value(world.settings).to_f64());
    let within = setting.form.range().map_or(wished, |range| range.clamp(wished));
    (setting.set)(T::from_f64(within))
}

fn drawn(world: &World<'_>, factor: f64) -> Command {
    moved(world, &CloudSettings::shown(), |paths| (paths.max(1.0) * factor).max(1.0).floor())
}

fn width(world: &World<'_>, factor: f64) -> Command {
    moved(world, &CloudSettings::width(), |pixels| pixels * factor)
}

fn larger(world: &World<'_>, percent: f64) -> Command {
    moved(world, &WindowSettings::scale(), |scale| scale + percent)
}

fn brighter(world: &World<'_>, stops: f32) -> Command {
    let wished = f64::from(world.settings.image.exposure.stops() + stops);
    let range = ImageSettings::exposure().form.range();
    let within = range.map_or(wished, |range| range.clamp(wished));
    Command::Image(ImageCommand::Exposure(within as f32))
}

fn handles(world: &World<'_>) -> Command {
    next(world, &SceneSettings::handles())
}

fn shading(world: &World<'_>) -> Command {
    next(world, &SceneSettings::shading())
}

fn x_ray(world: &World<'_>) -> Command {
    let solid = world.settings.scene.opacity > 0.99;
    Command::Scene(SceneCommand::Opacity(if solid { 0.3 } else { 1.0 }))
}

/// The command for a file of paths, where one is played.
fn in_file(world: &World<'_>, command: PlayCommand) -> Option<Command> {
    world.playback.map(|_| Command::Play(command))
}

/// Makes the selected path the explorer's, or the newest where none is selected.
fn seed(world: &World<'_>) -> Command {
    let seed = world.selection.map_or(Seed::Newest, |s| Seed::Path(s.header.id));
    explore(ExplorerCommand::Seed(seed))
}

fn step(world: &World<'_>) -> Command {
    in_file(world, PlayCommand::By(1)).unwrap_or_else(|| explore(ExplorerCommand::Step(1)))
}

fn skip(world: &World<'_>) -> Command {
    let skip = explore(ExplorerCommand::Skip(SkipTo::Acceptance));
    in_file(world, PlayCommand::Accepted).unwrap_or(skip)
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
    if is_over && !world.settings.window.help {
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
    let preset = world.settings.window.keys;
    // Those with modifiers first: without them, a key also fits its plain binding.
    let (plain, modified): (Vec<&Binding>, Vec<&Binding>) =
        bindings(preset).into_iter().partition(|b| b.shortcut.modifiers == Modifiers::NONE);
    for binding in modified.into_iter().chain(plain) {
        if ctx.input_mut(|input| input.consume_shortcut(&binding.shortcut)) {
            commands.push(binding.command(world));
        }
    }
}

fn help() -> Command {
    Command::Window(WindowCommand::Help(Switch::Toggle))
}

#[cfg(test)]
mod tests {
    use super::*;

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

    #[test]
    fn what_keys_say_are_commands() {
        for binding in KeyPreset::ALL.into_iter().flat_map(bindings) {
            if let Action::Say(text) = binding.action {
                assert!(text.parse::<Command>().is_ok(), "{}: `{text}`", binding.help);
            }
        }
    }
}
