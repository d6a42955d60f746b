//! All light, as bright as it is: `h = rho = 1`.
//!
//! Proof: the ratio of acceptance is that of `f`, and the mean of `b` over the states is the picture.

use super::{Importance, Weighing};
use crate::path::Path;

/// All light, as bright as it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Whole;

impl Weighing for Whole {
    #[inline]
    fn importance(&self, _: &Path) -> Importance {
        Importance::WHOLE
    }
}
