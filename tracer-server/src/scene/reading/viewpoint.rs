//! Where to look from when the scene file does not say: `camera.json` beside it, or a guess.

use std::path::Path;

use common::CameraPose;
use glam::DVec3;
use serde::Deserialize;

use super::diagnostic::{LoadError, Place};
use super::text::read_utf8;
use crate::scene::description::Mesh;

/// A camera with its film.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Viewpoint {
    /// Where the camera stands.
    pub(crate) camera: CameraPose,
    /// Film width in pixels.
    pub(crate) width: u32,
    /// Film height in pixels.
    pub(crate) height: u32,
}

/// The most bytes of a `camera.json`.
const MAX_JSON_BYTES: u64 = 1 << 20;
/// Sides of the film where nothing is known, in pixels.
const DEFAULT_SIDE: u32 = 512;
/// Vertical field of view of a look into an open box from outside, in degrees: so narrow that the
/// box's depth is seen with little distortion, as is the custom for Cornell boxes.
const OUTSIDE_FOV: f64 = 19.5;
/// Vertical field of view inside a closed room, in degrees.
const INSIDE_FOV: f64 = 60.0;
/// A side of the bounding box is a wall when surfaces lie before this share of it.
const WALL_COVERAGE: f64 = 0.5;
/// Surfaces within this share of the depth belong to a side.
const WALL_DEPTH: f64 = 0.05;

/// The part of a `camera.json` that is understood; other keys are for other programs.
#[derive(Debug, Deserialize)]
struct CameraJson {
    /// The eye point.
    origin: [f64; 3],
    /// View direction, of any length.
    forward: [f64; 3],
    /// A direction that points up in the picture.
    up: [f64; 3],
    /// Full horizontal field of view in degrees.
    x_fov_deg: f64,
    /// Film width in pixels.
    width: u32,
    /// Film height in pixels.
    height: u32,
}

/// Reads a `camera.json`.
pub(crate) fn read_json(path: &Path) -> Result<Viewpoint, LoadError> {
    let text = read_utf8(path, MAX_JSON_BYTES)?;
    let json: CameraJson = serde_json::from_str(&text).map_err(|error| {
        let place =
            Place { column: Some(error.column()), ..Place::line(path, error.line().max(1)) };
        place.error(format!("{error}; expected origin, forward, up, x_fov_deg, width and height"))
    })?;
    if json.width == 0 || json.height == 0 {
        let message =
            format!("the film is {} x {} pixels; give both sides", json.width, json.height);
        return Err(Place::file(path).error(message));
    }
    if !(json.x_fov_deg > 0.0 && json.x_fov_deg < 180.0) {
        let message = format!("x_fov_deg is {}; it must lie between 0 and 180", json.x_fov_deg);
        return Err(Place::file(path).error(message));
    }
    let origin = DVec3::from_array(json.origin);
    let forward = DVec3::from_array(json.forward);
    let Some(forward) = forward.try_normalize() else {
        return Err(Place::file(path).error("forward is zero; give the view direction"));
    };
    let aspect = f64::from(json.height) / f64::from(json.width);
    let tan_y = (0.5 * json.x_fov_deg.to_radians()).tan() * aspect;
    let camera = CameraPose {
        origin,
        target: origin + forward,
        up: DVec3::from_array(json.up),
        vertical_fov: 2.0 * tan_y.atan().to_degrees(),
    };
    Ok(Viewpoint { camera, width: json.width, height: json.height })
}

/// Looks into the bounding box from its most open side, the +z side if several are equally open;
/// from within when all four sides are walls. Up is +y.
pub(crate) fn guess(meshes: &[Mesh]) -> Viewpoint {
    let (low, high) = bounds(meshes);
    let (centre, half) = (0.5 * (low + high), 0.5 * (high - low));
    let sides = [DVec3::Z, DVec3::NEG_Z, DVec3::X, DVec3::NEG_X];
    let mut best = (DVec3::Z, f64::INFINITY);
    for side in sides {
        let covered = coverage(meshes, side, low, high);
        if covered < best.1 {
            best = (side, covered);
        }
    }
    let (side, covered) = best;
    let depth = half.dot(side.abs());
    let across = half.dot(DVec3::Y.cross(side).abs());
    let (origin, vertical_fov) = if covered > WALL_COVERAGE {
        (centre + 0.9 * depth * side, INSIDE_FOV)
    } else {
        // The nearest face of the box just fills the square film.
        let distance = half.y.max(across) / (0.5 * OUTSIDE_FOV.to_radians()).tan();
        (centre + (depth + distance) * side, OUTSIDE_FOV)
    };
    // A point of no extent still needs a direction.
    let target = if origin == centre { centre - side } else { centre };
    let camera = CameraPose { origin, target, up: DVec3::Y, vertical_fov };
    Viewpoint { camera, width: DEFAULT_SIDE, height: DEFAULT_SIDE }
}

fn bounds(meshes: &[Mesh]) -> (DVec3, DVec3) {
    let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    for mesh in meshes {
        for &vertex in mesh.triangles.as_flattened() {
            let position = mesh.positions.get(vertex as usize).copied().unwrap_or_default();
            low = low.min(position);
            high = high.max(position);
        }
    }
    if low.is_finite() && high.is_finite() { (low, high) } else { (DVec3::ZERO, DVec3::ZERO) }
}

/// The share of one side of the box that triangles near it cover.
fn coverage(meshes: &[Mesh], side: DVec3, low: DVec3, high: DVec3) -> f64 {
    let (extent, axis) = (high - low, side.abs());
    let face = if side.dot(DVec3::ONE) > 0.0 { high } else { low };
    let depth = extent.dot(axis);
    let area = extent.y * extent.dot(DVec3::Y.cross(side).abs());
    if !(area > 0.0) {
        return 0.0;
    }
    let mut covered = 0.0;
    for mesh in meshes {
        for triangle in &mesh.triangles {
            let [a, b, c] =
                triangle.map(|v| mesh.positions.get(v as usize).copied().unwrap_or_default());
            let near = |p: DVec3| (face - p).dot(axis).abs() <= WALL_DEPTH * depth;
            if near(a) && near(b) && near(c) {
                covered += 0.5 * (b - a).cross(c - a).dot(side).abs();
            }
        }
    }
    covered / area
}

#[cfg(test)]
mod tests {
    use super::super::shape::{Cuboid, Quad, Surface};
    use super::*;

    /// A box of 2 x 2 x 2 on the ground, open towards `open`.
    fn open_box(open: DVec3) -> Vec<Mesh> {
        let sides = [DVec3::X, DVec3::NEG_X, DVec3::Y, DVec3::NEG_Y, DVec3::Z, DVec3::NEG_Z];
        let walls = sides.into_iter().filter(|&side| side != open);
        let mesh = |side: DVec3| {
            let u = side.any_orthonormal_vector();
            let v = side.cross(u);
            let corner = DVec3::Y + side - u - v;
            let quad = Quad { corner, u: 2.0 * u, v: 2.0 * v };
            let Surface { positions, triangles, .. } = quad.surface();
            Mesh { materials: vec![0; triangles.len()], positions, triangles, ..Mesh::default() }
        };
        walls.map(mesh).collect()
    }

    #[test]
    fn a_box_open_to_the_front_is_seen_as_usual() {
        let view = guess(&open_box(DVec3::Z));
        assert!((view.camera.origin - DVec3::new(0.0, 1.0, 6.8)).length() < 0.05, "{view:?}");
        assert!((view.camera.target - DVec3::Y).length() < 1e-12, "{view:?}");
        assert_eq!(view.camera.vertical_fov, 19.5);
    }

    #[test]
    fn the_open_side_is_found() {
        let view = guess(&open_box(DVec3::NEG_X));
        assert!(view.camera.origin.x < -5.0, "{view:?}");
    }

    #[test]
    fn a_closed_room_is_seen_from_within() {
        let room = Cuboid { min: DVec3::ZERO, max: DVec3::ONE };
        let Surface { positions, triangles, .. } = room.surface();
        let mesh =
            Mesh { materials: vec![0; triangles.len()], positions, triangles, ..Mesh::default() };
        let origin = guess(&[mesh]).camera.origin;
        assert!(origin.min_element() > 0.0 && origin.max_element() < 1.0, "{origin}");
    }

    #[test]
    fn nothing_at_all_still_gives_a_camera() {
        let view = guess(&[]);
        assert!(common::Camera::new(&view.camera, view.width, view.height).is_ok(), "{view:?}");
    }

    #[test]
    fn json_is_read_and_its_mistakes_are_located() {
        let directory = tempfile::tempdir().expect("a directory");
        let path = directory.path().join("camera.json");
        let good = r#"{"origin":[1,2,3],"forward":[0,0,-2],"up":[0,1,0],"x_fov_deg":90,
            "width":200,"height":100,"note":"x"}"#;
        std::fs::write(&path, good).expect("written");
        let view = read_json(&path).expect("valid");
        assert_eq!(view.camera.target, DVec3::new(1.0, 2.0, 2.0));
        assert!((view.camera.vertical_fov - 53.13).abs() < 0.01, "{view:?}");
        let cases = [
            ("{", "camera.json:1"),
            ("{\"origin\":[1,2]}", "camera.json:1"),
            (&good.replace("\"width\":200", "\"width\":0"), "0 x 100"),
            (&good.replace(":90", ":180"), "x_fov_deg is 180"),
            (&good.replace("-2]", "0]"), "forward is zero"),
            (&good.replace("\"up\"", "\"down\""), "up"),
        ];
        for (text, expected) in cases {
            std::fs::write(&path, text).expect("written");
            let message = read_json(&path).expect_err("must be refused").to_string();
            assert!(message.contains(expected), "{text}: {message}");
        }
    }
}
