//! What the program ends with where it could not do what it was asked for.

use thiserror::Error;

/// Something that was asked for and could not be done, although nothing is wrong with how it was asked.
#[derive(Debug, Error)]
#[error("{0}")]
pub struct Failed(pub String);
