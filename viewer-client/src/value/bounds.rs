//! The box round a scene.

use glam::Vec3;

/// A box with sides along the axes, in scene units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// The corner with the smallest coordinates.
    pub min: Vec3,
    /// The corner with the largest.
    pub max: Vec3,
}

impl Bounds {
    /// The box round `points`, or `None` without any finite point.
    pub fn of(points: &[[f32; 3]]) -> Option<Self> {
        let mut finite = points.iter().map(|p| Vec3::from(*p)).filter(|p| p.is_finite());
        let first = finite.next()?;
        let start = Self { min: first, max: first };
        Some(finite.fold(start, |b, p| Self { min: b.min.min(p), max: b.max.max(p) }))
    }

    /// The middle.
    pub fn centre(self) -> Vec3 {
        0.5 * (self.min + self.max)
    }

    /// Radius of the sphere round it; never zero.
    pub fn radius(self) -> f32 {
        (0.5 * (self.max - self.min).length()).max(1.0)
    }
}
