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
        /// Where it differs from the reference: orange is brighter, blue darker.
        Difference,
        /// Where the image is still wrong: the relative squared error against the reference.
        Error,
        /// FLIP: the difference that a person perceives when flipping between image and reference.
        #[strum(message = "FLIP")]
        Flip,
        /// Mean acceptance probability of proposals made from paths that end here.
        Acceptance,
        /// How long chains stay at a path that ends here, in steps.
        Dwell,
        /// How often chains arrive here, relative to the mean.
        Visits,
        /// Relative standard error of the light here, estimated from how chains differ.
        Spread,
        /// R-hat: whether chains agree on how much light arrives here.
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
        /// Red alone, in grey.
        #[strum(message = "R")]
        Red,
        /// Green alone, in grey.
        #[strum(message = "G")]
        Green,
        /// Blue alone, in grey.
        #[strum(message = "B")]
        Blue,
        /// Luminance, in grey.
        #[strum(message = "Y")]
        Luminance,
    }
}

choices! {
    /// How light becomes colour.
    #[derive(Default)]
    pub enum ToneCurve {
        /// The sRGB curve that screens expect.
        #[default]
        #[strum(message = "sRGB")]
        Srgb,
        /// A power of the radiance.
        Gamma,
        /// Luminance as a colour, over four orders of magnitude.
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
