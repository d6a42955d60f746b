//! `image ...`: how the progressive image is shown, and where it goes.

use super::table::table;
use crate::value::{Axes, Channel, Exposure, Layer, Line, ToneCurve, axes, range};

/// A point of the film, from its upper left.
const FILM: Axes<f32, 2> = axes(["U", "V"], range(0.0, 1.0));

table! {
    /// What may be done with the image on screen; the tracer's film is untouched.
    #[derive(Clone, Debug, PartialEq)]
    pub enum ImageCommand in Image;

    /// How the progressive image is shown.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct ImageSettings {
        /// Which image or map is shown.
        Show "image show" (layer: Layer) sets layer = Layer::Image, "Show", Linked;
        /// Which channel is shown.
        Channel "image channel" (channel: Channel) sets channel = Channel::Rgb, "Channel", Linked;
        /// Brightness of the image on screen; each stop doubles it.
        Exposure "image exposure" (stops: Exposure [range(-20.0, 20.0).decimals(1).unit("EV")])
            sets exposure = Exposure::Auto(0.0), "Exposure", Linked;
        /// How radiance is mapped to colour.
        Tone "image tone" (tone: ToneCurve) sets tone = ToneCurve::Srgb, "Tone", Linked;
        /// Exponent of the tone curve called gamma; larger is flatter.
        Gamma "image gamma" (x: f32 [range(0.5, 4.0).decimals(2)])
            sets gamma = 2.2, "Gamma", Linked;
        /// Screen points per pixel of the film; the wheel changes it, too.
        Zoom "image zoom" (factor: Option<f32> [range(0.05, 64.0).log().decimals(2)])
            sets zoom = None, "Zoom", Linked;
        /// Point of the film at the centre of the panel while zoomed, as shares from its upper
        /// left.
        Look "image look" (centre: [f32; 2] [FILM]) sets centre = [0.5; 2], "Centre", Linked;
    }

    commands {
        /// Chooses the brightness that suits the scene.
        Auto "image auto", Linked;
        /// Fits the image to its panel.
        Fit "image fit", Linked;
        /// Compares with an image from a file.
        Reference "image reference" (file: String [Line::Any("FILE.exr")]);
        /// Removes the reference.
        Forget "image forget";
        /// Writes the radiance as .exr, or what is shown as .png.
        Save "image save" (file: String [Line::Any("FILE")]), Gives;
        /// Sends the image to the image viewer tev, which listens on port 14158.
        Tev "image tev" (address: String [Line::Any("HOST:PORT")]), Gives;
    }
}
