//! What the viewer remembers from one day to the next: theme, size of the interface, open panels, and
//! the daemons it was connected to. Never tokens.

use std::path::{Path, PathBuf};
use std::{fs, io};

use serde_json::{Value, json};

use crate::command::PanelName;
use crate::keys::KeyPreset;
use crate::settings::{Layout, SCALES};

/// Connections that are remembered.
const MOST: usize = 8;
/// No file of ours is larger.
const LARGEST: u64 = 64 << 10;

/// What is remembered.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Habits {
    /// HOST:PORT of daemons, the newest first.
    pub recent: Vec<String>,
    /// How the window was left; absent before the first time.
    pub layout: Option<Layout>,
}

impl Habits {
    /// Where they are kept: the user's folder for settings; `None` where there is none.
    pub fn file() -> Option<PathBuf> {
        let folder = std::env::var_os("XDG_CONFIG_HOME").map(PathBuf::from);
        let folder = folder.filter(|folder| folder.is_absolute());
        let usual = || std::env::home_dir().map(|home| home.join(".config"));
        Some(folder.or_else(usual)?.join("lvis").join("viewer.json"))
    }

    /// Reads them. A file that is missing or makes no sense is as none.
    pub fn load(file: &Path) -> Self {
        let is_small = fs::metadata(file).is_ok_and(|meta| meta.len() <= LARGEST);
        let text = if is_small { fs::read_to_string(file).ok() } else { None };
        let value: Option<Value> = text.and_then(|text| serde_json::from_str(&text).ok());
        value.map(|value| Self::from_json(&value)).unwrap_or_default()
    }

    fn from_json(value: &Value) -> Self {
        let texts = |value: &Value| -> Vec<String> {
            let list = value.as_array().map(Vec::as_slice).unwrap_or_default();
            list.iter().filter_map(Value::as_str).map(str::to_owned).collect()
        };
        let mut habits = Self::default();
        for address in texts(&value["recent"]).into_iter().take(MOST).rev() {
            habits.note(&address);
        }
        let layout = &value["layout"];
        if let Some(dark) = layout["dark"].as_bool() {
            let closed = texts(&layout["closed"]);
            let scale = layout["scale"].as_u64().and_then(|scale| u16::try_from(scale).ok());
            habits.layout = Some(Layout {
                open: PanelName::ALL.map(|name| !closed.contains(&name.to_string())),
                dark,
                help: false,
                keys: match layout["keys"].as_str() {
                    Some("classic") => KeyPreset::Classic,
                    _ => KeyPreset::Today,
                },
                seen: false,
                palette: false,
                hint: layout["hint"].as_bool().unwrap_or(false),
                scale: scale.filter(|scale| SCALES.contains(scale)).unwrap_or(100),
            });
        }
        habits
    }

    fn to_json(&self) -> Value {
        let layout = self.layout.as_ref().map(|layout| {
            let closed = PanelName::ALL.into_iter().filter(|name| !layout.is_open(*name));
            let closed: Vec<String> = closed.map(|name| name.to_string()).collect();
            json!({
                "dark": layout.dark,
                "scale": layout.scale,
                "hint": layout.hint,
                "keys": layout.keys.to_string(),
                "closed": closed,
            })
        });
        json!({ "recent": self.recent, "layout": layout })
    }

    /// Writes them.
    pub fn save(&self, file: &Path) -> io::Result<()> {
        if let Some(folder) = file.parent() {
            fs::create_dir_all(folder)?;
        }
        // A viewer that is closed at the same time must not find half a file.
        let fresh = file.with_extension("json.new");
        fs::write(&fresh, format!("{:#}\n", self.to_json()))?;
        fs::rename(fresh, file)
    }

    /// Remembers a connection as the newest.
    pub fn note(&mut self, address: &str) {
        self.recent.retain(|known| known != address);
        self.recent.insert(0, address.to_owned());
        self.recent.truncate(MOST);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn habits_survive_a_file() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let file = folder.path().join("lvis/viewer.json");
        assert_eq!(Habits::load(&file), Habits::default(), "the first time");
        let mut layout = Layout { dark: false, scale: 125, hint: false, ..Layout::default() };
        layout.open[PanelName::Statistics as usize] = false;
        let mut habits = Habits { layout: Some(layout), ..Habits::default() };
        for i in 0..20 {
            habits.note(&format!("127.0.0.1:{i}"));
        }
        habits.note("127.0.0.1:15");
        assert_eq!(habits.recent.len(), MOST, "bounded");
        assert_eq!(habits.recent[..2], ["127.0.0.1:15", "127.0.0.1:19"], "the newest first");
        habits.save(&file).expect("a file is written");
        assert_eq!(Habits::load(&file), habits, "and read");
    }

    #[test]
    fn nonsense_is_as_nothing() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let file = folder.path().join("viewer.json");
        for text in ["", "[]", "{\"recent\": 7, \"layout\": {\"dark\": 1}}", "{", "null"] {
            fs::write(&file, text).expect("a file is written");
            assert_eq!(Habits::load(&file), Habits::default(), "`{text}`");
        }
        fs::write(&file, "{\"layout\": {\"dark\": true, \"scale\": 9999}}").expect("a file");
        let scale = Habits::load(&file).layout.map(|layout| layout.scale);
        assert_eq!(scale, Some(100), "an absurd size");
    }
}
