//! Ray queries. The only file that names obvhs.
//!
//! Triangles are traversed in single precision; the winner is pierced again in double precision.
//! Spheres are solved in double precision, and cost nothing in a scene without them.

use std::time::Duration;

use glam::{DVec3, Vec3A};
use obvhs::{
    BvhBuildParams,
    aabb::Aabb,
    cwbvh::{
        CwBvh,
        builder::{build_cwbvh, build_cwbvh_from_tris},
    },
    ray::{Ray, RayHit},
    triangle::Triangle as BvhTriangle,
};

use super::surface::{Ball, NO_PRIMITIVE, Triangle};

/// A point that rays leave from or end at.
#[derive(Clone, Copy, Debug)]
pub struct Anchor {
    /// Where.
    pub position: DVec3,
    /// Unit normal of the surface; ignored at the lens.
    pub normal: DVec3,
    /// The primitive it lies on, or [`NO_PRIMITIVE`].
    pub primitive: u32,
}

/// The nearest surface along a ray.
#[derive(Clone, Copy, Debug)]
pub struct Hit {
    /// The point, exactly on the surface up to `f64` rounding.
    pub position: DVec3,
    /// Unit geometric normal on the front side.
    pub normal: DVec3,
    /// The primitive.
    pub primitive: u32,
}

/// Shapes and the hierarchies over them. Primitives are numbered triangles first, then spheres.
#[derive(Debug)]
pub(crate) struct Accel {
    triangles: Vec<Triangle>,
    balls: Vec<Ball>,
    triangle_tree: CwBvh,
    /// In the order of the tree's leaves.
    leaves: Vec<BvhTriangle>,
    ball_tree: CwBvh,
    /// For each shape, the one in the tree that stands for it; empty where each stands for itself.
    triangle_stands: Vec<u32>,
    ball_stands: Vec<u32>,
}

/// Where more shapes than this have one place, a tree holds the first of them only: one over many equal
/// boxes is too deep to be walked, and no ray could tell them apart.
const MOST_COPIES: usize = 8;

/// Roots nearer than this to the end of a segment that lies on the sphere are that end.
const ON_SPHERE: f64 = 1e-6;

impl Accel {
    pub(crate) fn new(triangles: Vec<Triangle>, balls: Vec<Ball>) -> Self {
        let mut elapsed = Duration::ZERO;
        let leaves: Vec<BvhTriangle> = triangles
            .iter()
            .map(|t| {
                let [v0, v1, v2] = t.to_single();
                BvhTriangle { v0, v1, v2 }
            })
            .collect();
        let place = |t: &BvhTriangle| [t.v0, t.v1, t.v2].map(|v| v.to_array().map(f32::to_bits));
        let (kept, triangle_stands) = thin(leaves.iter().map(place));
        let thinned: Vec<BvhTriangle> = kept.iter().map(|&i| leaves[i as usize]).collect();
        let mut triangle_tree =
            build_cwbvh_from_tris(&thinned, BvhBuildParams::medium_build(), &mut elapsed);
        renumber(&mut triangle_tree, &kept);
        let leaves = triangle_tree.primitive_indices.iter().map(|&i| leaves[i as usize]).collect();

        let boxes: Vec<Aabb> = balls.iter().map(bounding_box).collect();
        let place = |b: &Aabb| [b.min, b.max].map(|v| v.to_array().map(f32::to_bits));
        let (kept, ball_stands) = thin(boxes.iter().map(place));
        let thinned: Vec<Aabb> = kept.iter().map(|&i| boxes[i as usize]).collect();
        let mut ball_tree = build_cwbvh(&thinned, BvhBuildParams::medium_build(), &mut elapsed);
        renumber(&mut ball_tree, &kept);
        Self { triangles, balls, triangle_tree, leaves, ball_tree, triangle_stands, ball_stands }
    }

    pub(crate) fn triangles(&self) -> &[Triangle] {
        &self.triangles
    }

    pub(crate) fn balls(&self) -> &[Ball] {
        &self.balls
    }

    fn ball_index(&self, primitive: u32) -> Option<usize> {
        let index = (primitive as usize).checked_sub(self.triangles.len())?;
        (index < self.balls.len()).then_some(index)
    }

    /// The index of the sphere in the tree that stands for this primitive.
    fn own_ball(&self, primitive: u32) -> Option<usize> {
        let index = self.ball_index(primitive)?;
        Some(self.ball_stands.get(index).map_or(index, |&stand| stand as usize))
    }

    /// How far rays that leave `primitive` are moved off it.
    pub(crate) fn offset(&self, primitive: u32) -> f64 {
        if let Some(triangle) = self.triangles.get(primitive as usize) {
            return triangle.offset;
        }
        self.ball_index(primitive).map_or(0.0, |i| self.balls[i].offset)
    }

    /// The ray's origin: off the surface, towards the side that the ray leaves to.
    #[inline]
    fn leave(&self, from: &Anchor, direction: DVec3) -> DVec3 {
        if from.primitive == NO_PRIMITIVE {
            return from.position;
        }
        let offset = self.offset(from.primitive).copysign(from.normal.dot(direction));
        from.position + offset * from.normal
    }

    /// The nearest surface seen from `from` in the unit `direction`.
    #[inline]
    pub(crate) fn closest(&self, from: &Anchor, direction: DVec3) -> Option<Hit> {
        let mut nearest = RayHit::none();
        if !self.leaves.is_empty() {
            let origin = self.leave(from, direction).as_vec3a();
            let ray = Ray::new_inf(origin, direction.as_vec3a());
            let own = self.leaf_filter(from.primitive, NO_PRIMITIVE);
            self.triangle_tree.ray_traverse(ray, &mut nearest, |ray, leaf| {
                let t = self.leaves[leaf].intersect(ray);
                if t < f32::INFINITY && own(leaf) { f32::INFINITY } else { t }
            });
        }
        let sphere = self.closest_ball(from, direction, f64::from(nearest.t));
        if let Some((index, t)) = sphere {
            let ball = &self.balls[index];
            let position = ball.snap(from.position + t * direction);
            let primitive = (self.triangles.len() + index) as u32;
            return Some(Hit { position, normal: ball.normal(position), primitive });
        }
        if !(nearest.t < f32::INFINITY) {
            return None;
        }
        let primitive = self.triangle_tree.primitive_indices[nearest.primitive_id as usize];
        let triangle = &self.triangles[primitive as usize];
        let position = triangle.pierce(from.position, direction);
        position.is_finite().then_some(Hit { position, normal: triangle.normal, primitive })
    }

    /// True when nothing stands between the two points.
    #[inline]
    pub(crate) fn visible(&self, a: &Anchor, b: &Anchor) -> bool {
        let toward = b.position - a.position;
        let (start, end) = (self.leave(a, toward), self.leave(b, -toward));
        let span = end - start;
        let length = span.length();
        if !(length > 0.0) {
            return false;
        }
        let direction = span / length;
        if !self.leaves.is_empty() {
            const SHORTENED: f64 = 1.0 - 1.0 / (1 << 22) as f64;
            let reach = (length * SHORTENED) as f32;
            let ray = Ray::new(start.as_vec3a(), direction.as_vec3a(), 0.0, reach);
            let own = self.leaf_filter(a.primitive, b.primitive);
            let clear = self.triangle_tree.ray_traverse_miss(ray, |ray, leaf| {
                let t = self.leaves[leaf].intersect(ray);
                if t < f32::INFINITY && own(leaf) { f32::INFINITY } else { t }
            });
            if !clear {
                return false;
            }
        }
        self.balls.is_empty() || !self.any_ball_between(a, b)
    }

    /// Tells the leaves that a ray's own ends lie on: a plane never meets a ray twice.
    #[inline]
    fn leaf_filter(&self, from: u32, to: u32) -> impl Fn(usize) -> bool + '_ {
        let stand = |primitive: u32| {
            self.triangle_stands.get(primitive as usize).copied().unwrap_or(primitive)
        };
        let (from, to) = (stand(from), stand(to));
        move |leaf| {
            let primitive = self.triangle_tree.primitive_indices[leaf];
            primitive == from || primitive == to
        }
    }

    fn closest_ball(&self, from: &Anchor, direction: DVec3, reach: f64) -> Option<(usize, f64)> {
        if self.balls.is_empty() {
            return None;
        }
        let own = self.own_ball(from.primitive);
        let mut best: Option<(usize, f64)> = None;
        let ray = Ray::new_inf(from.position.as_vec3a(), direction.as_vec3a());
        self.ball_tree.ray_traverse_anyhit(ray, |_, leaf| {
            let index = self.ball_tree.primitive_indices[leaf] as usize;
            let Some((near, far)) = self.balls[index].roots(from.position, direction) else {
                return;
            };
            let nearest_allowed = if own == Some(index) { ON_SPHERE } else { 0.0 };
            let t = if near > nearest_allowed { near } else { far };
            if t > nearest_allowed && t < best.map_or(reach, |(_, t)| t) {
                best = Some((index, t));
            }
        });
        best
    }

    fn any_ball_between(&self, a: &Anchor, b: &Anchor) -> bool {
        let toward = b.position - a.position;
        let length = toward.length();
        let direction = toward / length;
        let (own_a, own_b) = (self.own_ball(a.primitive), self.own_ball(b.primitive));
        let ray = Ray::new(a.position.as_vec3a(), direction.as_vec3a(), 0.0, length as f32);
        let mut blocked = false;
        self.ball_tree.ray_traverse_anyhit(ray, |_, leaf| {
            let index = self.ball_tree.primitive_indices[leaf] as usize;
            let Some((near, far)) = self.balls[index].roots(a.position, direction) else {
                return;
            };
            let first = if own_a == Some(index) { ON_SPHERE } else { 0.0 };
            let last = if own_b == Some(index) { length - ON_SPHERE } else { length };
            let between = |t: f64| t > first && t < last;
            blocked |= between(near) || between(far);
        });
        blocked
    }
}

/// The shapes that a tree holds, and for each shape the one that stands for it.
fn thin<K: Ord>(places: impl Iterator<Item = K>) -> (Vec<u32>, Vec<u32>) {
    let mut sorted: Vec<(K, u32)> = places.zip(0..).collect();
    sorted.sort_unstable();
    let all = 0..sorted.len() as u32;
    let mut stands: Vec<u32> = all.clone().collect();
    let mut crowded = false;
    for copies in sorted.chunk_by(|a, b| a.0 == b.0).filter(|all| all.len() > MOST_COPIES) {
        crowded = true;
        for copy in copies {
            stands[copy.1 as usize] = copies[0].1;
        }
    }
    if !crowded {
        return (stands, Vec::new());
    }
    (all.filter(|&i| stands[i as usize] == i).collect(), stands)
}

/// Lets the leaves of a tree speak of all shapes, not of those that were kept.
fn renumber(tree: &mut CwBvh, kept: &[u32]) {
    tree.primitive_indices.iter_mut().for_each(|index| *index = kept[*index as usize]);
}

fn bounding_box(ball: &Ball) -> Aabb {
    // One part in a million wider, so that rounding to single precision never cuts the sphere.
    let reach = Vec3A::splat((ball.radius * (1.0 + 1e-6) + ball.offset) as f32);
    let centre = ball.centre.as_vec3a();
    Aabb::new(centre - reach, centre + reach)
}
