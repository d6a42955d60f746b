//! What a filter needs to know of a scene: names, and the frame of its coordinates.

use std::ops::Range;

use super::error::closest;
use super::{FilterError, Name, NameList};
use crate::{MaterialInfo, Rgb, SceneFrame, SceneMesh};

/// A complaint lists no more names than this.
const MAX_LISTED: usize = 12;
/// What made a path that no strategy did.
const SEED: &str = "seed";

/// The names of a scene, and the frame of its coordinates: what filters on its paths may ask for.
#[derive(Clone, Debug, PartialEq)]
pub struct FilterScene {
    /// How scene units relate to those of the file.
    pub frame: SceneFrame,
    /// The materials and, after them, the lights without a surface, in the order of their indices.
    pub materials: Vec<FilterMaterial>,
    /// Names of the mutation strategies, in the order of their indices.
    pub strategies: Vec<String>,
    /// The objects that have names.
    pub objects: Vec<FilterObject>,
}

/// A material by name.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct FilterMaterial {
    /// Its name; others may have the same.
    pub name: String,
    /// Something of it is a light.
    pub is_light: bool,
    /// It is the environment.
    pub is_background: bool,
}

/// An object by name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FilterObject {
    /// Its name; others may have the same.
    pub name: String,
    /// Its primitives.
    pub primitives: Range<u32>,
}

impl From<&MaterialInfo> for FilterMaterial {
    fn from(material: &MaterialInfo) -> Self {
        Self {
            name: material.name.clone(),
            is_light: material.emission != Rgb::BLACK,
            is_background: material.model == "environment",
        }
    }
}

impl From<&str> for FilterMaterial {
    /// A material that is no light.
    fn from(name: &str) -> Self {
        Self { name: name.to_owned(), ..Self::default() }
    }
}

impl FilterScene {
    /// What filters on the paths of a scene may ask for.
    pub fn new(frame: SceneFrame, mesh: &SceneMesh, strategies: Vec<String>) -> Self {
        let materials = mesh.materials.iter().map(FilterMaterial::from).collect();
        Self { frame, materials, strategies, objects: mesh.objects.clone() }
    }

    /// The names of a list, each once, in the order of menus.
    pub fn names(&self, list: NameList) -> Vec<&str> {
        let materials = |wanted: fn(&FilterMaterial) -> bool| -> Vec<&str> {
            let wanted = self.materials.iter().filter(|material| wanted(material));
            wanted.map(|material| material.name.as_str()).collect()
        };
        let mut names: Vec<&str> = match list {
            NameList::Objects => self.objects.iter().map(|object| object.name.as_str()).collect(),
            NameList::Materials => materials(|_| true),
            NameList::Lights => materials(|material| material.is_light),
            NameList::Strategies => {
                return self.strategies.iter().map(String::as_str).chain([SEED]).collect();
            }
        };
        names.retain(|name| !name.is_empty());
        names.sort_unstable();
        names.dedup();
        names
    }

    /// The index of the environment among the materials.
    pub(super) fn background(&self) -> Option<u16> {
        let index = self.materials.iter().position(|material| material.is_background)?;
        u16::try_from(index).ok()
    }

    /// For each material, whether it is called `name`; some must be. Where a light is asked for, other
    /// names are proposed.
    pub(super) fn materials_named(
        &self,
        list: NameList,
        name: &Name,
    ) -> Result<Vec<bool>, FilterError> {
        let named: Vec<bool> = self.materials.iter().map(|m| m.name == name.text).collect();
        if named.contains(&true) { Ok(named) } else { Err(self.unknown(list, name)) }
    }

    /// The primitives of all objects called `name`; some must be.
    pub(super) fn objects_named(&self, name: &Name) -> Result<Vec<Range<u32>>, FilterError> {
        let named = self.objects.iter().filter(|object| object.name == name.text);
        let primitives: Vec<_> = named.map(|object| object.primitives.clone()).collect();
        if primitives.is_empty() {
            Err(self.unknown(NameList::Objects, name))
        } else {
            Ok(primitives)
        }
    }

    /// The index of the strategy called `name`.
    pub(super) fn strategy_named(&self, name: &Name) -> Result<u8, FilterError> {
        if name.text == SEED {
            return Ok(u8::MAX);
        }
        let same = |known: &String| is_same_strategy(known, &name.text);
        let found = self.strategies.iter().position(same);
        let index = found.and_then(|index| u8::try_from(index).ok());
        index.ok_or_else(|| self.unknown(NameList::Strategies, name))
    }

    /// The complaint that nothing of its kind is called `name`.
    fn unknown(&self, list: NameList, name: &Name) -> FilterError {
        let mut known = self.names(list);
        let kind = list.kind();
        let remedy = if known.is_empty() {
            format!("it has no {kind} with a name")
        } else if let Some(nearest) = closest(&name.text, known.iter().copied()) {
            format!("did you mean \"{nearest}\"?")
        } else {
            let more = if known.len() > MAX_LISTED { ", ..." } else { "" };
            known.truncate(MAX_LISTED);
            format!("it has: {}{more}", known.join(", "))
        };
        let span = name.offset..name.offset + name.text.len();
        FilterError::new(span, format!("this scene has no {kind} \"{}\"; {remedy}", name.text))
    }
}

/// Whether two names mean the same strategy: `-` and `_` are as good as blanks.
pub fn is_same_strategy(a: &str, b: &str) -> bool {
    let plain = |name: &str| name.replace(['-', '_'], " ");
    plain(a) == plain(b)
}
