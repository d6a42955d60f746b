//! The numbers behind a path in the units of the scene file.
//!
//! The daemon works in lengths that are a power of two times those of the file, and in light that is
//! divided by another power of two ([`SceneFrame`]). Every number is brought back by the powers that
//! its dimension has, so none of them is rounded.

use common::{MaterialInfo, PathDetail, SceneFrame, SceneMesh, VertexRecord};

use crate::source::selection::Names;

/// What a path starts on. It decides what its first numbers measure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Start {
    /// A surface that glows: radiance, and a start with a density per area.
    Surface,
    /// A point or a spot: intensity, and a start that is chosen with a probability.
    Place,
    /// Parallel light: irradiance, and a start that is chosen with a probability.
    Sun,
    /// Light from all around: radiance, and a start with a density per solid angle.
    Sky,
}

impl Start {
    /// What `light`, the first vertex of a path, lies on.
    pub fn of(light: &VertexRecord, mesh: Option<&SceneMesh>) -> Self {
        if light.primitive != u32::MAX {
            return Self::Surface;
        }
        match material(light, mesh).map(|material| material.model.as_str()) {
            Some("directional light") => Self::Sun,
            Some("environment") => Self::Sky,
            _ => Self::Place,
        }
    }

    /// True where the start is a direction, not a point: its edge has no 1 / r².
    pub fn is_infinite(self) -> bool {
        matches!(self, Self::Sun | Self::Sky)
    }
}

/// What a density is a density over.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Measure {
    /// Area, in square units of the scene file.
    Area,
    /// Solid angle at the vertex that the step leaves.
    SolidAngle,
    /// Nothing: it is a probability.
    Probability,
    /// Area of film or lens, each of which is taken as one.
    Film,
}

impl Measure {
    /// What follows the number.
    pub fn unit(self) -> &'static str {
        match self {
            Self::Area => "per square unit",
            Self::SolidAngle => "per sr",
            Self::Probability => "(a probability)",
            Self::Film => "per film",
        }
    }

    /// Of the density of making vertex `j` from the light side.
    pub fn from_light(j: usize, vertices: &[VertexRecord], start: Start) -> Self {
        match (j, start) {
            (0, Start::Sky) => Self::SolidAngle,
            (0, Start::Place | Start::Sun) => Self::Probability,
            (0, Start::Surface) | (1, Start::Sun | Start::Sky) => Self::Area,
            _ => Self::of_step(j.checked_sub(1).and_then(|before| vertices.get(before))),
        }
    }

    /// Of the density of making vertex `j` from the eye side.
    pub fn from_eye(j: usize, vertices: &[VertexRecord]) -> Self {
        if j + 2 >= vertices.len() { Self::Film } else { Self::of_step(vertices.get(j + 1)) }
    }

    /// A step that leaves this vertex.
    fn of_step(left: Option<&VertexRecord>) -> Self {
        let is_specular = left.is_some_and(|vertex| vertex.event.is_specular());
        if is_specular { Self::Probability } else { Self::SolidAngle }
    }
}

/// Converts what the daemon reported about a path that starts at `light` to the units of the scene
/// file.
pub fn in_file_units(
    mut detail: PathDetail,
    light: &VertexRecord,
    names: &Names<'_>,
) -> PathDetail {
    let Some(SceneFrame { scale, light: radiance, .. }) = names.frame else { return detail };
    let area = scale * scale;
    let start = Start::of(light, names.mesh);
    // Intensity is radiance times an area.
    let emission = if start == Start::Place { radiance / area } else { radiance };
    let on_area = usize::from(start.is_infinite());
    if let Some(first) = detail.vertices.first_mut() {
        first.color = first.color * emission;
    }
    if start != Start::Place
        && let Some(vertex) = detail.vertices.get_mut(on_area)
    {
        vertex.light_pdf *= area;
        vertex.light_weight /= area;
    }
    for geometry in detail.geometry.iter_mut().skip(on_area) {
        *geometry *= area;
    }
    for reciprocal in &mut detail.reciprocals {
        *reciprocal /= radiance;
    }
    detail
}

fn material<'a>(vertex: &VertexRecord, mesh: Option<&'a SceneMesh>) -> Option<&'a MaterialInfo> {
    mesh?.materials.get(usize::from(vertex.material))
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use common::{Event, Rgb, VertexDetail, VertexKind};
    use glam::DVec3;

    use super::*;

    /// Scale of `caustic`, whose extent lies between 2 and 4.
    const SCALE: f64 = 512.0;
    const AREA: f64 = SCALE * SCALE;
    /// What its daemon divides light by.
    const LIGHT: f64 = 524_288.0;

    fn vertex(primitive: u32) -> VertexRecord {
        VertexRecord {
            position: [0.0; 3],
            normal: [0; 2],
            kind: VertexKind::Light,
            event: Event::End,
            material: 0,
            primitive,
        }
    }

    fn mesh(model: &str, emission: Rgb) -> SceneMesh {
        let material = MaterialInfo {
            name: "lamp".to_owned(),
            model: model.to_owned(),
            color: Rgb::BLACK,
            emission,
            transparent: false,
            texture: None,
        };
        SceneMesh { materials: vec![material], ..SceneMesh::default() }
    }

    fn names(mesh: &SceneMesh) -> Names<'_> {
        let frame = SceneFrame { centre: DVec3::ZERO, scale: SCALE, light: LIGHT };
        Names { frame: Some(frame), strategies: &[], mesh: Some(mesh) }
    }

    /// A path of two edges whose splits are consistent, as the daemon would tell it.
    fn detail(color: Rgb, start: f64, walk: f64, geometry: [f64; 2]) -> PathDetail {
        let light = VertexDetail {
            color,
            light_pdf: 1.0 / start,
            light_weight: start,
            eye_pdf: 0.2,
            eye_weight: 2.0,
            connection: 1.0,
        };
        let middle = VertexDetail {
            color: Rgb::new(0.75, 0.5, 0.25),
            light_pdf: 1.0 / walk,
            light_weight: walk,
            eye_pdf: 1.0,
            eye_weight: 1.0,
            connection: 0.25,
        };
        let lens = VertexDetail {
            color: Rgb::WHITE,
            eye_pdf: 1.0,
            eye_weight: 1.0,
            connection: 1.0,
            ..VertexDetail::default()
        };
        let vertices = vec![light, middle, lens];
        let mut detail =
            PathDetail { vertices, geometry: geometry.into(), reciprocals: Vec::new() };
        let counts = |light| detail.contribution(light).map_or(0.0, |c| 1.0 / c.luminance());
        detail.reciprocals = (0..3).map(counts).collect();
        detail
    }

    fn geometry(unit: f64) -> f64 {
        let lamp = unit * DVec3::new(-0.719, 1.9, -0.112);
        let wall = unit * DVec3::new(1.2, 0.857, -0.71);
        let edge = wall - lamp;
        edge.y.abs() * edge.x.abs() / edge.length_squared().powi(2)
    }

    #[test]
    fn a_lamp_has_the_numbers_of_its_file() {
        let emission = Rgb::new(200.0, 172.0, 138.0);
        let (lamp, mesh) = (vertex(3), mesh("lambert", emission));
        let told = detail(emission / LIGHT, 5138.0, PI, [geometry(SCALE), geometry(2.0 * SCALE)]);
        assert!((told.geometry[0] - 2.903e-7).abs() < 1e-10, "what the daemon tells");
        let shown = in_file_units(told.clone(), &lamp, &names(&mesh));
        assert_eq!(shown.geometry[0], geometry(1.0), "to the last bit");
        assert!((shown.geometry[0] - 0.0761).abs() < 5e-5, "as by hand");
        assert_eq!(shown.vertices[0].color, emission, "radiance");
        assert_eq!(shown.light_throughput(0), Rgb::grey(5138.0 / AREA), "the area of the lamp");
        assert!((shown.light_throughput(0).luminance() - 0.0196).abs() < 1e-5, "as by hand");
        assert_eq!(shown.vertices[0].light_pdf, AREA / 5138.0, "per area");
        assert_eq!(shown.vertices[1].light_pdf, 1.0 / PI, "per solid angle");
        assert_eq!(shown.eye_throughput(0), told.eye_throughput(0), "reflectances have no unit");
        assert!((shown.luminance() / told.luminance() / LIGHT - 1.0).abs() < 1e-15, "radiance");
    }

    /// What a split counts must follow from the parts in any units.
    #[test]
    fn the_parts_still_make_the_whole() {
        let emission = Rgb::new(3.0, 2.0, 1.0);
        let (intensity, ball) = (emission * (AREA / LIGHT), PI * 1e6);
        for (primitive, model, told) in [
            (3, "lambert", detail(emission / LIGHT, 1e4, PI, [1e-6, 2e-6])),
            (u32::MAX, "point light", detail(intensity, 2.0, 4.0 * PI, [1e-6, 2e-6])),
            (u32::MAX, "directional light", detail(emission / LIGHT, 2.0, ball, [0.5, 2e-6])),
            (u32::MAX, "environment", detail(emission / LIGHT, 4.0 * PI, ball, [0.5, 2e-6])),
        ] {
            let (light, mesh) = (vertex(primitive), mesh(model, emission));
            let shown = in_file_units(told, &light, &names(&mesh));
            assert_eq!(shown.vertices[0].color, emission, "{model}");
            // No walk from the eye ends on a point.
            let ends = usize::from(model == "point light");
            for (split, reciprocal) in shown.reciprocals.iter().enumerate().skip(ends) {
                let made = shown.contribution(split).expect("a split").luminance();
                assert!((made * reciprocal - 1.0).abs() < 1e-12, "{model}, split {split}");
            }
        }
    }

    #[test]
    fn densities_name_their_measure() {
        let mirror = VertexRecord { event: Event::Reflect, ..vertex(0) };
        let wall = VertexRecord { event: Event::Diffuse, ..vertex(0) };
        let path = [vertex(3), wall, mirror, wall, vertex(u32::MAX)];
        let of = |start| [0, 1, 3].map(|j| Measure::from_light(j, &path, start));
        let [area, sr, mass] = [Measure::Area, Measure::SolidAngle, Measure::Probability];
        assert_eq!(of(Start::Surface), [area, sr, mass], "a lamp");
        assert_eq!(of(Start::Place), [mass, sr, mass], "a point");
        assert_eq!(of(Start::Sun), [mass, area, mass], "the sun");
        assert_eq!(of(Start::Sky), [sr, area, mass], "the sky");
        let eye = [0, 1, 2, 3, 4].map(|j| Measure::from_eye(j, &path));
        assert_eq!(eye, [sr, mass, sr, Measure::Film, Measure::Film], "from the eye");
    }
}
