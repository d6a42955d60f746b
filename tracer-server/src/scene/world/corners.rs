//! What varies over triangles: shading normals and texture coordinates.

use glam::{DMat3, DVec2, DVec3, Vec2, Vec3};

use super::surface::Triangle;
use crate::scene::description::Mesh;

/// A corner whose normal is turned less from the triangle's, by its cosine, is flat: a thousandth
/// of a radian.
const FLAT: f64 = 1.0 - 1e-6;

/// Values at the three corners of the triangles; either list is empty where no triangle needs it.
#[derive(Debug, Default)]
pub(super) struct Corners {
    /// Unit normals; zero for a flat triangle.
    normals: Vec<[Vec3; 3]>,
    /// Texture coordinates; not finite for a triangle without.
    texcoords: Vec<[Vec2; 3]>,
    /// For each sphere, from directions in the scene to those of its texture; empty where all are the
    /// same.
    turns: Vec<DMat3>,
}

/// The corners that a flat triangle has.
const NO_NORMALS: [Vec3; 3] = [Vec3::ZERO; 3];
/// The corners that a triangle without texture coordinates has.
const NO_TEXCOORDS: [Vec2; 3] = [Vec2::NAN; 3];

impl Corners {
    /// Takes in what `mesh` tells of its triangle number `index`, which is the traced `triangle`
    /// number `primitive`.
    pub(super) fn push(
        &mut self,
        mesh: &Mesh,
        index: usize,
        triangle: &Triangle,
        primitive: usize,
    ) {
        if let Some(normals) = mesh.normals.get(index).and_then(|n| unit_normals(n, triangle)) {
            self.normals.resize(primitive, NO_NORMALS);
            self.normals.push(normals);
        }
        if let Some(&texcoords) = mesh.texcoords.get(index) {
            self.texcoords.resize(primitive, NO_TEXCOORDS);
            self.texcoords.push(texcoords);
        }
    }

    /// The texture coordinates at the corners of a triangle, where it has any.
    pub(super) fn texcoords(&self, primitive: usize) -> Option<[Vec2; 3]> {
        self.texcoords
            .get(primitive)
            .copied()
            .filter(|corners| corners.iter().all(|c| c.is_finite()))
    }

    /// Takes in how the textures of the spheres lie.
    pub(super) fn turn_spheres(&mut self, turns: Vec<DMat3>) {
        if turns.iter().any(|turn| *turn != DMat3::IDENTITY) {
            self.turns = turns;
        }
    }

    /// From directions in the scene to those of the texture of a sphere.
    #[inline]
    pub(super) fn turn(&self, sphere: usize) -> DMat3 {
        self.turns.get(sphere).copied().unwrap_or(DMat3::IDENTITY)
    }

    /// Forgets the texture coordinates.
    pub(super) fn drop_texcoords(&mut self) {
        (self.texcoords, self.turns) = (Vec::new(), Vec::new());
    }

    /// True when some triangle is shaded by other normals than its own.
    pub(super) fn has_normals(&self) -> bool {
        !self.normals.is_empty()
    }

    /// The unit shading normal at a point of a triangle; `None` where that is flat.
    #[inline]
    pub(super) fn normal(&self, primitive: u32, triangle: &Triangle, at: DVec3) -> Option<DVec3> {
        let &[a, b, c] = self.normals.get(primitive as usize)?;
        if a == Vec3::ZERO {
            return None;
        }
        let [u, v] = triangle.barycentric(at);
        let normal = (1.0 - u - v) * a.as_dvec3() + u * b.as_dvec3() + v * c.as_dvec3();
        normal.try_normalize()
    }

    /// The texture coordinates at a point of a triangle.
    #[inline]
    pub(super) fn texcoord(&self, primitive: u32, triangle: &Triangle, at: DVec3) -> Option<DVec2> {
        let &[a, b, c] = self.texcoords.get(primitive as usize)?;
        let [u, v] = triangle.barycentric(at);
        let uv = (1.0 - u - v) * a.as_dvec2() + u * b.as_dvec2() + v * c.as_dvec2();
        uv.is_finite().then_some(uv)
    }
}

/// Unit normals on the front side; `None` when all of them are the triangle's own.
fn unit_normals(given: &[Vec3; 3], triangle: &Triangle) -> Option<[Vec3; 3]> {
    let own = triangle.normal;
    let unit = given.map(|n| n.as_dvec3().try_normalize().unwrap_or(own));
    // The winding says what is the front; normals that disagree are those of the other side.
    let side = unit.iter().map(|n| n.dot(own)).sum::<f64>().signum();
    let unit = unit.map(|n| side * n);
    let is_flat = unit.iter().all(|n| n.dot(own) > FLAT);
    (!is_flat).then(|| {
        let [a, b, c] = unit;
        [a.as_vec3(), b.as_vec3(), c.as_vec3()]
    })
}
