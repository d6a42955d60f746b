//! How the picture is shown.

use super::Settable;
use super::choice::choices;

choices! {
    /// What the image panel shows.
    #[derive(Default)]
    pub enum Layer {
        /// The progressive image.
        #[default]
        Image,
        /// The image to compare with.
        Reference,
        /// Orange is brighter than the reference, blue darker.
        Difference,
        /// Where the image is still wrong: the relative squared error against the reference.
        Error,
        /// FLIP: how different a person sees image and reference who flips between them.
        #[strum(message = "FLIP")]
        Flip,
        /// Mean acceptance probability of proposals made from paths to here.
        Acceptance,
        /// How long chains stay at a path to here, in steps.
        Dwell,
        /// How often chains come here, against the mean.
        Visits,
        /// Relative standard error of the light here, from how chains differ.
        Spread,
        /// R-hat: whether chains agree how much light comes here.
        #[strum(message = "R-hat")]
        Disagreement,
    }
}

impl Layer {
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

choices! {
    /// A part of the light.
    #[derive(Default)]
    pub enum Channel {
        /// All of the light.
        #[default]
        #[strum(message = "RGB")]
        Rgb,
        /// Red alone, as grey.
        #[strum(message = "R")]
        Red,
        /// Green alone, as grey.
        #[strum(message = "G")]
        Green,
        /// Blue alone, as grey.
        #[strum(message = "B")]
        Blue,
        /// Luminance, as grey.
        #[strum(message = "Y")]
        Luminance,
    }
}

choices! {
    /// How light becomes colour.
    #[derive(Default)]
    pub enum ToneCurve {
        /// As screens expect light.
        #[default]
        #[strum(message = "sRGB")]
        Srgb,
        /// A power of the light.
        Gamma,
        /// Luminance as a colour, over four decades.
        #[strum(message = "False colour")]
        False,
    }
}

/// How bright the picture is shown, in stops: each doubles the brightness.
#[derive(Clone, Copy, Debug, PartialEq, serde::Deserialize, serde::Serialize)]
pub enum Exposure {
    /// So many, as suits the scene.
    Auto(f32),
    /// So many, as the user chose.
    Chosen(f32),
}

impl Exposure {
    /// In stops.
    pub fn stops(self) -> f32 {
        match self {
            Self::Auto(stops) | Self::Chosen(stops) => stops,
        }
    }

    /// True where the user chose.
    pub fn is_chosen(self) -> bool {
        matches!(self, Self::Chosen(_))
    }
}

impl Settable for Exposure {
    type Change = f32;

    fn change(&mut self, stops: f32) {
        *self = Self::Chosen(stops);
    }

    fn as_change(&self) -> Option<f32> {
        self.is_chosen().then(|| self.stops())
    }
}
