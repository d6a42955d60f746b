//! Who may connect to the daemon, and how.

use std::fs;
use std::io::Read as _;
use std::iter;
use std::net::{SocketAddr, ToSocketAddrs as _};
use std::path::{Path, PathBuf};

use anyhow::{Context as _, anyhow, ensure};
use clap::Args;
use host::file::{self, Place};

use crate::daemon::DEFAULT_ADDRESS;
use crate::service::{Access, Certificate, MAX_TOKEN_LENGTH, Security, Token};

/// No certificate or key is longer, in bytes.
const MAX_PEM_BYTES: u64 = 1 << 20;

/// Where to listen, and what to require of those who connect.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "Connections")]
pub struct AccessArgs {
    /// Where to listen: an address or name of this machine; port 0 takes any that is free.
    ///
    /// Other machines can connect to anything but `localhost`, `127.0.0.1` and `[::1]`; that asks for a
    /// token and for encryption.
    #[arg(long, value_name = "HOST:PORT", default_value_t = DEFAULT_ADDRESS, value_parser = listen)]
    pub listen: SocketAddr,
    /// File with the token that viewers must present; anyone who has it may steer.
    #[arg(long, value_name = "FILE")]
    pub token_file: Option<PathBuf>,
    /// File with a second token, for viewers that may only watch.
    #[arg(long, value_name = "FILE", requires = "token_file")]
    pub observer_token_file: Option<PathBuf>,
    /// Certificate (or chain) in PEM: encrypts with TLS.
    #[arg(long, value_name = "FILE", requires = "tls_key")]
    pub tls_cert: Option<PathBuf>,
    /// Private key of the certificate, in PEM.
    #[arg(long, value_name = "FILE", requires = "tls_cert")]
    pub tls_key: Option<PathBuf>,
    /// Make a certificate that viewers trust by its fingerprint.
    ///
    /// With --tls-cert and --tls-key it is written there and used again next time; without, it
    /// lasts for this run.
    #[arg(long)]
    pub tls_self_signed: bool,
    /// Let other machines connect without a token or without encryption.
    #[arg(long)]
    pub insecure: bool,
}

impl AccessArgs {
    /// Reads tokens and certificate; refuses to listen to other machines unprotected.
    pub fn security(&self) -> anyhow::Result<Security> {
        let guarded =
            self.token_file.is_some() && (self.tls_cert.is_some() || self.tls_self_signed);
        ensure!(
            self.insecure || guarded || self.listen.ip().is_loopback(),
            "--listen {}: other machines could connect. Require a token and encryption \
            (--token-file FILE --tls-self-signed), listen on 127.0.0.1, or add --insecure if \
            everyone on the network is trusted",
            self.listen,
        );
        let access = Access {
            driver: self.token_file.as_deref().map(token).transpose()?,
            observer: self.observer_token_file.as_deref().map(token).transpose()?,
        };
        ensure!(
            access.driver.is_none() || access.driver != access.observer,
            "--observer-token-file holds the same token as --token-file, so observers could steer"
        );
        Ok(Security { access, certificate: self.certificate()? })
    }

    fn certificate(&self) -> anyhow::Result<Option<Certificate>> {
        let files = self.tls_cert.as_deref().zip(self.tls_key.as_deref());
        match files {
            Some((chain, key)) if chain.exists() || key.exists() || !self.tls_self_signed => {
                let certificate = Certificate::from_pem(
                    text(chain, "--tls-cert", MAX_PEM_BYTES)?,
                    text(key, "--tls-key", MAX_PEM_BYTES)?,
                );
                let named = || format!("{} and {}", chain.display(), key.display());
                Ok(Some(certificate.with_context(named)?))
            }
            Some((chain, key)) => {
                let certificate = Certificate::self_signed(self.names())?;
                keep(&certificate, chain, key)?;
                Ok(Some(certificate))
            }
            None if self.tls_self_signed => Ok(Some(Certificate::self_signed(self.names())?)),
            None => Ok(None),
        }
    }

    /// What a certificate for this address is made out to.
    fn names(&self) -> Vec<String> {
        let ip = self.listen.ip();
        let own = (!ip.is_unspecified()).then(|| ip.to_string());
        iter::once("localhost".to_owned()).chain(own).collect()
    }
}

/// An address, by itself or by its name. Of several, one of IPv4 is what viewers try first.
fn listen(text: &str) -> Result<SocketAddr, String> {
    if let Ok(address) = text.parse() {
        return Ok(address);
    }
    let (host, port) = text.rsplit_once(':').unwrap_or_default();
    let port: u16 = port.parse().ok().filter(|_| !host.is_empty()).ok_or_else(|| {
        format!("write HOST:PORT, such as {DEFAULT_ADDRESS}, localhost:0 or [::1]:50061")
    })?;
    let found = (host, port).to_socket_addrs();
    let found = found.map_err(|error| format!("`{host}` has no known address: {error}"))?;
    let first = found.min_by_key(SocketAddr::is_ipv6);
    first.ok_or_else(|| format!("`{host}` has no known address"))
}

fn token(file: &Path) -> anyhow::Result<Token> {
    let secret = text(file, "the token", 2 * MAX_TOKEN_LENGTH as u64)?;
    Token::new(&secret).map_err(|problem| anyhow!("{}: {problem}", file.display()))
}

/// The whole of a small text file.
fn text(file: &Path, what: &str, limit: u64) -> anyhow::Result<String> {
    let named = || format!("cannot read {what} from {}", file.display());
    let mut text = String::new();
    let read = fs::File::open(file)
        .and_then(|file| file.take(limit + 1).read_to_string(&mut text))
        .with_context(named)?;
    ensure!(read as u64 <= limit, "{}: longer than {limit} bytes", file.display());
    Ok(text)
}

/// Writes certificate and key; the key for its owner only.
fn keep(certificate: &Certificate, chain: &Path, key: &Path) -> anyhow::Result<()> {
    let (chain_pem, key_pem) = certificate.pem();
    // Both or none: half a pair would be refused next time.
    let chain_place = Place::find(chain)?;
    file::write_private(key, key_pem.as_bytes())?;
    Ok(chain_place.write_bytes(chain_pem.as_bytes()).inspect_err(|_| drop(fs::remove_file(key)))?)
}

#[cfg(test)]
mod tests {
    use clap::Parser;

    use super::*;

    #[derive(Debug, Parser)]
    struct Line {
        #[command(flatten)]
        door: AccessArgs,
    }

    fn security(line: &str) -> Result<Security, String> {
        let line = Line::try_parse_from(iter::once("serve").chain(line.split_whitespace()))
            .map_err(|error| error.to_string())?;
        line.door.security().map_err(|error| format!("{error:#}"))
    }

    #[test]
    fn the_door_is_open_to_this_machine_only() {
        assert!(security("").is_ok() && security("--listen [::1]:0").is_ok());
        let complaint = security("--listen 0.0.0.0:0").expect_err("unguarded");
        assert!(
            complaint.contains("--token-file") && complaint.contains("--insecure"),
            "{complaint}"
        );
        security("--listen 0.0.0.0:0 --tls-self-signed").expect_err("without a token");
        security("--listen 0.0.0.0:0 --insecure").expect("the owner has decided");
    }

    #[test]
    fn names_of_this_machine_are_understood() {
        let address = |text: &str| {
            let line = Line::try_parse_from(["serve", "--listen", text]);
            line.map(|line| line.door.listen).map_err(|error| error.to_string())
        };
        let local = address("localhost:0").expect("every machine has one");
        assert!(local.ip().is_loopback() && security("--listen localhost:0").is_ok(), "{local}");
        assert_eq!(address("[::1]:7").expect("IPv6").port(), 7);
        for bad in ["localhost", "50061", ":50061", "localhost:many", "127.0.0.1:99999"] {
            let complaint = address(bad).expect_err(bad);
            assert!(complaint.contains("HOST:PORT"), "{bad}: {complaint}");
        }
        let complaint = address("no such host:1").expect_err("a name that nobody can have");
        assert!(complaint.contains("no such host"), "{complaint}");
    }

    #[test]
    fn a_certificate_is_made_once_and_kept() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = |name: &str| folder.path().join(name).display().to_string();
        fs::write(path("token"), "0123456789abcdef0123\n").expect("writable");
        let line = format!(
            "--listen 0.0.0.0:0 --token-file {} --tls-self-signed --tls-cert {} --tls-key {}",
            path("token"),
            path("cert"),
            path("key")
        );
        let fingerprint = || {
            let security = security(&line).expect("guarded");
            assert!(security.access.driver.is_some(), "a token is set");
            security.certificate.expect("encrypted").fingerprint()
        };
        assert_eq!(fingerprint(), fingerprint(), "viewers that know it find it again");
        let same = format!("{line} --observer-token-file {}", path("token"));
        security(&same).expect_err("observers with the driver's token");

        fs::write(path("cert"), "not PEM").expect("writable");
        let complaint = security(&line).expect_err("no certificate");
        assert!(complaint.contains("BEGIN CERTIFICATE"), "{complaint}");
        fs::write(path("token"), "short").expect("writable");
        let complaint = security(&line).expect_err("a weak token");
        assert!(complaint.contains("openssl rand"), "{complaint}");
    }
}
