//! What chains visit, and how the picture that is wanted is made of it.
//!
//! Wanted is the picture of `f h`; the chains walk on `f rho`, with a positive `rho` wherever `f h`
//! is. Only two things change against walking on `f` itself. Every acceptance ratio is multiplied by
//! `rho(y) / rho(x)`, since the ratio for `f` has `f(y) / f(x)` in it. And every splat is multiplied
//! by `h / rho`: states of the chain come with the density `f rho / b_rho`, so that the mean of
//! `b_rho h / rho` over them is `integral f h`. Seeds are drawn in proportion to `rho` times their
//! weight, and the mean of that is `b_rho = integral lum f rho`.
//!
//! A target is a function of the path alone: never of what chains have done, nor of how a sample was
//! drawn. Whatever in it is measured is frozen before the first seed is drawn.

mod equalised;
mod selective;
mod whole;

use std::fmt::Debug;
use std::sync::Arc;

use crate::path::Path;

pub use equalised::Equalised;
pub use selective::{Base, Selective};
pub use whole::Whole;

/// What a target says of one path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Importance {
    /// `rho(x)`: how much more often the path is visited than `f` alone would have it.
    pub rho: f64,
    /// `(h / rho)(x)`: what a splat of the path is multiplied by; zero where `rho` is.
    pub share: f64,
}

impl Importance {
    /// Of a path that is visited as `f` has it, and wanted whole.
    pub const WHOLE: Self = Self { rho: 1.0, share: 1.0 };
}

/// One way to weigh paths.
pub trait Weighing: Debug + Send + Sync {
    /// `rho` and `h / rho` of a path.
    fn importance(&self, x: &Path) -> Importance;
}

/// What chains visit.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Target {
    /// All light, as bright as it is.
    #[default]
    Whole,
    /// What a base sampler leaves over.
    Selective(Selective),
    /// All light, dark parts of the picture as often as bright ones.
    Equalised(Arc<Equalised>),
    /// Both at once: `rho` and `h` are the products of those of the parts.
    Product(Box<[Self; 2]>),
}

impl Target {
    /// `rho` and `h / rho` of a path.
    #[inline]
    pub fn importance(&self, x: &Path) -> Importance {
        match self {
            Self::Whole => Whole.importance(x),
            Self::Selective(selective) => selective.importance(x),
            Self::Equalised(equalised) => equalised.importance(x),
            Self::Product(parts) => {
                let [a, b] = &**parts;
                let (a, b) = (a.importance(x), b.importance(x));
                Importance { rho: a.rho * b.rho, share: a.share * b.share }
            }
        }
    }

    /// The product of two targets.
    #[must_use]
    pub fn times(self, other: Self) -> Self {
        match (self, other) {
            (Self::Whole, only) | (only, Self::Whole) => only,
            (a, b) => Self::Product(Box::new(<[Self; 2]>::from((a, b)))),
        }
    }

    /// A few words for people.
    pub fn name(&self) -> String {
        match self {
            Self::Whole => "whole".to_owned(),
            Self::Selective(_) => "selective".to_owned(),
            Self::Equalised(_) => "equalised".to_owned(),
            Self::Product(parts) => parts.iter().map(Self::name).collect::<Vec<_>>().join(", "),
        }
    }
}

#[cfg(test)]
pub(crate) mod laws;
