//! XML in the encodings that programs write: UTF-8, UTF-16 and the Latin alphabets of old.

use std::path::Path;

use super::diagnostic::{LoadError, Place};
use super::text::read_bytes;

/// How far into a file its declaration of an encoding is looked for, in bytes.
const DECLARATION: usize = 200;

/// What Windows-1252 has in the place of the control characters 0x80 to 0x9f of Latin-1.
const WINDOWS: [char; 32] = [
    '\u{20ac}', '\u{81}', '\u{201a}', '\u{192}', '\u{201e}', '\u{2026}', '\u{2020}', '\u{2021}',
    '\u{2c6}', '\u{2030}', '\u{160}', '\u{2039}', '\u{152}', '\u{8d}', '\u{17d}', '\u{8f}',
    '\u{90}', '\u{2018}', '\u{2019}', '\u{201c}', '\u{201d}', '\u{2022}', '\u{2013}', '\u{2014}',
    '\u{2dc}', '\u{2122}', '\u{161}', '\u{203a}', '\u{153}', '\u{9d}', '\u{17e}', '\u{178}',
];

/// The text of an XML file, whose first bytes tell how it is encoded; without a mark of its order.
pub(crate) fn read_xml(path: &Path, limit: u64) -> Result<String, LoadError> {
    let bytes = read_bytes(path, limit)?;
    let text = match bytes.as_slice() {
        [0xff, 0xfe, ..] | [b'<', 0, ..] => utf16(&bytes, u16::from_le_bytes),
        [0xfe, 0xff, ..] | [0, b'<', ..] => utf16(&bytes, u16::from_be_bytes),
        _ => latin(&bytes).map_or_else(|| utf8(bytes), Ok),
    };
    let text = text.map_err(|(line, message)| Place::line(path, line).error(message))?;
    Ok(text.strip_prefix('\u{feff}').map_or_else(|| text.clone(), str::to_owned))
}

/// What is wrong with a text, and on which line.
type Wrong = (usize, &'static str);

fn utf8(bytes: Vec<u8>) -> Result<String, Wrong> {
    String::from_utf8(bytes).map_err(|error| {
        let good = error.utf8_error().valid_up_to();
        let line = 1 + error.as_bytes().iter().take(good).filter(|&&byte| byte == b'\n').count();
        (
            line,
            "the text is not UTF-8, and its first line names no other encoding; save it as UTF-8",
        )
    })
}

fn utf16(bytes: &[u8], unit: fn([u8; 2]) -> u16) -> Result<String, Wrong> {
    let (pairs, rest) = bytes.as_chunks();
    let units: Vec<u16> = pairs.iter().map(|&pair| unit(pair)).collect();
    let text = String::from_utf16(&units).ok().filter(|_| rest.is_empty());
    text.ok_or((1, "the text begins as UTF-16 and does not go on so; save it as UTF-8"))
}

/// The text, where its declaration names a Latin alphabet of one byte a letter.
fn latin(bytes: &[u8]) -> Option<String> {
    let head = String::from_utf8_lossy(bytes.get(..DECLARATION).unwrap_or(bytes)).to_lowercase();
    let declaration = head.strip_prefix("<?xml")?.split("?>").next()?;
    let named = declaration.split("encoding").nth(1)?;
    let name = named.trim_start_matches(|c: char| c.is_whitespace() || "='\"".contains(c));
    let name = name.split(['"', '\'']).next()?;
    match name {
        "iso-8859-1" | "latin1" | "latin-1" => {
            Some(bytes.iter().copied().map(char::from).collect())
        }
        "windows-1252" | "cp1252" => {
            let letter = |byte: u8| match byte {
                0x80..=0x9f => WINDOWS.get(usize::from(byte - 0x80)).copied().unwrap_or('?'),
                _ => char::from(byte),
            };
            Some(bytes.iter().copied().map(letter).collect())
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What a file of these bytes says.
    fn read(bytes: &[u8]) -> Result<String, String> {
        let directory = tempfile::tempdir().expect("a directory");
        let path = directory.path().join("a.xml");
        std::fs::write(&path, bytes).expect("written");
        read_xml(&path, 1000).map_err(|error| error.to_string())
    }

    #[test]
    fn every_encoding_says_the_same() {
        let text =
            |encoding: &str| format!("<?xml version='1.0' encoding=\"{encoding}\"?><\u{e9}/>");
        let expected = Ok(text("utf-8"));
        assert_eq!(read(text("utf-8").as_bytes()), expected);
        assert_eq!(read(format!("\u{feff}{}", text("utf-8")).as_bytes()), expected, "with a mark");
        for mark in ["", "\u{feff}"] {
            let units: Vec<u16> = format!("{mark}{}", text("utf-16")).encode_utf16().collect();
            let little: Vec<u8> = units.iter().flat_map(|unit| unit.to_le_bytes()).collect();
            let big: Vec<u8> = units.iter().flat_map(|unit| unit.to_be_bytes()).collect();
            assert_eq!(read(&little), Ok(text("utf-16")));
            assert_eq!(read(&big), Ok(text("utf-16")));
        }
        for name in ["ISO-8859-1", "windows-1252"] {
            let bytes: Vec<u8> = text(name).chars().map(|c| c as u8).collect();
            assert_eq!(read(&bytes), Ok(text(name)));
        }
        assert_eq!(
            read(b"<?xml encoding='cp1252'?>\x93\x80"),
            Ok("<?xml encoding='cp1252'?>\u{201c}\u{20ac}".to_owned())
        );
    }

    #[test]
    fn what_is_in_no_encoding_is_located() {
        let complaint = read(b"<a>\n<b c=\"\xe9\"/></a>").expect_err("not UTF-8");
        assert!(complaint.contains("a.xml:2: the text is not UTF-8"), "{complaint}");
        assert!(read(b"\xff\xfe<\0a").is_err(), "half a letter is missing");
        assert!(read(b"\xff\xfe\x00\xd8<\0").is_err(), "half of a pair");
    }
}
