//! One vertex of a record, key by key.

use common::{Event, Rgb, VertexKind};
use glam::DVec3;

use super::{DumpVertex, Numbers, Sensor, Walked};

/// Bits of `componentType`.
const DIFFUSE: u32 = 2;
const GLOSSY: u32 = 8 | 16;
const MIRROR: u32 = 32;
const REFRACTION: u32 = 64;
/// What a connection leaves: every lobe that can be connected to.
const CONNECTED: u32 = 30;

/// The part of `data` whose keys stand two blanks deeper.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
enum Part {
    #[default]
    None,
    Frame,
    Shape,
}

/// Which way a step goes; Mitsuba calls the ways by what is carried along.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Way {
    /// From the light towards the lens: `importance`.
    Onward,
    /// From the lens towards the light: `radiance`.
    Back,
}

/// What stands in the brackets of `weight[...]` and `pdf[...]`.
#[derive(Clone, Copy, Debug, Default)]
struct OpenStep {
    pdf: Option<f64>,
    weight: Option<Rgb>,
}

/// A vertex of which not every key was read yet.
#[derive(Clone, Debug, Default)]
pub(super) struct OpenVertex {
    kind: String,
    components: u32,
    degenerate: bool,
    discrete: bool,
    position: Option<DVec3>,
    normal: DVec3,
    shape: String,
    part: Part,
    onward: OpenStep,
    back: OpenStep,
    pub(super) pixel: Option<[f64; 2]>,
}

impl OpenVertex {
    /// True for the ends that stand for no point.
    pub(super) fn is_formal(&self) -> bool {
        matches!(self.kind.as_str(), "emitterSupernode" | "sensorSupernode")
    }

    /// Reads a line at its depth in blanks.
    pub(super) fn line(
        &mut self,
        depth: usize,
        text: &str,
        sensor: &mut Sensor,
    ) -> Result<(), String> {
        let Some((key, value)) = text.split_once(" = ") else {
            if depth == 6 {
                self.part = Part::None;
            }
            return Ok(());
        };
        let value = value.trim_end().trim_end_matches(',');
        if depth == 6 {
            self.part = match key {
                "geoFrame" => Part::Frame,
                "shape" => Part::Shape,
                _ => Part::None,
            };
        }
        match (depth, key) {
            (4, "type") => value.clone_into(&mut self.kind),
            (4, "degenerate") => self.degenerate = value == "true",
            (4, "measure") => self.discrete = value == "discrete",
            (4, "componentType") => {
                self.components = value
                    .parse()
                    .ok()
                    .ok_or_else(|| format!("`{key} = {value}` is not a number"))?;
            }
            (4, "pdf[importance]") => self.onward.pdf = density(key, value)?,
            (4, "pdf[radiance]") => self.back.pdf = density(key, value)?,
            (4, "weight[importance]") => self.onward.weight = weight(key, value)?,
            (4, "weight[radiance]") => self.back.weight = weight(key, value)?,
            (6, "p") => self.position = Some(vector(key, value)?),
            (6, "n") => self.normal = vector(key, value)?,
            (6, "uv") => self.pixel = Some(numbers(key, value)?),
            (8, "n") if self.part == Part::Frame => self.normal = vector(key, value)?,
            (8, "name") if self.part == Part::Shape => {
                value.trim_matches('"').clone_into(&mut self.shape);
            }
            // Whatever else a sensor tells of itself, at any depth, may be left out.
            (8.., "fov") if self.kind == "sensorSample" => sensor.fov = numbers(key, value).ok(),
            (8.., "size") if self.kind == "sensorSample" => sensor.film = numbers(key, value).ok(),
            _ => {}
        }
        Ok(())
    }

    /// The vertex, once all of it was read. The neighbours tell a reflection from a refraction.
    pub(super) fn close(
        self,
        before: Option<DVec3>,
        after: Option<DVec3>,
        numbers: Numbers,
    ) -> Result<DumpVertex, String> {
        let position = self.position.ok_or_else(|| {
            format!("a vertex of the type `{}` has no position `p = [x, y, z]`", self.kind)
        })?;
        let (kind, event, shape) = match self.kind.as_str() {
            "emitterSample" => (VertexKind::Light, Event::End, "light"),
            "sensorSample" => (VertexKind::Eye, Event::End, "camera"),
            "surfaceInteraction" | "mediumInteraction" => {
                let event = self.event(position, before, after);
                let kind =
                    if event.is_specular() { VertexKind::Specular } else { VertexKind::Diffuse };
                (kind, event, "surface")
            }
            other => return Err(format!("`{other}` is no type of vertex that is known")),
        };
        let shape = if self.shape.is_empty() { shape.to_owned() } else { self.shape };
        Ok(DumpVertex { position, normal: self.normal, kind, event, shape, numbers })
    }

    fn event(&self, position: DVec3, before: Option<DVec3>, after: Option<DVec3>) -> Event {
        let delta = self.components & (MIRROR | REFRACTION);
        let specular = self.discrete && self.degenerate || delta != 0;
        if specular && self.components != CONNECTED {
            return match delta {
                MIRROR => Event::Reflect,
                REFRACTION => Event::Transmit,
                _ if self.crosses(position, before, after) => Event::Transmit,
                _ => Event::Reflect,
            };
        }
        let only_glossy = self.components & GLOSSY != 0 && self.components & DIFFUSE == 0;
        if only_glossy { Event::Glossy } else { Event::Diffuse }
    }

    /// True when the path goes on on the other side of the surface.
    fn crosses(&self, here: DVec3, before: Option<DVec3>, after: Option<DVec3>) -> bool {
        before.zip(after).is_some_and(|(before, after)| {
            (before - here).dot(self.normal) * (after - here).dot(self.normal) < 0.0
        })
    }

    pub(super) fn position(&self) -> Option<DVec3> {
        self.position
    }

    /// The step that leaves this vertex, where the file tells all of it.
    pub(super) fn step(&self, way: Way) -> Option<Walked> {
        let OpenStep { pdf, weight } = match way {
            Way::Onward => self.onward,
            Way::Back => self.back,
        };
        Some(Walked { pdf: pdf?, weight: weight?, is_discrete: self.discrete })
    }
}

/// A density; `None` for what Mitsuba prints where one overflows.
fn density(key: &str, value: &str) -> Result<Option<f64>, String> {
    let number = number(value).ok_or_else(|| format!("`{key} = {value}` should be a number"))?;
    Ok((number.is_finite() && number >= 0.0).then_some(number))
}

/// A weight; `None` for what Mitsuba prints where one overflows.
fn weight(key: &str, value: &str) -> Result<Option<Rgb>, String> {
    let problem = || format!("`{key} = {value}` should be 3 numbers in brackets");
    let inner = value.strip_prefix('[').and_then(|v| v.strip_suffix(']')).ok_or_else(problem)?;
    let parsed: Option<Vec<f64>> = inner.split(',').map(number).collect();
    let rgb: Option<[f64; 3]> = parsed.and_then(|numbers| numbers.try_into().ok());
    let rgb = rgb.ok_or_else(problem)?;
    Ok(rgb.iter().all(|c| c.is_finite() && *c >= 0.0).then_some(Rgb::from(rgb)))
}

/// A number as C prints it, which has many ways to say that it is none: `nan`, `-nan(ind)`,
/// `1.#QNAN`, `-1.#IND`, `1.#INF`.
fn number(text: &str) -> Option<f64> {
    let text = text.trim();
    let is_none = || text.contains('#') || text.trim_start_matches('-').starts_with("nan(");
    text.parse().ok().or_else(|| is_none().then_some(f64::NAN))
}

fn vector(key: &str, value: &str) -> Result<DVec3, String> {
    numbers::<3>(key, value).map(DVec3::from)
}

/// No number is larger: what is that far away is a mistake, as in a scene.
const LARGEST: f64 = 1e15;

/// `[a, b, ...]`: finite numbers.
fn numbers<const N: usize>(key: &str, value: &str) -> Result<[f64; N], String> {
    let problem = || {
        let parts = value.split(',').count();
        let point = if parts == 2 * N { "; a point divides whole and fraction" } else { "" };
        format!(
            "`{key} = {value}` should be {N} finite numbers in brackets, of 1e15 at most{point}"
        )
    };
    let inner = value.strip_prefix('[').and_then(|v| v.strip_suffix(']')).ok_or_else(problem)?;
    let parsed: Option<Vec<f64>> =
        inner.split(',').map(|n| number(n).filter(|n| n.abs() <= LARGEST)).collect();
    parsed.and_then(|numbers| numbers.try_into().ok()).ok_or_else(problem)
}
