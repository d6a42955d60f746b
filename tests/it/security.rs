//! Who gets in, and who does not.

use common::TracerEvent;
use std::time::Duration;

use tracer_server::hub::HubLimits;
use tracer_server::service::{Access, Certificate, Security, Server, Token};
use viewer_client::source::connection::{Bearer, Greeting, Peer, Session, SessionError, Trust};

use crate::stream::fixture;

const DRIVER: &str = "the-token-of-whoever-drives";
const OBSERVER: &str = "the-token-of-those-who-watch";

/// A server that asks for a token and encrypts, with its certificate.
fn guarded() -> (Server, Certificate) {
    let token = |text| Some(Token::new(text).expect("strong enough"));
    let certificate = Certificate::self_signed(vec!["localhost".to_owned()]).expect("made");
    let security = Security {
        access: Access { driver: token(DRIVER), observer: token(OBSERVER) },
        certificate: Some(certificate.clone()),
    };
    (fixture::start_guarded(HubLimits::default(), security), certificate)
}

fn peer(server: &Server, trust: Trust, token: &str) -> Peer {
    let address = format!("localhost:{}", server.address().port());
    let token = if token.is_empty() { Bearer::default() } else { bearer(token) };
    Peer { address, trust, token }
}

fn bearer(token: &str) -> Bearer {
    Bearer::new(token).expect("printable")
}

/// That the session begins, and the scene comes over the same door.
async fn is_let_in(peer: &Peer) {
    let mut session =
        fixture::soon("the greeting", Session::open(peer, Greeting::default())).await.expect("in");
    let first = fixture::soon("the welcome", session.next()).await.expect("readable");
    assert!(matches!(first, TracerEvent::Welcome(_)), "{first:?}");
    let scene = session.scene_fetcher().fetch(String::new());
    assert!(fixture::soon("the scene", scene).await.expect("whole").is_some(), "a scene");
    session.leave().await;
}

/// The error of a viewer that is not let in.
async fn is_kept_out(peer: &Peer) -> SessionError {
    fixture::soon("the refusal", Session::open(peer, Greeting::default()))
        .await
        .expect_err("kept out")
}

#[tokio::test]
async fn tokens_and_certificates_open_the_door() {
    let (server, certificate) = guarded();
    let pinned = Trust::Pinned(certificate.fingerprint());
    let authority = Trust::Authority(certificate.pem().0.to_owned());
    for trust in [&pinned, &authority] {
        for token in [DRIVER, OBSERVER] {
            is_let_in(&peer(&server, trust.clone(), token)).await;
        }
    }
    for wrong in ["", "the-token-of-nobody-at-all", &DRIVER[1..]] {
        let complaint = is_kept_out(&peer(&server, pinned.clone(), wrong)).await.to_string();
        assert!(complaint.contains("--token-file"), "{complaint}");
    }
    fixture::stop(server).await;
}

#[tokio::test]
async fn another_certificate_is_not_trusted() {
    let (server, certificate) = guarded();
    let other = Certificate::self_signed(vec!["localhost".to_owned()]).expect("made");
    let pinned = peer(&server, Trust::Pinned(other.fingerprint()), DRIVER);
    let complaint = is_kept_out(&pinned).await.to_string();
    let shown = certificate.fingerprint();
    assert!(complaint.contains(&shown.to_string()), "the user can compare: {complaint}");
    assert!(complaint.contains(": its certificate"), "and reads no more than that: {complaint}");
    let authority = peer(&server, Trust::Authority(other.pem().0.to_owned()), DRIVER);
    let complaint = is_kept_out(&authority).await;
    assert!(matches!(complaint, SessionError::Untrusted { .. }), "{complaint}");
    fixture::stop(server).await;
}

#[tokio::test]
async fn plain_speech_is_not_understood_and_tokens_stay_secret() {
    let (server, _) = guarded();
    let plain = peer(&server, Trust::Plain, DRIVER);
    let complaint = is_kept_out(&plain).await.to_string();
    assert!(
        complaint.contains("uses encryption") && complaint.contains("--fingerprint"),
        "{complaint}"
    );
    let elsewhere = Peer { address: "192.0.2.1:1".to_owned(), ..plain };
    let complaint = is_kept_out(&elsewhere).await;
    assert!(matches!(complaint, SessionError::ExposedToken(_)), "{complaint}");
    fixture::stop(server).await;
}

#[tokio::test]
async fn who_wants_encryption_of_a_daemon_without_is_told_so() {
    let server = fixture::start_guarded(HubLimits::default(), Security::default());
    let other = Certificate::self_signed(vec!["localhost".to_owned()]).expect("made");
    for trust in [Trust::Pinned(other.fingerprint()), Trust::Authority(other.pem().0.to_owned())] {
        let complaint = is_kept_out(&peer(&server, trust, "")).await.to_string();
        assert!(complaint.contains("does not use encryption"), "{complaint}");
    }
    fixture::stop(server).await;
}

#[tokio::test]
async fn what_is_wrong_at_the_door_is_told_apart() {
    let (server, certificate) = guarded();
    let pinned = Trust::Pinned(certificate.fingerprint());
    let wrong = is_kept_out(&peer(&server, pinned.clone(), "the-token-of-nobody-at-all")).await;
    assert!(wrong.to_string().contains("a wrong token"), "{wrong}");
    let none = is_kept_out(&peer(&server, pinned, "")).await;
    assert!(none.to_string().contains("no token"), "{none}");
    fixture::stop(server).await;

    let limits = HubLimits { viewers: 1, ..HubLimits::default() };
    let server = fixture::start_guarded(limits, Security::default());
    let plain = peer(&server, Trust::Plain, "");
    let first = fixture::soon("the greeting", Session::open(&plain, Greeting::default())).await;
    let first = first.expect("the only place");
    let full = is_kept_out(&plain).await.to_string();
    assert!(full.contains("1 viewer"), "{full}");
    first.leave().await;
    fixture::stop(server).await;
}

/// Peers that connect and say nothing give their places back.
#[tokio::test]
async fn a_silent_peer_does_not_hold_the_door() {
    let (server, certificate) = guarded();
    let mut silent = Vec::new();
    for _ in 0..200 {
        silent.push(tokio::net::TcpStream::connect(server.address()).await.expect("listens"));
    }
    let peer = peer(&server, Trust::Pinned(certificate.fingerprint()), DRIVER);
    let patient = async {
        while Session::open(&peer, Greeting::default()).await.is_err() {
            tokio::time::sleep(Duration::from_millis(100)).await;
        }
    };
    fixture::soon("a place comes free", patient).await;
    drop(silent);
    fixture::stop(server).await;
}
