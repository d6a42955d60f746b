//! Numbers within ranges.

use std::fmt::{self, Debug, Display};
use std::str::FromStr;

use super::{CommandError, Shape, Value, Words};

/// The values that a number may have, and how a slider shows them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Range<T> {
    /// The smallest.
    pub low: T,
    /// The largest.
    pub high: T,
    /// Equal factors are equal steps of a slider.
    pub logarithmic: bool,
    /// Decimals that a slider shows.
    pub decimals: usize,
    /// What is counted, such as `px`.
    pub unit: &'static str,
}

/// A range of whole numbers without a unit, linear; the methods change that.
pub const fn range<T: Copy>(low: T, high: T) -> Range<T> {
    Range { low, high, logarithmic: false, decimals: 0, unit: "" }
}

impl<T: Copy> Range<T> {
    /// Equal ratios are equal steps.
    #[must_use]
    pub const fn log(self) -> Self {
        Self { logarithmic: true, ..self }
    }

    /// With this many decimals.
    #[must_use]
    pub const fn decimals(self, decimals: usize) -> Self {
        Self { decimals, ..self }
    }

    /// In this unit.
    #[must_use]
    pub const fn unit(self, unit: &'static str) -> Self {
        Self { unit, ..self }
    }
}

impl<T: Number> Range<T> {
    /// True for numbers within; NaN is not.
    pub fn contains(&self, value: T) -> bool {
        self.low <= value && value <= self.high
    }

    /// Reads a number within; NaN and infinities are none. `name` is for complaints.
    pub fn read(&self, words: &mut Words<'_>, name: &str) -> Result<T, CommandError> {
        let word = words.parameter(name)?;
        let parameter = name.to_uppercase();
        let is_finite = word.parse::<f64>().is_ok_and(f64::is_finite);
        let Some(value) = word.parse().ok().filter(|_| is_finite) else {
            return Err(CommandError::NotANumber { parameter, found: word.to_owned() });
        };
        if self.contains(value) {
            return Ok(value);
        }
        let limits = format!("{} and {}", self.low, self.high);
        Err(CommandError::OutOfRange { parameter, found: word.to_owned(), limits })
    }

    /// The number within that is next to `value`.
    pub fn clamp(&self, value: f64) -> T {
        T::from_f64(value.clamp(self.low.to_f64(), self.high.to_f64()))
    }
}

impl<T: Display> Display for Range<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let gap = if self.unit.is_empty() { "" } else { " " };
        write!(f, "{} to {}{gap}{}", self.low, self.high, self.unit)
    }
}

/// A kind of numbers.
pub trait Number: Copy + PartialOrd + FromStr + Display + Debug {
    /// As the widest kind.
    fn to_f64(self) -> f64;
    /// The nearest of this kind.
    fn from_f64(value: f64) -> Self;
}

macro_rules! numbers {
    ($($type:ty: $round:expr),+) => {$(
        impl Number for $type {
            fn to_f64(self) -> f64 {
                self as f64
            }

            fn from_f64(value: f64) -> Self {
                let round: fn(f64) -> f64 = $round;
                round(value) as $type
            }
        }
    )+};
}

numbers!(f32: |x| x, u8: f64::round, u16: f64::round, u32: f64::round, u64: f64::round);
numbers!(i16: f64::round, i32: f64::round);

impl Number for f64 {
    fn to_f64(self) -> f64 {
        self
    }

    fn from_f64(value: f64) -> Self {
        value
    }
}

macro_rules! values {
    ($($type:ty),+) => {$(
        impl Value for $type {
            type Limits = Range<$type>;

            fn form(name: &str, _: &Range<$type>) -> String {
                name.to_uppercase()
            }

            fn read(
                words: &mut Words<'_>,
                name: &str,
                limits: &Range<$type>,
            ) -> Result<Self, CommandError> {
                limits.read(words, name)
            }

            fn text(&self) -> String {
                self.to_string()
            }

            fn examples(limits: &Range<$type>) -> Vec<Self> {
                let middle = 0.5 * (limits.low.to_f64() + limits.high.to_f64());
                vec![limits.low, limits.high, limits.clamp(middle)]
            }

            fn shape(limits: &Range<$type>) -> Shape {
                let Range { low, high, logarithmic, decimals, unit } = *limits;
                let (low, high) = (low.to_f64(), high.to_f64());
                Shape::Number(Range { low, high, logarithmic, decimals, unit })
            }
        }
    )+};
}

values!(f32, f64, u8, u16, u32, u64, i16, i32);

/// Numbers that belong together, such as the coordinates of a point.
#[derive(Clone, Copy, Debug)]
pub struct Axes<T, const N: usize> {
    /// What each is called.
    pub names: [&'static str; N],
    /// What each may be.
    pub ranges: [Range<T>; N],
}

/// Numbers of these names within one range.
pub const fn axes<T: Copy, const N: usize>(
    names: [&'static str; N],
    range: Range<T>,
) -> Axes<T, N> {
    Axes { names, ranges: [range; N] }
}

impl<T: Number, const N: usize> Value for [T; N] {
    type Limits = Axes<T, N>;

    fn form(_: &str, limits: &Axes<T, N>) -> String {
        limits.names.join(" ")
    }

    fn read(words: &mut Words<'_>, _: &str, limits: &Axes<T, N>) -> Result<Self, CommandError> {
        let mut values = limits.ranges.map(|range| range.low);
        for (i, value) in values.iter_mut().enumerate() {
            *value = limits.ranges[i].read(words, limits.names[i])?;
        }
        Ok(values)
    }

    fn text(&self) -> String {
        self.map(|value| value.to_string()).join(" ")
    }

    fn examples(limits: &Axes<T, N>) -> Vec<Self> {
        let ranges = limits.ranges;
        let middle = ranges.map(|range| range.clamp(0.125));
        vec![ranges.map(|range| range.low), ranges.map(|range| range.high), middle]
    }
}
