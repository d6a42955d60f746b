//! The scenes that come with the program: the files of the folder `scenes/`, embedded.
//!
//! To add one: its TOML file there, and one line here.

use std::path::{Path, PathBuf};

use super::reading::diagnostic::LoadError;
use super::toml;

/// A built-in scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Builtin {
    /// The name that stands for it wherever a scene is asked for.
    pub name: &'static str,
    /// Its TOML file.
    pub text: &'static str,
}

/// All of them, the gentlest first.
pub const BUILTINS: &[Builtin] = &[
    Builtin { name: "cornell", text: include_str!("../../../scenes/cornell.toml") },
    Builtin { name: "caustic", text: include_str!("../../../scenes/caustic.toml") },
    Builtin { name: "mirror-caustic", text: include_str!("../../../scenes/mirror-caustic.toml") },
    Builtin { name: "door", text: include_str!("../../../scenes/door.toml") },
    Builtin { name: "terrace", text: include_str!("../../../scenes/terrace.toml") },
    Builtin { name: "furnace", text: include_str!("../../../scenes/furnace.toml") },
];

impl Builtin {
    /// The built-in scene of that name.
    pub fn find(name: &str) -> Option<&'static Self> {
        BUILTINS.iter().find(|builtin| builtin.name == name)
    }

    /// What messages call its file.
    pub fn path(&self) -> PathBuf {
        Path::new("scenes").join(format!("{}.toml", self.name))
    }

    /// One line for people: what there is to see.
    pub fn summary(&self) -> Result<String, LoadError> {
        toml::parse(self.text, &self.path()).map(|scene| scene.description)
    }
}

/// The names of all built-in scenes.
pub(crate) fn names() -> Vec<&'static str> {
    BUILTINS.iter().map(|builtin| builtin.name).collect()
}

/// The built-in name nearest to a misspelt one, if any is near.
pub(crate) fn closest(name: &str) -> Option<&'static str> {
    // Arguments may be long paths; no built-in name is near those.
    if name.len() > 40 {
        return None;
    }
    let nearest = names().into_iter().map(|known| (edit_distance(name, known), known)).min()?;
    (nearest.0 <= 1 + nearest.1.len() / 4).then_some(nearest.1)
}

/// The number of characters to insert, remove or replace to make one word the other.
fn edit_distance(a: &str, b: &str) -> usize {
    let mut row: Vec<usize> = (0..=b.chars().count()).collect();
    for (i, from) in a.chars().enumerate() {
        let mut diagonal = i;
        let mut left = i + 1;
        for (cell, to) in row.iter_mut().skip(1).zip(b.chars()) {
            let replaced = diagonal + usize::from(from != to);
            diagonal = *cell;
            left = replaced.min(diagonal + 1).min(left + 1);
            *cell = left;
        }
        if let Some(first) = row.first_mut() {
            *first = i + 1;
        }
    }
    row.last().copied().unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances() {
        for (a, b, distance) in [
            ("", "", 0),
            ("door", "door", 0),
            ("dor", "door", 1),
            ("abc", "", 3),
            ("cat", "act", 2),
        ] {
            assert_eq!(edit_distance(a, b), distance, "{a} {b}");
            assert_eq!(edit_distance(b, a), distance, "{b} {a}");
        }
    }

    #[test]
    fn misspelt_names_are_recognised() {
        assert_eq!(closest("cornel"), Some("cornell"));
        assert_eq!(closest("mirror_caustic"), Some("mirror-caustic"));
        assert_eq!(closest("kitchen"), None);
    }
}
