//! From what a user names to a description that is known to be sound.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};

use super::builtin::{self, Builtin};
use super::description::SceneDescription;
use super::description::check::{Part, Problem, validate};
pub use super::reading::diagnostic::{LoadError, Place, Warning};
use super::reading::origin::Origins;
use super::reading::text::read_utf8;
use super::reading::{DEFAULT_MAX_EDGES, Read, StrategySetting, viewpoint};
use super::{mitsuba, obj, toml};

/// The most bytes of a TOML scene file that are read.
const MAX_TOML_BYTES: u64 = 64 << 20;
/// The most entries of a directory that are searched for a scene.
const MAX_ENTRIES: usize = 10_000;

/// A scene that has been read and checked.
#[derive(Clone, Debug)]
pub struct Loaded {
    /// The scene.
    pub description: SceneDescription,
    /// What it asks for and does not get, or gets in another way.
    pub warnings: Vec<Warning>,
    /// What it asks of the mutation strategies.
    pub strategies: Vec<StrategySetting>,
}

/// Loads a built-in scene by name, a `.toml`, `.obj` or Mitsuba `.xml` file, or a directory that
/// holds one.
///
/// A built-in name comes first; `./NAME` always means a file.
pub fn load(spec: &str) -> Result<Loaded, LoadError> {
    if let Some(builtin) = Builtin::find(spec) {
        return check(toml::read(builtin.text, &builtin.path(), builtin.name)?);
    }
    let path = Path::new(spec);
    if !path.exists() {
        let closest = builtin::closest(spec);
        return Err(LoadError::NotFound {
            spec: spec.to_owned(),
            closest,
            known: builtin::names(),
        });
    }
    let path = if path.is_dir() { only_scene(path)? } else { path.to_path_buf() };
    check(match format_of(&path)? {
        Format::Toml => {
            let text = read_utf8(&path, MAX_TOML_BYTES)?;
            toml::read(text.trim_start_matches('\u{feff}'), &path, &stem(&path))?
        }
        Format::Obj => read_obj(&path)?,
        Format::Mitsuba => mitsuba::read(&path, &stem(&path))?,
    })
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Format {
    Toml,
    Obj,
    Mitsuba,
}

fn format_of(path: &Path) -> Result<Format, LoadError> {
    let extension = path.extension().and_then(OsStr::to_str).unwrap_or("").to_ascii_lowercase();
    let kind = match extension.as_str() {
        "toml" => return Ok(Format::Toml),
        "obj" => return Ok(Format::Obj),
        "xml" => return Ok(Format::Mitsuba),
        "gltf" | "glb" => "glTF".to_owned(),
        "" => "extensionless".to_owned(),
        other => format!(".{other}"),
    };
    Err(LoadError::Unsupported { path: path.to_path_buf(), kind })
}

fn stem(path: &Path) -> String {
    path.file_stem().unwrap_or(path.as_os_str()).to_string_lossy().into_owned()
}

/// The scene file of a directory: its only `.toml`, or else its only `.xml`, or else its only
/// `.obj`.
fn only_scene(directory: &Path) -> Result<PathBuf, LoadError> {
    let unreadable = |source| LoadError::Unreadable { path: directory.to_path_buf(), source };
    let mut found: Vec<(Format, PathBuf)> = Vec::new();
    for entry in std::fs::read_dir(directory).map_err(unreadable)?.take(MAX_ENTRIES) {
        let path = entry.map_err(unreadable)?.path();
        if let Ok(format) = format_of(&path) {
            found.push((format, path));
        }
    }
    for format in [Format::Toml, Format::Mitsuba, Format::Obj] {
        let mut scenes = found.iter().filter(|(found, _)| *found == format);
        match (scenes.next(), scenes.next()) {
            (Some((_, scene)), None) => return Ok(scene.clone()),
            (None, _) => {}
            (Some(_), Some(_)) => break,
        }
    }
    let mut found: Vec<String> = found
        .iter()
        .filter_map(|(_, path)| Some(path.file_name()?.to_string_lossy().into_owned()))
        .collect();
    found.sort();
    Err(LoadError::Directory { path: directory.to_path_buf(), found })
}

fn read_obj(path: &Path) -> Result<Read, LoadError> {
    let scene = obj::read(path)?;
    let mut origins = Origins::of_file(path);
    origins.materials = scene.places;
    origins.meshes = vec![Place::file(path); scene.meshes.len()];

    let json = path.with_file_name("camera.json");
    let view = if json.is_file() {
        origins.camera = Place::file(&json);
        viewpoint::read_json(&json)?
    } else {
        viewpoint::guess(&scene.meshes)
    };
    let description = SceneDescription {
        materials: scene.materials,
        textures: scene.textures,
        meshes: scene.meshes,
        ..SceneDescription::empty(
            stem(path),
            view.camera,
            [view.width, view.height],
            DEFAULT_MAX_EDGES,
        )
    };
    Ok(Read { description, origins, warnings: scene.warnings, strategies: Vec::new() })
}

/// The first warnings as lines below an error: what went before often tells why.
fn notes(warnings: &[Warning]) -> String {
    const LISTED: usize = 4;
    let note = |warning: &Warning| format!("\n  note: {warning}");
    let mut notes: Vec<String> = warnings.iter().take(LISTED).map(note).collect();
    if warnings.len() > LISTED {
        notes.push(format!("\n  and {} more", warnings.len() - LISTED));
    }
    notes.concat()
}

/// Validates what was read; problems and repairs are reported with their place.
fn check(read: Read) -> Result<Loaded, LoadError> {
    let Read { mut description, origins, mut warnings, strategies } = read;
    let names: Vec<String> = description.meshes.iter().map(|mesh| mesh.name.clone()).collect();
    let dropped = validate(&mut description).map_err(|problem| {
        let subject = subject_of(&description, &problem);
        let notes = notes(&warnings);
        let message = format!("{subject}{}{notes}", problem.message);
        origins.of(problem.part, &problem.field).error(message)
    })?;
    for drop in dropped {
        let name = names.get(drop.mesh).map_or("", String::as_str);
        let place = origins.of(Part::Mesh(drop.mesh), "");
        warnings.push(place.warning(format!(
            "mesh `{name}`: {} triangles without area were ignored",
            drop.triangles
        )));
    }
    Ok(Loaded { description, warnings, strategies })
}

/// "material `red`, eta: ", or nothing for what is wrong with the whole.
fn subject_of(description: &SceneDescription, problem: &Problem) -> String {
    let named = |kind: &str, name: Option<&String>| match (name, problem.field.as_str()) {
        (Some(name), "") => format!("{kind} `{name}`: "),
        (Some(name), field) => format!("{kind} `{name}`, {field}: "),
        (None, _) => String::new(),
    };
    match problem.part {
        Part::Scene | Part::Film => String::new(),
        Part::Camera if problem.field.is_empty() => String::new(),
        Part::Camera => format!("camera, {}: ", problem.field),
        Part::Material(i) => named("material", description.materials.get(i).map(|m| &m.name)),
        Part::Mesh(i) => named("mesh", description.meshes.get(i).map(|m| &m.name)),
        Part::Sphere(i) => named("sphere", description.spheres.get(i).map(|s| &s.name)),
        Part::Light(i) => named("light", description.lights.get(i).map(|l| &l.name)),
    }
}
