//! A path, and a vertex of it.

use common::{Event, MAX_VERTICES, PathHeader, StrategyId, VertexKind, VertexRecord};

use glam::Vec2;

use super::{Axes, CommandError, Range, Value, Words, range};

/// Which vertex of a path.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum VertexStep {
    /// One further towards the camera.
    Next,
    /// One further towards the light.
    Previous,
    /// This one, counted from the light, which is 0.
    To(u8),
}

impl Value for VertexStep {
    type Limits = ();

    fn form(_: &str, (): &()) -> String {
        "next|previous|INDEX".to_owned()
    }

    fn read(words: &mut Words<'_>, _: &str, (): &()) -> Result<Self, CommandError> {
        if words.skip("next") {
            Ok(Self::Next)
        } else if words.skip("previous") {
            Ok(Self::Previous)
        } else {
            range(0, u8::MAX).read(words, "INDEX").map(Self::To)
        }
    }

    fn text(&self) -> String {
        match self {
            Self::Next => "next".to_owned(),
            Self::Previous => "previous".to_owned(),
            Self::To(index) => index.to_string(),
        }
    }

    fn examples((): &()) -> Vec<Self> {
        vec![Self::Next, Self::Previous, Self::To(3)]
    }
}

/// Where the user points, and how far off a path may lie.
///
/// All three are tangents of angles from the view direction, so that neither the size nor the shape
/// of the window matters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pointer {
    /// To the right and upwards.
    pub at: [f32; 2],
    /// How far off, in any direction.
    pub reach: f32,
}

impl Pointer {
    /// True when the user points at the same thing, as far as a hand can.
    pub fn is_near(self, other: Self) -> bool {
        let off = Vec2::from(self.at).distance(Vec2::from(other.at));
        off <= 0.5 * self.reach.max(other.reach)
    }

    const NUMBERS: Axes<f32, 3> = Axes {
        names: ["RIGHT", "UP", "REACH"],
        ranges: [range(-100.0, 100.0), range(-100.0, 100.0), range(0.0, 1.0)],
    };
}

impl Value for Pointer {
    type Limits = ();

    fn form(name: &str, (): &()) -> String {
        <[f32; 3]>::form(name, &Self::NUMBERS)
    }

    fn read(words: &mut Words<'_>, name: &str, (): &()) -> Result<Self, CommandError> {
        let [x, y, reach] = Value::read(words, name, &Self::NUMBERS)?;
        Ok(Self { at: [x, y], reach })
    }

    fn text(&self) -> String {
        let [x, y] = self.at;
        [x, y, self.reach].text()
    }

    fn examples((): &()) -> Vec<Self> {
        vec![Self { at: [0.1, -0.2], reach: 0.01 }]
    }
}

/// A whole path, written out.
#[derive(Clone, Debug, PartialEq)]
pub struct ShownPath {
    /// What is known of it.
    pub header: PathHeader,
    /// Its vertices, from the light on; at least two.
    pub vertices: Vec<VertexRecord>,
}

const ANY: Range<f32> = range(f32::MIN, f32::MAX);

impl Value for ShownPath {
    type Limits = ();

    fn form(_: &str, (): &()) -> String {
        "ID NUMBERS".to_owned()
    }

    fn read(words: &mut Words<'_>, _: &str, (): &()) -> Result<Self, CommandError> {
        let id = words.parameter("ID")?.parse().map_err(|_no_id| CommandError::NoPath)?;
        let mut number = |name| ANY.read(words, name);
        let header = PathHeader {
            id,
            strategy: StrategyId(number("STRATEGY")?.clamp(0.0, 255.0) as u8),
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
        Ok(Self { header, vertices })
    }

    fn text(&self) -> String {
        let h = &self.header;
        let ([u, v], [r, g, b]) = (h.film, h.rgb);
        let mut words = vec![
            format!("{} {} {} {}", h.id, h.strategy.0, h.dwell, h.weight),
            format!("{} {u} {v} {} {r} {g} {b}", h.acceptance, h.luminance),
        ];
        words.extend(self.vertices.iter().map(vertex_text));
        words.join(" ")
    }

    fn examples((): &()) -> Vec<Self> {
        let text = "3.0.1024 1 7 32 0.5 0.25 0.75 1.5 1 0.5 0 1 2.5 -3 0 32767 0 0 1 4 \
                    4 5 6 0 -32768 6 0 0 4294967295";
        Self::read(&mut Words::new(text), "", &()).into_iter().collect()
    }
}

fn vertex_text(vertex: &VertexRecord) -> String {
    let ([x, y, z], [m, n]) = (vertex.position, vertex.normal);
    let (kind, event) = (vertex.kind as u8, vertex.event as u8);
    format!("{x} {y} {z} {m} {n} {kind} {event} {} {}", vertex.material, vertex.primitive)
}

fn read_vertex(words: &mut Words<'_>) -> Result<VertexRecord, CommandError> {
    let position = [ANY.read(words, "X")?, ANY.read(words, "Y")?, ANY.read(words, "Z")?];
    let mut normal = || range(i16::MIN, i16::MAX).read(words, "NORMAL");
    let normal = [normal()?, normal()?];
    let kind = VertexKind::from_code(range(u8::MIN, u8::MAX).read(words, "KIND")?);
    let event = Event::from_code(range(u8::MIN, u8::MAX).read(words, "EVENT")?);
    Ok(VertexRecord {
        position,
        normal,
        kind: kind.ok_or(CommandError::NoPath)?,
        event: event.ok_or(CommandError::NoPath)?,
        material: range(u16::MIN, u16::MAX).read(words, "MATERIAL")?,
        primitive: range(u32::MIN, u32::MAX).read(words, "PRIMITIVE")?,
    })
}
