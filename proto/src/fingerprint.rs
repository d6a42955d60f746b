//! What a certificate is known by.

use std::fmt;
use std::str::FromStr;

use ring::digest::{SHA256, digest};

/// SHA-256 of a certificate in DER: what `openssl x509 -noout -fingerprint -sha256` prints.
///
/// Both ends show it, so that a person can compare the two.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Fingerprint([u8; 32]);

impl Fingerprint {
    /// Of the certificate `der`.
    pub fn of(der: &[u8]) -> Self {
        let mut bytes = [0; 32];
        bytes.copy_from_slice(digest(&SHA256, der).as_ref());
        Self(bytes)
    }
}

impl fmt::Display for Fingerprint {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, byte) in self.0.iter().enumerate() {
            let colon = if i == 0 { "" } else { ":" };
            write!(f, "{colon}{byte:02X}")?;
        }
        Ok(())
    }
}

impl FromStr for Fingerprint {
    type Err = String;

    /// Reads 64 hexadecimal digits; colons and spaces between them do not matter.
    fn from_str(text: &str) -> Result<Self, String> {
        let digits: Option<Vec<u8>> = text
            .chars()
            .filter(|c| !matches!(c, ':' | ' '))
            .map(|c| c.to_digit(16).map(|digit| digit as u8))
            .collect();
        let complaint =
            "a fingerprint is 64 hexadecimal digits (SHA-256), such as the daemon prints";
        let digits = digits.filter(|digits| digits.len() == 64).ok_or(complaint)?;
        let mut bytes = [0; 32];
        for (byte, pair) in bytes.iter_mut().zip(digits.chunks_exact(2)) {
            *byte = pair.iter().fold(0, |high, low| high << 4 | low);
        }
        Ok(Self(bytes))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_shown_can_be_typed() {
        // The digest of no bytes at all [FIPS 180-4].
        let empty = Fingerprint::of(&[]);
        let text = empty.to_string();
        assert!(text.starts_with("E3:B0:C4:42") && text.ends_with("78:52:B8:55"), "{text}");
        assert_eq!(text.parse(), Ok(empty));
        assert_eq!(text.replace(':', "").to_lowercase().parse(), Ok(empty));
        for bad in ["", "E3:B0", &text[1..], &text.replace('E', "G"), &format!("{text}:00")] {
            assert!(bad.parse::<Fingerprint>().is_err(), "`{bad}` was taken");
        }
    }
}
