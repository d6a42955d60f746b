//! Connecting, encrypted where the daemon is to be trusted.

use std::sync::Arc;
use std::{error, io};

use hyper_util::rt::TokioIo;
use proto::Fingerprint;
use tokio::net::TcpStream;
use tokio_rustls::TlsConnector;
use tokio_rustls::client::TlsStream;
use tokio_rustls::rustls::client::danger::{
    HandshakeSignatureValid, ServerCertVerified, ServerCertVerifier,
};
use tokio_rustls::rustls::crypto::{
    CryptoProvider, ring, verify_tls12_signature, verify_tls13_signature,
};
use tokio_rustls::rustls::pki_types::{CertificateDer, ServerName, UnixTime};
use tokio_rustls::rustls::{
    ClientConfig, DigitallySignedStruct, Error as TlsError, SignatureScheme,
};
use tonic::transport::{Certificate, Channel, ClientTlsConfig, Endpoint};

use super::error::{HandshakeError, SessionError};
use super::peer::{Peer, Trust};

/// The protocol that gRPC speaks inside TLS.
const HTTP2: &[u8] = b"h2";

/// Opens a channel to `peer`; `tune` sets what does not depend on how it is trusted.
pub(super) async fn connect(
    peer: &Peer,
    tune: impl FnOnce(Endpoint) -> Endpoint,
) -> Result<Channel, HandshakeError> {
    let bad_address = || HandshakeError::Told(SessionError::BadAddress(peer.address.clone()));
    let scheme = if matches!(peer.trust, Trust::Authority(_)) { "https" } else { "http" };
    let endpoint = Endpoint::from_shared(format!("{scheme}://{}", peer.address))
        .map_err(|_invalid| bad_address())?;
    let endpoint = tune(endpoint);
    let untrusted = |error: &dyn error::Error| HandshakeError::Untrusted(innermost(error));
    match &peer.trust {
        Trust::Plain => endpoint.connect().await.map_err(|_unclear| HandshakeError::Off),
        Trust::Authority(pem) => {
            let tls = ClientTlsConfig::new().ca_certificate(Certificate::from_pem(pem));
            let endpoint = endpoint.tls_config(tls).map_err(|error| untrusted(&error))?;
            endpoint.connect().await.map_err(|error| untrusted(&error))
        }
        Trust::Pinned(fingerprint) => {
            let connector = pinned(*fingerprint).map_err(|error| untrusted(&error))?;
            let name = ServerName::try_from(peer.host().to_owned());
            let name = name.map_err(|_invalid| bad_address())?;
            let address = peer.address.clone();
            let dial =
                tower::service_fn(move |_| dial(address.clone(), name.clone(), connector.clone()));
            endpoint.connect_with_connector(dial).await.map_err(|error| untrusted(&error))
        }
    }
}

/// The message at the bottom of an error, which says what is wrong.
fn innermost(mut error: &dyn error::Error) -> String {
    while let Some(source) = error.source() {
        error = source;
    }
    let text = error.to_string();
    // How rustls begins what others have said, such as we ourselves below.
    text.strip_prefix("unexpected error: ").unwrap_or(&text).to_owned()
}

async fn dial(
    address: String,
    name: ServerName<'static>,
    connector: TlsConnector,
) -> io::Result<TokioIo<TlsStream<TcpStream>>> {
    let stream = TcpStream::connect(address).await?;
    stream.set_nodelay(true)?;
    Ok(TokioIo::new(connector.connect(name, stream).await?))
}

fn pinned(fingerprint: Fingerprint) -> Result<TlsConnector, TlsError> {
    let provider = Arc::new(ring::default_provider());
    let verifier = PinnedCertificate { fingerprint, provider: Arc::clone(&provider) };
    let mut config = ClientConfig::builder_with_provider(provider)
        .with_safe_default_protocol_versions()?
        .dangerous()
        .with_custom_certificate_verifier(Arc::new(verifier))
        .with_no_client_auth();
    config.alpn_protocols = vec![HTTP2.to_vec()];
    Ok(TlsConnector::from(Arc::new(config)))
}

/// Takes one certificate and no other, whatever names and dates it bears.
///
/// The peer must still prove, by its signature of the handshake, that it has the key.
#[derive(Debug)]
struct PinnedCertificate {
    fingerprint: Fingerprint,
    provider: Arc<CryptoProvider>,
}

impl ServerCertVerifier for PinnedCertificate {
    fn verify_server_cert(
        &self,
        end_entity: &CertificateDer<'_>,
        _intermediates: &[CertificateDer<'_>],
        _server_name: &ServerName<'_>,
        _ocsp_response: &[u8],
        _now: UnixTime,
    ) -> Result<ServerCertVerified, TlsError> {
        let shown = Fingerprint::of(end_entity);
        if shown == self.fingerprint {
            return Ok(ServerCertVerified::assertion());
        }
        Err(TlsError::General(format!(
            "its certificate has the fingerprint {shown}, not the one you gave. Either the daemon \
             has a new certificate (ask its owner), or someone is intercepting the connection"
        )))
    }

    fn verify_tls12_signature(
        &self,
        message: &[u8],
        cert: &CertificateDer<'_>,
        dss: &DigitallySignedStruct,
    ) -> Result<HandshakeSignatureValid, TlsError> {
        let algorithms = &self.provider.signature_verification_algorithms;
        verify_tls12_signature(message, cert, dss, algorithms)
    }

    fn verify_tls13_signature(
        &self,
        message: &[u8],
        cert: &CertificateDer<'_>,
        dss: &DigitallySignedStruct,
    ) -> Result<HandshakeSignatureValid, TlsError> {
        let algorithms = &self.provider.signature_verification_algorithms;
        verify_tls13_signature(message, cert, dss, algorithms)
    }

    fn supported_verify_schemes(&self) -> Vec<SignatureScheme> {
        self.provider.signature_verification_algorithms.supported_schemes()
    }
}
