//! Regions of space.

use glam::DVec3;

/// A region of space, its surface included.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Volume {
    /// A ball.
    Sphere {
        /// Its middle.
        centre: DVec3,
        /// Its radius; positive.
        radius: f64,
    },
    /// A box whose edges are parallel to the axes.
    Box {
        /// Its least coordinates.
        min: DVec3,
        /// Its largest coordinates.
        max: DVec3,
    },
}

impl Volume {
    /// Why the region makes no sense, if it does not.
    pub(super) fn complaint(&self) -> Option<&'static str> {
        match *self {
            Self::Sphere { centre, radius } if !(centre.is_finite() && radius.is_finite()) => {
                Some("a sphere needs finite numbers")
            }
            Self::Sphere { radius, .. } if !(radius > 0.0) => {
                Some("a sphere's radius, its last number, must be positive")
            }
            Self::Box { min, max } if !(min.is_finite() && max.is_finite()) => {
                Some("a box needs finite numbers")
            }
            Self::Box { min, max } if !min.cmple(max).all() => {
                Some("a box is written least corner first: x0, y0, z0, x1, y1, z1")
            }
            Self::Sphere { .. } | Self::Box { .. } => None,
        }
    }

    /// True where `point` lies inside.
    #[inline]
    pub fn contains(&self, point: DVec3) -> bool {
        match *self {
            Self::Sphere { centre, radius } => (point - centre).length_squared() <= radius * radius,
            Self::Box { min, max } => point.cmpge(min).all() && point.cmple(max).all(),
        }
    }

    /// True where the segment from `a` to `b` has a point inside.
    #[inline]
    pub fn meets_segment(&self, a: DVec3, b: DVec3) -> bool {
        let d = b - a;
        match *self {
            Self::Sphere { centre, radius } => {
                let along = (centre - a).dot(d);
                let length_squared = d.length_squared();
                // A segment without length is its point.
                let t = if along > 0.0 { (along / length_squared).min(1.0) } else { 0.0 };
                (a + t * d - centre).length_squared() <= radius * radius
            }
            Self::Box { min, max } => {
                // The part of the segment that lies between each pair of faces.
                let (mut enter, mut leave) = (0.0_f64, 1.0_f64);
                for axis in 0..3 {
                    let (s, t) = between([min[axis], max[axis]], a[axis], d[axis]);
                    enter = enter.max(s);
                    leave = leave.min(t);
                }
                enter <= leave
            }
        }
    }
}

/// The parameters between which `a + t d` lies between two faces; an empty range where it never does.
fn between(faces: [f64; 2], a: f64, d: f64) -> (f64, f64) {
    if d != 0.0 {
        let [s, t] = faces.map(|face| (face - a) / d);
        return (s.min(t), s.max(t));
    }
    if (faces[0]..=faces[1]).contains(&a) { (0.0, 1.0) } else { (1.0, 0.0) }
}
