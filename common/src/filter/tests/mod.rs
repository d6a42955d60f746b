//! Filters: their text, their judgement, and what their tally says.

mod completion;
mod extend;
mod judgement;
mod laws;
mod light_path;
mod random;
#[expect(unreachable_pub, reason = "it is written for another place")]
mod returns;
mod text;
mod tree;

use glam::DVec3;

use super::condition::{Condition, Gap, Predicate, volume};
use super::*;
use crate::{Event, PathHeader, SceneFrame, VertexKind, VertexRecord};

/// A scene whose frame is not the file's, with names of every kind.
fn scene() -> FilterScene {
    let strings = |names: &[&str]| names.iter().map(|&name| name.to_owned()).collect();
    let material = |name: &str| FilterMaterial {
        name: name.to_owned(),
        is_light: matches!(name, "lamp" | "spot" | "sky"),
        is_background: name == "sky",
    };
    let materials = ["wall", "glass", "lamp", "wall", "spot", "sky"].map(material).to_vec();
    FilterScene {
        frame: SceneFrame { centre: DVec3::new(1.0, 2.0, 3.0), scale: 4.0, light: 1.0 },
        materials,
        strategies: strings(&["bidirectional", "lens", "lens subpath"]),
        objects: vec![
            FilterObject { name: "table".to_owned(), primitives: 0..10 },
            FilterObject { name: "vase".to_owned(), primitives: 10..12 },
        ],
    }
}

fn compiled(text: &str) -> CompiledFilter {
    let filter = Filter::parse(text).unwrap_or_else(|e| panic!("{}", e.pointed(text)));
    filter.compile(&scene()).unwrap_or_else(|e| panic!("{}", e.pointed(text)))
}

/// A vertex at a point of the file.
fn vertex(kind: VertexKind, event: Event, point: [f64; 3], material: u16) -> VertexRecord {
    let position = scene().frame.to_scene(DVec3::from_array(point)).as_vec3().to_array();
    let primitive = if material < 4 { 0 } else { u32::MAX };
    VertexRecord { position, normal: [0, 0], kind, event, material, primitive }
}

/// A path with one vertex a letter, from the light.
///
/// Lamp `L`, spot `P`, sky `B`, camera `E`, diffuse `D`, glossy `G`, mirror `S`, glass `T`. Vertex `i` lies at `(i, 0, 0)` in the file; glass is material 1, the lamp 2, all else wall.
fn path(letters: &str) -> Vec<VertexRecord> {
    let record = |(i, letter)| {
        let (kind, event, material) = match letter {
            'L' => (VertexKind::Light, Event::End, 2),
            'P' => (VertexKind::Light, Event::End, 4),
            'B' => (VertexKind::Light, Event::End, 5),
            'E' => (VertexKind::Eye, Event::End, 0),
            'S' => (VertexKind::Specular, Event::Reflect, 0),
            'G' => (VertexKind::Diffuse, Event::Glossy, 0),
            'T' => (VertexKind::Specular, Event::Transmit, 1),
            _ => (VertexKind::Diffuse, Event::Diffuse, 3),
        };
        vertex(kind, event, [i as f64, 0.0, 0.0], material)
    };
    letters.chars().enumerate().map(record).collect()
}

/// Whether the filter wants the path, asked in both ways.
fn wants(text: &str, header: &PathHeader, path: &[VertexRecord]) -> bool {
    let filter = compiled(text);
    let wanted = filter.matches(header, path);
    assert_eq!(filter.wants(filter.conditions(header, path)), wanted, "`{text}` on {path:?}");
    wanted
}
