//! What is done to meshes on their way into the world.

use glam::{DMat3, DMat4, DVec3, Vec3};

use crate::scene::description::Mesh;

/// Moves a mesh; the winding of its triangles stays.
pub(super) fn transform(mesh: &mut Mesh, to_world: &DMat4) {
    for position in &mut mesh.positions {
        *position = to_world.transform_point3(*position);
    }
    // Normals are orthogonal to tangents, which the matrix moves.
    let normals = DMat3::from_mat4(*to_world).inverse().transpose();
    for normal in mesh.normals.as_flattened_mut() {
        *normal = (normals * normal.as_dvec3()).normalize_or_zero().as_vec3();
    }
}

/// Turns the front sides to the back; normals stay where they point.
pub(super) fn flip(mesh: &mut Mesh) {
    (0..mesh.triangles.len()).for_each(|i| turn(mesh, i));
}

/// Turns one triangle over, with all that belongs to its corners.
fn turn(mesh: &mut Mesh, triangle: usize) {
    if let Some(corners) = mesh.triangles.get_mut(triangle) {
        corners.swap(1, 2);
    }
    if let Some(normals) = mesh.normals.get_mut(triangle) {
        normals.swap(1, 2);
    }
    if let Some(texcoords) = mesh.texcoords.get_mut(triangle) {
        texcoords.swap(1, 2);
    }
}

/// Points all normals the other way.
pub(super) fn negate_normals(mesh: &mut Mesh) {
    for normal in mesh.normals.as_flattened_mut() {
        *normal = -*normal;
    }
}

/// Puts v = 0 to the other edge of the image.
pub(super) fn turn_texture_over(mesh: &mut Mesh) {
    for texcoord in mesh.texcoords.as_flattened_mut() {
        texcoord.y = 1.0 - texcoord.y;
    }
}

/// Turns those triangles over whose front is not where the normals of their corners point.
pub(super) fn face_along_normals(mesh: &mut Mesh) {
    for i in 0..mesh.normals.len() {
        let normal: Vec3 = mesh.normals.get(i).map_or(Vec3::ZERO, |n| n.iter().sum());
        if area_normal(mesh, i).dot(normal.as_dvec3()) < 0.0 {
            turn(mesh, i);
        }
    }
}

/// Normal of a triangle with twice its area as length; zero for one that refers to no position.
fn area_normal(mesh: &Mesh, triangle: usize) -> DVec3 {
    corners(mesh, triangle).map_or(DVec3::ZERO, |[a, b, c]| (b - a).cross(c - a))
}

fn corners(mesh: &Mesh, triangle: usize) -> Option<[DVec3; 3]> {
    let &[a, b, c] = mesh.triangles.get(triangle)?;
    let at = |index: u32| mesh.positions.get(index as usize).copied();
    Some([at(a)?, at(b)?, at(c)?])
}

/// Gives a mesh smooth normals: at every position the mean of the faces that share it, weighted by
/// their angles there [Thürmer and Wüthrich 1998].
pub(super) fn smooth(mesh: &mut Mesh) {
    let mut sums = vec![DVec3::ZERO; mesh.positions.len()];
    for i in 0..mesh.triangles.len() {
        let (Some(&triangle), Some(points)) = (mesh.triangles.get(i), corners(mesh, i)) else {
            continue;
        };
        let Some(normal) = area_normal(mesh, i).try_normalize() else { continue };
        for k in 0..3 {
            let [at, next, last] = [points[k], points[(k + 1) % 3], points[(k + 2) % 3]];
            let angle = (next - at).angle_between(last - at);
            if let Some(sum) = sums.get_mut(triangle[k] as usize) {
                *sum += angle * normal;
            }
        }
    }
    let normal = |index: u32| {
        let sum = sums.get(index as usize).copied().unwrap_or_default();
        sum.normalize_or_zero().as_vec3()
    };
    mesh.normals = mesh.triangles.iter().map(|triangle| triangle.map(normal)).collect();
}
