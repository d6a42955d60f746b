//! What a filter needs to know of a scene: names, and the frame of its coordinates.

use std::ops::Range;

use super::{FilterError, Name};
use crate::{MaterialInfo, SceneFrame};

/// Two names of at least this Jaro-Winkler similarity may have been mixed up.
const SIMILAR: f64 = 0.75;
/// A complaint lists no more names than this.
const MAX_LISTED: usize = 12;

/// The names of a scene, and the frame of its coordinates.
#[derive(Clone, Debug, PartialEq)]
pub struct FilterScene {
    /// How scene units relate to those of the file.
    pub frame: SceneFrame,
    /// Names of the materials and, after them, of the lights without a surface, in the order of their
    /// indices.
    pub materials: Vec<String>,
    /// Index of the environment among them.
    pub background: Option<u16>,
    /// Names of the mutation strategies, in the order of their indices.
    pub strategies: Vec<String>,
    /// The objects that have names.
    pub objects: Vec<FilterObject>,
}

/// An object by name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FilterObject {
    /// Its name; others may have the same.
    pub name: String,
    /// Its primitives.
    pub primitives: Range<u32>,
}

impl FilterScene {
    /// The index of the environment among the materials that travel with a scene.
    pub fn background_among(materials: &[MaterialInfo]) -> Option<u16> {
        let index = materials.iter().position(|material| material.model == "environment")?;
        u16::try_from(index).ok()
    }

    /// How many materials there are.
    pub(super) fn material_count(&self) -> usize {
        self.materials.len()
    }

    /// For each material, whether it is called `name`; some must be.
    pub(super) fn materials_named(&self, name: &Name) -> Result<Vec<bool>, FilterError> {
        let named: Vec<bool> = self.materials.iter().map(|known| *known == name.text).collect();
        if named.contains(&true) {
            return Ok(named);
        }
        let known: Vec<&str> = self.materials.iter().map(String::as_str).collect();
        Err(unknown("material", name, known))
    }

    /// The primitives of all objects called `name`; some must be.
    pub(super) fn objects_named(&self, name: &Name) -> Result<Vec<Range<u32>>, FilterError> {
        let named = self.objects.iter().filter(|object| object.name == name.text);
        let primitives: Vec<_> = named.map(|object| object.primitives.clone()).collect();
        if !primitives.is_empty() {
            return Ok(primitives);
        }
        let known: Vec<&str> = self.objects.iter().map(|object| object.name.as_str()).collect();
        Err(unknown("object", name, known))
    }

    /// The index of the strategy called `name`, with `-` and `_` as good as blanks.
    pub(super) fn strategy_named(&self, name: &Name) -> Result<u8, FilterError> {
        const SEED: &str = "seed";
        let plain = |text: &str| text.replace(['-', '_'], " ");
        if name.text == SEED {
            return Ok(u8::MAX);
        }
        let found = self.strategies.iter().position(|known| plain(known) == plain(&name.text));
        let index = found.and_then(|index| u8::try_from(index).ok());
        index.ok_or_else(|| {
            let names = self.strategies.iter().map(String::as_str).chain([SEED]);
            unknown("strategy", name, names.collect())
        })
    }
}

/// The complaint that nothing of its kind is called `name`.
fn unknown(kind: &str, name: &Name, mut known: Vec<&str>) -> FilterError {
    let likeness = |known: &str| strsim::jaro_winkler(known, &name.text);
    known.sort_unstable();
    known.dedup();
    let nearest = known.iter().copied().max_by(|a, b| likeness(a).total_cmp(&likeness(b)));
    let remedy = match nearest {
        None => format!("it has no {kind} with a name"),
        Some(nearest) if likeness(nearest) >= SIMILAR => format!("did you mean \"{nearest}\"?"),
        Some(_) => {
            let more = if known.len() > MAX_LISTED { ", ..." } else { "" };
            known.truncate(MAX_LISTED);
            format!("it has: {}{more}", known.join(", "))
        }
    };
    let span = name.offset..name.offset + name.text.len();
    FilterError::new(span, format!("this scene has no {kind} \"{}\"; {remedy}", name.text))
}
