//! Regions of space.

use glam::{DVec3, Vec3};

use super::{Described, Form, NumberPart, Spot, Unit, choose};
use crate::filter::word::{Walk, words};
use crate::filter::{FilterError, MARGIN};
use crate::{SceneFrame, VertexRecord};

/// Steps of the search for the point of a segment that is nearest to a box; each leaves two thirds.
const SEARCH: usize = 48;
/// No coordinate is larger, in the file's units.
const FAR: f64 = 1e12;

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

words! {
    /// The shape of a region.
    enum Shape: "The shape of the region" {
        Sphere = "sphere", "x, y, z, radius";
        Box = "box", "x0, y0, z0, x1, y1, z1";
    }
}

impl Default for Volume {
    fn default() -> Self {
        Self::ball(Spot::default())
    }
}

impl Described for Volume {
    fn describe(&mut self, form: &mut dyn Form) -> Walk {
        const PLACE: NumberPart =
            NumberPart { about: "x", least: -FAR, most: FAR, unit: Unit::Length };
        let start = form.mark();
        let mut shape = self.shape();
        choose(form, &mut shape)?;
        if shape != self.shape() {
            *self = self.in_place(shape);
        }
        form.sign("(", "")?;
        match self {
            Self::Sphere { centre, radius } => {
                for (i, about) in ["x", "y", "z"].into_iter().enumerate() {
                    form.number(&NumberPart { about, ..PLACE }, &mut centre[i])?;
                    form.sign(", ", "")?;
                }
                let about = "radius";
                form.number(&NumberPart { about, least: f64::MIN_POSITIVE, ..PLACE }, radius)?;
            }
            Self::Box { min, max } => {
                for (i, about) in ["least x", "least y", "least z"].into_iter().enumerate() {
                    form.number(&NumberPart { about, most: max[i], ..PLACE }, &mut min[i])?;
                    form.sign(", ", "")?;
                }
                for (i, about) in ["largest x", "largest y", "largest z"].into_iter().enumerate() {
                    if i > 0 {
                        form.sign(", ", "")?;
                    }
                    form.number(&NumberPart { about, least: min[i], ..PLACE }, &mut max[i])?;
                }
            }
        }
        form.sign(")", "")?;
        form.check(start, self.complaint())
    }
}

impl Volume {
    /// A new ball.
    pub(super) fn ball(spot: Spot) -> Self {
        Self::Sphere { centre: spot.centre, radius: spot.radius }
    }

    /// A new cube.
    pub(super) fn cube(spot: Spot) -> Self {
        Self::Box { min: spot.centre - spot.radius, max: spot.centre + spot.radius }
    }

    fn shape(&self) -> Shape {
        match self {
            Self::Sphere { .. } => Shape::Sphere,
            Self::Box { .. } => Shape::Box,
        }
    }

    /// A region of another shape that lies around the same point and is about as large.
    fn in_place(&self, shape: Shape) -> Self {
        let spot = match *self {
            Self::Sphere { centre, radius } => Spot { centre, radius },
            Self::Box { min, max } => Spot { centre: 0.5 * (min + max), radius: self.reach() },
        };
        match shape {
            Shape::Sphere => Self::ball(spot),
            Shape::Box => Self::cube(spot),
        }
    }

    /// The region in scene units.
    pub(super) fn bind(&self, frame: SceneFrame) -> Result<Self, FilterError> {
        if let Some(complaint) = self.complaint() {
            return Err(FilterError::of_tree(complaint));
        }
        Ok(match *self {
            Self::Sphere { centre, radius } => {
                Self::Sphere { centre: frame.to_scene(centre), radius: radius * frame.scale }
            }
            Self::Box { min, max } => {
                Self::Box { min: frame.to_scene(min), max: frame.to_scene(max) }
            }
        })
    }

    /// The region, larger by `by` on every side, and what that is called.
    pub fn widened(&self, by: f64) -> (&'static str, Self) {
        match *self {
            Self::Sphere { centre, radius } => {
                ("Widen the sphere", Self::Sphere { centre, radius: (radius + by) * MARGIN })
            }
            Self::Box { min, max } => {
                let by = by * MARGIN;
                ("Widen the box", Self::Box { min: min - by, max: max + by })
            }
        }
    }

    /// Why the region makes no sense, if it does not.
    fn complaint(&self) -> Option<&'static str> {
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
                Some("a box is given with its smallest corner first: x0, y0, z0, x1, y1, z1")
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

    /// How far outside `point` lies; zero inside.
    pub(super) fn distance(&self, point: DVec3) -> f64 {
        match *self {
            Self::Sphere { centre, radius } => ((point - centre).length() - radius).max(0.0),
            Self::Box { min, max } => (point - point.clamp(min, max)).length(),
        }
    }

    /// How far the segment from `a` to `b` passes by; zero where it meets the region. The distance to
    /// a convex region is convex along the segment, so that a search by thirds finds the least.
    pub(super) fn distance_to_segment(&self, a: DVec3, b: DVec3) -> f64 {
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..SEARCH {
            let third = (high - low) / 3.0;
            let [left, right] = [low + third, high - third];
            if self.distance(a.lerp(b, left)) <= self.distance(a.lerp(b, right)) {
                high = right;
            } else {
                low = left;
            }
        }
        self.distance(a.lerp(b, 0.5 * (low + high)))
    }

    /// Its size: a radius, or half of a box's diagonal.
    pub(super) fn reach(&self) -> f64 {
        let reach = match *self {
            Self::Sphere { radius, .. } => radius,
            Self::Box { min, max } => 0.5 * (max - min).length(),
        };
        reach.max(f64::MIN_POSITIVE)
    }
}

/// The point at which a vertex lies, in scene units.
#[inline]
pub(in crate::filter) fn point(vertex: &VertexRecord) -> DVec3 {
    Vec3::from_array(vertex.position).as_dvec3()
}

/// The parameters between which `a + t d` lies between two faces; an empty range where it never does.
fn between(faces: [f64; 2], a: f64, d: f64) -> (f64, f64) {
    if d != 0.0 {
        let [s, t] = faces.map(|face| (face - a) / d);
        return (s.min(t), s.max(t));
    }
    if (faces[0]..=faces[1]).contains(&a) { (0.0, 1.0) } else { (1.0, 0.0) }
}
