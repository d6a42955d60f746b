//! `panel`, `theme`, `help`, `keys`, `palette`, `hint`, `scale`: what the window holds, and how large.

use std::fmt;

use super::Form;
use super::words::{CommandError, Switch, Words};
use crate::keys::{KeyPreset, MousePreset};
use crate::settings::{SCALES, WIDTHS};

/// What may be done to the window.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LayoutCommand {
    /// Opens or closes a panel.
    Panel(PanelName, Switch),
    /// Leaves nothing but the heading of a panel, or shows it again.
    Fold(PanelName, Switch),
    /// Puts a panel elsewhere.
    Arrange(PanelName, Move),
    /// How wide a side is, in points.
    Width(WindowSide, u16),
    /// Puts all panels where they usually are.
    Usual,
    /// What dragging with the mouse does to the camera.
    Mouse(MousePreset),
    /// Chooses the colours of the interface.
    Theme(ThemeName),
    /// Opens or closes the sheet of keys.
    Help(Switch),
    /// Which keys there are.
    Keys(KeyPreset),
    /// Whether others see where this viewer looks, and its filter.
    Seen(Switch),
    /// The palette of commands.
    Palette(Switch),
    /// Shows or hides the first steps.
    Hint(Switch),
    /// Size of texts and buttons in percent.
    Scale(u16),
}

/// A side of the window.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WindowSide {
    /// The left one.
    Left,
    /// The right one.
    Right,
}

impl WindowSide {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Left, Self::Right];
}

impl fmt::Display for WindowSide {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Left => "left",
            Self::Right => "right",
        })
    }
}

/// Where a panel is put.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Move {
    /// To the foot of the left side.
    Left,
    /// To the foot of the right side.
    Right,
    /// Before the one above it.
    Up,
    /// Behind the one below it.
    Down,
    /// Above another one, on whatever side that is.
    Before(PanelName),
}

impl fmt::Display for Move {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Left => f.write_str("left"),
            Self::Right => f.write_str("right"),
            Self::Up => f.write_str("up"),
            Self::Down => f.write_str("down"),
            Self::Before(other) => write!(f, "before {other}"),
        }
    }
}

/// A panel that can be closed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PanelName {
    /// How paths are drawn.
    Cloud,
    /// Which paths are shown.
    Filter,
    /// How the scene is drawn.
    Scene,
    /// The progressive image.
    Image,
    /// The selected path.
    Path,
    /// The chain that the user steps.
    Explorer,
    /// The file of paths that is played.
    Playback,
    /// Counts and rates.
    Statistics,
    /// Whether the chains can be believed.
    Diagnostics,
}

impl PanelName {
    /// All of them, from the left of the window to the right.
    pub const ALL: [Self; 9] = [
        Self::Cloud,
        Self::Filter,
        Self::Scene,
        Self::Image,
        Self::Path,
        Self::Explorer,
        Self::Playback,
        Self::Statistics,
        Self::Diagnostics,
    ];

    /// True for those that are on the left side unless they were put elsewhere.
    pub fn is_usually_left(self) -> bool {
        matches!(self, Self::Cloud | Self::Filter | Self::Scene)
    }

    /// The heading.
    pub fn title(self) -> &'static str {
        match self {
            Self::Cloud => "Paths",
            Self::Filter => "Filter",
            Self::Scene => "Scene",
            Self::Image => "Image",
            Self::Statistics => "Statistics",
            Self::Diagnostics => "Chains",
            Self::Path => "Selected path",
            Self::Explorer => "Explorer",
            Self::Playback => "Playback",
        }
    }
}

impl fmt::Display for PanelName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Cloud => "cloud",
            Self::Filter => "filter",
            Self::Scene => "scene",
            Self::Image => "image",
            Self::Statistics => "statistics",
            Self::Diagnostics => "diagnostics",
            Self::Path => "path",
            Self::Explorer => "explorer",
            Self::Playback => "playback",
        })
    }
}

/// Colours of the interface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ThemeName {
    /// Light on dark.
    Dark,
    /// Dark on light.
    Light,
    /// The other one.
    Toggle,
}

impl ThemeName {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Dark, Self::Light, Self::Toggle];
}

impl fmt::Display for ThemeName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Dark => "dark",
            Self::Light => "light",
            Self::Toggle => "toggle",
        })
    }
}

pub(super) const FORMS: &[Form] = &[
    (
        "panel NAME on|off|toggle",
        "cloud, filter, scene, image, path, explorer, playback, statistics, diagnostics: open or \
         close it",
    ),
    ("fold NAME on|off|toggle", "leave nothing of a panel but its heading"),
    ("arrange NAME left|right|up|down|before [NAME]", "put a panel elsewhere"),
    ("width left|right POINTS", "width of a side of the window (200 to 900)"),
    ("usual", "put all panels where they usually are"),
    ("mouse rerun|blender|maya", "what dragging does to the camera, as in these programs"),
    ("theme dark|light|toggle", "colours of the interface"),
    ("help on|off|toggle", "the sheet of keys"),
    ("keys today|classic", "those of today's programs, or of the Lvis of 2014"),
    ("seen on|off|toggle", "let others see where you look, and your filter"),
    ("palette on|off|toggle", "find a command by typing"),
    ("hint on|off|toggle", "the first steps"),
    ("scale PERCENT", "size of texts and buttons (50 to 300)"),
];

impl fmt::Display for LayoutCommand {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Panel(name, switch) => write!(f, "panel {name} {switch}"),
            Self::Fold(name, switch) => write!(f, "fold {name} {switch}"),
            Self::Arrange(name, place) => write!(f, "arrange {name} {place}"),
            Self::Width(side, points) => write!(f, "width {side} {points}"),
            Self::Usual => write!(f, "usual"),
            Self::Mouse(preset) => write!(f, "mouse {preset}"),
            Self::Theme(theme) => write!(f, "theme {theme}"),
            Self::Help(switch) => write!(f, "help {switch}"),
            Self::Keys(preset) => write!(f, "keys {preset}"),
            Self::Seen(switch) => write!(f, "seen {switch}"),
            Self::Palette(switch) => write!(f, "palette {switch}"),
            Self::Hint(switch) => write!(f, "hint {switch}"),
            Self::Scale(percent) => write!(f, "scale {percent}"),
        }
    }
}

fn place(words: &mut Words<'_>) -> Result<Move, CommandError> {
    if words.peek() == Some("before") {
        words.next("place")?;
        return Ok(Move::Before(words.choice("NAME", &PanelName::ALL)?));
    }
    words.choice("PLACE", &[Move::Left, Move::Right, Move::Up, Move::Down])
}

pub(super) fn parse(word: &str, words: &mut Words<'_>) -> Result<LayoutCommand, CommandError> {
    Ok(match word {
        "panel" => LayoutCommand::Panel(words.choice("NAME", &PanelName::ALL)?, words.switch()?),
        "fold" => LayoutCommand::Fold(words.choice("NAME", &PanelName::ALL)?, words.switch()?),
        "arrange" => {
            let name = words.choice("NAME", &PanelName::ALL)?;
            LayoutCommand::Arrange(name, place(words)?)
        }
        "width" => LayoutCommand::Width(
            words.choice("SIDE", &WindowSide::ALL)?,
            words.within("POINTS", WIDTHS)?,
        ),
        "usual" => LayoutCommand::Usual,
        "mouse" => LayoutCommand::Mouse(words.choice("NAME", &MousePreset::ALL)?),
        "theme" => LayoutCommand::Theme(words.choice("NAME", &ThemeName::ALL)?),
        "help" => LayoutCommand::Help(words.switch()?),
        "keys" => LayoutCommand::Keys(words.choice("NAME", &KeyPreset::ALL)?),
        "seen" => LayoutCommand::Seen(words.switch()?),
        "palette" => LayoutCommand::Palette(words.switch()?),
        "hint" => LayoutCommand::Hint(words.switch()?),
        "scale" => LayoutCommand::Scale(words.within("PERCENT", SCALES)?),
        other => return Err(CommandError::Unknown(other.to_owned())),
    })
}
