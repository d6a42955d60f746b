//! The focus lane.

use common::{
    ChainId, FocusOutcome, FocusPath, FocusStep, MAX_VERTICES, PathHeader, PathId, RatioFactors,
    StrategyId, VertexColumns, VertexRecord,
};

use super::{WireError, check, column};
use crate::v1;

impl From<PathId> for v1::PathId {
    fn from(PathId { chain, epoch, step }: PathId) -> Self {
        Self { chain: chain.0, epoch, step }
    }
}

impl From<v1::PathId> for PathId {
    fn from(v1::PathId { chain, epoch, step }: v1::PathId) -> Self {
        Self { chain: ChainId(chain), epoch, step }
    }
}

fn to_vertices(records: &[VertexRecord]) -> Option<v1::Vertices> {
    if records.is_empty() {
        return None;
    }
    let mut columns = VertexColumns::default();
    for vertex in records {
        columns.push(vertex);
    }
    Some(v1::Vertices {
        count: records.len() as u32,
        position: column::encode(&columns.position),
        normal: column::encode(&columns.normal),
        kind: column::encode(&columns.kind),
        event: column::encode(&columns.event),
        material: column::encode(&columns.material),
        primitive: column::encode(&columns.primitive),
    })
}

fn from_vertices(wire: Option<v1::Vertices>) -> Result<Vec<VertexRecord>, WireError> {
    let Some(wire) = wire else { return Ok(Vec::new()) };
    let count = wire.count as usize;
    check::length("vertices", count, MAX_VERTICES)?;
    let columns = VertexColumns {
        position: column::decode("position", &wire.position, count)?,
        normal: column::decode("normal", &wire.normal, count)?,
        kind: column::decode("kind", &wire.kind, count)?,
        event: column::decode("event", &wire.event, count)?,
        material: column::decode("material", &wire.material, count)?,
        primitive: column::decode("primitive", &wire.primitive, count)?,
    };
    Ok(columns.records()?)
}

fn to_color([r, g, b]: [f32; 3]) -> v1::Color {
    v1::Color { r: r.into(), g: g.into(), b: b.into() }
}

/// A colour, black where it is absent.
fn from_color(wire: Option<v1::Color>) -> Result<[f32; 3], WireError> {
    let v1::Color { r, g, b } = wire.unwrap_or_default();
    let rgb = [r as f32, g as f32, b as f32];
    check::all_finite("color", &rgb)?;
    Ok(rgb)
}

/// A point in single precision.
pub(super) fn to_point([x, y, z]: [f32; 3]) -> v1::Vector {
    v1::Vector { x: x.into(), y: y.into(), z: z.into() }
}

/// See [`to_point`].
pub(super) fn from_point(field: &'static str, wire: v1::Vector) -> Result<[f32; 3], WireError> {
    let point = [wire.x as f32, wire.y as f32, wire.z as f32];
    check::all_finite(field, &point)?;
    Ok(point)
}

fn strategy(index: u32) -> Result<StrategyId, WireError> {
    Ok(StrategyId(check::within("strategy", index, 0, 255)? as u8))
}

impl From<&FocusPath> for v1::FocusPath {
    fn from(path: &FocusPath) -> Self {
        let FocusPath { header, vertices, next } = path;
        Self {
            id: Some(header.id.into()),
            strategy: header.strategy.0.into(),
            acceptance: header.acceptance,
            dwell: header.dwell,
            film_u: header.film[0],
            film_v: header.film[1],
            luminance: header.luminance,
            color: Some(to_color(header.rgb)),
            vertices: to_vertices(vertices),
            next: *next,
        }
    }
}

impl TryFrom<v1::FocusPath> for FocusPath {
    type Error = WireError;

    fn try_from(wire: v1::FocusPath) -> Result<Self, WireError> {
        let numbers = [wire.acceptance, wire.film_u, wire.film_v, wire.luminance];
        check::all_finite("focus_path", &numbers)?;
        let vertices = from_vertices(wire.vertices)?;
        check::within("focus_path.vertices", vertices.len() as u32, 2, MAX_VERTICES as u32)?;
        let header = PathHeader {
            id: check::required("focus_path.id", wire.id)?.into(),
            strategy: strategy(wire.strategy)?,
            dwell: wire.dwell,
            weight: 0.0,
            acceptance: wire.acceptance,
            film: [wire.film_u, wire.film_v],
            luminance: wire.luminance,
            rgb: from_color(wire.color)?,
        };
        Ok(Self { header, vertices, next: wire.next })
    }
}

impl From<&FocusStep> for v1::FocusStep {
    fn from(step: &FocusStep) -> Self {
        let (outcome, reason) = match step.outcome {
            FocusOutcome::Accepted => (v1::FocusOutcome::Accepted, 0),
            FocusOutcome::Rejected => (v1::FocusOutcome::Rejected, 0),
            FocusOutcome::Failed(reason) => (v1::FocusOutcome::Failed, reason),
        };
        Self {
            number: step.number,
            id: Some(step.id.into()),
            fan: step.fan,
            strategy: step.strategy.0.into(),
            outcome: outcome.into(),
            reason: reason.into(),
            acceptance: step.acceptance,
            forward: step.factors.forward,
            backward: step.factors.backward,
            mixture_current: step.factors.mixture_current,
            mixture_proposed: step.factors.mixture_proposed,
            target_current: step.factors.target_current,
            target_proposed: step.factors.target_proposed,
            length: step.length as u32,
            kept_light: step.kept_light as u32,
            kept_eye: step.kept_eye as u32,
            inserted: to_vertices(&step.inserted),
            eye_side: to_vertices(&step.eye_side),
            blocker: step.blocker.map(to_point),
            film_u: step.film[0],
            film_v: step.film[1],
            luminance: step.luminance,
            color: Some(to_color(step.rgb)),
            rays: step.rays,
        }
    }
}

impl TryFrom<v1::FocusStep> for FocusStep {
    type Error = WireError;

    fn try_from(wire: v1::FocusStep) -> Result<Self, WireError> {
        let most = MAX_VERTICES as u32;
        let length = check::within("focus_step.length", wire.length, 2, most)?;
        let kept_light = check::within("focus_step.kept_light", wire.kept_light, 0, length)?;
        let kept_eye = check::within("focus_step.kept_eye", wire.kept_eye, 0, length - kept_light)?;
        let inserted = from_vertices(wire.inserted.clone())?;
        let reason = check::within("focus_step.reason", wire.reason, 0, 255)? as u8;
        let outcome = match v1::FocusOutcome::try_from(wire.outcome) {
            Ok(v1::FocusOutcome::Accepted) => FocusOutcome::Accepted,
            Ok(v1::FocusOutcome::Rejected) => FocusOutcome::Rejected,
            Ok(v1::FocusOutcome::Failed) => FocusOutcome::Failed(reason),
            Ok(v1::FocusOutcome::Unspecified) | Err(_) => {
                return Err(WireError::Missing("focus_step.outcome"));
            }
        };
        if !matches!(outcome, FocusOutcome::Failed(_)) {
            let made = kept_light + kept_eye + inserted.len() as u32;
            check::within("focus_step.inserted", made, 2, most)?;
        }
        check::all_finite("focus_step", &[wire.film_u, wire.film_v, wire.luminance])?;
        Ok(Self {
            number: wire.number,
            id: check::required("focus_step.id", wire.id)?.into(),
            fan: wire.fan,
            strategy: strategy(wire.strategy)?,
            outcome,
            acceptance: check::not_negative("focus_step.acceptance", wire.acceptance)?,
            factors: factors(&wire)?,
            length: length as usize,
            kept_light: kept_light as usize,
            kept_eye: kept_eye as usize,
            inserted,
            eye_side: from_vertices(wire.eye_side)?,
            blocker: wire.blocker.map(|p| from_point("focus_step.blocker", p)).transpose()?,
            film: [wire.film_u, wire.film_v],
            luminance: wire.luminance,
            rgb: from_color(wire.color)?,
            rays: wire.rays,
        })
    }
}

/// Densities may be infinite where a move is impossible one way: only NaN tells nothing.
fn factors(wire: &v1::FocusStep) -> Result<RatioFactors, WireError> {
    let number = |field, found: f64| {
        let told = found >= 0.0;
        told.then_some(found).ok_or(WireError::BadNumber { field, found, wanted: "non-negative" })
    };
    Ok(RatioFactors {
        forward: number("focus_step.forward", wire.forward)?,
        backward: number("focus_step.backward", wire.backward)?,
        mixture_current: number("focus_step.mixture_current", wire.mixture_current)?,
        mixture_proposed: number("focus_step.mixture_proposed", wire.mixture_proposed)?,
        target_current: number("focus_step.target_current", wire.target_current)?,
        target_proposed: number("focus_step.target_proposed", wire.target_proposed)?,
    })
}
