//! The ground: values that know nothing else of the viewer.
//!
//! Most are what commands carry and settings hold: numbers within ranges, switches, choices, places.
//! Each of these has one text form, which it reads and writes.

mod bounds;
mod camera;
mod choice;
mod cloud;
mod filter;
pub mod format;
mod fresh;
pub mod history;
mod image;
mod number;
mod panel;
mod path;
pub mod rates;
mod scene;
mod steer;
mod switch;
mod text;
pub mod theme;
pub mod trends;
mod window;
mod words;

pub use bounds::Bounds;
pub use camera::{Side, Viewpoint};
pub use choice::Choice;
pub use cloud::{Blend, ColorMode, ColorScale, Marks};
pub use filter::{MOST_SELECTORS, Sphere, kind_name};
pub use fresh::fresh;
pub use image::{Channel, Exposure, Layer, ToneCurve};
pub use number::{Axes, Number, Range, axes, range};
pub use panel::PanelName;
pub use path::{Pointer, ShownPath, VertexStep};
pub use scene::{ClipSide, Handles, Light, Lighting, Shading};
pub use switch::Switch;
pub use text::{Line, name};
pub use window::{KeyPreset, MousePreset, Move, Part, Theme, ThemeChange, WIDTHS, WindowSide};
pub use words::{CommandError, Words};

use std::fmt::Debug;

/// What a command can carry: read from the words of its text, and written as such.
pub trait Value: Clone + PartialEq + Debug {
    /// What is asked of it beyond its type, such as a range.
    type Limits;

    /// How help texts show a parameter `name` of this kind: `PIXELS`, `on|off|toggle`, `X Y Z`.
    fn form(name: &str, limits: &Self::Limits) -> String;

    /// Reads it from the next words; `name` is for complaints.
    fn read(words: &mut Words<'_>, name: &str, limits: &Self::Limits)
    -> Result<Self, CommandError>;

    /// Its text, which [`Value::read`] understands.
    fn text(&self) -> String;

    /// Some of these values, among them the extreme ones.
    fn examples(limits: &Self::Limits) -> Vec<Self>;

    /// What help texts and controls need to know of the limits.
    fn shape(_limits: &Self::Limits) -> Shape {
        Shape::Other
    }
}

/// What help texts and controls need to know of a parameter.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// A number within a range.
    Number(Range<f64>),
    /// One of these words.
    Choice(Vec<String>),
    /// Something else.
    Other,
}

/// What a setting can hold: it changes as a command says, and says how to make others the same.
pub trait Settable: Clone + PartialEq + Debug {
    /// What a command carries to change it.
    type Change: Value;

    /// Follows a change.
    fn change(&mut self, to: Self::Change);

    /// The change that leads here from anywhere; `None` where no command does.
    fn as_change(&self) -> Option<Self::Change>;
}

/// Values that are replaced whole.
macro_rules! settable {
    ($($type:ty),+) => {$(
        impl $crate::value::Settable for $type {
            type Change = Self;

            fn change(&mut self, to: Self) {
                *self = to;
            }

            fn as_change(&self) -> Option<Self> {
                Some(*self)
            }
        }
    )+};
}
use settable;

settable!(f32, u16, u32);

/// A number that is not always chosen.
impl Settable for Option<f32> {
    type Change = f32;

    fn change(&mut self, to: f32) {
        *self = Some(to);
    }

    fn as_change(&self) -> Self {
        *self
    }
}

impl<const N: usize> Settable for [f32; N] {
    type Change = Self;

    fn change(&mut self, to: Self) {
        *self = to;
    }

    fn as_change(&self) -> Option<Self> {
        Some(*self)
    }
}
