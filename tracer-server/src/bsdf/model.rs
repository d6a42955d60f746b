//! What an author may ask for: a scattering model with its parameters, before it is built.
//!
//! A model says once what its parameters are ([`Model::parameters`]); checks, digests, textures and
//! tables follow from that. It reads them by their names from any format that answers to [`Given`].

use std::fmt::Debug;

use common::Rgb;

use super::ggx::SMOOTH;
use super::{Bsdf, BsdfDescription};

/// A scattering model as its author describes it.
pub trait Model: Copy + Debug + PartialEq {
    /// The name in the project's own scene files.
    const NAME: &'static str;
    /// What it is, for people.
    const ABOUT: &'static str;
    /// What the project's own scene files may say of it.
    const PARAMETERS: &'static [Parameter];
    /// What Mitsuba calls it, and models that come near it.
    const PLUGINS: &'static [&'static str] = &[];

    /// Reads the parameters of the project's own scene files.
    fn read<G: Given>(given: &mut G) -> Result<Self, G::Error>;

    /// Reads the parameters that Mitsuba gives the model of one of [`Model::PLUGINS`].
    fn read_plugin<G: Given>(_plugin: &str, given: &mut G) -> Result<Self, G::Error> {
        Self::read(given)
    }

    /// Shows every parameter under its name.
    fn parameters(&mut self, see: &mut dyn FnMut(&'static str, Value<'_>));

    /// The model that scatters, with inputs read where it is wanted.
    fn build(&self, inputs: &impl Inputs) -> Bsdf;

    /// As [`Model::build`], where the model was `built` before with other inputs: for those to which
    /// building is dear.
    fn rebuild(&self, _built: &Bsdf, inputs: &impl Inputs) -> Bsdf {
        self.build(inputs)
    }

    /// The model of a surface that is turned inside out; `None` where that makes no difference.
    fn inside_out(&self) -> Option<Self> {
        None
    }
}

/// A parameter of a model in the project's own scene files.
#[derive(Clone, Copy, Debug)]
pub struct Parameter {
    /// Its name.
    pub name: &'static str,
    /// What it is, and what stands for it where it is not given.
    pub about: &'static str,
}

/// A parameter, and what it may be.
#[derive(Debug)]
pub enum Value<'a> {
    /// A share of the light.
    Share(&'a mut Rgb),
    /// A share of the light.
    ShareInput(&'a mut ColorInput),
    /// An index of refraction, or an extinction coefficient, a channel.
    Indices(&'a mut Rgb),
    /// A number within a range.
    Number(&'a mut f64, Range),
    /// A number within a range.
    NumberInput(&'a mut NumberInput, Range),
    /// On or off.
    Flag(&'a mut bool),
}

impl Value<'_> {
    /// The texture that it is read from.
    pub fn texture(&mut self) -> Option<&mut u16> {
        match self {
            Value::ShareInput(ColorInput::Texture { texture, .. })
            | Value::NumberInput(NumberInput::Texture { texture, .. }, _) => Some(texture),
            Value::ShareInput(ColorInput::Constant(_))
            | Value::NumberInput(NumberInput::Constant(_), _)
            | Value::Share(_)
            | Value::Indices(_)
            | Value::Number(..)
            | Value::Flag(_) => None,
        }
    }
}

/// Where a number may lie.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    /// The least that it may be.
    pub low: f64,
    /// The most that it may be.
    pub high: f64,
    /// What it is then, for messages.
    pub about: &'static str,
}

impl Range {
    /// Alpha of GGX.
    pub const ROUGHNESS: Self = Self { low: 0.0, high: 1.0, about: "0 is smooth, 1 is matt" };
    /// Index of refraction: beyond these it is a mistake.
    pub const INDEX: Self =
        Self { low: 1e-3, high: 1e3, about: "an index of refraction, 1.5 for glass" };
}

/// A number that is the same everywhere, or read from a texture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NumberInput {
    /// The same everywhere.
    Constant(f64),
    /// The texture's luminance times a factor.
    Texture {
        /// Index into the scene's textures.
        texture: u16,
        /// What it is multiplied by.
        factor: f64,
    },
}

impl From<f64> for NumberInput {
    fn from(number: f64) -> Self {
        Self::Constant(number)
    }
}

/// A colour that is the same everywhere, or read from a texture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ColorInput {
    /// The same everywhere.
    Constant(Rgb),
    /// The texture's colour times a factor.
    Texture {
        /// Index into the scene's textures.
        texture: u16,
        /// What each channel is multiplied by, in [0, 1].
        factor: Rgb,
    },
}

impl From<Rgb> for ColorInput {
    fn from(color: Rgb) -> Self {
        Self::Constant(color)
    }
}

/// Where inputs are read: on the average over a texture, or at a point of it.
pub trait Inputs {
    /// The colour of an input.
    fn color(&self, input: ColorInput) -> Rgb;

    /// The number of an input.
    fn number(&self, input: NumberInput) -> f64;
}

/// What a scene file gives a model: parameters by name, whatever the format. A parameter that is not
/// given is `None`; one that is something else than asked for is an error.
pub trait Given {
    /// What is wrong, and where.
    type Error;

    /// A colour.
    fn color(&mut self, name: &'static str) -> Result<Option<Rgb>, Self::Error>;

    /// A colour or a texture.
    fn color_input(&mut self, name: &'static str) -> Result<Option<ColorInput>, Self::Error>;

    /// A number.
    fn number(&mut self, name: &'static str) -> Result<Option<f64>, Self::Error>;

    /// A number or a texture.
    fn number_input(&mut self, name: &'static str) -> Result<Option<NumberInput>, Self::Error>;

    /// A number, or the name of something that has one.
    fn number_or_name(&mut self, name: &'static str) -> Result<Option<Named>, Self::Error>;

    /// A word.
    fn word(&mut self, name: &'static str) -> Result<Option<String>, Self::Error>;

    /// On or off; off where it is not given.
    fn flag(&mut self, name: &'static str) -> Result<bool, Self::Error>;

    /// What is wrong with a parameter.
    fn error(&self, name: &'static str, message: &str) -> Self::Error;

    /// Tells the author that something is not modelled as it is written.
    fn warn(&mut self, message: &str);

    /// A colour or texture without which the model is none.
    fn needed_color_input(&mut self, name: &'static str) -> Result<ColorInput, Self::Error> {
        self.color_input(name)?.ok_or_else(|| self.error(name, COLOR_NEEDED))
    }

    /// A colour without which the model is none.
    fn needed_color(&mut self, name: &'static str) -> Result<Rgb, Self::Error> {
        self.color(name)?.ok_or_else(|| self.error(name, COLOR_NEEDED))
    }
}

const COLOR_NEEDED: &str = "this model requires it: a number or [r, g, b] in [0, 1]";

/// A number, or the name of something that has one.
#[derive(Clone, Debug, PartialEq)]
pub enum Named {
    /// The number itself.
    Number(f64),
    /// A name.
    Name(String),
}

impl NumberInput {
    /// True for a roughness below which facets are none. A texture is rough everywhere, so that the
    /// kind of an event does not depend on the place.
    pub(super) fn is_smooth(self) -> bool {
        match self {
            Self::Constant(alpha) => alpha < SMOOTH,
            Self::Texture { .. } => false,
        }
    }
}

impl BsdfDescription {
    /// The same model reading textures that are `by` places further on in the list.
    #[must_use]
    pub fn with_textures_after(mut self, by: u16) -> Self {
        self.parameters(&mut |_, mut value| {
            if let Some(texture) = value.texture() {
                *texture = texture.saturating_add(by);
            }
        });
        self
    }

    /// True when it reads a texture.
    pub fn is_textured(mut self) -> bool {
        let mut found = false;
        self.parameters(&mut |_, mut value| found |= value.texture().is_some());
        found
    }

    /// The first texture that a colour is read from, and what that is multiplied by.
    pub fn color_texture(mut self) -> Option<(u16, Rgb)> {
        let mut found = None;
        self.parameters(&mut |_, value| {
            if let Value::ShareInput(ColorInput::Texture { texture, factor }) = value {
                found = found.or(Some((*texture, *factor)));
            }
        });
        found
    }
}
