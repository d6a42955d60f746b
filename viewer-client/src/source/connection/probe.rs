//! What is wrong where a connection does not come about: one more connection, to see what answers.
//!
//! Whatever goes wrong in a greeting looks alike from within: a broken pipe. A peer's own first bytes
//! tell more.

use std::io::{self, ErrorKind};
use std::time::Duration;

use tokio::io::{AsyncReadExt as _, AsyncWriteExt as _};
use tokio::net::TcpStream;
use tokio::time::timeout;

/// How long a peer may take to accept a connection.
const CONNECTING: Duration = Duration::from_secs(5);
/// How long a peer that speaks first, such as one for SSH, may take to begin.
const FIRST_WORD: Duration = Duration::from_millis(300);
/// How long a peer may take to answer.
const ANSWER: Duration = Duration::from_secs(2);
/// How a client of HTTP/2 begins (RFC 9113, section 3.4), with an empty frame of settings.
const PREFACE: &[u8] = b"PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n\0\0\0\x04\0\0\0\0\0";

/// What is found at an address.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Found {
    /// There is no such machine, or no way to it.
    NoWay(String),
    /// The machine answers that nobody listens.
    Nobody,
    /// Nothing answers at all.
    Silence,
    /// It speaks HTTP/2 without encryption, as a daemon does.
    Plain,
    /// It speaks TLS.
    Encrypted,
    /// It speaks something else, which is this.
    Other(&'static str),
    /// It closes the connection without a word.
    Closed,
}

/// Finds out what is at `address`, HOST:PORT.
pub(super) async fn identify(address: &str) -> Found {
    let mut stream = match timeout(CONNECTING, TcpStream::connect(address)).await {
        Ok(Ok(stream)) => stream,
        Ok(Err(error)) if error.kind() == ErrorKind::ConnectionRefused => return Found::Nobody,
        Ok(Err(error)) => return Found::NoWay(error.to_string()),
        Err(_) => return Found::Silence,
    };
    if let Some(found) = hear(&mut stream, FIRST_WORD).await {
        return found;
    }
    if stream.write_all(PREFACE).await.is_err() {
        return Found::Closed;
    }
    hear(&mut stream, ANSWER).await.unwrap_or(Found::Silence)
}

/// What the peer's next bytes mean; `None` where none come in time.
async fn hear(stream: &mut TcpStream, patience: Duration) -> Option<Found> {
    let mut bytes = [0; 16];
    let read = timeout(patience, stream.read(&mut bytes)).await.ok()?;
    Some(understand(&read, &bytes))
}

fn understand(read: &io::Result<usize>, bytes: &[u8]) -> Found {
    match (read, bytes) {
        (Err(_) | Ok(0), _) => Found::Closed,
        // A frame of settings: three bytes of length, then its type.
        (Ok(9..), [_, _, _, 0x04, ..]) => Found::Plain,
        // An alert (RFC 8446, section 5.1).
        (_, [0x15, 0x03, ..]) => Found::Encrypted,
        // Some answer to what they do not understand with a page and no more.
        (_, bytes) if bytes.starts_with(b"HTTP/") || bytes.starts_with(b"<") => {
            Found::Other("a web server")
        }
        (_, bytes) if bytes.starts_with(b"SSH-") => Found::Other("an SSH server"),
        _ => Found::Other("something else"),
    }
}

#[cfg(test)]
mod tests {
    use std::io::{Read as _, Write as _};
    use std::net::TcpListener;

    use crate::source::connection::{Greeting, Peer, Session};

    /// A peer that says `first` to whoever comes, and `then` to whoever has said something.
    fn peer(first: &'static [u8], then: &'static [u8]) -> String {
        let listener = TcpListener::bind("127.0.0.1:0").expect("a free port");
        let address = listener.local_addr().expect("bound").to_string();
        let serve = move || {
            for mut stream in listener.incoming().flatten() {
                // Whoever has hung up is no concern of a peer.
                let said = stream.write_all(first);
                let heard = said.and_then(|()| stream.read(&mut [0; 64]));
                drop(heard.and_then(|_| stream.write_all(then)));
            }
        };
        let thread = std::thread::Builder::new().name("peer".to_owned()).spawn(serve);
        drop(thread.expect("a thread"));
        address
    }

    async fn complaint(address: String) -> String {
        let opened = Session::open(&Peer::open(address), Greeting::default()).await;
        opened.map(drop).expect_err("no daemon").to_string()
    }

    #[tokio::test]
    async fn what_answers_instead_of_a_daemon_is_named() {
        let gone = {
            let listener = TcpListener::bind("127.0.0.1:0").expect("a free port");
            listener.local_addr().expect("bound").to_string()
        };
        let alert = b"\x15\x03\x03\0\x02\x02\x0a";
        for (address, words) in [
            (peer(b"SSH-2.0-OpenSSH_9.6\r\n", b""), "is an SSH server"),
            (peer(b"", b"HTTP/1.1 400 Bad Request\r\n\r\n"), "is a web server"),
            (peer(b"", b"<!DOCTYPE HTML>\n"), "is a web server"),
            (peer(b"", alert), "uses encryption: give the fingerprint"),
            (peer(b"220 mail ESMTP\r\n", b""), "is something else"),
            (peer(b"", b""), "closes the connection at once"),
            (gone, "nobody listens at 127.0.0.1:"),
            ("no-such-host.invalid:50061".to_owned(), "cannot reach no-such-host.invalid:50061"),
        ] {
            let complaint = complaint(address).await;
            assert!(complaint.contains(words), "{words}: {complaint}");
        }
    }
}
