//! Where the parts of a description were written, so that validation can name file and line.

use std::path::Path;

use super::diagnostic::Place;
use crate::scene::description::check::Part;

/// The places of a description's parts, in the order of its lists.
#[derive(Clone, Debug)]
pub(crate) struct Origins {
    /// The scene file.
    pub(crate) whole: Place,
    /// The file that tells the camera and the film.
    pub(crate) camera: Place,
    /// One place a material.
    pub(crate) materials: Vec<Place>,
    /// One place a mesh.
    pub(crate) meshes: Vec<Place>,
    /// One place a sphere.
    pub(crate) spheres: Vec<Place>,
    /// One place a light without a surface.
    pub(crate) lights: Vec<Place>,
    /// The scene file's text, where it is TOML: it tells the line of a field.
    text: String,
}

impl Origins {
    /// The places of a TOML scene, still without its parts.
    pub(crate) fn of_text(file: &Path, text: &str) -> Self {
        Self { text: text.to_owned(), ..Self::of_file(file) }
    }

    /// The places of any other scene, still without its parts.
    pub(crate) fn of_file(file: &Path) -> Self {
        Self {
            whole: Place::file(file),
            camera: Place::file(file),
            materials: Vec::new(),
            meshes: Vec::new(),
            spheres: Vec::new(),
            lights: Vec::new(),
            text: String::new(),
        }
    }

    /// The place of one field of a part.
    pub(crate) fn of(&self, part: Part, field: &str) -> Place {
        let listed = |places: &[Place], index: usize| places.get(index).cloned();
        let entry = match part {
            Part::Scene => None,
            Part::Camera => Some(self.table("[camera]", &self.camera)),
            Part::Film => Some(self.table("[film]", &self.camera)),
            Part::Material(index) => listed(&self.materials, index),
            Part::Mesh(index) => listed(&self.meshes, index),
            Part::Sphere(index) => listed(&self.spheres, index),
            Part::Light(index) => listed(&self.lights, index),
        };
        match entry {
            Some(place) => self.field(&place, field),
            // Keys of the scene itself stand before the first table.
            None => match self.find(1, field) {
                Some(line) => Place { line: Some(line), ..self.whole.clone() },
                None => self.whole.clone(),
            },
        }
    }

    /// The line of `field` in the TOML entry that begins at `entry`, or `entry` itself.
    pub(crate) fn field(&self, entry: &Place, field: &str) -> Place {
        let found = match entry.line {
            Some(line) if entry.file == self.whole.file => self.find(line, field),
            _ => None,
        };
        Place { line: found.or(entry.line), ..entry.clone() }
    }

    /// The line of a table's header, where the file is TOML.
    fn table(&self, header: &str, otherwise: &Place) -> Place {
        let index = self.text.lines().position(|line| line.trim().starts_with(header));
        match index {
            Some(index) => Place { line: Some(index + 1), ..self.whole.clone() },
            None => otherwise.clone(),
        }
    }

    /// The first line from `start` on that sets `field`, before the next table begins.
    fn find(&self, start: usize, field: &str) -> Option<usize> {
        let lines = self.text.lines().enumerate().skip(start - 1);
        for (index, line) in lines {
            let line = line.trim_start();
            let is_table = line.starts_with('[') && index + 1 > start;
            if is_table || field.is_empty() {
                return None;
            }
            let value = line.strip_prefix(field).map(str::trim_start);
            if value.is_some_and(|value| value.starts_with('=')) {
                return Some(index + 1);
            }
        }
        None
    }
}
