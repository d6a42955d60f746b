//! The daemon that is meant, and how it is trusted.

use std::fmt;
use std::net::IpAddr;

use proto::Fingerprint;
use tonic::metadata::{Ascii, MetadataValue};
use tonic::service::Interceptor;
use tonic::{Request, Status};

/// Why the daemon is believed to be the one that is meant.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Trust {
    /// It is not asked: nothing is encrypted.
    Plain,
    /// Its certificate is signed by one of these authorities, in PEM.
    Authority(String),
    /// Its certificate is this one.
    Pinned(Fingerprint),
}

/// A daemon's address, with what opens its door.
#[derive(Clone, Debug)]
pub struct Peer {
    /// HOST:PORT.
    pub address: String,
    /// How it is trusted.
    pub trust: Trust,
    /// What it is shown.
    pub token: Bearer,
}

impl Peer {
    /// A daemon that asks for nothing.
    pub fn open(address: String) -> Self {
        Self { address, trust: Trust::Plain, token: Bearer::default() }
    }

    /// Where a token would go through the network for all to read.
    pub fn exposes_token(&self) -> bool {
        self.token.0.is_some() && self.trust == Trust::Plain && !self.is_local()
    }

    /// The host of HOST:PORT, without the brackets of IPv6.
    pub fn host(&self) -> &str {
        let host = self.address.rsplit_once(':').map_or(self.address.as_str(), |(host, _)| host);
        host.trim_start_matches('[').trim_end_matches(']')
    }

    fn is_local(&self) -> bool {
        let host = self.host();
        host == "localhost" || host.parse::<IpAddr>().is_ok_and(|ip| ip.is_loopback())
    }
}

/// Adds the token, if there is one, to every request.
#[derive(Clone, Default)]
pub struct Bearer(Option<MetadataValue<Ascii>>);

impl Bearer {
    /// For a token as its file holds it.
    pub fn new(token: &str) -> Result<Self, String> {
        let mut value: MetadataValue<Ascii> = format!("Bearer {}", token.trim())
            .parse()
            .map_err(|_invalid| "a token is one line of printable ASCII".to_owned())?;
        value.set_sensitive(true);
        Ok(Self(Some(value)))
    }
}

/// Tells nothing of the token.
impl fmt::Debug for Bearer {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(if self.0.is_some() { "Bearer(..)" } else { "Bearer(none)" })
    }
}

impl Interceptor for Bearer {
    fn call(&mut self, mut request: Request<()>) -> Result<Request<()>, Status> {
        if let Some(value) = &self.0 {
            request.metadata_mut().insert("authorization", value.clone());
        }
        Ok(request)
    }
}
