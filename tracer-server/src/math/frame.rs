//! Orthonormal bases.

use glam::DVec3;

/// A right-handed orthonormal basis around a unit vector.
#[derive(Clone, Copy, Debug)]
pub struct Frame {
    x: DVec3,
    y: DVec3,
    z: DVec3,
}

impl Frame {
    /// A basis whose third axis is the unit vector `z` [Duff et al. 2017].
    #[inline]
    pub fn new(z: DVec3) -> Self {
        let sign = 1.0_f64.copysign(z.z);
        let a = -1.0 / (sign + z.z);
        let b = z.x * z.y * a;
        let x = DVec3::new(1.0 + sign * z.x * z.x * a, sign * b, -sign * z.x);
        let y = DVec3::new(b, sign + z.y * z.y * a, -z.y);
        Self { x, y, z }
    }

    /// The vector with coordinates `v` in this basis.
    #[inline]
    pub fn to_world(self, v: DVec3) -> DVec3 {
        v.x * self.x + v.y * self.y + v.z * self.z
    }

    /// The coordinates of `v` in this basis.
    #[inline]
    pub fn to_local(self, v: DVec3) -> DVec3 {
        DVec3::new(self.x.dot(v), self.y.dot(v), self.z.dot(v))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{Rng, Stream, uniform_sphere};

    #[test]
    fn axes_are_orthonormal() {
        let mut rng = Rng::new(0, Stream::Laboratory, 0);
        let random = (0..1000).map(|_| uniform_sphere(rng.uniform(), rng.uniform()));
        for z in random.chain([DVec3::Z, -DVec3::Z, DVec3::X]) {
            let f = Frame::new(z);
            let error = (f.x.cross(f.y) - f.z).length() + f.x.dot(f.y).abs() + f.x.dot(f.z).abs();
            assert!(error < 1e-12, "basis around {z} is off by {error}");
            assert!((f.x.length() - 1.0).abs() < 1e-12, "x is no unit vector around {z}");
        }
    }
}
