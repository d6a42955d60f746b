//! The traced shapes in scene units, in double precision.

use glam::{DVec3, Vec3A};

use crate::math::{
    invert_uniform_sphere, invert_uniform_triangle, uniform_sphere, uniform_triangle,
};

/// Stands for "no primitive": the lens.
pub const NO_PRIMITIVE: u32 = u32::MAX;

/// A triangle whose corners are exact `f32` values, so that traversal and shading see one shape.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Triangle {
    pub(crate) v0: DVec3,
    pub(crate) e1: DVec3,
    pub(crate) e2: DVec3,
    /// Unit normal on the front side.
    pub(crate) normal: DVec3,
    /// How far a ray's origin is moved off the plane; see [`ray_offset`].
    pub(crate) offset: f64,
}

/// A sphere.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ball {
    pub(crate) centre: DVec3,
    pub(crate) radius: f64,
    pub(crate) offset: f64,
}

/// Distance that a ray's origin moves along the normal.
///
/// Sixteen units in the last place of `f32` at the shape's farthest corner: this bounds the rounding of the point, of the traversal's copy of
/// it and of the coplanar neighbour's plane.
fn ray_offset(normal: DVec3, farthest: DVec3) -> f64 {
    const ULPS: f64 = 16.0 * (f32::EPSILON as f64 / 2.0);
    ULPS * normal.abs().dot(farthest)
}

impl Triangle {
    /// A triangle, or `None` when its area is zero.
    pub(crate) fn new(corners: [DVec3; 3]) -> Option<Self> {
        let [v0, v1, v2] = corners;
        let (e1, e2) = (v1 - v0, v2 - v0);
        let normal = e1.cross(e2).try_normalize()?;
        let farthest = v0.abs().max(v1.abs()).max(v2.abs());
        Some(Self { v0, e1, e2, normal, offset: ray_offset(normal, farthest) })
    }

    pub(crate) fn area(&self) -> f64 {
        0.5 * self.e1.cross(self.e2).length()
    }

    pub(crate) fn corners(&self) -> [DVec3; 3] {
        [self.v0, self.v0 + self.e1, self.v0 + self.e2]
    }

    /// Where the line through `origin` along `direction` pierces the plane, as a weighted sum of
    /// the corners: its error does not grow with the length of the ray [Möller and Trumbore 1997].
    #[inline]
    pub(crate) fn pierce(&self, origin: DVec3, direction: DVec3) -> DVec3 {
        let p = direction.cross(self.e2);
        let inv_det = 1.0 / self.e1.dot(p);
        let to_origin = origin - self.v0;
        let b1 = to_origin.dot(p) * inv_det;
        let b2 = direction.dot(to_origin.cross(self.e1)) * inv_det;
        self.v0 + b1 * self.e1 + b2 * self.e2
    }

    pub(crate) fn sample(&self, u: f64, v: f64) -> DVec3 {
        let (b1, b2) = uniform_triangle(u, v);
        self.v0 + b1 * self.e1 + b2 * self.e2
    }

    /// The numbers from which [`Triangle::sample`] makes the point `at`.
    pub(crate) fn invert(&self, at: DVec3) -> [f64; 2] {
        let [b1, b2] = self.barycentric(at);
        invert_uniform_triangle(b1.max(0.0), b2.max(0.0))
    }

    /// The weights of the second and third corner in a point of the plane.
    #[inline]
    pub(crate) fn barycentric(&self, at: DVec3) -> [f64; 2] {
        let cross = self.e1.cross(self.e2);
        let from_corner = at - self.v0;
        let scale = 1.0 / cross.length_squared();
        let b1 = from_corner.cross(self.e2).dot(cross) * scale;
        let b2 = self.e1.cross(from_corner).dot(cross) * scale;
        [b1, b2]
    }

    pub(crate) fn to_single(self) -> [Vec3A; 3] {
        self.corners().map(|c: DVec3| c.as_vec3a())
    }
}

impl Ball {
    pub(crate) fn new(centre: DVec3, radius: f64) -> Self {
        let offset = ray_offset(DVec3::splat(1.0 / 3_f64.sqrt()), centre.abs() + radius);
        Self { centre, radius, offset }
    }

    pub(crate) fn area(&self) -> f64 {
        4.0 * std::f64::consts::PI * self.radius * self.radius
    }

    pub(crate) fn normal(&self, at: DVec3) -> DVec3 {
        (at - self.centre).normalize_or(DVec3::Z)
    }

    pub(crate) fn sample(&self, u: f64, v: f64) -> (DVec3, DVec3) {
        let normal = uniform_sphere(u, v);
        (self.centre + self.radius * normal, normal)
    }

    /// The numbers from which [`Ball::sample`] makes the point `at`.
    pub(crate) fn invert(&self, at: DVec3) -> [f64; 2] {
        invert_uniform_sphere(self.normal(at))
    }

    /// Distances at which the line meets the sphere, the smaller one first.
    #[inline]
    pub(crate) fn roots(&self, origin: DVec3, direction: DVec3) -> Option<(f64, f64)> {
        let to_origin = origin - self.centre;
        let b = to_origin.dot(direction);
        // The distance of the line from the centre, free of the cancellation in b^2 - c.
        let off_axis = to_origin - b * direction;
        let discriminant = self.radius * self.radius - off_axis.length_squared();
        if !(discriminant > 0.0) {
            return None;
        }
        let root = discriminant.sqrt();
        Some((-b - root, -b + root))
    }

    /// Puts a point that lies nearly on the sphere onto it.
    pub(crate) fn snap(&self, near: DVec3) -> DVec3 {
        self.centre + self.radius * self.normal(near)
    }
}
