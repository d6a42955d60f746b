//! The checks that every conversion shares.

use super::WireError;

/// Longest name of anything, in bytes.
pub(super) const MAX_NAME: usize = 256;
/// Longest reason, in bytes.
pub(super) const MAX_REASON: usize = 1024;
/// Longest list of names; strategies and reasons are referred to by one byte.
pub(super) const MAX_NAMES: usize = 256;
/// Largest side of the film in pixels.
pub(super) const MAX_FILM_SIDE: u32 = 1 << 16;

/// A text of at most `limit` bytes.
pub(super) fn text(field: &'static str, text: String, limit: usize) -> Result<String, WireError> {
    length(field, text.len(), limit)?;
    Ok(text)
}

/// A text cut to at most `limit` bytes: scene files may hold longer ones than the wire.
pub(super) fn cut(text: &str, limit: usize) -> String {
    text[..text.floor_char_boundary(limit)].to_owned()
}

/// A list of names, as strategies and reasons are announced.
pub(super) fn names(field: &'static str, names: Vec<String>) -> Result<Vec<String>, WireError> {
    length(field, names.len(), MAX_NAMES)?;
    names.into_iter().map(|name| text(field, name, MAX_NAME)).collect()
}

/// That a length keeps to its limit.
pub(super) fn length(field: &'static str, found: usize, limit: usize) -> Result<(), WireError> {
    if found > limit { Err(WireError::TooLong { field, found, limit }) } else { Ok(()) }
}

/// That a list is as long as another one says.
pub(super) fn exactly(field: &'static str, found: usize, wanted: usize) -> Result<(), WireError> {
    let bound = |length: usize| length.try_into().unwrap_or(u32::MAX);
    within(field, bound(found), bound(wanted), bound(wanted)).map(drop)
}

/// The content of a field that must be there.
pub(super) fn required<T>(field: &'static str, value: Option<T>) -> Result<T, WireError> {
    value.ok_or(WireError::Missing(field))
}

/// A whole number within `least..=most`.
pub(super) fn within(
    field: &'static str,
    found: u32,
    least: u32,
    most: u32,
) -> Result<u32, WireError> {
    if (least..=most).contains(&found) {
        return Ok(found);
    }
    Err(WireError::OutOfRange {
        field,
        found: found.into(),
        least: least.into(),
        most: most.into(),
    })
}

/// A number that is neither NaN nor infinite.
pub(super) fn finite(field: &'static str, found: f64) -> Result<f64, WireError> {
    if found.is_finite() {
        Ok(found)
    } else {
        Err(WireError::BadNumber { field, found, wanted: "finite" })
    }
}

/// A finite number above zero.
pub(super) fn positive(field: &'static str, found: f64) -> Result<f64, WireError> {
    if found.is_finite() && found > 0.0 {
        Ok(found)
    } else {
        Err(WireError::BadNumber { field, found, wanted: "finite and positive" })
    }
}

/// A finite number, zero included.
pub(super) fn not_negative(field: &'static str, found: f64) -> Result<f64, WireError> {
    if found.is_finite() && found >= 0.0 {
        Ok(found)
    } else {
        Err(WireError::BadNumber { field, found, wanted: "finite, non-negative" })
    }
}

/// A number within `least..=most`; NaN is not.
pub(super) fn between(
    field: &'static str,
    found: f64,
    least: f64,
    most: f64,
) -> Result<f64, WireError> {
    if (least..=most).contains(&found) {
        Ok(found)
    } else {
        Err(WireError::OutOfBounds { field, found, least, most })
    }
}

/// A column of finite numbers.
pub(super) fn all_finite(field: &'static str, values: &[f32]) -> Result<(), WireError> {
    match values.iter().find(|value| !value.is_finite()) {
        Some(&found) => Err(WireError::BadNumber { field, found: found.into(), wanted: "finite" }),
        None => Ok(()),
    }
}

/// The number itself, or zero where it is not known, as the protocol says it.
pub(super) fn known_or_zero(value: f64) -> f64 {
    if value.is_finite() { value } else { 0.0 }
}
