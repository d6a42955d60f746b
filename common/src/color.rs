//! Linear RGB in 64-bit floats.

use std::ops::{Add, AddAssign, Div, Mul, MulAssign};

use serde::{Deserialize, Serialize};

/// A linear-light RGB triple with Rec. 709 primaries: a reflectance, a radiance or a film value.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(from = "[f64; 3]", into = "[f64; 3]")]
pub struct Rgb {
    /// Red.
    pub r: f64,
    /// Green.
    pub g: f64,
    /// Blue.
    pub b: f64,
}

impl Rgb {
    /// No light.
    pub const BLACK: Self = Self::grey(0.0);
    /// One in every channel.
    pub const WHITE: Self = Self::grey(1.0);

    /// A colour from its three channels.
    pub const fn new(r: f64, g: f64, b: f64) -> Self {
        Self { r, g, b }
    }

    /// The same value in every channel.
    pub const fn grey(value: f64) -> Self {
        Self { r: value, g: value, b: value }
    }

    /// Rec. 709 luminance: the scalar that a Metropolis chain equilibrates to.
    pub fn luminance(self) -> f64 {
        0.2126 * self.r + 0.7152 * self.g + 0.0722 * self.b
    }

    /// The largest channel.
    pub fn max_channel(self) -> f64 {
        self.r.max(self.g).max(self.b)
    }

    /// True when every channel is zero.
    pub fn is_black(self) -> bool {
        self.r == 0.0 && self.g == 0.0 && self.b == 0.0
    }

    /// True when every channel is finite and none is negative.
    pub fn is_physical(self) -> bool {
        [self.r, self.g, self.b].into_iter().all(|c| c.is_finite() && c >= 0.0)
    }

    /// True where every channel is a number and none is infinite.
    pub fn is_finite(self) -> bool {
        [self.r, self.g, self.b].into_iter().all(f64::is_finite)
    }

    /// The channels rounded to `f32`, as they travel and as they are drawn.
    pub fn to_f32(self) -> [f32; 3] {
        [self.r as f32, self.g as f32, self.b as f32]
    }
}

impl From<[f64; 3]> for Rgb {
    fn from([r, g, b]: [f64; 3]) -> Self {
        Self { r, g, b }
    }
}

impl From<[f32; 3]> for Rgb {
    fn from([r, g, b]: [f32; 3]) -> Self {
        Self { r: r.into(), g: g.into(), b: b.into() }
    }
}

impl From<Rgb> for [f64; 3] {
    fn from(color: Rgb) -> Self {
        [color.r, color.g, color.b]
    }
}

impl Add for Rgb {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self { r: self.r + other.r, g: self.g + other.g, b: self.b + other.b }
    }
}

impl AddAssign for Rgb {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl Mul for Rgb {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        Self { r: self.r * other.r, g: self.g * other.g, b: self.b * other.b }
    }
}

impl MulAssign for Rgb {
    fn mul_assign(&mut self, other: Self) {
        *self = *self * other;
    }
}

impl Mul<f64> for Rgb {
    type Output = Self;
    fn mul(self, scale: f64) -> Self {
        Self { r: self.r * scale, g: self.g * scale, b: self.b * scale }
    }
}

impl Div<f64> for Rgb {
    type Output = Self;
    fn div(self, divisor: f64) -> Self {
        Self { r: self.r / divisor, g: self.g / divisor, b: self.b / divisor }
    }
}
