//! Why a message is refused.

use common::{BatchError, CameraError};
use thiserror::Error;

use crate::ProtocolVersion;

/// Why a message of a peer is refused. Each names the field at fault.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum WireError {
    /// A field that must be there is not.
    #[error("field `{0}` is missing")]
    Missing(&'static str),
    /// A text, list or column longer than the protocol allows.
    #[error("field `{field}` has length {found}; at most {limit} is allowed")]
    TooLong {
        /// The field.
        field: &'static str,
        /// Its length, in bytes or entries.
        found: usize,
        /// The longest allowed.
        limit: usize,
    },
    /// A whole number outside its range.
    #[error("field `{field}` is {found}; it must lie in {least} to {most}")]
    OutOfRange {
        /// The field.
        field: &'static str,
        /// What it holds.
        found: u64,
        /// The smallest allowed.
        least: u64,
        /// The largest allowed.
        most: u64,
    },
    /// A number outside its range, or none at all.
    #[error("field `{field}` is {found}; it must lie in {least} to {most}")]
    OutOfBounds {
        /// The field.
        field: &'static str,
        /// What it holds.
        found: f64,
        /// The smallest allowed.
        least: f64,
        /// The largest allowed.
        most: f64,
    },
    /// A number that is NaN, infinite, or of the wrong sign.
    #[error("field `{field}` is {found}, which is not a {wanted} number")]
    BadNumber {
        /// The field.
        field: &'static str,
        /// What it holds.
        found: f64,
        /// What it must be.
        wanted: &'static str,
    },
    /// A column whose length does not fit the number of entries announced.
    #[error("column `{column}` holds {found} bytes where {expected} are expected")]
    ColumnLength {
        /// The column.
        column: &'static str,
        /// Its bytes.
        found: usize,
        /// The bytes it should have.
        expected: usize,
    },
    /// Columns that make no batch of paths.
    #[error(transparent)]
    Batch(#[from] BatchError),
    /// A camera whose axes are no frame or whose film is empty.
    #[error(transparent)]
    Camera(#[from] CameraError),
    /// The peer speaks a major version that this program does not.
    #[error(
        "the peer speaks protocol {theirs}, this program speaks {ours}; use a viewer and a \
         daemon of the same major version"
    )]
    Version {
        /// What this program speaks.
        ours: ProtocolVersion,
        /// What the peer speaks.
        theirs: ProtocolVersion,
    },
    /// Parts of a scene that do not make one.
    #[error("the scene is inconsistent: {0}")]
    Scene(&'static str),
}
