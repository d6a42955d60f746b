//! Why there is no session.

use proto::WireError;
use thiserror::Error;
use tonic::{Code, Status};

/// Why a session could not begin or came to an end.
#[derive(Debug, Error)]
pub enum SessionError {
    /// The address is none.
    #[error("`{0}` is not an address; write HOST:PORT, such as 127.0.0.1:50061")]
    BadAddress(String),
    /// The certificate is not the right one, or there is no TLS.
    #[error("cannot make a trusted connection to {address}: {reason}")]
    Untrusted {
        /// HOST:PORT.
        address: String,
        /// What is wrong.
        reason: String,
    },
    /// A token must not be seen by others.
    #[error(
        "{0} is another machine, and the token would be sent unencrypted: trust the daemon's \
        certificate with --fingerprint or --ca-cert"
    )]
    ExposedToken(String),
    /// The greeting broke off; what is there tells why.
    #[error("{0}")]
    Unreachable(String),
    /// The daemon refused or broke off.
    #[error("{0}")]
    Refused(String),
    /// The daemon said goodbye.
    #[error("the daemon said goodbye: {0}")]
    Goodbye(String),
    /// The stream ended without a goodbye.
    #[error("the connection was lost")]
    Lost,
    /// A message that makes no sense.
    #[error("the daemon sent an unreadable message: {0}")]
    Unreadable(#[from] WireError),
}

impl From<Status> for SessionError {
    fn from(status: Status) -> Self {
        match status.code() {
            Code::Unavailable | Code::Cancelled | Code::Unknown => Self::Lost,
            _ => Self::Refused(format!("the daemon refused: {}", status.message())),
        }
    }
}

/// Why the handshake failed.
pub(super) enum HandshakeError {
    /// It is known already.
    Told(SessionError),
    /// The connection did not come about, or was broken off.
    Off,
    /// There was no encrypted connection, for this reason.
    Untrusted(String),
}
