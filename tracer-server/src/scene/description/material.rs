//! Materials and textures as their author wrote them.

use std::sync::Arc;

use common::Rgb;
use glam::DAffine2;

use crate::bsdf::BsdfDescription;

/// How a surface scatters and emits.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// The name in the scene file.
    pub name: String,
    /// How it scatters.
    pub bsdf: BsdfDescription,
    /// True when an opaque model scatters on both sides alike, false when its back is black. What
    /// light passes through has two sides of its own and is the same either way.
    pub two_sided: bool,
    /// Radiance emitted from the front side (the side the normal points to); black for none.
    pub emission: Rgb,
}

impl Material {
    /// A two-sided material that emits nothing.
    pub fn new(name: impl Into<String>, bsdf: impl Into<BsdfDescription>) -> Self {
        Self { name: name.into(), bsdf: bsdf.into(), two_sided: true, emission: Rgb::BLACK }
    }
}

/// An image that is laid over surfaces and repeats.
#[derive(Clone, PartialEq)]
pub struct Texture {
    /// The file's name, for people.
    pub name: String,
    /// Width in texels.
    pub width: u32,
    /// Height in texels.
    pub height: u32,
    /// Red, green and blue, row by row from the top.
    pub texels: Texels,
    /// From the coordinates of a surface to those of the image.
    pub placing: DAffine2,
}

/// The values of a texture.
#[derive(Clone, Debug, PartialEq)]
pub enum Texels {
    /// Codes, and what they mean.
    Codes(Arc<[[u8; 3]]>, Coding),
    /// The numbers themselves, each in [0, 1].
    Numbers(Arc<[[f32; 3]]>),
}

/// How the 8-bit codes of a texture stand for numbers in [0, 1].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Coding {
    /// Colours by the sRGB curve (IEC 61966-2-1).
    Srgb,
    /// Proportional: numbers such as roughness.
    Linear,
}

impl Coding {
    /// The sRGB code that comes nearest to a number in [0, 1].
    pub(crate) fn encode_srgb(value: f64) -> u8 {
        let value = value.clamp(0.0, 1.0);
        let share = if value <= 0.003_130_8 {
            12.92 * value
        } else {
            1.055 * value.powf(1.0 / 2.4) - 0.055
        };
        (255.0 * share).round() as u8
    }

    /// The number in [0, 1] that a code stands for.
    pub fn decode(self, code: u8) -> f64 {
        self.decode_share(f64::from(code) / 255.0)
    }

    /// The number that a share of the largest code stands for.
    pub fn decode_share(self, value: f64) -> f64 {
        match self {
            Self::Linear => value,
            Self::Srgb if value <= 0.04045 => value / 12.92,
            Self::Srgb => ((value + 0.055) / 1.055).powf(2.4),
        }
    }
}

impl Texture {
    /// The mean of all texels, decoded; black for a texture without any.
    pub fn mean(&self) -> Rgb {
        match &self.texels {
            Texels::Codes(codes, coding) => mean_of_codes(codes, *coding),
            Texels::Numbers(numbers) => {
                let colors = numbers.iter().map(|&[r, g, b]| Rgb::from([r, g, b]));
                let sum = colors.fold(Rgb::BLACK, |sum, color| sum + color);
                sum / numbers.len().max(1) as f64
            }
        }
    }
}

impl Texels {
    /// How many there are.
    pub fn len(&self) -> usize {
        match self {
            Self::Codes(codes, _) => codes.len(),
            Self::Numbers(numbers) => numbers.len(),
        }
    }

    /// True where there is none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

/// The mean of all texels, decoded; black for none.
fn mean_of_codes(texels: &[[u8; 3]], coding: Coding) -> Rgb {
    // Counting codes first makes the sum exact and independent of the order of texels.
    let mut counts = [[0_u64; 256]; 3];
    for texel in texels {
        for (channel, &code) in counts.iter_mut().zip(texel) {
            channel[usize::from(code)] += 1;
        }
    }
    let mean = |channel: &[u64; 256]| {
        let decoded = (0_u8..=255).map(|code| coding.decode(code));
        let sum: f64 = decoded.zip(channel).map(|(value, &n)| n as f64 * value).sum();
        sum / texels.len().max(1) as f64
    };
    let [r, g, b] = &counts;
    Rgb::new(mean(r), mean(g), mean(b))
}

impl std::fmt::Debug for Texture {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { name, width, height, texels, .. } = self;
        let kind = match texels {
            Texels::Codes(_, coding) => format!("{coding:?}"),
            Texels::Numbers(_) => "numbers".to_owned(),
        };
        write!(f, "Texture({name}, {width} x {height}, {kind})")
    }
}
