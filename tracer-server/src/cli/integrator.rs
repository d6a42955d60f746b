//! The integrators, as the command line calls them.

use clap::ValueEnum;

use crate::render::Integrator;

/// The integrators by the names they have on the command line.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum IntegratorName {
    /// Base samples for what they find well, Metropolis light transport for the rest.
    Auto,
    /// Metropolis light transport.
    Mlt,
    /// Metropolis light transport over the random numbers of a renderer.
    Pssmlt,
    /// Bidirectional path tracing.
    Bdpt,
    /// Path tracing with light sampling.
    Path,
}

impl From<IntegratorName> for Integrator {
    fn from(name: IntegratorName) -> Self {
        match name {
            IntegratorName::Auto => Self::Auto,
            IntegratorName::Mlt => Self::Mlt,
            IntegratorName::Pssmlt => Self::Pssmlt,
            IntegratorName::Bdpt => Self::Bdpt,
            IntegratorName::Path => Self::Path,
        }
    }
}
