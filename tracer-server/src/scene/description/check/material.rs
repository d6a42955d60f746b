//! What every material and texture must fulfil.

use common::Rgb;

use super::Fault;
use crate::bsdf::{ColorInput, NumberInput, Range, Value};
use crate::scene::description::{Material, Texels, Texture};

/// Radiance beyond this is a mistake, and its products could overflow.
const MAX_RADIANCE: f64 = 1e15;

/// Checks a texture's size.
pub(super) fn check_texture(texture: &Texture) -> Result<(), Fault> {
    let texels = u64::from(texture.width) * u64::from(texture.height);
    if texels > 0 && texels == texture.texels.len() as u64 {
        let is_share = |numbers: &[[f32; 3]]| {
            numbers.as_flattened().iter().all(|number| (0.0..=1.0).contains(number))
        };
        return match &texture.texels {
            Texels::Numbers(numbers) if !is_share(numbers) => {
                let message = format!("texture `{}`: its numbers must lie in [0, 1]", texture.name);
                Err(Fault::new("", message))
            }
            Texels::Codes(..) | Texels::Numbers(_) => Ok(()),
        };
    }
    let Texture { name, width, height, texels, .. } = texture;
    let count = texels.len();
    Err(Fault::new(
        "",
        format!("texture `{name}` of {width} x {height} texels has {count} of them"),
    ))
}

/// Checks all parameters of a material in a scene with this many textures.
pub(super) fn check_material(material: &Material, textures: usize) -> Result<(), Fault> {
    let mut first = Ok(());
    let mut bsdf = material.bsdf;
    bsdf.parameters(&mut |name, value| {
        if first.is_ok() {
            first = check_value(value, textures).map_err(|message| Fault::new(name, message));
        }
    });
    first?;
    check_emission("emission", material.emission)
}

/// That a colour can be emitted.
pub(super) fn check_emission(field: &str, color: Rgb) -> Result<(), Fault> {
    if color.is_physical() && color.max_channel() <= MAX_RADIANCE {
        return Ok(());
    }
    let message = format!(
        "{} must have all channels finite, not negative, and at most {MAX_RADIANCE:e}",
        show(color)
    );
    Err(Fault::new(field, message))
}

fn check_value(mut value: Value<'_>, textures: usize) -> Result<(), String> {
    if let Some(&mut texture) = value.texture()
        && usize::from(texture) >= textures
    {
        return Err(format!("texture {texture} does not exist; there are {textures}"));
    }
    match value {
        Value::Share(color)
        | Value::ShareInput(
            ColorInput::Constant(color) | ColorInput::Texture { factor: color, .. },
        ) => check_channels(*color, 1.0),
        Value::Indices(color) => check_channels(*color, Range::INDEX.high),
        Value::Number(number, range)
        | Value::NumberInput(
            NumberInput::Constant(number) | NumberInput::Texture { factor: number, .. },
            range,
        ) => check_number(*number, range),
        Value::Flag(_) => Ok(()),
    }
}

fn check_channels(color: Rgb, most: f64) -> Result<(), String> {
    if color.is_physical() && color.max_channel() <= most {
        return Ok(());
    }
    Err(format!("{} must have all channels in [0, {most}]", show(color)))
}

fn check_number(number: f64, range: Range) -> Result<(), String> {
    let Range { low, high, about } = range;
    if (low..=high).contains(&number) {
        return Ok(());
    }
    Err(format!("{number} must lie in [{low}, {high}]: {about}"))
}

fn show(color: Rgb) -> String {
    format!("({}, {}, {})", color.r, color.g, color.b)
}
