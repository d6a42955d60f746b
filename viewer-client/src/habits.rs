//! What the viewer remembers from one day to the next: theme, size of the interface, open panels, and
//! the daemons it was connected to. Never tokens.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};
use std::{fs, io};

use common::FilterText;
use serde_json::{Value, json};

use crate::command::{MOST_KEPT, PanelName, kept_name};
use crate::keys::{KeyPreset, MousePreset};
use crate::settings::{KeptFilter, Layout, SCALES, WIDTHS};

/// Connections that are remembered.
const MOST: usize = 8;
/// No file of ours is larger.
const LARGEST: u64 = 256 << 10;

/// From a change to its being written: someone who drags is done by then, and a crash takes little.
const PATIENCE: Duration = Duration::from_secs(2);

/// What is remembered.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Habits {
    /// HOST:PORT of daemons, the newest first.
    pub recent: Vec<String>,
    /// Filters that have names; none is on.
    pub filters: Vec<KeptFilter>,
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
        habits.filters = filters(&value["filters"]);
        let layout = &value["layout"];
        if let Some(dark) = layout["dark"].as_bool() {
            let closed = texts(&layout["closed"]);
            let listed: Vec<String> = texts(&layout["order"]);
            let folded = texts(&layout["folded"]);
            let left = layout["left"].as_array().map(|_| texts(&layout["left"]));
            let is_left = |name: PanelName| match &left {
                Some(left) => left.contains(&name.to_string()),
                None => name.is_usually_left(),
            };
            let scale = layout["scale"].as_u64().and_then(|scale| u16::try_from(scale).ok());
            habits.layout = Some(Layout {
                open: PanelName::ALL.map(|name| !closed.contains(&name.to_string())),
                folded: PanelName::ALL.map(|name| folded.contains(&name.to_string())),
                order: order(&listed),
                left: PanelName::ALL.map(is_left),
                widths: widths(&layout["widths"]),
                mouse: choice(&MousePreset::ALL, &layout["mouse"]),
                dark,
                help: false,
                keys: choice(&KeyPreset::ALL, &layout["keys"]),
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
            let names = |wanted: &dyn Fn(PanelName) -> bool| -> Vec<String> {
                let names = layout.order.into_iter().filter(|name| wanted(*name));
                names.map(|name| name.to_string()).collect()
            };
            json!({
                "order": names(&|_| true),
                "left": names(&|name| layout.is_left(name)),
                "folded": names(&|name| layout.is_folded(name)),
                "widths": layout.widths,
                "mouse": layout.mouse.to_string(),
                "dark": layout.dark,
                "scale": layout.scale,
                "hint": layout.hint,
                "keys": layout.keys.to_string(),
                "closed": closed,
            })
        });
        let filters = self.filters.iter().map(|kept| {
            json!({ "name": kept.name, "text": kept.text().text(), "inverted": kept.inverted })
        });
        let filters: Vec<Value> = filters.collect();
        json!({ "recent": self.recent, "filters": filters, "layout": layout })
    }

    /// Writes them.
    pub fn save(&self, file: &Path) -> io::Result<()> {
        if let Some(folder) = file.parent() {
            fs::create_dir_all(folder)?;
        }
        // Another viewer must neither find half a file nor write into the same one.
        let fresh = file.with_extension(format!("json.new.{}", std::process::id()));
        let written = fs::write(&fresh, format!("{:#}\n", self.to_json()))
            .and_then(|()| fs::rename(&fresh, file));
        if written.is_err() {
            // What went wrong is told; whether anything is left to take away is no news.
            drop(fs::remove_file(&fresh));
        }
        written
    }

    /// These without what a file does not keep.
    fn lasting(mut self) -> Self {
        if let Some(layout) = &mut self.layout {
            (layout.help, layout.seen, layout.palette) = (false, false, false);
        }
        self
    }

    /// Remembers a connection as the newest.
    pub fn note(&mut self, address: &str) {
        self.recent.retain(|known| known != address);
        self.recent.insert(0, address.to_owned());
        self.recent.truncate(MOST);
    }
}

/// Writes habits soon after they have changed, so that nothing has to end well for them to be kept.
#[derive(Debug)]
pub struct Keeper {
    file: PathBuf,
    /// What was last written, or tried.
    written: Habits,
    /// Since when there is something to write.
    changed: Option<Instant>,
}

impl Keeper {
    /// Of a file that holds `habits`.
    pub fn new(file: PathBuf, habits: Habits) -> Self {
        Self { file, written: habits.lasting(), changed: None }
    }

    /// Takes note of the habits, and writes them if they have been others for a while. The answer is when
    /// to ask again, even if nothing happens.
    pub fn note(&mut self, habits: Habits, now: Instant) -> Option<Duration> {
        let habits = habits.lasting();
        if habits == self.written {
            self.changed = None;
            return None;
        }
        let since = *self.changed.get_or_insert(now);
        let left = PATIENCE.saturating_sub(now.saturating_duration_since(since));
        if !left.is_zero() {
            return Some(left);
        }
        self.write(habits);
        None
    }

    /// Writes what is not written yet.
    pub fn finish(&mut self, habits: Habits) {
        let habits = habits.lasting();
        if habits != self.written || !self.file.exists() {
            self.write(habits);
        }
    }

    fn write(&mut self, habits: Habits) {
        self.changed = None;
        if let Err(error) = habits.save(&self.file) {
            tracing::warn!("{} cannot be written: {error}", self.file.display());
        }
        // What cannot be written is tried again with the next change, not with every frame.
        self.written = habits;
    }
}

/// All panels, those that are listed first.
fn order(listed: &[String]) -> [PanelName; PanelName::ALL.len()] {
    let place = |name: &PanelName| {
        let text = name.to_string();
        listed.iter().position(|listed| *listed == text).unwrap_or(usize::MAX)
    };
    let mut order = PanelName::ALL;
    order.sort_by_key(place);
    order
}

/// The widths of the sides; the usual ones where they make no sense.
fn widths(value: &Value) -> [u16; 2] {
    let usual = Layout::default().widths;
    [0, 1].map(|side| {
        let width = value[side].as_u64().and_then(|width| u16::try_from(width).ok());
        width.filter(|width| WIDTHS.contains(width)).unwrap_or(usual[side])
    })
}

/// The choice of this text; the usual one where there is none.
fn choice<T: Copy + Default + ToString>(all: &[T], value: &Value) -> T {
    let text = value.as_str().unwrap_or_default();
    all.iter().copied().find(|choice| choice.to_string() == text).unwrap_or_default()
}

/// The kept filters of a file. One that cannot be read is kept as it is: another version may read it.
fn filters(value: &Value) -> Vec<KeptFilter> {
    let list = value.as_array().map(Vec::as_slice).unwrap_or_default();
    let read = list.iter().filter_map(|entry| {
        let name = kept_name(entry["name"].as_str()?)?;
        let text = FilterText::read(entry["text"].as_str()?);
        let inverted = entry["inverted"].as_bool().unwrap_or(false);
        Some(KeptFilter::new(name, text, inverted))
    });
    read.take(MOST_KEPT).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::command::{LayoutCommand, Move, Switch, WindowSide};

    #[test]
    fn habits_survive_a_file() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let file = folder.path().join("lvis/viewer.json");
        assert_eq!(Habits::load(&file), Habits::default(), "the first time");
        let mut layout = Layout { dark: false, scale: 125, hint: false, ..Layout::default() };
        layout.open[PanelName::Statistics as usize] = false;
        for command in [
            LayoutCommand::Arrange(PanelName::Path, Move::Left),
            LayoutCommand::Fold(PanelName::Scene, Switch::On),
            LayoutCommand::Width(WindowSide::Left, 333),
            LayoutCommand::Mouse(MousePreset::Blender),
        ] {
            layout.apply(command);
        }
        let caustics = FilterText::read("lpe \"C.*DS+L\"");
        let newer = FilterText::read("what only a newer version reads");
        let filters = vec![
            KeptFilter::new("my caustics".to_owned(), caustics, true),
            KeptFilter::new("newer".to_owned(), newer, false),
        ];
        let mut habits = Habits { filters, layout: Some(layout), ..Habits::default() };
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
    fn a_change_is_written_soon_and_once() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let file = folder.path().join("lvis/viewer.json");
        let habits = Habits { layout: Some(Layout::default()), ..Habits::default() };
        let mut keeper = Keeper::new(file.clone(), habits.clone());
        let start = Instant::now();
        let after = |seconds: u64| start + Duration::from_secs(seconds);
        let with = |layout: Layout| Habits { layout: Some(layout), ..habits.clone() };
        assert_eq!(keeper.note(habits.clone(), start), None, "nothing has changed");
        let sheet = with(Layout { help: true, palette: true, ..Layout::default() });
        assert_eq!(keeper.note(sheet, start), None, "sheets are not kept");
        let light = with(Layout { dark: false, ..Layout::default() });
        assert_eq!(keeper.note(light.clone(), start), Some(PATIENCE), "not at once");
        let larger = with(Layout { dark: false, scale: 150, ..Layout::default() });
        let left = keeper.note(larger.clone(), after(1));
        assert_eq!(left, Some(PATIENCE.saturating_sub(Duration::from_secs(1))), "the first counts");
        assert!(!file.exists(), "it may still change");
        assert_eq!(keeper.note(larger.clone(), after(2)), None, "written");
        assert_eq!(Habits::load(&file), larger, "the newest");
        assert_eq!(fs::read_dir(folder.path().join("lvis")).expect("a folder").count(), 1, "alone");
        fs::remove_file(&file).expect("the file");
        assert_eq!(keeper.note(larger, after(9)), None, "nothing new");
        assert!(!file.exists(), "so nothing is written");
        assert_eq!(keeper.note(light.clone(), after(10)), Some(PATIENCE), "another change");
        keeper.finish(light.clone());
        assert_eq!(Habits::load(&file), light, "the end does not wait");
    }

    #[test]
    fn nonsense_is_as_nothing() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let file = folder.path().join("viewer.json");
        for text in [
            "",
            "[]",
            "{\"recent\": 7, \"layout\": {\"dark\": 1}}",
            "{",
            "null",
            "{\"filters\": [{\"name\": \"x\"}, {\"text\": \"\"}, 7]}",
        ] {
            fs::write(&file, text).expect("a file is written");
            assert_eq!(Habits::load(&file), Habits::default(), "`{text}`");
        }
        fs::write(&file, "{\"layout\": {\"dark\": true, \"scale\": 9999}}").expect("a file");
        let scale = Habits::load(&file).layout.map(|layout| layout.scale);
        assert_eq!(scale, Some(100), "an absurd size");
    }
}
