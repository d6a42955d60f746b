//! `path ...`: the path that is looked at.

use std::fmt;

use common::{Event, MAX_VERTICES, PathHeader, StrategyId, VertexKind, VertexRecord};

use super::Form;
use super::words::{CommandError, Words};
use crate::draw::pick::Aim;

/// What may be done with a path.
#[derive(Clone, Debug, PartialEq)]
pub enum PathCommand {
    /// Selects the path under the cursor; again, the next one there.
    Pick(Aim),
    /// Selects the path at which a chain stayed longest, or the next in that order.
    Stay(u8),
    /// Selects this path, whether or not it is among those that are held.
    Show(Box<PathHeader>, Vec<VertexRecord>),
    /// Selects the explorer's path, before the step that is shown.
    Explored,
    /// Selects none.
    Deselect,
    /// Brings a vertex of it into the middle of the view.
    Vertex(VertexStep),
}

/// Which vertex.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum VertexStep {
    /// One further towards the camera.
    Next,
    /// One further towards the light.
    Previous,
    /// This one, counted from the light, which is 0.
    To(u8),
}

impl fmt::Display for VertexStep {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Next => write!(f, "next"),
            Self::Previous => write!(f, "previous"),
            Self::To(index) => write!(f, "{index}"),
        }
    }
}

pub(super) const FORMS: &[Form] = &[
    (
        "path pick RIGHT UP REACH",
        "select the path at tangents from the view direction; again, the next one there",
    ),
    ("path stay RANK", "select a path at which a chain stayed long; the longest stay is 0"),
    ("path explored", "select the explorer's path, before the step that is shown"),
    ("path show ID NUMBERS", "select a path that is written out, as in a link to a view"),
    ("path none", "select no path"),
    ("path vertex next|previous|INDEX", "look at a vertex of the selected path"),
];

impl fmt::Display for PathCommand {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Pick(Aim { at: [x, y], reach }) => write!(f, "pick {x} {y} {reach}"),
            Self::Stay(rank) => write!(f, "stay {rank}"),
            Self::Show(header, vertices) => show(f, header, vertices),
            Self::Explored => write!(f, "explored"),
            Self::Deselect => write!(f, "none"),
            Self::Vertex(step) => write!(f, "vertex {step}"),
        }
    }
}

fn show(f: &mut fmt::Formatter<'_>, h: &PathHeader, vertices: &[VertexRecord]) -> fmt::Result {
    let ([u, v], [r, g, b]) = (h.film, h.rgb);
    write!(f, "show {} {} {} {} ", h.id, h.strategy.0, h.dwell, h.weight)?;
    write!(f, "{} {u} {v} {} {r} {g} {b}", h.acceptance, h.luminance)?;
    for vertex in vertices {
        let ([x, y, z], [m, n]) = (vertex.position, vertex.normal);
        let (kind, event) = (vertex.kind as u8, vertex.event as u8);
        write!(f, " {x} {y} {z} {m} {n} {kind} {event} {} {}", vertex.material, vertex.primitive)?;
    }
    Ok(())
}

/// Reads what [`show`] has written.
fn read_shown(words: &mut Words<'_>) -> Result<PathCommand, CommandError> {
    const ANY: std::ops::RangeInclusive<f32> = f32::MIN..=f32::MAX;
    let id = words.next("ID")?;
    let id = id.parse().map_err(|_no_id| CommandError::NoPath)?;
    let mut number = |name| words.number(name, ANY);
    let strategy = StrategyId(number("STRATEGY")?.clamp(0.0, 255.0) as u8);
    let header = PathHeader {
        id,
        strategy,
        dwell: number("DWELL")?.max(0.0) as u32,
        weight: number("WEIGHT")?,
        acceptance: number("ACCEPTANCE")?,
        film: [number("U")?, number("V")?],
        luminance: number("LUMINANCE")?,
        rgb: [number("RED")?, number("GREEN")?, number("BLUE")?],
    };
    let mut vertices = Vec::new();
    while words.peek().is_some() && vertices.len() < MAX_VERTICES {
        vertices.push(read_vertex(words)?);
    }
    if vertices.len() < 2 {
        return Err(CommandError::NoPath);
    }
    Ok(PathCommand::Show(Box::new(header), vertices))
}

fn read_vertex(words: &mut Words<'_>) -> Result<VertexRecord, CommandError> {
    const ANY: std::ops::RangeInclusive<f32> = f32::MIN..=f32::MAX;
    let position = [words.number("X", ANY)?, words.number("Y", ANY)?, words.number("Z", ANY)?];
    let normal = [
        words.within("NORMAL", i16::MIN..=i16::MAX)?,
        words.within("NORMAL", i16::MIN..=i16::MAX)?,
    ];
    let kind = VertexKind::from_code(words.within("KIND", u8::MIN..=u8::MAX)?);
    let event = Event::from_code(words.within("EVENT", u8::MIN..=u8::MAX)?);
    Ok(VertexRecord {
        position,
        normal,
        kind: kind.ok_or(CommandError::NoPath)?,
        event: event.ok_or(CommandError::NoPath)?,
        material: words.within("MATERIAL", u16::MIN..=u16::MAX)?,
        primitive: words.within("PRIMITIVE", u32::MIN..=u32::MAX)?,
    })
}

pub(super) fn parse(words: &mut Words<'_>) -> Result<PathCommand, CommandError> {
    const TANGENT: std::ops::RangeInclusive<f32> = -100.0..=100.0;
    Ok(match words.next("path command")? {
        "pick" => PathCommand::Pick(Aim {
            at: [words.number("RIGHT", TANGENT)?, words.number("UP", TANGENT)?],
            reach: words.number("REACH", 0.0..=1.0)?,
        }),
        "stay" => PathCommand::Stay(words.count("RANK", 0..=255)? as u8),
        "show" => read_shown(words)?,
        "explored" => PathCommand::Explored,
        "none" => PathCommand::Deselect,
        "vertex" => PathCommand::Vertex(match words.peek() {
            Some("next") => words.next("vertex").map(|_| VertexStep::Next)?,
            Some("previous") => words.next("vertex").map(|_| VertexStep::Previous)?,
            _ => VertexStep::To(words.count("INDEX", 0..=255)? as u8),
        }),
        other => return Err(CommandError::Unknown(format!("path {other}"))),
    })
}
