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
        Ok(_) => Content::Damaged("it is not a JSON object".to_owned()),
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
    let mut kept_aside = None;
    let nothing = Value::Object(Map::new());
    let merged = match read(file)? {
        Content::Object(theirs) => merge(base, ours, &modernised(theirs)),
        Content::Nothing => merge(&nothing, ours, &nothing),
        Content::Damaged(_) => {
            kept_aside = Some(keep_aside(file)?);
            merge(&nothing, ours, &nothing)
        }
    };
    host::file::write(file, format!("{merged:#}\n").as_bytes()).map_err(io::Error::other)?;
    Ok(kept_aside)
}

/// Copies a file to a name that nothing has yet.
fn keep_aside(file: &Path) -> io::Result<PathBuf> {
    let mut number = 1;
    let mut place = with_ending(file, "damaged");
    while fs::symlink_metadata(&place).is_ok() {
        number += 1;
        place = with_ending(file, &format!("damaged-{number}"));
    }
    host::file::write(&place, &fs::read(file)?).map_err(io::Error::other)?;
    Ok(place)
}

/// Locks a file, which is made where it is missing, until the answer is dropped.
fn lock(file: &Path) -> io::Result<File> {
    // Never replaced: who holds a lock holds it on this file, and not on its name.
    if !file.exists()
        && let Err(error) = host::file::write_private(file, b"")
        && !file.exists()
    {
        return Err(io::Error::other(error));
    }
    let lock = File::open(file)?;
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
