//! Maps from uniform numbers to points, directions and radii.

use std::f64::consts::TAU;

use glam::DVec3;

/// A direction on the hemisphere around +z with density `cos / pi`.
#[inline]
pub fn cosine_hemisphere(u: f64, v: f64) -> DVec3 {
    let radius = u.sqrt();
    let (sin, cos) = (TAU * v).sin_cos();
    DVec3::new(radius * cos, radius * sin, (1.0 - u).sqrt())
}

/// A direction on the whole sphere with density `1 / (4 pi)`.
pub fn uniform_sphere(u: f64, v: f64) -> DVec3 {
    let z = 1.0 - 2.0 * u;
    let radius = (1.0 - z * z).max(0.0).sqrt();
    let (sin, cos) = (TAU * v).sin_cos();
    DVec3::new(radius * cos, radius * sin, z)
}

/// Barycentric weights of the second and third corner of a triangle, uniform over its area.
#[inline]
pub fn uniform_triangle(u: f64, v: f64) -> (f64, f64) {
    let root = u.sqrt();
    (root * (1.0 - v), root * v)
}

/// A number in (`min`, `max`] whose logarithm is uniform: density `1 / (x ln(max/min))`.
#[inline]
pub fn log_uniform(min: f64, max: f64, u: f64) -> f64 {
    max * (-(max / min).ln() * u).exp()
}
