//! How surfaces and drawing aids look.

use super::choice::choices;
use super::{Axes, CommandError, Value, Words, axes, range, settable};

choices! {
    /// How surfaces are drawn.
    #[derive(Default)]
    pub enum Shading {
        /// Lit, with their textures.
        #[default]
        Shaded,
        /// Lit, each in one colour.
        Plain,
        /// Textures and colours alone, unlit.
        Texture,
        /// Lit, with the edges of triangles.
        Edges,
        /// Edges of triangles only.
        Wireframe,
        /// Not at all.
        Off,
    }
}

choices! {
    /// How surfaces are lit in the preview.
    #[derive(Default)]
    pub enum Lighting {
        /// Under a soft sky, so that nothing is black.
        #[default]
        Soft,
        /// One point light and Phong's model, with the parameters of the Lvis of 2014.
        Phong,
    }
}

choices! {
    /// What the handles of selectors do.
    #[derive(Default)]
    pub enum Handles {
        /// They move along an axis.
        #[default]
        Move,
        /// They scale.
        Scale,
    }
}

choices! {
    /// What a plane cuts away.
    #[derive(Default)]
    pub enum ClipSide {
        /// Nothing.
        #[default]
        Off,
        /// Everything with smaller x.
        X,
        /// Everything with larger x.
        #[strum(serialize = "-x")]
        #[serde(rename = "-x")]
        MinusX,
        /// Everything with smaller y.
        Y,
        /// Everything with larger y.
        #[strum(serialize = "-y")]
        #[serde(rename = "-y")]
        MinusY,
        /// Everything with smaller z.
        Z,
        /// Everything with larger z.
        #[strum(serialize = "-z")]
        #[serde(rename = "-z")]
        MinusZ,
    }
}

impl ClipSide {
    /// The direction in which the rest lies, or `None` when nothing is cut.
    pub fn normal(self) -> Option<[f32; 3]> {
        Some(match self {
            Self::Off => return None,
            Self::X => [1.0, 0.0, 0.0],
            Self::MinusX => [-1.0, 0.0, 0.0],
            Self::Y => [0.0, 1.0, 0.0],
            Self::MinusY => [0.0, -1.0, 0.0],
            Self::Z => [0.0, 0.0, 1.0],
            Self::MinusZ => [0.0, 0.0, -1.0],
        })
    }
}

/// Where the light of the preview is.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Deserialize, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Light {
    /// At the camera, wherever that goes.
    #[default]
    Camera,
    /// At a point, in the file's units.
    At([f64; 3]),
}

settable!(Light);

/// Where a point may be, in the file's units.
const POINT: Axes<f64, 3> = axes(["X", "Y", "Z"], range(-1e12, 1e12));

impl Value for Light {
    type Limits = ();

    fn form(_: &str, (): &()) -> String {
        "camera|at X Y Z".to_owned()
    }

    fn read(words: &mut Words<'_>, name: &str, (): &()) -> Result<Self, CommandError> {
        match words.parameter(name)? {
            "camera" => Ok(Self::Camera),
            "at" => Ok(Self::At(Value::read(words, name, &POINT)?)),
            other => Err(CommandError::no_choice(other, "camera, at X Y Z")),
        }
    }

    fn text(&self) -> String {
        match self {
            Self::Camera => "camera".to_owned(),
            Self::At(point) => format!("at {}", point.text()),
        }
    }

    fn examples((): &()) -> Vec<Self> {
        vec![Self::Camera, Self::At([1.0, -2.5, 3.0])]
    }
}
