//! The file of preferences: read with complaints, and written so that nobody loses anything.

use std::fs::{self, File, TryLockError};
use std::io;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use serde_json::{Map, Value, json};

use super::merge::merge;

/// No file of ours is larger.
const LARGEST: u64 = 256 << 10;
/// So long is waited for another viewer that writes.
const LOCK_TIME: Duration = Duration::from_millis(500);
/// Links of links that are followed.
const MOST_LINKS: usize = 40;

/// What a file holds.
#[derive(Debug)]
pub(super) enum Content {
    /// There is none.
    Nothing,
    /// An object of JSON.
    Object(Value),
    /// Something else, and why it is.
    Damaged(String),
}

/// Reads a file; an error where there is one that cannot be read at all.
pub(super) fn read(file: &Path) -> io::Result<Content> {
    match fs::metadata(file) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(Content::Nothing),
        Err(error) => return Err(error),
        Ok(meta) if meta.len() > LARGEST => {
            return Ok(Content::Damaged("it is larger than 256 KiB".to_owned()));
        }
        Ok(_) => {}
    }
    let bytes = fs::read(file)?;
    Ok(match serde_json::from_slice(&bytes) {
        Ok(Value::Object(object)) => Content::Object(Value::Object(object)),
        Ok(_) => Content::Damaged("it holds no object".to_owned()),
        Err(error) => Content::Damaged(error.to_string()),
    })
}

/// Changes in `file` what differs between `base` and `ours`. A damaged file is kept aside; the answer
/// is where.
pub(super) fn write(file: &Path, base: &Value, ours: &Value) -> io::Result<Option<PathBuf>> {
    if let Some(folder) = file.parent() {
        fs::create_dir_all(folder)?;
    }
    // Two viewers must not read the same, and then each write without the other's.
    let _lock = lock(&with_ending(file, "lock"))?;
    let place = behind_links(file)?;
    let mut kept_aside = None;
    let nothing = Value::Object(Map::new());
    let merged = match read(&place)? {
        Content::Object(theirs) => merge(base, ours, &modernised(theirs)),
        Content::Nothing => merge(&nothing, ours, &nothing),
        Content::Damaged(_) => {
            kept_aside = Some(keep_aside(&place)?);
            merge(&nothing, ours, &nothing)
        }
    };
    replace(&place, &merged)?;
    Ok(kept_aside)
}

/// Puts `value` in the place of a file, so that it is there whole or not at all.
fn replace(place: &Path, value: &Value) -> io::Result<()> {
    let fresh = with_ending(place, &format!("new.{}", std::process::id()));
    let written = fs::write(&fresh, format!("{value:#}\n"))
        .and_then(|()| match fs::metadata(place) {
            // Who may read it is for the user to say.
            Ok(meta) => fs::set_permissions(&fresh, meta.permissions()),
            Err(_) => Ok(()),
        })
        .and_then(|()| File::open(&fresh)?.sync_all())
        .and_then(|()| fs::rename(&fresh, place));
    if written.is_err() {
        // What went wrong is told; whether anything is left to take away is no news.
        drop(fs::remove_file(&fresh));
    }
    written
}

/// Gives a file another name, which no file has.
fn keep_aside(place: &Path) -> io::Result<PathBuf> {
    let names = (1..).map(|number| match number {
        1 => with_ending(place, "damaged"),
        number => with_ending(place, &format!("damaged-{number}")),
    });
    let free = names.into_iter().find(|name| !name.exists()).unwrap_or_default();
    fs::rename(place, &free)?;
    Ok(free)
}

/// Where a file lies that may be a symbolic link, even to nowhere: the link stays one.
fn behind_links(file: &Path) -> io::Result<PathBuf> {
    let mut place = file.to_owned();
    for _ in 0..MOST_LINKS {
        let Ok(target) = fs::read_link(&place) else { return Ok(place) };
        place = place.parent().unwrap_or_else(|| Path::new("")).join(target);
    }
    Err(io::Error::other("too many symbolic links"))
}

/// Locks a file, which is made where it is missing, until the answer is dropped.
fn lock(file: &Path) -> io::Result<File> {
    let lock = File::options().create(true).append(true).open(file)?;
    let start = Instant::now();
    loop {
        match lock.try_lock() {
            Ok(()) => return Ok(lock),
            Err(TryLockError::WouldBlock) if start.elapsed() < LOCK_TIME => {
                std::thread::sleep(Duration::from_millis(5));
            }
            Err(TryLockError::WouldBlock) => {
                let text = format!("another viewer holds {}", file.display());
                return Err(io::Error::new(io::ErrorKind::WouldBlock, text));
            }
            // Some file systems know no locks; the file is still replaced whole.
            Err(TryLockError::Error(error)) if error.kind() == io::ErrorKind::Unsupported => {
                return Ok(lock);
            }
            Err(TryLockError::Error(error)) => return Err(error),
        }
    }
}

fn with_ending(file: &Path, ending: &str) -> PathBuf {
    let mut name = file.file_name().unwrap_or_default().to_owned();
    name.push(format!(".{ending}"));
    file.with_file_name(name)
}

/// The content of a file of before 2027 in the shape of today: settings were fields of the layout, and
/// what is a map now was a list.
pub(super) fn modernised(mut content: Value) -> Value {
    let Some(object) = content.as_object_mut() else { return content };
    if let Some(layout) = object.remove("layout") {
        let settings = object.entry("settings").or_insert_with(|| json!({}));
        let dark = layout["dark"].as_bool().map(|dark| if dark { "dark" } else { "light" });
        let hint = layout["hint"].as_bool().map(|on| if on { "on" } else { "off" });
        let words = |key: &str| layout[key].as_str().map(str::to_owned);
        for (key, value) in [
            ("theme", dark.map(str::to_owned)),
            ("hint", hint.map(str::to_owned)),
            ("keys", words("keys")),
            ("mouse", words("mouse")),
            ("scale", layout["scale"].as_u64().map(|scale| scale.to_string())),
        ] {
            if let (Some(value), Some(settings)) = (value, settings.as_object_mut()) {
                settings.entry(key).or_insert(Value::String(value));
            }
        }
        object.entry("panels").or_insert(layout);
    }
    // The first is the newest; when it was is not known any more.
    list_to_map(object, "recent", |at, address| Some((address.as_str()?.to_owned(), json!(at))));
    list_to_map(object, "filters", |_, kept| Some((kept["name"].as_str()?.to_owned(), kept)));
    content
}

/// Makes the list `key` a map; `entry` knows of each how many stand behind it.
fn list_to_map(
    object: &mut Map<String, Value>,
    key: &str,
    entry: impl Fn(usize, Value) -> Option<(String, Value)>,
) {
    if let Some(Value::Array(list)) = object.get_mut(key) {
        let list = std::mem::take(list).into_iter().rev().enumerate();
        let map = list.filter_map(|(behind, value)| entry(behind, value)).collect();
        object.insert(key.to_owned(), Value::Object(map));
    }
}
