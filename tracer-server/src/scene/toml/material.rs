//! `[[materials]]` of the project's own scene file.

use common::Rgb;
use serde::Deserialize;

use crate::bsdf::Fresnel;
use crate::scene::description::{BsdfDescription, Coding, ColorInput, NumberInput};

/// `[[materials]]`: how a surface scatters and emits.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct MaterialEntry {
    /// The name that shapes refer to.
    pub(crate) name: String,
    /// `"lambert"`, `"mirror"`, `"dielectric"`, `"conductor"` or `"plastic"`.
    model: Model,
    /// Share of light reflected, in [0, 1]: a number or `[r, g, b]`; for `lambert` and `plastic`
    /// (the base below the coat) also `{ texture = "file.png", factor = 1 }`. Needed by `lambert`,
    /// `mirror` and `plastic`; a tint of what is reflected for `dielectric` and for a `conductor`
    /// with `eta` and `k`, default 1.
    reflectance: Option<ColorEntry>,
    /// `dielectric` only: tint of what is refracted at each crossing, in [0, 1]; default 1.
    transmittance: Option<Color>,
    /// Index of refraction: for `dielectric`, needed, that behind the surface over that in front;
    /// for `plastic` that of the coat, default 1.5; for `conductor` that of the metal, also
    /// `[r, g, b]`.
    eta: Option<Color>,
    /// `conductor` only: extinction coefficient, a number or `[r, g, b]`.
    k: Option<Color>,
    /// `conductor` and `plastic`: what a facet reflects at normal incidence, in place of the
    /// indices; more at other angles by Schlick's approximation.
    specular: Option<Color>,
    /// `dielectric`, `conductor` and `plastic`: alpha of GGX in [0, 1]; default 0, smooth. For the
    /// first two also `{ texture = "file.png", factor = 1 }`.
    roughness: Option<NumberEntry>,
    /// `plastic` only: true when light that goes to and fro below the coat takes on the base's
    /// colour each time; default false.
    #[serde(default)]
    nonlinear: bool,
    /// False to make the back of an opaque material black; default true.
    #[serde(default = "yes")]
    pub(crate) two_sided: bool,
    /// Radiance emitted from the front side, a number or `[r, g, b]`; default 0.
    pub(crate) emission: Option<Color>,
}

fn yes() -> bool {
    true
}

/// A scattering model.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
enum Model {
    /// Ideal diffuse reflection.
    Lambert,
    /// Ideal mirror.
    Mirror,
    /// A boundary between two transparent media.
    Dielectric,
    /// A metal.
    Conductor,
    /// Diffuse paint under a transparent coat.
    Plastic,
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

/// A colour, or a texture.
#[derive(Clone, Debug, Deserialize)]
#[serde(
    untagged,
    expecting = "a number, three numbers [r, g, b], or { texture = \"file\", factor = 1 }"
)]
enum ColorEntry {
    /// The same everywhere.
    Constant(Color),
    /// From an image.
    Texture(TextureEntry),
}

/// A number, or a texture.
#[derive(Clone, Debug, Deserialize)]
#[serde(untagged, expecting = "a number, or { texture = \"file\", factor = 1 }")]
enum NumberEntry {
    /// The same everywhere.
    Constant(f64),
    /// From an image.
    Texture(TextureEntry),
}

/// The field that is amiss, and a message.
pub(crate) type Fault = (&'static str, String);

/// Reads a texture and gives its index.
pub(crate) trait ReadTexture {
    /// Reads the image file of that name, relative to the scene file.
    fn read(&mut self, file: &str, coding: Coding) -> Result<u16, String>;
}

impl MaterialEntry {
    /// The model with its parameters, or the field that is amiss.
    pub(crate) fn bsdf(&self, textures: &mut impl ReadTexture) -> Result<BsdfDescription, Fault> {
        self.refuse_strangers()?;
        let tint = self.constant_reflectance();
        match self.model {
            Model::Lambert => Ok(BsdfDescription::Lambert { reflectance: self.base(textures)? }),
            Model::Mirror => {
                Ok(BsdfDescription::Mirror { reflectance: tint?.ok_or_else(reflectance_needed)? })
            }
            Model::Dielectric => {
                let missing = || fault("eta", "the model `dielectric` needs it (glass is 1.5)");
                let eta = self.index()?.ok_or_else(missing)?;
                let reflectance = tint?.unwrap_or(Rgb::WHITE);
                let transmittance = self.transmittance.map_or(Rgb::WHITE, Rgb::from);
                Ok(match self.rough(textures)? {
                    Some(roughness) => BsdfDescription::RoughDielectric {
                        eta,
                        reflectance,
                        transmittance,
                        roughness,
                    },
                    None => BsdfDescription::Dielectric { eta, reflectance, transmittance },
                })
            }
            Model::Conductor => {
                let fresnel = match (self.specular, self.eta, self.k) {
                    (Some(specular), None, None) => Fresnel::Schlick(specular.into()),
                    (None, Some(eta), Some(k)) => Fresnel::Conductor {
                        eta: eta.into(),
                        k: k.into(),
                        tint: tint?.unwrap_or(Rgb::WHITE),
                    },
                    _ => {
                        let message = "give either specular, or eta and k, for a conductor";
                        return Err(fault("model", message));
                    }
                };
                let roughness = self.rough(textures)?.unwrap_or(NumberInput::Constant(0.0));
                Ok(BsdfDescription::Conductor { fresnel, roughness })
            }
            Model::Plastic => {
                let fresnel = match (self.specular, self.index()?) {
                    (Some(_), Some(_)) => {
                        return Err(fault("specular", "give either specular or eta for a coat"));
                    }
                    (Some(specular), None) => Fresnel::Schlick(specular.into()),
                    (None, eta) => {
                        Fresnel::Dielectric { eta: eta.unwrap_or(1.5), tint: Rgb::WHITE }
                    }
                };
                let roughness = match self.roughness {
                    None => 0.0,
                    Some(NumberEntry::Constant(roughness)) => roughness,
                    Some(NumberEntry::Texture(_)) => {
                        let message = "the roughness of a coat is a number, the same everywhere";
                        return Err(fault("roughness", message));
                    }
                };
                let (diffuse, nonlinear) = (self.base(textures)?, self.nonlinear);
                Ok(BsdfDescription::Plastic { diffuse, fresnel, roughness, nonlinear })
            }
        }
    }

    /// Fields that another model has.
    fn refuse_strangers(&self) -> Result<(), Fault> {
        use Model::{Conductor, Dielectric, Plastic};
        let fields = [
            ("transmittance", self.transmittance.is_some(), &[Dielectric][..]),
            ("eta", self.eta.is_some(), &[Dielectric, Conductor, Plastic]),
            ("k", self.k.is_some(), &[Conductor]),
            ("specular", self.specular.is_some(), &[Conductor, Plastic]),
            ("roughness", self.roughness.is_some(), &[Dielectric, Conductor, Plastic]),
            ("nonlinear", self.nonlinear, &[Plastic]),
        ];
        for (field, given, models) in fields {
            if given && !models.contains(&self.model) {
                let names: Vec<String> =
                    models.iter().map(|m| format!("`{m:?}`").to_lowercase()).collect();
                let names = names.join(" or ");
                return Err((
                    field,
                    format!("only the model {names} has it; remove it or change the model"),
                ));
            }
        }
        Ok(())
    }

    fn constant_reflectance(&self) -> Result<Option<Rgb>, Fault> {
        match &self.reflectance {
            None => Ok(None),
            Some(ColorEntry::Constant(color)) => Ok(Some((*color).into())),
            Some(ColorEntry::Texture(_)) => {
                Err(fault("reflectance", "only `lambert` and `plastic` read a texture here"))
            }
        }
    }

    fn base(&self, textures: &mut impl ReadTexture) -> Result<ColorInput, Fault> {
        match self.reflectance.as_ref().ok_or_else(reflectance_needed)? {
            ColorEntry::Constant(color) => Ok(Rgb::from(*color).into()),
            ColorEntry::Texture(entry) => {
                let texture = textures
                    .read(&entry.texture, Coding::Srgb)
                    .map_err(|message| ("reflectance", message))?;
                Ok(ColorInput::Texture {
                    texture,
                    factor: entry.factor.map_or(Rgb::WHITE, Rgb::from),
                })
            }
        }
    }

    /// The roughness, unless the surface is smooth.
    fn rough(&self, textures: &mut impl ReadTexture) -> Result<Option<NumberInput>, Fault> {
        match &self.roughness {
            None => Ok(None),
            Some(NumberEntry::Constant(roughness)) => Ok(Some((*roughness).into())),
            Some(NumberEntry::Texture(entry)) => {
                let texture = textures
                    .read(&entry.texture, Coding::Linear)
                    .map_err(|message| ("roughness", message))?;
                let factor = match entry.factor {
                    None => 1.0,
                    Some(Color::Grey(factor)) => factor,
                    Some(Color::Rgb(_)) => {
                        return Err(fault("roughness", "its factor is one number"));
                    }
                };
                Ok(Some(NumberInput::Texture { texture, factor }))
            }
        }
    }

    /// An index of refraction that is the same for all colours.
    fn index(&self) -> Result<Option<f64>, Fault> {
        match self.eta {
            None => Ok(None),
            Some(Color::Grey(eta)) => Ok(Some(eta)),
            Some(Color::Rgb(_)) => Err(fault("eta", "it is one number, the same for all colours")),
        }
    }
}

fn fault(field: &'static str, message: &str) -> Fault {
    (field, message.to_owned())
}

fn reflectance_needed() -> Fault {
    fault("reflectance", "this model needs it: a number or [r, g, b] in [0, 1]")
}
