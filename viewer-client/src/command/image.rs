//! `image ...`: how the progressive image is shown, and where it goes.

use std::fmt;

use super::Form;
use super::words::{CommandError, Words};

/// What may be done with the image on screen; the tracer's film is untouched.
#[derive(Clone, Debug, PartialEq)]
pub enum ImageCommand {
    /// Brightness in stops: each doubles it.
    Exposure(f32),
    /// Brightness that suits the scene.
    Auto,
    /// Screen points a film pixel.
    Zoom(f32),
    /// Film point in the middle of the panel; both coordinates from 0 to 1, from the upper left.
    Look([f32; 2]),
    /// As large as its panel.
    Fit,
    /// What is shown.
    Show(Layer),
    /// Which part of the light is shown.
    Channel(Channel),
    /// How light becomes colour.
    Tone(ToneCurve),
    /// The exponent of [`ToneCurve::Gamma`].
    Gamma(f32),
    /// Reads an EXR file to compare with.
    Reference(String),
    /// Compares with nothing.
    Forget,
    /// Writes the image as EXR, or what is shown as PNG; the name tells which.
    Save(String),
    /// Sends the image to the viewer tev at HOST:PORT.
    Tev(String),
}

/// What the image panel shows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Layer {
    /// The image.
    #[default]
    Image,
    /// What it is compared with.
    Reference,
    /// How much brighter or darker than the reference it is.
    Difference,
    /// The relative squared error of each pixel against the reference.
    Error,
    /// How different it looks from the reference.
    Flip,
    /// Mean acceptance probability of proposals made from here.
    Acceptance,
    /// Mean stay of a chain at a path that ends here.
    Dwell,
    /// How often chains came here, against the mean.
    Visits,
    /// Relative standard error, from how chains differ.
    Spread,
    /// How far chains disagree.
    Disagreement,
}

impl Layer {
    /// All of them.
    pub const ALL: [Self; 10] = [
        Self::Image,
        Self::Reference,
        Self::Difference,
        Self::Error,
        Self::Flip,
        Self::Acceptance,
        Self::Dwell,
        Self::Visits,
        Self::Spread,
        Self::Disagreement,
    ];

    /// True where there is nothing to show without a reference.
    pub fn compares(self) -> bool {
        matches!(self, Self::Reference | Self::Difference | Self::Error | Self::Flip)
    }

    /// True for what the chains' diagnostics tell.
    pub fn is_map(self) -> bool {
        matches!(
            self,
            Self::Acceptance | Self::Dwell | Self::Visits | Self::Spread | Self::Disagreement
        )
    }
}

impl fmt::Display for Layer {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Image => "image",
            Self::Reference => "reference",
            Self::Difference => "difference",
            Self::Error => "error",
            Self::Flip => "flip",
            Self::Acceptance => "acceptance",
            Self::Dwell => "dwell",
            Self::Visits => "visits",
            Self::Spread => "spread",
            Self::Disagreement => "disagreement",
        })
    }
}

/// A part of the light.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Channel {
    /// All of it.
    #[default]
    Rgb,
    /// Red alone, in grey.
    Red,
    /// Green alone, in grey.
    Green,
    /// Blue alone, in grey.
    Blue,
    /// Luminance, in grey.
    Luminance,
}

impl Channel {
    /// All of them.
    pub const ALL: [Self; 5] = [Self::Rgb, Self::Red, Self::Green, Self::Blue, Self::Luminance];
}

impl fmt::Display for Channel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Rgb => "rgb",
            Self::Red => "red",
            Self::Green => "green",
            Self::Blue => "blue",
            Self::Luminance => "luminance",
        })
    }
}

/// How light becomes colour.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ToneCurve {
    /// As screens expect it.
    #[default]
    Srgb,
    /// A power of the light.
    Gamma,
    /// Luminance as a colour, on a logarithmic scale.
    False,
}

impl ToneCurve {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Srgb, Self::Gamma, Self::False];
}

impl fmt::Display for ToneCurve {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Srgb => "srgb",
            Self::Gamma => "gamma",
            Self::False => "false",
        })
    }
}

pub(super) const FORMS: &[Form] = &[
    ("image exposure STOPS", "brightness; each stop doubles it (-20 to 20)"),
    ("image auto", "brightness that suits the scene"),
    ("image zoom FACTOR", "screen points a film pixel"),
    ("image look U V", "film point in the middle, from 0 to 1"),
    ("image fit", "as large as its panel"),
    (
        "image show LAYER",
        "image, reference, difference, error, flip, acceptance, dwell, visits, spread, disagreement",
    ),
    ("image channel rgb|red|green|blue|luminance", "which part of the light is shown"),
    ("image tone srgb|gamma|false", "how light becomes colour"),
    ("image gamma X", "exponent of the tone `gamma` (0.5 to 4)"),
    ("image reference FILE.exr", "compare with an image"),
    ("image forget", "compare with nothing"),
    ("image save FILE", "write the radiance as .exr, or what is shown as .png"),
    ("image tev HOST:PORT", "send the image to the viewer tev (its port is 14158)"),
];

impl fmt::Display for ImageCommand {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Exposure(stops) => write!(f, "exposure {stops}"),
            Self::Auto => write!(f, "auto"),
            Self::Zoom(factor) => write!(f, "zoom {factor}"),
            Self::Look([u, v]) => write!(f, "look {u} {v}"),
            Self::Fit => write!(f, "fit"),
            Self::Show(layer) => write!(f, "show {layer}"),
            Self::Channel(channel) => write!(f, "channel {channel}"),
            Self::Tone(tone) => write!(f, "tone {tone}"),
            Self::Gamma(gamma) => write!(f, "gamma {gamma}"),
            Self::Reference(file) => write!(f, "reference {file}"),
            Self::Forget => write!(f, "forget"),
            Self::Save(file) => write!(f, "save {file}"),
            Self::Tev(address) => write!(f, "tev {address}"),
        }
    }
}

pub(super) fn parse(words: &mut Words<'_>) -> Result<ImageCommand, CommandError> {
    Ok(match words.next("image command")? {
        "exposure" => ImageCommand::Exposure(words.number("STOPS", -20.0..=20.0)?),
        "auto" => ImageCommand::Auto,
        "zoom" => ImageCommand::Zoom(words.number("FACTOR", 0.05..=64.0)?),
        "look" => {
            ImageCommand::Look([words.number("U", 0.0..=1.0)?, words.number("V", 0.0..=1.0)?])
        }
        "fit" => ImageCommand::Fit,
        "show" => ImageCommand::Show(words.choice("LAYER", &Layer::ALL)?),
        "channel" => ImageCommand::Channel(words.choice("CHANNEL", &Channel::ALL)?),
        "tone" => ImageCommand::Tone(words.choice("TONE", &ToneCurve::ALL)?),
        "gamma" => ImageCommand::Gamma(words.number("X", 0.5..=4.0)?),
        "reference" => ImageCommand::Reference(words.rest("FILE")?),
        "forget" => ImageCommand::Forget,
        "save" => ImageCommand::Save(words.rest("FILE")?),
        "tev" => ImageCommand::Tev(words.rest("HOST:PORT")?),
        other => return Err(CommandError::Unknown(format!("image {other}"))),
    })
}
