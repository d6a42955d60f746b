//! What a file of paths says about one of them, and what it does not.

use super::table::{Column, Line, Table, color};
use crate::source::dump::{DumpPath, Outcome, Walked};
use crate::source::selection::Selection;
use crate::source::units::Measure;
use crate::value::format;
use crate::world::World;

/// Stands for what is not known.
pub(super) const UNKNOWN: &str = "–";

/// The record of the selected path, where it is one of the file that is played.
pub(super) fn record<'a>(world: &World<'a>, selection: &Selection) -> Option<&'a DumpPath> {
    let paths = &world.playback?.dump().paths;
    paths
        .iter()
        .find(|path| path.header.id == selection.header.id && path.vertices == selection.vertices)
}

/// True where the file has densities and weights of the path.
pub(super) fn tells_numbers(record: &DumpPath) -> bool {
    record.numbers.iter().any(|n| n.from_light.is_some() || n.from_eye.is_some())
}

/// The acceptance probability of the proposal that made it.
pub(super) fn acceptance(record: Option<&DumpPath>) -> String {
    match record.map(|record| record.outcome) {
        Some(Outcome::Accepted(a)) => format!("a = {a:.4}"),
        _ => UNKNOWN.to_owned(),
    }
}

/// How long the chain stayed; known only for a file that reports every step.
pub(super) fn stay(record: Option<&DumpPath>) -> String {
    match record.filter(|record| record.outcome != Outcome::Recorded) {
        Some(record) => format::steps(u64::from(record.header.dwell)),
        None => UNKNOWN.to_owned(),
    }
}

/// A row a vertex.
pub(super) fn table(record: &DumpPath) -> Table {
    let density = |walked: Option<Walked>| {
        walked.map_or_else(|| UNKNOWN.to_owned(), |walked| format::exact(walked.pdf))
    };
    let weight = |walked: Option<Walked>| {
        walked.map_or_else(|| UNKNOWN.to_owned(), |w| format::exact(w.weight.luminance()))
    };
    let numbers = || record.numbers.iter();
    let of_density = |side: &str| {
        format!(
            "Density of generating the vertex from the {side} side, per square unit of the scene \
            file at the vertex itself, as Mitsuba defines it; a probability after a mirror or \
            glass, and at the lens"
        )
    };
    let of_weight = |side: &str| {
        format!(
            "Weight from the {side} side, in luminance: value over density of the step that \
            generates the vertex"
        )
    };
    Table {
        name: "of the file",
        columns: vec![
            Column::new("p light", of_density("light"), numbers().map(|n| density(n.from_light))),
            Column::new("p eye", of_density("eye"), numbers().map(|n| density(n.from_eye))),
            Column::new("f/p light", of_weight("light"), numbers().map(|n| weight(n.from_light))),
            Column::new("f/p eye", of_weight("eye"), numbers().map(|n| weight(n.from_eye))),
        ],
    }
}

/// All of one vertex.
pub(super) fn lines(record: &DumpPath, index: usize) -> Vec<Line> {
    let Some(numbers) = record.numbers.get(index) else { return Vec::new() };
    let sides = [("From light", numbers.from_light), ("From eye", numbers.from_eye)];
    let lines = sides.into_iter().map(|(side, walked)| {
        let text = walked.map_or_else(|| UNKNOWN.to_owned(), told);
        let tip = "As the file gives it: density of generating the vertex from this side, and \
            value over density in red, green and blue";
        (side, text, tip)
    });
    lines.collect()
}

fn told(walked: Walked) -> String {
    let measure = if walked.is_discrete { Measure::Probability } else { Measure::Area };
    let (pdf, weight) = (format::exact(walked.pdf), color(walked.weight));
    format!("p {pdf} {}   f/p {weight}", measure.unit())
}
