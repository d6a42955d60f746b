//! The materials and textures of a scene, each read once however often it is used.

use std::collections::BTreeMap;

use common::Rgb;
use glam::DMat4;

use super::bsdf;
use super::document::Element;
use crate::scene::description::{BsdfDescription, Coding, ColorInput, Material, Texture};
use crate::scene::diagnostic::{LoadError, Place, Warning};
use crate::scene::texture::read_texture;

/// What stands for a texture that cannot be read.
const UNKNOWN_GREY: f64 = 0.5;

/// Materials and textures read so far.
#[derive(Debug, Default)]
pub(super) struct Palette {
    /// The materials.
    pub(super) materials: Vec<Material>,
    /// Where each was defined.
    pub(super) places: Vec<Place>,
    /// The textures.
    pub(super) textures: Vec<Texture>,
    /// What is not modelled of them.
    pub(super) warnings: Vec<Warning>,
    /// Indices of materials by the element that defines them; `None` for those nobody sees.
    read: BTreeMap<u32, Option<u16>>,
    /// Textures by the element that defines them.
    inputs: BTreeMap<u32, ColorInput>,
    /// Index of the material of shapes that have none.
    default: Option<u16>,
}

impl Palette {
    /// The index of a `bsdf`'s material; `None` for a surface that nobody sees.
    pub(super) fn material(&mut self, element: Element<'_>) -> Result<Option<u16>, LoadError> {
        if let Some(&index) = self.read.get(&element.index()) {
            return Ok(index);
        }
        let index = match bsdf::read(element, self)? {
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
        let BsdfDescription::Dielectric { eta, reflectance, transmittance } = bsdf else {
            return Ok(None);
        };
        let bsdf = BsdfDescription::Dielectric { eta: 1.0 / eta, reflectance, transmittance };
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

    /// What a `texture` amounts to.
    pub(super) fn texture(&mut self, element: Element<'_>) -> Result<ColorInput, LoadError> {
        if let Some(&input) = self.inputs.get(&element.index()) {
            return Ok(input);
        }
        let input = match element.plugin()?.as_str() {
            "bitmap" => self.bitmap(element)?,
            "checkerboard" => self.checkerboard(element)?,
            _ => {
                let message = "no such texture here; those known: bitmap, checkerboard. Grey \
                               stands for it";
                self.warnings.push(element.warning(message));
                Rgb::grey(UNKNOWN_GREY).into()
            }
        };
        self.inputs.insert(element.index(), input);
        Ok(input)
    }

    fn bitmap(&mut self, element: Element<'_>) -> Result<ColorInput, LoadError> {
        let name = element.string("filename")?.ok_or_else(|| {
            element.error("the parameter `filename` is missing: the file with the image")
        })?;
        let raw = element.flag("raw")?;
        if element.transform("to_uv")? != DMat4::IDENTITY {
            self.warnings.push(element.warning("the transform to_uv is ignored"));
        }
        let coding = if raw { Coding::Linear } else { Coding::Srgb };
        let texture = match read_texture(&element.file(&name), coding) {
            Ok(texture) => texture,
            Err(message) => {
                let message = format!("{message}; grey stands for it");
                self.warnings.push(element.warning(message));
                return Ok(Rgb::grey(UNKNOWN_GREY).into());
            }
        };
        let index = u16::try_from(self.textures.len())
            .map_err(|_error| element.error("more than 65,536 textures"))?;
        self.textures.push(texture);
        Ok(ColorInput::Texture { texture: index, factor: Rgb::WHITE })
    }

    /// A checkerboard is its mean colour.
    fn checkerboard(&mut self, element: Element<'_>) -> Result<ColorInput, LoadError> {
        let a = element.color("color0")?.unwrap_or(Rgb::grey(0.4));
        let b = element.color("color1")?.unwrap_or(Rgb::grey(0.2));
        self.warnings.push(element.warning("the checkerboard becomes its mean colour"));
        Ok(((a + b) * 0.5).into())
    }
}
