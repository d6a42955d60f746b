//! What the viewer remembers from one day to the next: settings of the window, panels, kept filters, and
//! the daemons it was connected to. Never tokens.
//!
//! The file is written soon after a change, key by key, so that two viewers lose nothing of each other.

mod file;
mod merge;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant, SystemTime};

use common::FilterText;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::command::{Command, MOST_KEPT, Trait};
use crate::settings::{KeptFilter, Layout, Settings};
use crate::value::name;
use file::Content;

/// Connections that are remembered.
const MOST: usize = 8;
/// From a change to its being written: someone who drags is done by then, and a crash takes little.
const PATIENCE: Duration = Duration::from_secs(2);

/// What is remembered.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Preferences {
    /// HOST:PORT of daemons, the newest first.
    pub recent: Vec<String>,
    /// When each of them was connected to, in seconds since 1970.
    times: BTreeMap<String, u64>,
    /// Filters that have names; none is on.
    pub filters: Vec<KeptFilter>,
    /// Commands that set what is remembered of the settings, where it is not as usual, by the words
    /// that they begin with.
    pub settings: BTreeMap<&'static str, Command>,
    /// Where the panels are.
    pub panels: Layout,
    /// There was nothing to remember: somebody uses the viewer for the first time.
    pub is_first_time: bool,
}

/// The content of the file.
#[derive(Debug, Deserialize, Serialize)]
struct Stored {
    /// When a daemon was connected to, in seconds since 1970, by HOST:PORT.
    recent: BTreeMap<String, u64>,
    /// Kept filters by their names.
    filters: BTreeMap<String, StoredFilter>,
    /// The parameters of commands by the words that these begin with.
    settings: BTreeMap<String, String>,
    panels: Layout,
}

#[derive(Debug, Deserialize, Serialize)]
struct StoredFilter {
    text: String,
    #[serde(default)]
    inverted: bool,
}

impl Preferences {
    /// Where they are kept: the user's folder for settings; `None` where there is none.
    pub fn file() -> Option<PathBuf> {
        let folders = directories::ProjectDirs::from("", "", "lvis")?;
        Some(folders.config_dir().join("viewer.json"))
    }

    /// What is worth remembering of these settings.
    pub fn of(settings: &Settings, before: &Self) -> Self {
        let mut filters = settings.filter.kept().to_vec();
        for kept in &mut filters {
            kept.on = false;
        }
        let remembered = worth_it(settings.commands());
        let panels = settings.layout.clone();
        Self {
            filters,
            settings: remembered.collect(),
            panels,
            is_first_time: false,
            ..before.clone()
        }
    }

    /// Makes these the settings, as far as they are remembered.
    pub fn restore(&self, settings: &mut Settings) {
        for command in self.settings.values() {
            settings.apply(command);
        }
        settings.layout.clone_from(&self.panels);
        settings.filter.keep_all(&self.filters);
        // Only who has never seen them sees the first steps unasked.
        settings.window.hint |= self.is_first_time;
    }

    /// Reads them, with what is wrong with the file. What cannot be read is as if it were not there, and
    /// stays in the file.
    pub fn load(file: &Path) -> (Self, Vec<String>) {
        let mut complaints = Vec::new();
        let first = Self { is_first_time: true, ..Self::default() };
        let preferences = match file::read(file) {
            Ok(Content::Object(content)) => Self::from_json(&content, &mut complaints),
            Ok(Content::Nothing) => first,
            Ok(Content::Damaged(reason)) => {
                complaints.push(format!(
                    "{reason}. Default settings are used. Fix the file and start again; otherwise \
                    it is renamed to end in .damaged as soon as a setting changes"
                ));
                Self::default()
            }
            Err(error) => {
                complaints.push(format!("it cannot be read: {error}"));
                Self::default()
            }
        };
        let named = complaints.into_iter().map(|text| format!("{}: {text}", file.display()));
        (preferences, named.collect())
    }

    fn from_json(content: &Value, complaints: &mut Vec<String>) -> Self {
        let content = file::modernised(content.clone());
        let times: BTreeMap<String, u64> = entries(&content, "recent", complaints);
        let settings: BTreeMap<String, String> = entries(&content, "settings", complaints);
        let filters: BTreeMap<String, StoredFilter> = entries(&content, "filters", complaints);
        let settings = settings.iter().filter_map(|(words, parameters)| {
            let command = format!("{words} {parameters}").parse::<Command>();
            let tell = |error| complaints.push(format!("`{words} {parameters}`: {error}"));
            command.map_err(tell).ok()
        });
        let settings = worth_it(settings.collect()).collect();
        // One whose text cannot be read is kept with its text: another version may read it.
        let filters = filters.into_iter().filter_map(|(given, StoredFilter { text, inverted })| {
            let name = name(&given);
            if name.is_none() {
                complaints.push(format!("`{given}` is not the name of a filter"));
            }
            Some(KeptFilter::new(name?, FilterText::read(text), inverted))
        });
        let filters = filters.take(MOST_KEPT).collect();
        let panels: Layout = by_key(&content["panels"], "panels", complaints);
        let mut recent: Vec<String> = times.keys().cloned().collect();
        recent.sort_by_key(|address| std::cmp::Reverse(times[address]));
        let panels = panels.completed();
        let mut read = Self { recent, times, filters, settings, panels, is_first_time: false };
        read.shorten();
        read
    }

    fn to_json(&self) -> Value {
        let settings = self.settings.iter().map(|(words, command)| {
            let text = command.to_string();
            ((*words).to_owned(), text[words.len()..].trim().to_owned())
        });
        let filters = self.filters.iter().map(|kept| {
            let text = kept.text().text().to_owned();
            (kept.name.clone(), StoredFilter { text, inverted: kept.inverted })
        });
        let stored = Stored {
            recent: self.times.clone(),
            filters: filters.collect(),
            settings: settings.collect(),
            panels: self.panels.clone(),
        };
        serde_json::to_value(stored).unwrap_or_default()
    }

    /// Remembers a connection as the newest.
    pub fn add_recent(&mut self, address: &str) {
        let since = SystemTime::now().duration_since(SystemTime::UNIX_EPOCH);
        // A clock that was put back must not make it older than the others.
        let newest = self.times.values().copied().max().map_or(0, |newest| newest + 1);
        let now = since.map_or(0, |since| since.as_secs()).max(newest);
        self.recent.retain(|known| known != address);
        self.recent.insert(0, address.to_owned());
        self.times.insert(address.to_owned(), now);
        self.shorten();
    }

    fn shorten(&mut self) {
        self.recent.truncate(MOST);
        self.times.retain(|address, _| self.recent.contains(address));
    }
}

/// Those of the commands that set what is remembered, and to something unusual.
fn worth_it(commands: Vec<Command>) -> impl Iterator<Item = (&'static str, Command)> {
    let usual = Settings::default().commands();
    let is_worth_it = move |command: &Command| !usual.contains(command);
    let kept = commands.into_iter().filter(is_worth_it).map(|c| (c.form(), c));
    kept.filter(|(form, _)| form.is(Trait::Kept)).map(|(form, command)| (form.words, command))
}

/// The entries of the map `key`; invalid ones are reported and left out.
fn entries<T: DeserializeOwned>(
    content: &Value,
    key: &str,
    complaints: &mut Vec<String>,
) -> BTreeMap<String, T> {
    let Some(entries) = content[key].as_object() else {
        if !content[key].is_null() {
            complaints.push(format!("{key}: this should be an object"));
        }
        return BTreeMap::new();
    };
    let read = entries.iter().filter_map(|(name, value)| match T::deserialize(value) {
        Ok(entry) => Some((name.clone(), entry)),
        Err(error) => {
            complaints.push(format!("{key}, {name}: {error}"));
            None
        }
    });
    read.collect()
}

/// What `T` reads from an object, except for keys with invalid values, which are reported.
fn by_key<T: Default + DeserializeOwned + Serialize>(
    object: &Value,
    place: &str,
    complaints: &mut Vec<String>,
) -> T {
    let mut good = serde_json::to_value(T::default()).unwrap_or_default();
    for (key, value) in object.as_object().into_iter().flatten() {
        let before = good.clone();
        good[key] = value.clone();
        if let Err(error) = T::deserialize(&good) {
            complaints.push(format!("{place}, {key}: {error}"));
            good = before;
        }
    }
    T::deserialize(good).unwrap_or_default()
}

/// Writes preferences soon after they have changed, so that nothing has to end well for them to be kept.
#[derive(Debug)]
pub struct Keeper {
    file: PathBuf,
    /// What was read, or written last.
    written: Preferences,
    /// What could not be written is tried again with the next change, not with every frame.
    tried: Preferences,
    /// Since when there is something to write.
    changed: Option<Instant>,
    /// What went otherwise than it should, and is not told yet.
    problem: Option<String>,
}

impl Keeper {
    /// Of a file that holds `preferences`.
    pub fn new(file: PathBuf, preferences: Preferences) -> Self {
        Self {
            file,
            tried: preferences.clone(),
            written: preferences,
            changed: None,
            problem: None,
        }
    }

    /// Takes note of the preferences, and writes them if they have been others for a while. The answer is
    /// when to ask again, even if nothing happens.
    pub fn update(&mut self, present: Preferences, now: Instant) -> Option<Duration> {
        if present == self.tried {
            self.changed = None;
            return None;
        }
        let since = *self.changed.get_or_insert(now);
        let left = PATIENCE.saturating_sub(now.saturating_duration_since(since));
        if !left.is_zero() {
            return Some(left);
        }
        self.write(present);
        None
    }

    /// Writes what is not written yet.
    pub fn finish(&mut self, present: Preferences) {
        if present != self.written || !self.file.exists() {
            self.write(present);
        }
    }

    /// What is to be told to the user, once.
    pub fn problem(&mut self) -> Option<String> {
        self.problem.take()
    }

    fn write(&mut self, present: Preferences) {
        self.changed = None;
        let name = self.file.display();
        let written = file::write(&self.file, &self.written.to_json(), &present.to_json());
        self.problem = match &written {
            Ok(None) => None,
            Ok(Some(place)) => {
                Some(format!("{name} was damaged, and has been kept as {}", place.display()))
            }
            Err(error) => Some(format!("settings cannot be saved in {name}: {error}")),
        };
        if let Some(problem) = &self.problem {
            tracing::warn!("{problem}");
        }
        if written.is_ok() {
            self.written.clone_from(&present);
        }
        self.tried = present;
    }
}

#[cfg(test)]
mod tests;
