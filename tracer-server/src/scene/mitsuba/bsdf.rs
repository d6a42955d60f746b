//! Scattering models, as far as the tracer has them.

use common::Rgb;

use super::document::Element;
use super::texture::Textures;
use crate::bsdf::{
    BsdfDescription, ColorInput, Given, LambertDescription, MODELS, Named, NumberInput, mitsuba,
};
use crate::scene::description::Material;
use crate::scene::reading::diagnostic::LoadError;

/// The deepest that models may be nested in one another.
const MAX_NESTING: usize = 16;

/// Plugins that change or choose among the models that are nested in them.
const WRAPPERS: &str = "twosided, mask, bumpmap, normalmap, bump, blendbsdf, mixturebsdf, null";

/// A model as it is read, before it becomes a material.
#[derive(Clone, Copy, Debug)]
struct Model {
    bsdf: BsdfDescription,
    two_sided: bool,
}

/// Reads a `bsdf`; `None` for a surface that nothing sees.
pub(super) fn read(
    element: Element<'_>,
    textures: &mut Textures,
) -> Result<Option<Material>, LoadError> {
    let model = Reader { textures }.model(element, 0)?;
    Ok(model.map(|Model { bsdf, two_sided }| Material {
        two_sided,
        ..Material::new(element.label(), bsdf)
    }))
}

/// The material of a shape without a `bsdf`.
pub(super) fn default_material(emits: bool) -> Material {
    let reflectance = if emits { Rgb::BLACK.into() } else { mitsuba::REFLECTANCE };
    let bsdf = LambertDescription { reflectance };
    Material { two_sided: false, ..Material::new("(default)", bsdf) }
}

struct Reader<'t> {
    textures: &'t mut Textures,
}

impl Reader<'_> {
    fn model(&mut self, element: Element<'_>, depth: usize) -> Result<Option<Model>, LoadError> {
        if depth > MAX_NESTING {
            let message = format!("nested more than {MAX_NESTING} deep, or within itself");
            return Err(element.error(message));
        }
        match element.plugin()?.as_str() {
            "twosided" => {
                let inner = self.nested(element, depth)?;
                Ok(inner.map(|model| Model { two_sided: true, ..model }))
            }
            "mask" | "bumpmap" | "normalmap" | "bump" => {
                self.warn(element, "is ignored; the model nested in it is used");
                self.nested(element, depth)
            }
            "blendbsdf" | "mixturebsdf" => {
                self.warn(element, "only the first of the models in it has an effect");
                self.nested(element, depth)
            }
            "null" => Ok(None),
            plugin => {
                let mut given = Parameters { element, textures: self.textures };
                let read = BsdfDescription::read_plugin(plugin, &mut given);
                let bsdf = read.ok_or_else(|| {
                    let known = MODELS.iter().flat_map(|kind| kind.plugins).copied();
                    let known = known.collect::<Vec<_>>().join(", ");
                    let message =
                        format!("unknown scattering model; supported: {known}, {WRAPPERS}");
                    element.error(message)
                })??;
                Ok(Some(Model { bsdf, two_sided: false }))
            }
        }
    }

    fn warn(&mut self, element: Element<'_>, message: &str) {
        self.textures.warnings.push(element.warning(message));
    }

    fn nested(&mut self, element: Element<'_>, depth: usize) -> Result<Option<Model>, LoadError> {
        let inner = element.objects("bsdf")?;
        let first = inner
            .first()
            .ok_or_else(|| element.error("a `<bsdf>` must be nested in it, or a `<ref>` to one"))?;
        self.model(*first, depth + 1)
    }
}

/// The parameters of one model.
struct Parameters<'e, 't> {
    element: Element<'e>,
    textures: &'t mut Textures,
}

impl<'e> Parameters<'e, '_> {
    /// The element of a parameter that is a texture.
    fn texture(&self, name: &str) -> Result<Option<Element<'e>>, LoadError> {
        Ok(self.element.property(name)?.filter(|value| value.tag() == "texture"))
    }
}

impl Given for Parameters<'_, '_> {
    type Error = LoadError;

    fn color(&mut self, name: &'static str) -> Result<Option<Rgb>, LoadError> {
        self.element.color(name)
    }

    fn color_input(&mut self, name: &'static str) -> Result<Option<ColorInput>, LoadError> {
        match self.texture(name)? {
            Some(texture) => self.textures.input(texture).map(Some),
            None => Ok(self.element.color(name)?.map(ColorInput::from)),
        }
    }

    fn number(&mut self, name: &'static str) -> Result<Option<f64>, LoadError> {
        self.element.number(name)
    }

    fn number_input(&mut self, name: &'static str) -> Result<Option<NumberInput>, LoadError> {
        let Some(texture) = self.texture(name)? else {
            return Ok(self.element.number(name)?.map(NumberInput::from));
        };
        Ok(Some(match self.textures.input(texture)? {
            ColorInput::Texture { texture, .. } => NumberInput::Texture { texture, factor: 1.0 },
            ColorInput::Constant(color) => color.luminance().into(),
        }))
    }

    fn number_or_name(&mut self, name: &'static str) -> Result<Option<Named>, LoadError> {
        match self.element.property(name)? {
            Some(value) if value.tag() == "string" => {
                value.needed("value").map(|name| Some(Named::Name(name)))
            }
            Some(_) | None => Ok(self.element.number(name)?.map(Named::Number)),
        }
    }

    fn word(&mut self, name: &'static str) -> Result<Option<String>, LoadError> {
        self.element.string(name)
    }

    fn flag(&mut self, name: &'static str) -> Result<bool, LoadError> {
        self.element.flag(name)
    }

    fn error(&self, name: &'static str, message: &str) -> LoadError {
        match self.element.property(name) {
            Ok(Some(value)) => value.error(message),
            Ok(None) | Err(_) => self.element.error(format!("{name}: {message}")),
        }
    }

    fn warn(&mut self, message: &str) {
        self.textures.warnings.push(self.element.warning(message));
    }
}
