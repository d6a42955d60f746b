//! `[[materials]]` of the project's own scene file.

use std::collections::BTreeMap;
use std::fmt;

use common::Rgb;
use serde::de::{Error as _, MapAccess, Visitor};
use serde::{Deserialize, Deserializer};

use crate::bsdf::{BsdfDescription, ColorInput, Given, MODELS, ModelKind, Named, NumberInput};
use crate::scene::description::Coding;
use crate::scene::description::check::Fault;

/// `[[materials]]`: how a surface scatters and emits.
#[derive(Clone, Debug)]
pub(crate) struct MaterialEntry {
    /// The name that shapes refer to.
    pub(crate) name: String,
    /// The name of a scattering model: one of [`MODELS`].
    model: String,
    /// False to make the back of an opaque material black; default true.
    pub(crate) two_sided: bool,
    /// Radiance emitted from the front side, a number or `[r, g, b]`; default 0.
    pub(crate) emission: Option<Color>,
    /// All other keys: what the model's [`ModelKind::parameters`] are.
    parameters: BTreeMap<String, Parameter>,
}

impl<'de> Deserialize<'de> for MaterialEntry {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_map(MaterialVisitor)
    }
}

struct MaterialVisitor;

impl<'de> Visitor<'de> for MaterialVisitor {
    type Value = MaterialEntry;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a table with the name of a material, its model, and the model's parameters")
    }

    fn visit_map<M: MapAccess<'de>>(self, mut map: M) -> Result<MaterialEntry, M::Error> {
        let (mut name, mut model) = (None, None);
        let (mut two_sided, mut emission, mut parameters) = (true, None, BTreeMap::new());
        while let Some(key) = map.next_key::<String>()? {
            match key.as_str() {
                "name" => name = Some(map.next_value()?),
                "model" => model = Some(map.next_value()?),
                "two_sided" => two_sided = map.next_value()?,
                "emission" => emission = Some(map.next_value()?),
                _ => {
                    let value = map.next_value()?;
                    parameters.insert(key, value);
                }
            }
        }
        let name = name.ok_or_else(|| M::Error::missing_field("name"))?;
        let model = model.ok_or_else(|| M::Error::missing_field("model"))?;
        Ok(MaterialEntry { name, model, two_sided, emission, parameters })
    }
}

/// What may stand for a parameter of a model.
#[derive(Clone, Debug, Deserialize)]
#[serde(
    untagged,
    expecting = "a number, three numbers [r, g, b], true or false, or { texture = \"file\", factor = 1 }"
)]
enum Parameter {
    /// On or off.
    Flag(bool),
    /// A number or a colour.
    Color(Color),
    /// A name.
    Word(String),
    /// From an image.
    Texture(TextureEntry),
}

/// A grey value or a colour.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(untagged, expecting = "a number, or three numbers [r, g, b]")]
pub(crate) enum Color {
    /// The same in all channels.
    Grey(f64),
    /// Red, green and blue.
    Rgb(Rgb),
}

impl From<Color> for Rgb {
    fn from(color: Color) -> Self {
        match color {
            Color::Grey(value) => Self::grey(value),
            Color::Rgb(rgb) => rgb,
        }
    }
}

/// An image file, relative to the scene file.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct TextureEntry {
    /// A PNG or JPEG file; colours in sRGB, roughness proportional to the code.
    texture: String,
    /// What it is multiplied by, a number or `[r, g, b]`; default 1.
    factor: Option<Color>,
}

/// Reads a texture and gives its index.
pub(crate) trait ReadTexture {
    /// Reads the image file of that name, relative to the scene file.
    fn read(&mut self, file: &str, coding: Coding) -> Result<u16, String>;
}

impl MaterialEntry {
    /// The model with its parameters and what of it is not supported, or the field that is wrong.
    pub(crate) fn bsdf(
        &self,
        textures: &mut impl ReadTexture,
    ) -> Result<(BsdfDescription, Vec<String>), Fault> {
        let unknown = || {
            let known: Vec<&str> = MODELS.iter().map(|kind| kind.name).collect();
            let known = known.join(", ");
            Fault::new(
                "model",
                format!("there is no model `{}`; the models are {known}", self.model),
            )
        };
        let kind = MODELS.iter().find(|kind| kind.name == self.model).ok_or_else(unknown)?;
        self.refuse_strangers(kind)?;
        let mut given = Entry { parameters: &self.parameters, textures, warnings: Vec::new() };
        let read = BsdfDescription::read(&self.model, &mut given).ok_or_else(unknown)?;
        Ok((read?, given.warnings))
    }

    /// Keys that the model does not have.
    fn refuse_strangers(&self, kind: &ModelKind) -> Result<(), Fault> {
        let has = |kind: &ModelKind, key: &str| kind.parameters.iter().any(|p| p.name == key);
        let Some(key) = self.parameters.keys().find(|key| !has(kind, key)) else { return Ok(()) };
        let others = MODELS.iter().filter(|kind| has(kind, key));
        let others: Vec<String> = others.map(|kind| format!("`{}`", kind.name)).collect();
        if others.is_empty() {
            let known: Vec<&str> = kind.parameters.iter().map(|p| p.name).collect();
            let message = format!(
                "unknown field `{key}`; a material has name, model, two_sided and emission, and \
                 `{}` has {}",
                kind.name,
                known.join(", ")
            );
            return Err(Fault::new(key, message));
        }
        let others = match others.as_slice() {
            [only] => format!("the model {only} has"),
            several => format!("the models {} have", several.join(", ")),
        };
        let message = format!("only {others} it; remove it or change the model");
        Err(Fault::new(key, message))
    }
}

/// The parameters of one material.
struct Entry<'a, T> {
    parameters: &'a BTreeMap<String, Parameter>,
    textures: &'a mut T,
    warnings: Vec<String>,
}

impl<T: ReadTexture> Entry<'_, T> {
    fn texture(&mut self, name: &str, entry: &TextureEntry, coding: Coding) -> Result<u16, Fault> {
        self.textures.read(&entry.texture, coding).map_err(|message| Fault::new(name, message))
    }
}

impl<T: ReadTexture> Given for Entry<'_, T> {
    type Error = Fault;

    fn color(&mut self, name: &'static str) -> Result<Option<Rgb>, Fault> {
        match self.parameters.get(name) {
            None => Ok(None),
            Some(Parameter::Color(color)) => Ok(Some((*color).into())),
            Some(Parameter::Texture(_)) => {
                Err(self.error(name, "a texture is not possible here: give a number or [r, g, b]"))
            }
            Some(Parameter::Flag(_) | Parameter::Word(_)) => {
                Err(self.error(name, "expected a number or [r, g, b]"))
            }
        }
    }

    fn color_input(&mut self, name: &'static str) -> Result<Option<ColorInput>, Fault> {
        let Some(Parameter::Texture(entry)) = self.parameters.get(name) else {
            return Ok(self.color(name)?.map(ColorInput::from));
        };
        let texture = self.texture(name, entry, Coding::Srgb)?;
        let factor = entry.factor.map_or(Rgb::WHITE, Rgb::from);
        Ok(Some(ColorInput::Texture { texture, factor }))
    }

    fn number(&mut self, name: &'static str) -> Result<Option<f64>, Fault> {
        match self.parameters.get(name) {
            None => Ok(None),
            Some(Parameter::Color(Color::Grey(number))) => Ok(Some(*number)),
            Some(Parameter::Color(Color::Rgb(_))) => {
                Err(self.error(name, "it must be a single number"))
            }
            Some(Parameter::Texture(_)) => {
                Err(self.error(name, "a texture is not possible here: give a number"))
            }
            Some(Parameter::Flag(_) | Parameter::Word(_)) => {
                Err(self.error(name, "expected a number"))
            }
        }
    }

    fn number_input(&mut self, name: &'static str) -> Result<Option<NumberInput>, Fault> {
        let Some(Parameter::Texture(entry)) = self.parameters.get(name) else {
            return Ok(self.number(name)?.map(NumberInput::from));
        };
        let texture = self.texture(name, entry, Coding::Linear)?;
        let factor = match entry.factor {
            None => 1.0,
            Some(Color::Grey(factor)) => factor,
            Some(Color::Rgb(_)) => {
                return Err(self.error(name, "its factor must be a single number"));
            }
        };
        Ok(Some(NumberInput::Texture { texture, factor }))
    }

    fn number_or_name(&mut self, name: &'static str) -> Result<Option<Named>, Fault> {
        if let Some(Parameter::Word(word)) = self.parameters.get(name) {
            return Ok(Some(Named::Name(word.clone())));
        }
        Ok(self.number(name)?.map(Named::Number))
    }

    fn word(&mut self, name: &'static str) -> Result<Option<String>, Fault> {
        match self.parameters.get(name) {
            None => Ok(None),
            Some(Parameter::Word(word)) => Ok(Some(word.clone())),
            Some(_) => Err(self.error(name, "expected a string in quotes")),
        }
    }

    fn flag(&mut self, name: &'static str) -> Result<bool, Fault> {
        match self.parameters.get(name) {
            None => Ok(false),
            Some(Parameter::Flag(flag)) => Ok(*flag),
            Some(_) => Err(self.error(name, "expected true or false")),
        }
    }

    fn error(&self, name: &'static str, message: &str) -> Fault {
        Fault::new(name, message)
    }

    fn warn(&mut self, message: &str) {
        self.warnings.push(message.to_owned());
    }
}
