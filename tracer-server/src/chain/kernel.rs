//! The law by which a chain moves.

use crate::mutation::Mixture;
use crate::path::Path;
use crate::target::{Importance, Target};

/// Everything that decides how a chain moves and what its states stand for; fixed for an epoch.
#[derive(Clone, Debug)]
pub struct Kernel {
    /// The strategies with their weights.
    pub mixture: Mixture,
    /// What the chain visits.
    pub target: Target,
}

impl Kernel {
    /// A kernel that visits all light as it is.
    pub fn whole(mixture: Mixture) -> Self {
        Self { mixture, target: Target::Whole }
    }

    /// What the kernel says of a path.
    #[inline]
    pub(super) fn stand(&self, x: &Path) -> Standing {
        Standing { mixture_total: self.mixture.total(x), importance: self.target.importance(x) }
    }
}

/// What a kernel says of a path: computed once, when a chain comes to it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Standing {
    /// `Z(x)`.
    pub(super) mixture_total: f64,
    /// `rho(x)` and `(h / rho)(x)`.
    pub(super) importance: Importance,
}
