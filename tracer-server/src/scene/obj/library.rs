//! Reads the text of an MTL file once before the parser does, so that every complaint names its
//! line, and so that the parser meets only statements that it can read.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use crate::scene::reading::diagnostic::{LoadError, Place, Warning};
use crate::scene::reading::text::{Statement, number, statements};

/// A checked MTL text.
#[derive(Debug, Default)]
pub(crate) struct MtlText {
    /// Statements that the parser can read, all of them valid.
    pub(crate) text: String,
    /// Where each material begins.
    pub(crate) places: BTreeMap<String, Place>,
    /// What in the file is not supported.
    pub(crate) warnings: Vec<Warning>,
}

/// Checks an MTL text and appends what remains of it to `out`.
pub(crate) fn scan(text: &str, file: &Path, out: &mut MtlText) -> Result<(), LoadError> {
    let mut material: Option<String> = None;
    for statement in statements(text) {
        let place = Place::line(file, statement.line);
        let Statement { keyword, rest, .. } = &statement;
        if keyword == "newmtl" {
            if rest.is_empty() {
                return Err(place.error("newmtl without a name"));
            }
            if let Some(before) = out.places.get(rest.as_ref()) {
                let message =
                    format!("material `{rest}` is defined again; it replaces the one at {before}");
                out.warnings.push(place.clone().warning(message));
            }
            out.places.insert(rest.to_string(), place);
            material = Some(rest.to_string());
            emit(out, keyword, rest);
            continue;
        }
        let Some(name) = &material else {
            return Err(place.error(format!("`{keyword}` before the first newmtl")));
        };
        match check(keyword, rest) {
            Ok(Meaning::Keep(value)) => emit(out, keyword, &value),
            Ok(Meaning::Silent) => {}
            Ok(Meaning::Ignored) => {
                let message =
                    format!("material `{name}`: `{keyword}` is not supported and was ignored");
                out.warnings.push(place.warning(message));
            }
            Err(message) => {
                return Err(place.error(format!("material `{name}`, {keyword}: {message}")));
            }
        }
    }
    Ok(())
}

fn emit(out: &mut MtlText, keyword: &str, rest: &str) {
    for part in [keyword, " ", rest, "\n"] {
        out.text.push_str(part);
    }
}

/// What becomes of a statement.
enum Meaning {
    /// It goes to the parser, with this value.
    Keep(String),
    /// It says nothing about how the surface looks here.
    Silent,
    /// It would change the picture, but is not modelled.
    Ignored,
}

fn check(keyword: &str, rest: &str) -> Result<Meaning, String> {
    match keyword {
        "Kd" | "Ks" | "Ke" | "Tf" => color(rest).map(Meaning::Keep),
        "Ns" | "Ni" | "Tr" | "Pr" | "Pm" => one_number(rest).map(Meaning::Keep),
        // `-halo` makes the dissolve depend on the angle.
        "d" => one_number(rest.trim_start_matches("-halo").trim()).map(Meaning::Keep),
        "illum" => match rest.parse::<u8>() {
            Ok(0..=10) => Ok(Meaning::Keep(rest.to_owned())),
            _ => Err(format!("`{rest}` is not an illumination model; they are numbered 0 to 10")),
        },
        "map_Kd" | "map_Ke" | "map_Pr" | "map_Ns" if rest.is_empty() => {
            Err("the name of an image is missing".to_owned())
        }
        "map_Kd" | "map_Ke" | "map_Pr" | "map_Ns" => Ok(Meaning::Keep(rest.to_owned())),
        "Ka" | "map_Ka" | "Km" | "sharpness" | "map_aat" => Ok(Meaning::Silent),
        _ => Ok(Meaning::Ignored),
    }
}

/// One or three numbers that are not negative; always written out as three.
fn color(rest: &str) -> Result<String, String> {
    let first = rest.split_whitespace().next().unwrap_or_default();
    if first == "spectral" || first == "xyz" {
        return Err(format!("{first} colours are not supported; write three RGB values"));
    }
    let mut values = Vec::with_capacity(3);
    for word in rest.split_whitespace().take(4) {
        let value = number(word)?;
        if value < 0.0 {
            return Err(format!("`{word}` is negative; a colour has no negative channel"));
        }
        values.push(word);
    }
    match values.as_slice() {
        [r, g, b] => Ok(format!("{r} {g} {b}")),
        [grey] => Ok(format!("{grey} {grey} {grey}")),
        _ => Err(format!("`{rest}` is not a colour; write one or three numbers")),
    }
}

fn one_number(rest: &str) -> Result<String, String> {
    let mut words = rest.split_whitespace();
    match (words.next(), words.next()) {
        (Some(word), None) => number(word).map(|_| word.to_owned()),
        _ => Err(format!("`{rest}` is not one number")),
    }
}

/// The file that a `map_` statement names: everything after its options, spaces included.
pub(crate) fn texture_file(value: &str) -> PathBuf {
    let mut rest = value.trim();
    while let Some(option) = rest.strip_prefix('-') {
        let (name, tail) = option.split_once(char::is_whitespace).unwrap_or((option, ""));
        let arguments = match name {
            "blendu" | "blendv" | "cc" | "clamp" | "imfchan" | "bm" | "boost" | "texres"
            | "type" => 1,
            "mm" => 2,
            // One to three numbers.
            "o" | "s" | "t" => {
                let words = tail.split_whitespace().take(3);
                words.take_while(|word| word.parse::<f64>().is_ok()).count()
            }
            _ => break,
        };
        rest = tail.trim_start();
        for _ in 0..arguments {
            rest = rest.split_once(char::is_whitespace).map_or("", |(_, tail)| tail.trim_start());
        }
    }
    PathBuf::from(rest.replace('\\', "/"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_mistake_names_its_line_material_and_field() {
        let cases = [
            ("Kd 1 2", "`1 2` is not a colour"),
            ("Kd", "is not a colour"),
            ("Kd 1 1 1 1", "is not a colour"),
            ("Ke 1 nan 1", "not a finite number"),
            ("Ke 1 1e999 1", "not a finite number"),
            ("Ks -1 0 0", "negative"),
            ("Kd spectral a.rfl 1", "spectral"),
            ("Ns ten", "`ten` is not a number"),
            ("Ni", "is not one number"),
            ("d 0.5 0.5", "is not one number"),
            ("illum 11", "illumination model"),
            ("illum x", "illumination model"),
            ("map_Kd", "image is missing"),
        ];
        for (line, expected) in cases {
            let text = format!("# head\nnewmtl red\n{line}\n");
            let message = scan(&text, Path::new("x.mtl"), &mut MtlText::default())
                .expect_err("must be refused")
                .to_string();
            let keyword = line.split(' ').next().expect("a word");
            let start = format!("x.mtl:3: material `red`, {keyword}: ");
            assert!(message.starts_with(&start), "{line}: {message}");
            assert!(message.contains(expected), "{line}: {message}");
        }
        for (text, expected) in [("Kd 1 1 1", "before the first"), ("newmtl", "without a name")] {
            let error = scan(text, Path::new("x.mtl"), &mut MtlText::default());
            let message = error.expect_err("must be refused").to_string();
            assert!(message.starts_with("x.mtl:1: ") && message.contains(expected), "{message}");
        }
    }

    #[test]
    fn what_remains_is_plain() {
        let mut out = MtlText::default();
        let text = "newmtl a b #1\n\tKd 0.5\nKa 1 1 1\nd -halo 0.5\nmap_bump x.png\n";
        scan(text, Path::new("x.mtl"), &mut out).expect("valid");
        assert_eq!(out.text, "newmtl a b #1\nKd 0.5 0.5 0.5\nd 0.5\n");
        assert_eq!(out.warnings.len(), 1, "the bump map: {:?}", out.warnings);
        assert!(out.places.contains_key("a b #1"), "names may hold spaces and numbers");
    }

    #[test]
    fn texture_options_are_not_part_of_the_name() {
        let file = |value| texture_file(value).to_string_lossy().into_owned();
        assert_eq!(file("textures/Good Textures_1.jpg"), "textures/Good Textures_1.jpg");
        assert_eq!(file("-s 1 1 1 -clamp on a b.png"), "a b.png");
        assert_eq!(file("-o 0.5 -mm 0 1 a\\b.png"), "a/b.png");
        assert_eq!(file("-odd.png"), "-odd.png");
        assert_eq!(file("-s 1 1 1"), "");
    }
}
