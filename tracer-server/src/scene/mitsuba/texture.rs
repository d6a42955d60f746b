//! The textures of a scene, each read once however often it is used.

use std::collections::BTreeMap;

use common::Rgb;
use glam::{DAffine2, DVec2, Vec4Swizzles as _};

use super::document::Element;
use crate::bsdf::ColorInput;
use crate::scene::description::{Coding, Texture};
use crate::scene::reading::diagnostic::{LoadError, Warning};
use crate::scene::reading::image::read_texture;

/// What stands for a texture that cannot be read.
const UNKNOWN_GREY: f64 = 0.5;

/// Textures read so far.
#[derive(Debug, Default)]
pub(super) struct Textures {
    /// The textures.
    pub(super) list: Vec<Texture>,
    /// What is not modelled of them, and of the models that read them.
    pub(super) warnings: Vec<Warning>,
    /// Textures by the element that defines them.
    inputs: BTreeMap<u32, ColorInput>,
}

impl Textures {
    /// What a `texture` amounts to.
    pub(super) fn input(&mut self, element: Element<'_>) -> Result<ColorInput, LoadError> {
        if let Some(&input) = self.inputs.get(&element.index()) {
            return Ok(input);
        }
        let input = match element.plugin()?.as_str() {
            "bitmap" => self.bitmap(element)?,
            "checkerboard" => self.checkerboard(element)?,
            _ => {
                let message = "unknown texture; supported: bitmap, checkerboard. Grey is used \
                    instead";
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
        let placing = placing(element)?;
        let coding = if raw { Coding::Linear } else { Coding::Srgb };
        let texture = match read_texture(&element.file(&name), coding) {
            Ok(texture) => Texture { placing, ..texture },
            Err(message) => {
                let message = format!("{message}; grey stands for it");
                self.warnings.push(element.warning(message));
                return Ok(Rgb::grey(UNKNOWN_GREY).into());
            }
        };
        let index = u16::try_from(self.list.len())
            .map_err(|_error| element.error("more than 65,536 textures"))?;
        self.list.push(texture);
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

/// Where the image lies: `to_uv`, or the four numbers that version 0 has for it.
fn placing(element: Element<'_>) -> Result<DAffine2, LoadError> {
    let to_uv = element.transform("to_uv")?;
    let number = |name, absent| Ok::<_, LoadError>(element.number(name)?.unwrap_or(absent));
    let scale = DVec2::new(number("uscale", 1.0)?, number("vscale", 1.0)?);
    let offset = DVec2::new(number("uoffset", 0.0)?, number("voffset", 0.0)?);
    let plane = DAffine2::from_cols(to_uv.x_axis.xy(), to_uv.y_axis.xy(), to_uv.w_axis.xy());
    let old = DAffine2::from_cols(DVec2::X * scale.x, DVec2::Y * scale.y, offset);
    // Its images have v pointing down.
    let over = DAffine2::from_cols(DVec2::X, DVec2::NEG_Y, DVec2::Y);
    let placed = over * (old * plane) * over;
    Ok(if old * plane == DAffine2::IDENTITY { DAffine2::IDENTITY } else { placed })
}
