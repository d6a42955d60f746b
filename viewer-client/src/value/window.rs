//! What the window holds, and whose keys and mouse it follows.

use super::choice::choices;
use super::{CommandError, PanelName, Range, Settable, Value, Words, range};

choices! {
    /// A side of the window.
    pub enum WindowSide {
        /// The left one.
        Left,
        /// The right one.
        Right,
    }
}

/// Widths of a side in points.
pub const WIDTHS: Range<u16> = range(200, 900);

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

/// The places that are one word.
const PLACES: [(&str, Move); 4] =
    [("left", Move::Left), ("right", Move::Right), ("up", Move::Up), ("down", Move::Down)];

impl Value for Move {
    type Limits = ();

    fn form(_: &str, (): &()) -> String {
        "left|right|up|down|before NAME".to_owned()
    }

    fn read(words: &mut Words<'_>, name: &str, (): &()) -> Result<Self, CommandError> {
        let word = words.parameter(name)?;
        if word == "before" {
            return PanelName::read(words, "NAME", &()).map(Self::Before);
        }
        let place = PLACES.into_iter().find(|(known, _)| *known == word).map(|(_, place)| place);
        place.ok_or_else(|| CommandError::no_choice(word, "left, right, up, down, before NAME"))
    }

    fn text(&self) -> String {
        if let Self::Before(other) = self {
            return format!("before {other}");
        }
        let known = PLACES.into_iter().find(|(_, place)| place == self);
        known.map_or("", |(word, _)| word).to_owned()
    }

    fn examples((): &()) -> Vec<Self> {
        let before = PanelName::ALL.map(Self::Before);
        PLACES.into_iter().map(|(_, place)| place).chain(before).collect()
    }
}

/// Colours of the interface.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Deserialize, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Theme {
    /// Light on dark.
    #[default]
    Dark,
    /// Dark on light.
    Light,
}

choices! {
    /// What to do with the colours of the interface.
    pub enum ThemeChange {
        /// Light on dark.
        Dark,
        /// Dark on light.
        Light,
        /// The other ones.
        Toggle,
    }
}

impl Settable for Theme {
    type Change = ThemeChange;

    fn change(&mut self, to: ThemeChange) {
        *self = match (to, *self) {
            (ThemeChange::Dark, _) | (ThemeChange::Toggle, Self::Light) => Self::Dark,
            (ThemeChange::Light, _) | (ThemeChange::Toggle, Self::Dark) => Self::Light,
        };
    }

    fn as_change(&self) -> Option<ThemeChange> {
        Some(match self {
            Self::Dark => ThemeChange::Dark,
            Self::Light => ThemeChange::Light,
        })
    }
}

choices! {
    /// Which keys there are.
    #[derive(Default)]
    pub enum KeyPreset {
        /// Those of present-day programs.
        #[strum(message = "Modern keys")]
        #[default]
        Today,
        /// Those of the Lvis of 2014.
        #[strum(message = "Keys of 2014")]
        Classic,
    }
}

choices! {
    /// What dragging with the mouse does to the camera.
    #[derive(Default)]
    pub enum MousePreset {
        /// As in Rerun: left orbits, right pans.
        #[default]
        Rerun,
        /// As in Blender: the middle button orbits, with Shift it pans, with Ctrl it zooms.
        Blender,
        /// As in Maya: all with Alt, left turns, middle shifts, right comes closer.
        Maya,
    }
}

/// Something that has a text to be copied.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// The state of the session.
    Status,
    /// Every setting, as commands.
    Settings,
    /// A panel.
    Panel(PanelName),
}

impl Value for Part {
    type Limits = ();

    fn form(_: &str, (): &()) -> String {
        "NAME|status|settings".to_owned()
    }

    fn read(words: &mut Words<'_>, name: &str, (): &()) -> Result<Self, CommandError> {
        if words.skip("status") {
            Ok(Self::Status)
        } else if words.skip("settings") {
            Ok(Self::Settings)
        } else {
            PanelName::read(words, name, &()).map(Self::Panel)
        }
    }

    fn text(&self) -> String {
        match self {
            Self::Status => "status".to_owned(),
            Self::Settings => "settings".to_owned(),
            Self::Panel(name) => name.to_string(),
        }
    }

    fn examples((): &()) -> Vec<Self> {
        let panels = PanelName::ALL.map(Self::Panel);
        [Self::Status, Self::Settings].into_iter().chain(panels).collect()
    }
}
