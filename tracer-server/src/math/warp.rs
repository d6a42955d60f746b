//! Maps from uniform numbers to points, directions and radii, and back.

use std::f64::consts::TAU;

use glam::DVec3;

/// A direction on the hemisphere around +z with density `cos / pi`.
#[inline]
pub fn cosine_hemisphere(u: f64, v: f64) -> DVec3 {
    let radius = u.sqrt();
    let (sin, cos) = (TAU * v).sin_cos();
    DVec3::new(radius * cos, radius * sin, (1.0 - u).sqrt())
}

/// The numbers from which [`cosine_hemisphere`] makes the unit vector `w`, whose z is not negative.
pub fn invert_cosine_hemisphere(w: DVec3) -> [f64; 2] {
    [below_one(w.x * w.x + w.y * w.y), turn(w.y, w.x)]
}

/// A direction on the whole sphere with density `1 / (4 pi)`.
pub fn uniform_sphere(u: f64, v: f64) -> DVec3 {
    let z = 1.0 - 2.0 * u;
    let radius = (1.0 - z * z).max(0.0).sqrt();
    let (sin, cos) = (TAU * v).sin_cos();
    DVec3::new(radius * cos, radius * sin, z)
}

/// The numbers from which [`uniform_sphere`] makes the unit vector `w`.
pub fn invert_uniform_sphere(w: DVec3) -> [f64; 2] {
    [below_one(0.5 * (1.0 - w.z)), turn(w.y, w.x)]
}

/// Barycentric weights of the second and third corner of a triangle, uniform over its area.
#[inline]
pub fn uniform_triangle(u: f64, v: f64) -> (f64, f64) {
    let root = u.sqrt();
    (root * (1.0 - v), root * v)
}

/// The numbers from which [`uniform_triangle`] makes the weights `b1` and `b2`.
pub fn invert_uniform_triangle(b1: f64, b2: f64) -> [f64; 2] {
    let root = b1 + b2;
    let v = if root > 0.0 { b2 / root } else { 0.0 };
    [below_one(root * root), below_one(v)]
}

/// A number in (`min`, `max`] whose logarithm is uniform: density `1 / (x ln(max/min))`.
#[inline]
pub fn log_uniform(min: f64, max: f64, u: f64) -> f64 {
    max * (-(max / min).ln() * u).exp()
}

/// The item that owns `u`, when each owns as many numbers from zero on as its weight says; the last
/// one where rounding leaves `u` to none.
#[inline]
pub fn pick<T>(mut u: f64, items: impl IntoIterator<Item = (T, f64)>) -> Option<T> {
    let mut chosen = None;
    for (item, weight) in items {
        chosen = Some(item);
        u -= weight;
        if u < 0.0 {
            break;
        }
    }
    chosen
}

/// `2^-n`, exactly; zero where that is smaller than any normal number.
#[inline]
pub fn power_of_half(n: usize) -> f64 {
    // The exponent field alone: a library call costs more than all the sums it is used in.
    f64::from_bits(1023_u64.saturating_sub(n as u64) << 52)
}

/// The angle from the x axis to the point (`x`, `y`) as a share of a full turn, in [0, 1).
#[inline]
pub fn turn(y: f64, x: f64) -> f64 {
    let turn = y.atan2(x) / TAU;
    below_one(if turn < 0.0 { turn + 1.0 } else { turn })
}

/// The nearest number in [0, 1): inverses err by a rounding at the ends.
#[inline]
pub fn below_one(u: f64) -> f64 {
    u.clamp(0.0, 1.0 - 0.5 * f64::EPSILON)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{Rng, Stream};

    #[test]
    fn powers_of_half_are_exact() {
        let mut expected = 1.0;
        for n in 0..1023 {
            assert_eq!(power_of_half(n), expected, "2^-{n}");
            expected *= 0.5;
        }
        assert_eq!(power_of_half(5000), 0.0, "beyond the normal numbers");
    }

    #[test]
    fn inverses_give_the_numbers_back() {
        let mut rng = Rng::new(4, Stream::Laboratory, 0);
        let corners = [[0.0, 0.0], [0.0, 0.5], [0.5, 0.0], [1.0 - 1e-12, 0.25], [1e-12, 0.75]];
        let random = (0..10_000).map(|_| rng.array::<2>());
        for [u, v] in corners.into_iter().chain(random) {
            let (b1, b2) = uniform_triangle(u, v);
            let inverses = [
                ("cosine hemisphere", invert_cosine_hemisphere(cosine_hemisphere(u, v))),
                ("sphere", invert_uniform_sphere(uniform_sphere(u, v))),
                ("triangle", invert_uniform_triangle(b1, b2)),
            ];
            for (name, [iu, iv]) in inverses {
                assert!((iu - u).abs() < 1e-9, "{name}: {iu} instead of {u}");
                // The azimuth is a circle, and at a pole any azimuth is right.
                let turn = (iv - v).abs();
                assert!(u == 0.0 || turn.min(1.0 - turn) < 1e-9, "{name}: {iv} instead of {v}");
                let unit = |u| (0.0..1.0).contains(&u);
                assert!(unit(iu) && unit(iv), "{name}: ({iu}, {iv}) is outside of the square");
            }
        }
    }
}
