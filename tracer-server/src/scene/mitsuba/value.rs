//! Parameters: numbers, words, points and colours.

use common::Rgb;
use glam::DVec3;

use super::document::{Element, shorten};
use crate::scene::description::Coding;
use crate::scene::reading::diagnostic::LoadError;
use crate::scene::reading::text;

/// The most numbers of one value; a matrix has sixteen.
const MAX_NUMBERS: usize = 16;

/// Numbers that are separated by commas or white space.
pub(super) fn numbers(value: &str) -> Result<Vec<f64>, String> {
    let words = value.split(|c: char| c == ',' || c.is_whitespace()).filter(|w| !w.is_empty());
    let numbers: Vec<f64> = words
        .take(MAX_NUMBERS + 1)
        .map(|word| text::number(word).map_err(|_error| not_a_number(word)))
        .collect::<Result<_, _>>()?;
    if numbers.len() > MAX_NUMBERS {
        return Err(format!("more than {MAX_NUMBERS} numbers"));
    }
    Ok(numbers)
}

fn not_a_number(word: &str) -> String {
    format!("`{}` is not a finite number", shorten(word))
}

/// One or three numbers; one stands for all three.
fn triple(value: &str) -> Result<DVec3, String> {
    match numbers(value)?.as_slice() {
        [all] => Ok(DVec3::splat(*all)),
        [x, y, z] => Ok(DVec3::new(*x, *y, *z)),
        other => Err(format!("{} numbers where one or three are expected", other.len())),
    }
}

/// `#rrggbb` as codes.
fn hex(value: &str) -> Option<[u8; 3]> {
    let digits = value.trim().strip_prefix('#').filter(|digits| digits.len() == 6)?;
    let code = |at: usize| u8::from_str_radix(digits.get(at..at + 2)?, 16).ok();
    Some([code(0)?, code(2)?, code(4)?])
}

impl Element<'_> {
    /// A number among its attributes.
    pub(super) fn attribute_number(&self, name: &str) -> Result<Option<f64>, LoadError> {
        let Some(value) = self.attribute(name)? else { return Ok(None) };
        let number = text::number(value.trim())
            .map_err(|_error| self.error(format!("{name}: {}", not_a_number(&value))))?;
        Ok(Some(number))
    }

    /// A `float` or `integer` parameter.
    pub(super) fn number(&self, name: &str) -> Result<Option<f64>, LoadError> {
        let Some(element) = self.property(name)? else { return Ok(None) };
        if !matches!(element.tag(), "float" | "integer") {
            return Err(element.error("expected a number, as `<float>` or `<integer>`"));
        }
        element.needed("value")?;
        element.attribute_number("value")
    }

    /// An `integer` parameter.
    pub(super) fn integer(&self, name: &str) -> Result<Option<i64>, LoadError> {
        let Some(element) = self.property(name)? else { return Ok(None) };
        let value = element.needed("value")?;
        match value.trim().parse() {
            Ok(number) => Ok(Some(number)),
            Err(_) => Err(element.error(format!("`{}` is not a whole number", shorten(&value)))),
        }
    }

    /// A `boolean` parameter, false where it is absent.
    pub(super) fn flag(&self, name: &str) -> Result<bool, LoadError> {
        Ok(self.boolean(name)?.unwrap_or(false))
    }

    /// A `boolean` parameter.
    pub(super) fn boolean(&self, name: &str) -> Result<Option<bool>, LoadError> {
        let Some(element) = self.property(name)? else { return Ok(None) };
        let value = element.needed("value")?;
        match value.trim().to_ascii_lowercase().as_str() {
            "true" => Ok(Some(true)),
            "false" => Ok(Some(false)),
            _ => Err(element.error(format!("`{}` is neither true nor false", shorten(&value)))),
        }
    }

    /// A `string` parameter.
    pub(super) fn string(&self, name: &str) -> Result<Option<String>, LoadError> {
        let Some(element) = self.property(name)? else { return Ok(None) };
        element.needed("value").map(Some)
    }

    /// A `point` or `vector` parameter.
    pub(super) fn point(&self, name: &str) -> Result<Option<DVec3>, LoadError> {
        let Some(element) = self.property(name)? else { return Ok(None) };
        element.triple(0.0).map(Some)
    }

    /// The numbers `value`, or `x`, `y` and `z` with what stands for those that are absent.
    pub(super) fn triple(&self, absent: f64) -> Result<DVec3, LoadError> {
        if self.attribute("value")?.is_some() {
            return self.attribute_triple("value");
        }
        let coordinate = |name| Ok(self.attribute_number(name)?.unwrap_or(absent));
        Ok(DVec3::new(coordinate("x")?, coordinate("y")?, coordinate("z")?))
    }

    /// One or three numbers in an attribute that must be there.
    pub(super) fn attribute_triple(&self, name: &str) -> Result<DVec3, LoadError> {
        let value = self.needed(name)?;
        triple(&value).map_err(|message| self.error(format!("{name}: {message}")))
    }

    /// A colour parameter; textures are none.
    pub(super) fn color(&self, name: &str) -> Result<Option<Rgb>, LoadError> {
        self.property(name)?.map(|element| element.as_color()).transpose()
    }

    /// What this element, itself a parameter, says of a colour: linear RGB.
    pub(super) fn as_color(&self) -> Result<Rgb, LoadError> {
        let spectral = "colours are computed in RGB; give `<rgb value=\"r, g, b\"/>` instead";
        match self.tag() {
            "rgb" | "srgb" | "spectrum" | "float" | "integer" | "color" => {}
            "texture" => return Err(self.error("a texture is not possible here; give a colour")),
            _ => return Err(self.error(spectral)),
        }
        let Some(value) = self.attribute("value")? else { return Err(self.error(spectral)) };
        if value.contains(':') {
            return Err(self.error(format!("it is a spectrum over wavelengths: {spectral}")));
        }
        if let Some(codes) = hex(&value) {
            let [r, g, b] = codes.map(|code| Coding::Srgb.decode(code));
            return Ok(Rgb::new(r, g, b));
        }
        let DVec3 { x, y, z } = triple(&value).map_err(|message| self.error(message))?;
        if self.tag() != "srgb" {
            return Ok(Rgb::new(x, y, z));
        }
        let [r, g, b] = [x, y, z].map(|share| Coding::Srgb.decode_share(share));
        Ok(Rgb::new(r, g, b))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_stand_between_commas_or_spaces() {
        assert_eq!(numbers(" 0.725, 0.71 ,0.68"), Ok(vec![0.725, 0.71, 0.68]));
        assert_eq!(numbers("1 -2e3\n3"), Ok(vec![1.0, -2000.0, 3.0]));
        for bad in ["1, two", "nan", "1e999", "0x3"] {
            assert!(numbers(bad).is_err(), "{bad}");
        }
        assert!(numbers(&"1 ".repeat(17)).is_err(), "too many");
        assert!(triple("1, 2").is_err() && triple("").is_err(), "neither one nor three");
    }

    #[test]
    fn codes_stand_behind_a_hash() {
        assert_eq!(hex("#ff0080"), Some([255, 0, 128]));
        for bad in ["ff0080", "#ff00", "#gg0000", "#ff00800", "#\u{e9}\u{e9}\u{e9}"] {
            assert_eq!(hex(bad), None, "{bad}");
        }
    }
}
