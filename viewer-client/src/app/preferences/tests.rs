//! What was set is there the next day, whoever else was at it.

use std::fs;

use serde_json::json;
use tempfile::{TempDir, tempdir};

use super::*;
use crate::command::{Trait, forms};

/// A folder, and the file that preferences have in it; the file is not there yet.
fn place() -> (TempDir, PathBuf) {
    let folder = tempdir().expect("a temporary folder");
    let file = folder.path().join("lvis/viewer.json");
    (folder, file)
}

/// What is read from a file with nothing wrong.
fn loaded(file: &Path) -> Preferences {
    let (preferences, complaints) = Preferences::load(file);
    assert_eq!(complaints, [""; 0], "nothing is wrong");
    preferences
}

/// These preferences after some commands.
fn after(preferences: &Preferences, commands: &[&str]) -> Preferences {
    let mut settings = Settings::default();
    preferences.restore(&mut settings);
    for text in commands {
        settings.apply(&text.parse().unwrap_or_else(|error| panic!("`{text}`: {error}")));
    }
    Preferences::of(&settings, preferences)
}

fn save(file: &Path, before: &Preferences, after: &Preferences) {
    Keeper::new(file.to_owned(), before.clone()).finish(after.clone());
}

#[test]
fn preferences_survive_a_file() {
    let (_folder, file) = place();
    let first = loaded(&file);
    assert!(first.is_first_time, "the first time");
    let mut changed = after(
        &first,
        &[
            "theme light",
            "scale 125",
            "keys classic",
            "mouse blender",
            "hint off",
            "panel statistics off",
            "arrange path left",
            "fold scene on",
            "width left 333",
            "filter set lpe \"C.*DS+L\"",
            "filter invert on",
            "filter keep my caustics",
        ],
    );
    for i in 0..20 {
        changed.add_recent(&format!("127.0.0.1:{i}"));
    }
    changed.add_recent("127.0.0.1:15");
    assert_eq!(changed.recent.len(), MOST, "bounded");
    assert_eq!(changed.recent[..2], ["127.0.0.1:15", "127.0.0.1:19"], "the newest first");
    save(&file, &first, &changed);
    assert_eq!(loaded(&file), changed, "and read");
}

#[test]
fn everything_that_is_kept_survives() {
    let (_folder, file) = place();
    let mut count = 0;
    for form in forms().filter(|form| form.is(Trait::Kept)) {
        for example in (form.examples)() {
            let before = loaded(&file);
            let changed = after(&before, &[&example.to_string()]);
            save(&file, &before, &changed);
            assert_eq!(loaded(&file).settings, changed.settings, "{example}");
            count += 1;
        }
    }
    assert!(count > 10, "{count} examples");
}

#[test]
fn a_change_is_written_soon_and_once() {
    let (folder, file) = place();
    let usual = Preferences::of(&Settings::default(), &Preferences::default());
    let mut keeper = Keeper::new(file.clone(), usual.clone());
    let start = Instant::now();
    let later = |seconds: u64| start + Duration::from_secs(seconds);
    assert_eq!(keeper.update(usual.clone(), start), None, "nothing has changed");
    let sheet = after(&usual, &["help on", "palette on", "seen on"]);
    assert_eq!(keeper.update(sheet, start), None, "sheets are not kept");
    let light = after(&usual, &["theme light"]);
    assert_eq!(keeper.update(light.clone(), start), Some(PATIENCE), "not at once");
    let larger = after(&light, &["scale 150"]);
    let left = keeper.update(larger.clone(), later(1));
    assert_eq!(left, Some(PATIENCE.saturating_sub(Duration::from_secs(1))), "the first counts");
    assert!(!file.exists(), "it may still change");
    assert_eq!(keeper.update(larger.clone(), later(2)), None, "written");
    assert_eq!(loaded(&file), larger, "the newest");
    let names: Vec<_> = fs::read_dir(folder.path().join("lvis")).expect("a folder").collect();
    assert_eq!(names.len(), 2, "the file and its lock: {names:?}");
    fs::remove_file(&file).expect("the file");
    assert_eq!(keeper.update(larger, later(9)), None, "nothing new");
    assert!(!file.exists(), "so nothing is written");
    assert_eq!(keeper.update(light.clone(), later(10)), Some(PATIENCE), "another change");
    keeper.finish(light.clone());
    assert_eq!(loaded(&file), light, "the end does not wait");
}

#[test]
fn two_viewers_lose_nothing_of_each_other() {
    let (_folder, file) = place();
    let first = loaded(&file);
    // Both begin with the same, and each changes something of its own, twice.
    let (mut one, mut other) =
        (Keeper::new(file.clone(), first.clone()), Keeper::new(file.clone(), first.clone()));
    let mut light = after(&first, &["theme light", "filter set edges > 2", "filter keep long"]);
    light.add_recent("one:1");
    one.finish(light.clone());
    let mut large = after(&first, &["scale 150", "filter set edges < 3", "filter keep short"]);
    large.add_recent("other:1");
    other.finish(large.clone());
    one.finish(after(&light, &["keys classic", "panel path off"]));
    other.finish(after(&large, &["mouse maya", "filter forget short"]));
    let both = loaded(&file);
    let settings: Vec<String> = both.settings.values().map(ToString::to_string).collect();
    let expected = ["hint on", "keys classic", "mouse maya", "scale 150", "theme light"];
    assert_eq!(settings, expected, "of both");
    let names: Vec<&str> = both.filters.iter().map(|kept| kept.name.as_str()).collect();
    assert_eq!(names, ["long"], "one was kept by one, the other forgotten by the other");
    assert!(!both.panels.is_open(crate::value::PanelName::Path), "panels, too");
    let mut recent = both.recent.clone();
    recent.sort();
    assert_eq!(recent, ["one:1", "other:1"], "and connections");
}

#[test]
fn viewers_that_write_at_once_lose_nothing() {
    let (_folder, file) = place();
    let first = loaded(&file);
    std::thread::scope(|scope| {
        for viewer in 0..4 {
            let (file, mut present) = (file.clone(), first.clone());
            scope.spawn(move || {
                let mut keeper = Keeper::new(file, present.clone());
                for i in 0..4 {
                    let keep = format!("filter keep filter {viewer} {i}");
                    present = after(&present, &["filter set edges > 2", &keep]);
                    keeper.finish(present.clone());
                }
            });
        }
    });
    assert_eq!(loaded(&file).filters.len(), 16, "of four viewers four each");
}

#[test]
fn a_damaged_file_is_told_and_kept_aside() {
    let broken =
        concat!(env!("CARGO_MANIFEST_DIR"), "/../../shared/cases/files/settings/broken.json");
    let own = "{\n  \"settings\": {\n    \"theme\": \"light\",\n  }\n}\n".to_owned();
    let cases = [fs::read_to_string(broken).unwrap_or(own), String::new(), "[]".to_owned()];
    for text in cases {
        let (_folder, file) = place();
        fs::create_dir_all(file.parent().expect("a folder")).expect("made");
        for (ending, round) in [("json.damaged", 1), ("json.damaged-2", 2)] {
            fs::write(&file, &text).expect("written");
            let (read, complaints) = Preferences::load(&file);
            let [complaint] = complaints.as_slice() else { panic!("{complaints:?}") };
            assert!(complaint.contains("viewer.json: "), "names the file: {complaint}");
            assert!(complaint.contains(".damaged"), "says what becomes of it: {complaint}");
            assert_eq!(fs::read_to_string(&file).expect("there"), text, "reading changes nothing");
            let changed = after(&read, &["theme light"]);
            let mut keeper = Keeper::new(file.clone(), read.clone());
            keeper.finish(changed.clone());
            let problem = keeper.problem().expect("it is told");
            assert!(problem.contains(ending), "where it is kept: {problem}");
            let aside = file.with_extension(ending);
            assert_eq!(fs::read_to_string(&aside).expect("kept aside"), text, "round {round}");
            assert_eq!(loaded(&file), changed, "what was set is kept");
        }
    }
}

#[test]
fn what_makes_no_sense_costs_nothing_else() {
    let (_folder, file) = place();
    fs::create_dir_all(file.parent().expect("a folder")).expect("made");
    let content = json!({
        "recent": { "a:1": 7, "b:1": "yesterday" },
        "filters": { "good": { "text": "edges > 2" }, "newer": { "text": "edges >" }, "nameless": 7 },
        "settings": { "theme": "light", "scale": "9999", "of next year": "1", "cloud width": "9" },
        "panels": { "widths": [333, 9], "closed": ["path", "of next year"], "folded": 7 },
        "of next year": [1, 2],
    });
    fs::write(&file, content.to_string()).expect("written");
    let (read, complaints) = Preferences::load(&file);
    for part in ["b:1", "nameless", "between 50 and 300", "`of next year 1`", "folded"] {
        let told = complaints.iter().any(|complaint| complaint.contains(part));
        assert!(told, "{part} in {complaints:#?}");
    }
    assert_eq!(complaints.len(), 5, "{complaints:#?}");
    let settings: Vec<String> = read.settings.values().map(ToString::to_string).collect();
    assert_eq!(settings, ["theme light"], "but for the size, and what is not remembered");
    assert_eq!((read.recent.as_slice(), read.filters.len()), (["a:1".to_owned()].as_slice(), 2));
    let sides = crate::value::WindowSide::ALL.iter().map(|side| read.panels.width(*side));
    assert_eq!(sides.collect::<Vec<_>>(), [333, 380], "a width, and the usual one");
    // What this viewer cannot read is not its to throw away.
    save(&file, &read, &after(&read, &["keys classic"]));
    let text = fs::read_to_string(&file).expect("there");
    for part in ["yesterday", "\"edges >\"", "9999", "of next year", "cloud width", "classic"] {
        assert!(text.contains(part), "{part} in {text}");
    }
}

#[test]
fn files_of_before_are_read() {
    let (_folder, file) = place();
    fs::create_dir_all(file.parent().expect("a folder")).expect("made");
    let content = json!({
        "recent": ["newest:1", "older:1"],
        "filters": [{ "name": "my caustics", "text": "lpe \"C.*DS+L\"", "inverted": true }],
        "layout": {
            "order": ["scene", "cloud"], "left": ["scene", "path"], "folded": ["image"],
            "widths": [300, 400], "mouse": "blender", "dark": false, "scale": 125, "hint": false,
            "keys": "classic", "closed": ["statistics"],
        },
    });
    fs::write(&file, content.to_string()).expect("written");
    let read = loaded(&file);
    assert_eq!(read.recent, ["newest:1", "older:1"]);
    assert!(read.filters.iter().any(|kept| kept.name == "my caustics" && kept.inverted));
    let settings: Vec<String> = read.settings.values().map(ToString::to_string).collect();
    let expected = ["keys classic", "mouse blender", "scale 125", "theme light"];
    assert_eq!(settings, expected);
    use crate::value::{PanelName, WindowSide};
    assert!(read.panels.is_left(PanelName::Path) && read.panels.is_left(PanelName::Filter));
    assert!(!read.panels.is_open(PanelName::Statistics) && read.panels.is_folded(PanelName::Image));
    let right: Vec<_> = read.panels.side(WindowSide::Right).collect();
    assert!(right.contains(&PanelName::Image), "{right:?}");
    save(&file, &read, &after(&read, &["theme dark"]));
    assert_eq!(loaded(&file), after(&read, &["theme dark"]), "in the shape of today");
}

#[cfg(unix)]
#[test]
fn a_symbolic_link_stays_one() {
    use std::os::unix::fs::{PermissionsExt as _, symlink};
    let (folder, file) = place();
    fs::create_dir_all(file.parent().expect("a folder")).expect("made");
    let target = folder.path().join("dotfiles.json");
    symlink("../dotfiles.json", &file).expect("a link");
    let first = loaded(&file);
    let light = after(&first, &["theme light"]);
    save(&file, &first, &light);
    let is_link = |file: &Path| fs::symlink_metadata(file).is_ok_and(|meta| meta.is_symlink());
    assert!(is_link(&file) && !is_link(&target), "a link to what was not there yet");
    let private = fs::Permissions::from_mode(0o600);
    fs::set_permissions(&target, private).expect("private");
    save(&file, &light, &after(&light, &["scale 150"]));
    assert!(is_link(&file), "still a link");
    let mode = fs::metadata(&target).expect("there").permissions().mode();
    assert_eq!(mode & 0o777, 0o600, "as private as before");
    assert_eq!(loaded(&file), after(&light, &["scale 150"]), "and the target is written");
}

#[test]
fn a_file_that_cannot_be_written_stays() {
    let (_folder, file) = place();
    fs::create_dir_all(&file).expect("a folder in its place");
    let (read, complaints) = Preferences::load(&file);
    assert_eq!(complaints.len(), 1, "{complaints:?}");
    let mut keeper = Keeper::new(file.clone(), read.clone());
    keeper.finish(after(&read, &["theme light"]));
    assert!(file.is_dir(), "as it was");
    let problem = keeper.problem().expect("it is told");
    assert!(problem.contains("settings cannot be saved in"), "{problem}");
}
