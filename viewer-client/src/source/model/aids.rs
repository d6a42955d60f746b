//! Lines that belong to no path: the model of the render camera and the grid on the ground.

use common::Camera;
use glam::Vec3;
use shaders::{LinePoint, role};

use crate::settings::SceneSettings;
use crate::value::Bounds;

/// Size of the camera model, in radii of the scene.
const CAMERA_SIZE: f32 = 0.16;
/// Cells of the grid to each side of its middle.
const GRID_CELLS: i32 = 8;
/// Half the side of the grid, in radii of the scene.
const GRID_REACH: f32 = 1.35;

/// Square roots of linear colours, and opacities.
const CAMERA_COLOR: [u8; 4] = [150, 195, 255, 255];
const CAMERA_UP_COLOR: [u8; 4] = [255, 190, 92, 255];
const GRID_COLOR: [u8; 4] = [120, 124, 132, 56];

/// The aids that are wanted, as one list of polylines.
pub fn drawing_aids(
    bounds: Bounds,
    camera: Option<&Camera>,
    up: Vec3,
    wanted: &SceneSettings,
) -> Vec<LinePoint> {
    let mut points = Vec::new();
    if wanted.grid {
        grid(&mut points, bounds, up, GRID_REACH * bounds.radius());
    }
    if let Some(camera) = camera.filter(|_| wanted.camera) {
        camera_model(&mut points, camera, CAMERA_SIZE * bounds.radius());
    }
    points
}

fn polyline(points: &mut Vec<LinePoint>, color: [u8; 4], line: &[Vec3]) {
    for (i, position) in line.iter().enumerate() {
        let last = if i + 1 == line.len() { role::LAST } else { 0 };
        let info = [role::ANNOTATION | last, 0, 0, 0];
        points.push(LinePoint { position: position.to_array(), color, ordinal: 0, info });
    }
}

/// A pyramid from the pinhole to the picture, with a small roof that points up.
fn camera_model(points: &mut Vec<LinePoint>, camera: &Camera, size: f32) {
    let origin = camera.origin.as_vec3();
    let largest = camera.tan_x.max(camera.tan_y).max(1e-3) as f32;
    let depth = size / largest.max(0.6);
    let middle = origin + depth * camera.forward.as_vec3();
    let right = depth * camera.tan_x as f32 * camera.right.as_vec3();
    let up = depth * camera.tan_y as f32 * camera.up.as_vec3();
    let corners =
        [middle - right + up, middle + right + up, middle + right - up, middle - right - up];
    let [a, b, c, d] = corners;
    polyline(points, CAMERA_COLOR, &[a, b, c, d, a]);
    polyline(points, CAMERA_COLOR, &[a, origin, c]);
    polyline(points, CAMERA_COLOR, &[b, origin, d]);
    let base = middle + 1.12 * up;
    let roof = [base - 0.4 * right, base + 0.55 * up, base + 0.4 * right, base - 0.4 * right];
    polyline(points, CAMERA_UP_COLOR, &roof);
}

/// A square of lines under the scene, `reach` from its middle to each side.
fn grid(points: &mut Vec<LinePoint>, bounds: Bounds, up: Vec3, reach: f32) {
    let x = up.any_orthonormal_vector();
    let y = up.cross(x);
    let centre = bounds.centre();
    let lowest = bounds.min.dot(up).min(bounds.max.dot(up));
    // A little below, or the grid and a floor would fight for the same depth.
    let ground = centre + (lowest - 0.004 * bounds.radius() - centre.dot(up)) * up;
    for i in -GRID_CELLS..=GRID_CELLS {
        let offset = reach * i as f32 / GRID_CELLS as f32;
        polyline(
            points,
            GRID_COLOR,
            &[ground + offset * x - reach * y, ground + offset * x + reach * y],
        );
        polyline(
            points,
            GRID_COLOR,
            &[ground + offset * y - reach * x, ground + offset * y + reach * x],
        );
    }
}

#[cfg(test)]
mod tests {
    use common::CameraPose;
    use glam::DVec3;

    use super::*;

    #[test]
    fn aids_come_and_go_with_their_settings() {
        let bounds = Bounds { min: Vec3::splat(-10.0), max: Vec3::splat(10.0) };
        let pose = CameraPose {
            origin: DVec3::new(0.0, 0.0, 30.0),
            target: DVec3::ZERO,
            up: DVec3::Y,
            vertical_fov: 40.0,
        };
        let camera = Camera::new(&pose, 4, 3).expect("a valid pose");
        let with = |camera_on, grid| {
            let wanted = SceneSettings { camera: camera_on, grid, ..SceneSettings::default() };
            drawing_aids(bounds, Some(&camera), Vec3::Y, &wanted)
        };
        assert!(with(false, false).is_empty(), "nothing wanted");
        let model = with(true, false);
        let at_pinhole =
            |p: &LinePoint| (Vec3::from(p.position) - camera.origin.as_vec3()).length() < 1e-3;
        assert!(model.iter().any(at_pinhole), "the model begins at the pinhole");
        assert_eq!(model.last().map(|p| p.info[0]), Some(role::ANNOTATION | role::LAST), "closed");
        let grid = with(false, true);
        assert!(grid.iter().all(|p| p.position[1] < -10.0), "the grid lies under the scene");
    }
}
