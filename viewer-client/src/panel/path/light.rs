//! What the daemon reports about the vertices of a path: throughputs, densities, geometry terms.

use common::{PathDetail, Rgb};

use super::table::{Column, Described, Line, Table, color};
use crate::source::units::{Measure, Start};
use crate::value::format;

/// What the column `β light` holds.
const BETA_LIGHT: &str = "Luminance that a walk from the light carries when it arrives here. At \
    x0 this is the area of the lamp over the probability of choosing it, in square units of the \
    scene file (one over the density of the start, for lights without a surface); from x1 on it \
    is flux: radiance times square unit times sr";
/// What the column `β eye` holds.
const BETA_EYE: &str = "Luminance that a walk from the eye carries when it arrives here: a \
    product of reflectances and the like, without a unit; the whole film counts as one";
/// What the column `p light` holds.
const P_LIGHT: &str = "Density of generating the vertex from the light side: per square unit of \
    the scene file for x0, per sr for the others (solid angle at the vertex before), and a \
    probability after a mirror or glass. On a point light or the sun x0 has a probability, in the \
    sky a density per sr; after sun or sky, x1 has a density per square unit of a disk";
/// What the column `p eye` holds.
const P_EYE: &str = "Density of generating the vertex from the eye side, per sr (solid angle at \
    the vertex after); a probability after a mirror or glass; per film for the last two";
/// What the column `G` holds.
const G: &str = "Geometry term of the edge to the next vertex, cos cos / r², per square unit of \
    the scene file; at the lens with film area per solid angle in place of the cosine";

/// A row a vertex.
pub(super) fn table(detail: &PathDetail) -> Table {
    let vertices = || detail.vertices.iter().enumerate();
    let walked = |density: f64, throughput: Rgb| {
        if density > 0.0 { format::exact(throughput.luminance()) } else { "–".to_owned() }
    };
    let density = |p: f64| if p > 0.0 { format::exact(p) } else { "–".to_owned() };
    let from_light = vertices().map(|(i, v)| walked(v.light_pdf, detail.light_throughput(i)));
    let from_eye = vertices().map(|(i, v)| walked(v.eye_pdf, detail.eye_throughput(i)));
    Table {
        name: "light",
        columns: vec![
            Column::new("β light", BETA_LIGHT, from_light),
            Column::new("β eye", BETA_EYE, from_eye),
            Column::new("p light", P_LIGHT, vertices().map(|(_, v)| density(v.light_pdf))),
            Column::new("p eye", P_EYE, vertices().map(|(_, v)| density(v.eye_pdf))),
            Column::new("G", G, detail.geometry.iter().copied().map(format::exact)),
        ],
    }
}

/// All of one vertex.
pub(super) fn lines(path: Described<'_>, detail: &PathDetail, index: usize) -> Vec<Line> {
    let Some(vertex) = detail.vertices.get(index) else { return Vec::new() };
    let vertices = path.selection.vertices.as_slice();
    let start = vertices.first().map_or(Start::Surface, |first| Start::of(first, path.names.mesh));
    let walk = |pdf: f64, weight: f64, measure: Measure| {
        if pdf > 0.0 {
            format!("p {} {}   f/p {}", format::exact(pdf), measure.unit(), format::exact(weight))
        } else {
            "no walk generates it".to_owned()
        }
    };
    let tip = "Density of generating it from this side, and value over density without colour, in \
        the inverse unit; square units are those of the scene file";
    let light = Measure::from_light(index, vertices, start);
    let eye = Measure::from_eye(index, vertices);
    let mut lines = vec![
        ("From light", walk(vertex.light_pdf, vertex.light_weight, light), tip),
        ("From eye", walk(vertex.eye_pdf, vertex.eye_weight, eye), tip),
    ];
    if vertex.light_pdf > 0.0 {
        let tip = if index == 0 {
            "Throughput of a walk from the light at its start, before emission is counted: area \
            of the lamp over probability, in square units of the scene file"
        } else {
            "Throughput of a walk from the light when it arrives here: red, green and blue flux"
        };
        lines.push(("β light", color(detail.light_throughput(index)), tip));
    }
    if vertex.eye_pdf > 0.0 {
        let tip = "Throughput of a walk from the eye when it arrives here: red, green and blue, \
            without a unit";
        lines.push(("β eye", color(detail.eye_throughput(index)), tip));
    }
    let tip = if index == 0 {
        "Emission as in the scene file: radiance, intensity or irradiance"
    } else {
        "Its factor in the path's colour: reflectance or transmittance"
    };
    lines.push(("Colour", color(vertex.color), tip));
    if let Some(geometry) = detail.geometry.get(index) {
        let tip = "Geometry term of the edge to the next vertex, cos cos / r², per square unit of \
                   the scene file";
        lines.push(("G after", format::exact(*geometry), tip));
    }
    lines
}
