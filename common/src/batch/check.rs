//! What columns from elsewhere must be before they are believed.

use super::{BatchError, BatchOrigin, MAX_VERTICES, PathColumns, VertexColumns};
use crate::{Event, VertexKind};

pub(super) fn lengths(paths: &PathColumns, vertices: &VertexColumns) -> Result<(), BatchError> {
    let records = paths.chain.len();
    let inserted = paths.inserted.iter().map(|&n| usize::from(n)).sum();
    let expectations = [
        ("epoch", paths.epoch.len(), records),
        ("step", paths.step.len(), records),
        ("strategy", paths.strategy.len(), records),
        ("kept_light", paths.kept_light.len(), records),
        ("kept_eye", paths.kept_eye.len(), records),
        ("inserted", paths.inserted.len(), records),
        ("dwell", paths.dwell.len(), records),
        ("weight", paths.weight.len(), records),
        ("acceptance", paths.acceptance.len(), records),
        ("film", paths.film.len(), records),
        ("luminance", paths.luminance.len(), records),
        ("rgb", paths.rgb.len(), records),
        ("position", vertices.position.len(), inserted),
        ("normal", vertices.normal.len(), inserted),
        ("kind", vertices.kind.len(), inserted),
        ("event", vertices.event.len(), inserted),
        ("material", vertices.material.len(), inserted),
        ("primitive", vertices.primitive.len(), inserted),
    ];
    for (column, found, expected) in expectations {
        if found != expected {
            return Err(BatchError::Length { column, found, expected });
        }
    }
    Ok(())
}

pub(super) fn origin(origin: &BatchOrigin) -> Result<(), BatchError> {
    let BatchOrigin { decimation, seen, matched, seen_steps, matched_steps, .. } = *origin;
    let counts = |number: f64| number.is_finite() && number >= 0.0;
    let complaint = if !counts(f64::from(decimation)) {
        "the decimation is not a finite number of steps"
    } else if !(counts(seen_steps) && counts(matched_steps)) {
        "the steps are not finite numbers"
    } else if matched > seen {
        "more paths match than were seen"
    } else {
        return Ok(());
    };
    Err(BatchError::Origin(complaint))
}

pub(super) fn values(paths: &PathColumns, vertices: &VertexColumns) -> Result<(), BatchError> {
    finite("weight", &paths.weight)?;
    finite("acceptance", &paths.acceptance)?;
    finite("film", paths.film.as_flattened())?;
    finite("luminance", &paths.luminance)?;
    finite("rgb", paths.rgb.as_flattened())?;
    self::vertices(vertices)
}

/// Values of vertices.
pub(super) fn vertices(vertices: &VertexColumns) -> Result<(), BatchError> {
    finite("position", vertices.position.as_flattened())?;
    known("kind", &vertices.kind, |code| VertexKind::from_code(code).is_some())?;
    known("event", &vertices.event, |code| Event::from_code(code).is_some())
}

fn finite(column: &'static str, values: &[f32]) -> Result<(), BatchError> {
    match values.iter().position(|v| !v.is_finite()) {
        Some(index) => Err(BatchError::NotFinite { column, index }),
        None => Ok(()),
    }
}

fn known(column: &'static str, codes: &[u8], is_known: fn(u8) -> bool) -> Result<(), BatchError> {
    match codes.iter().position(|&code| !is_known(code)) {
        Some(index) => Err(BatchError::UnknownCode { column, code: codes[index], index }),
        None => Ok(()),
    }
}

pub(super) fn splices(paths: &PathColumns) -> Result<(), BatchError> {
    let mut lengths: Vec<(u32, usize)> = Vec::new();
    for (record, &chain) in paths.chain.iter().enumerate() {
        let kept = usize::from(paths.kept_light[record]) + usize::from(paths.kept_eye[record]);
        let total = kept + usize::from(paths.inserted[record]);
        let slot = lengths.iter_mut().find(|(known, _)| *known == chain);
        let available = slot.as_ref().map_or(0, |(_, length)| *length);
        if slot.is_none() && kept > 0 {
            return Err(BatchError::NoKeyframe { record, chain });
        }
        if kept > available || !(2..=MAX_VERTICES).contains(&total) {
            return Err(BatchError::Splice { record, kept, available, total });
        }
        match slot {
            Some((_, length)) => *length = total,
            None => lengths.push((chain, total)),
        }
    }
    Ok(())
}
