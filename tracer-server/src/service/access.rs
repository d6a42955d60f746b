//! Who may connect, and in which role.

use common::Role;
use tonic::service::Interceptor;
use tonic::{Request, Status};

use super::connections::Caller;

/// What comes before a token in the `authorization` entry of a request [RFC 6750].
const SCHEME: &str = "Bearer ";
/// Shorter tokens can be guessed.
pub const MIN_TOKEN_LENGTH: usize = 16;
/// Longer ones are no tokens.
pub const MAX_TOKEN_LENGTH: usize = 1024;

/// A secret that viewers show at the door.
///
/// Only its hash is kept, and hashes are compared in constant time: neither the time of a refusal
/// nor a memory dump tells the secret.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Token(blake3::Hash);

impl Token {
    /// Of a secret text; white space around it does not count.
    pub fn new(secret: &str) -> Result<Self, String> {
        let secret = secret.trim();
        let length = secret.len();
        if !(MIN_TOKEN_LENGTH..=MAX_TOKEN_LENGTH).contains(&length) {
            return Err(format!(
                "the token has {length} characters; it must have {MIN_TOKEN_LENGTH} to \
                {MAX_TOKEN_LENGTH}: make one with `openssl rand -base64 24`"
            ));
        }
        if !secret.chars().all(|c| c.is_ascii_graphic()) {
            return Err("a token is one line of printable ASCII without spaces; make one with \
                        `openssl rand -base64 24`"
                .to_owned());
        }
        Ok(Self(blake3::hash(secret.as_bytes())))
    }
}

/// The tokens that open the door. Without any, everyone may do everything.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Access {
    /// Lets a viewer steer.
    pub driver: Option<Token>,
    /// Lets a viewer watch.
    pub observer: Option<Token>,
}

impl Access {
    /// What the bearer of `presented` may do at most; `None` for no entry.
    pub fn role(&self, presented: Option<&str>) -> Option<Role> {
        if self.driver.is_none() && self.observer.is_none() {
            return Some(Role::Driver);
        }
        let presented = blake3::hash(presented?.trim().as_bytes());
        // Both are compared, whatever the first says.
        let is = |token: Option<Token>| token.is_some_and(|token| token.0 == presented);
        let (drives, observes) = (is(self.driver), is(self.observer));
        match (drives, observes) {
            (true, _) => Some(Role::Driver),
            (false, true) => Some(Role::Observer),
            (false, false) => None,
        }
    }
}

/// The most that the bearer of a request's token may become.
#[derive(Clone, Copy, Debug)]
pub(super) struct Allowed(pub(super) Role);

impl Interceptor for Access {
    fn call(&mut self, mut request: Request<()>) -> Result<Request<()>, Status> {
        let caller = Caller::of(request.extensions());
        caller.map_or(Ok(()), Caller::check)?;
        let entry = request.metadata().get("authorization").map(|value| value.to_str());
        let presented = entry.and_then(|text| text.ok()?.strip_prefix(SCHEME));
        let Some(role) = self.role(presented) else {
            let what = if presented.is_some() { "a wrong token" } else { "no token" };
            let address = caller.and_then(Caller::address);
            let peer = address.map_or_else(|| "somebody".to_owned(), |address| address.to_string());
            tracing::warn!(peer, "refused: {what}");
            let message = format!(
                "{what}: this daemon requires one; start the viewer with --token-file FILE, where \
                FILE holds the token that the daemon's owner gave you"
            );
            return Err(Status::unauthenticated(message));
        };
        request.extensions_mut().insert(Allowed(role));
        Ok(request)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const DRIVER: &str = "a-token-for-the-driver";
    const OBSERVER: &str = "a-token-for-observers";

    #[test]
    fn each_token_gives_its_role() {
        let token = |text| Some(Token::new(text).expect("long enough"));
        let both = Access { driver: token(DRIVER), observer: token(OBSERVER) };
        assert_eq!(both.role(Some(DRIVER)), Some(Role::Driver));
        assert_eq!(both.role(Some(&format!("{OBSERVER}\n"))), Some(Role::Observer));
        for wrong in [None, Some(""), Some("x"), Some(&DRIVER[1..]), Some("a-token-for-the-drives")]
        {
            assert_eq!(both.role(wrong), None, "{wrong:?}");
        }
        let one = Access { driver: token(DRIVER), observer: None };
        assert_eq!(one.role(Some(OBSERVER)), None, "an observers' token that nobody has set");
        assert_eq!(Access::default().role(None), Some(Role::Driver), "an open door");
    }

    #[test]
    fn weak_tokens_are_refused() {
        let long = "x".repeat(MAX_TOKEN_LENGTH + 1);
        for weak in [
            "",
            "short",
            "   padded        ",
            &long,
            "has spaces in the middle",
            "schlüssel-zum-tor",
        ] {
            assert!(Token::new(weak).is_err(), "`{weak}` was taken");
        }
    }
}
