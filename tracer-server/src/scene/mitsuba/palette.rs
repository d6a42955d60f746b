//! The materials of a scene, each read once however often it is used.

use std::collections::BTreeMap;

use common::Rgb;

use super::bsdf;
use super::document::Element;
use super::texture::Textures;
use crate::scene::description::Material;
use crate::scene::reading::diagnostic::{LoadError, Place};

/// Materials read so far.
#[derive(Debug, Default)]
pub(super) struct Palette {
    /// The materials.
    pub(super) materials: Vec<Material>,
    /// Where each was defined.
    pub(super) places: Vec<Place>,
    /// The textures that they read.
    pub(super) textures: Textures,
    /// Indices of materials by the element that defines them; `None` for those nobody sees.
    read: BTreeMap<u32, Option<u16>>,
    /// Index of the material of shapes that have none.
    default: Option<u16>,
}

impl Palette {
    /// The index of a `bsdf`'s material; `None` for a surface that nobody sees.
    pub(super) fn material(&mut self, element: Element<'_>) -> Result<Option<u16>, LoadError> {
        if let Some(&index) = self.read.get(&element.index()) {
            return Ok(index);
        }
        let index = match bsdf::read(element, &mut self.textures)? {
            Some(material) => Some(self.add(material, element.place())?),
            None => None,
        };
        self.read.insert(element.index(), index);
        Ok(index)
    }

    /// The index of the material of shapes that have none and emit nothing.
    pub(super) fn default_material(&mut self, place: Place) -> Result<u16, LoadError> {
        if let Some(index) = self.default {
            return Ok(index);
        }
        let index = self.add(bsdf::default_material(false), place)?;
        self.default = Some(index);
        Ok(index)
    }

    /// A material that is as that of `base` but emits, for one shape.
    pub(super) fn lamp(
        &mut self,
        base: Option<u16>,
        name: &str,
        emission: Rgb,
        place: Place,
    ) -> Result<u16, LoadError> {
        let base = base.and_then(|index| self.materials.get(usize::from(index)).cloned());
        let base = base.unwrap_or_else(|| bsdf::default_material(true));
        self.add(Material { name: name.to_owned(), emission, ..base }, place)
    }

    /// The index of a transparent material with its two sides exchanged; `None` if it is opaque.
    pub(super) fn inside_out(
        &mut self,
        index: u16,
        place: Place,
    ) -> Result<Option<u16>, LoadError> {
        let material = self.materials.get(usize::from(index)).cloned();
        let Some(Material { name, bsdf, two_sided, emission }) = material else { return Ok(None) };
        let Some(bsdf) = bsdf.inside_out() else { return Ok(None) };
        let name = format!("{name}, inside out");
        self.add(Material { name, bsdf, two_sided, emission }, place).map(Some)
    }

    fn add(&mut self, material: Material, place: Place) -> Result<u16, LoadError> {
        let index = u16::try_from(self.materials.len())
            .map_err(|_error| place.clone().error("more than 65,536 materials"))?;
        self.materials.push(material);
        self.places.push(place);
        Ok(index)
    }
}
