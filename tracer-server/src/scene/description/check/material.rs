//! What every material and texture must fulfil.

use common::Rgb;

use super::Fault;
use crate::bsdf::Fresnel;
use crate::scene::description::{BsdfDescription, ColorInput, Material, NumberInput, Texture};

/// Radiance beyond this is a mistake, and its products could overflow.
const MAX_RADIANCE: f64 = 1e15;
/// Indices of refraction beyond this (or below its inverse) are a mistake, and so are extinction
/// coefficients beyond it.
const MAX_ETA: f64 = 1000.0;

/// Checks a texture's size.
pub(crate) fn check_texture(texture: &Texture) -> Result<(), Fault> {
    let texels = u64::from(texture.width) * u64::from(texture.height);
    if texels > 0 && texels == texture.texels.len() as u64 {
        return Ok(());
    }
    let Texture { name, width, height, texels, .. } = texture;
    let count = texels.len();
    Err(("", format!("texture `{name}` of {width} x {height} texels has {count} of them")))
}

/// Checks all parameters of a material in a scene with so many textures.
pub(crate) fn check_material(material: &Material, textures: usize) -> Result<(), Fault> {
    match material.bsdf {
        BsdfDescription::Lambert { reflectance } => {
            check_color_input("reflectance", reflectance, textures)?;
        }
        BsdfDescription::Mirror { reflectance } => check_share("reflectance", reflectance)?,
        BsdfDescription::Dielectric { eta, reflectance, transmittance } => {
            check_share("reflectance", reflectance)?;
            check_share("transmittance", transmittance)?;
            check_eta(eta)?;
        }
        BsdfDescription::RoughDielectric { eta, reflectance, transmittance, roughness } => {
            check_share("reflectance", reflectance)?;
            check_share("transmittance", transmittance)?;
            check_eta(eta)?;
            check_roughness(roughness, textures)?;
        }
        BsdfDescription::Conductor { fresnel, roughness } => {
            check_fresnel(fresnel)?;
            check_roughness(roughness, textures)?;
        }
        BsdfDescription::Plastic { diffuse, fresnel, roughness, .. } => {
            check_color_input("reflectance", diffuse, textures)?;
            check_fresnel(fresnel)?;
            check_roughness(roughness.into(), textures)?;
        }
    }
    check_emission("emission", material.emission)
}

/// That a colour can be emitted.
pub(crate) fn check_emission(field: &'static str, color: Rgb) -> Result<(), Fault> {
    if color.is_physical() && color.max_channel() <= MAX_RADIANCE {
        return Ok(());
    }
    let message = format!(
        "{} must have all channels finite, not negative, and at most {MAX_RADIANCE:e}",
        show(color)
    );
    Err((field, message))
}

fn check_share(field: &'static str, color: Rgb) -> Result<(), Fault> {
    let inside = color.is_physical() && color.max_channel() <= 1.0;
    let message = || format!("{} must have all channels in [0, 1]", show(color));
    if inside { Ok(()) } else { Err((field, message())) }
}

fn check_exists(field: &'static str, texture: u16, textures: usize) -> Result<(), Fault> {
    if usize::from(texture) < textures {
        return Ok(());
    }
    Err((field, format!("texture {texture} does not exist; there are {textures}")))
}

fn check_color_input(field: &'static str, input: ColorInput, textures: usize) -> Result<(), Fault> {
    match input {
        ColorInput::Constant(color) => check_share(field, color),
        ColorInput::Texture { texture, factor } => {
            check_share(field, factor)?;
            check_exists(field, texture, textures)
        }
    }
}

fn check_roughness(input: NumberInput, textures: usize) -> Result<(), Fault> {
    let number = match input {
        NumberInput::Constant(number) => number,
        NumberInput::Texture { texture, factor } => {
            check_exists("roughness", texture, textures)?;
            factor
        }
    };
    if (0.0..=1.0).contains(&number) {
        return Ok(());
    }
    Err(("roughness", format!("{number} must lie in [0, 1]: 0 is smooth, 1 is matt")))
}

fn check_eta(eta: f64) -> Result<(), Fault> {
    if (1.0 / MAX_ETA..=MAX_ETA).contains(&eta) {
        return Ok(());
    }
    let message = format!(
        "{eta} is no index of refraction: it must lie between {} and {MAX_ETA} (glass is 1.5)",
        1.0 / MAX_ETA
    );
    Err(("eta", message))
}

fn check_fresnel(fresnel: Fresnel) -> Result<(), Fault> {
    let index = |field: &'static str, color: Rgb| {
        let inside = color.is_physical() && color.max_channel() <= MAX_ETA;
        let message = || format!("{} must have all channels in [0, {MAX_ETA}]", show(color));
        if inside { Ok(()) } else { Err((field, message())) }
    };
    match fresnel {
        Fresnel::Constant(color) => check_share("reflectance", color),
        Fresnel::Schlick(color) => check_share("specular", color),
        Fresnel::Conductor { eta, k, tint } => {
            index("eta", eta)?;
            index("k", k)?;
            check_share("specular", tint)
        }
        Fresnel::Dielectric { eta, tint } => {
            check_eta(eta)?;
            check_share("specular", tint)
        }
    }
}

fn show(color: Rgb) -> String {
    format!("({}, {}, {})", color.r, color.g, color.b)
}
