//! `panel`, `theme`, `help`, `keys`, `palette`, `hint`, `scale`: what the window holds, and how large.

use std::fmt;

use super::Form;
use super::words::{CommandError, Switch, Words};
use crate::keys::KeyPreset;
use crate::settings::SCALES;

/// What may be done to the window.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LayoutCommand {
    /// Opens or closes a panel.
    Panel(PanelName, Switch),
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

pub(super) fn parse(word: &str, words: &mut Words<'_>) -> Result<LayoutCommand, CommandError> {
    Ok(match word {
        "panel" => LayoutCommand::Panel(words.choice("NAME", &PanelName::ALL)?, words.switch()?),
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
