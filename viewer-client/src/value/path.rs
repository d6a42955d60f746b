//! A path, and a vertex of it.

use glam::Vec2;

/// Where the user points, and how far off a path may lie.
///
/// All three are tangents of angles from the view direction, so that neither the size nor the shape
/// of the window matters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pointer {
    /// To the right and upwards.
    pub at: [f32; 2],
    /// How far off, in any direction.
    pub reach: f32,
}

impl Pointer {
    /// True when the user points at the same thing, as far as a hand can.
    pub fn is_near(self, other: Self) -> bool {
        let off = Vec2::from(self.at).distance(Vec2::from(other.at));
        off <= 0.5 * self.reach.max(other.reach)
    }
}
