//! Encryption: the certificate that the daemon shows.

use proto::Fingerprint;
use rustls_pki_types::pem::PemObject as _;
use rustls_pki_types::{CertificateDer, PrivateKeyDer};
use thiserror::Error;
use tonic::transport::{Identity, ServerTlsConfig};

use super::HELLO_TIMEOUT;

/// Why a certificate is of no use.
#[derive(Debug, Error)]
pub enum CertificateError {
    /// It is no certificate.
    #[error("no certificate in PEM (a block `-----BEGIN CERTIFICATE-----`): {0}")]
    Certificate(#[source] rustls_pki_types::pem::Error),
    /// It is no key.
    #[error("no private key in PEM (a block `-----BEGIN PRIVATE KEY-----`): {0}")]
    Key(#[source] rustls_pki_types::pem::Error),
    /// The system gives no random numbers, or the names make no certificate.
    #[error("cannot make a certificate: {0}")]
    Generate(#[from] rcgen::Error),
}

/// A certificate with its private key.
#[derive(Clone)]
pub struct Certificate {
    chain: String,
    key: String,
    fingerprint: Fingerprint,
}

/// Tells nothing of the key.
impl std::fmt::Debug for Certificate {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Certificate")
            .field("fingerprint", &self.fingerprint)
            .finish_non_exhaustive()
    }
}

impl Certificate {
    /// Of a certificate (or a chain that begins with it) and its key, both in PEM.
    pub fn from_pem(chain: String, key: String) -> Result<Self, CertificateError> {
        let der = CertificateDer::from_pem_slice(chain.as_bytes())
            .map_err(CertificateError::Certificate)?;
        let fingerprint = Fingerprint::of(&der);
        PrivateKeyDer::from_pem_slice(key.as_bytes()).map_err(CertificateError::Key)?;
        Ok(Self { chain, key, fingerprint })
    }

    /// A fresh one for the host `names`, signed by itself: viewers trust its fingerprint.
    pub fn self_signed(names: Vec<String>) -> Result<Self, CertificateError> {
        let made = rcgen::generate_simple_self_signed(names)?;
        Self::from_pem(made.cert.pem(), made.signing_key.serialize_pem())
    }

    /// What viewers may know it by.
    pub fn fingerprint(&self) -> Fingerprint {
        self.fingerprint
    }

    /// The certificate and the key in PEM.
    pub fn pem(&self) -> (&str, &str) {
        (&self.chain, &self.key)
    }

    /// For the server. A peer that does not finish its handshake in time is dropped.
    pub(super) fn server_config(&self) -> ServerTlsConfig {
        ServerTlsConfig::new()
            .identity(Identity::from_pem(&self.chain, &self.key))
            .timeout(HELLO_TIMEOUT)
    }
}
