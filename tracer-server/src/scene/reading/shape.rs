//! The shapes and transforms of the project's own scene files.

use glam::{DMat3, DVec3, Vec2, Vec3};
use serde::Deserialize;

/// Vertex positions and triangles, counter-clockwise seen from the front side.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Surface {
    /// Vertex positions.
    pub(crate) positions: Vec<DVec3>,
    /// Indices into them.
    pub(crate) triangles: Vec<[u32; 3]>,
    /// Shading normals at the corners of each triangle, or nothing.
    pub(crate) normals: Vec<[Vec3; 3]>,
    /// Texture coordinates at the corners of each triangle, or nothing.
    pub(crate) texcoords: Vec<[Vec2; 3]>,
}

/// A flat parallelogram of two triangles.
///
/// ```toml
/// rectangle = { corner = [0, 0, 0], u = [1, 0, 0], v = [0, 1, 0] }   # faces +z
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Quad {
    /// One corner.
    pub(crate) corner: DVec3,
    /// The edge from the corner to the next.
    pub(crate) u: DVec3,
    /// The other edge at the corner; the front side faces `u` cross `v`.
    pub(crate) v: DVec3,
}

impl Quad {
    /// Its triangles.
    pub(crate) fn surface(&self) -> Surface {
        let Self { corner, u, v } = *self;
        Surface {
            positions: vec![corner, corner + u, corner + u + v, corner + v],
            triangles: vec![[0, 1, 2], [0, 2, 3]],
            texcoords: vec![[Vec2::ZERO, Vec2::X, Vec2::ONE], [Vec2::ZERO, Vec2::ONE, Vec2::Y]],
            ..Surface::default()
        }
    }
}

/// A box with its sides along the axes, of twelve triangles that face outwards.
///
/// ```toml
/// box = { min = [0, 0, 0], max = [1, 2, 1] }
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Cuboid {
    /// The corner with the smallest coordinates.
    pub(crate) min: DVec3,
    /// The corner with the largest coordinates.
    pub(crate) max: DVec3,
}

impl Cuboid {
    /// Its triangles. Corner `i` takes x, y, z from `max` where bit 0, 1, 2 of `i` is set.
    pub(crate) fn surface(&self) -> Surface {
        let pick =
            |i: u32, bit: u32, low: f64, high: f64| if (i >> bit) & 1 == 1 { high } else { low };
        let corner = |i: u32| {
            DVec3::new(
                pick(i, 0, self.min.x, self.max.x),
                pick(i, 1, self.min.y, self.max.y),
                pick(i, 2, self.min.z, self.max.z),
            )
        };
        let faces =
            [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
        let triangles = faces.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]);
        Surface {
            positions: (0..8).map(corner).collect(),
            triangles: triangles.collect(),
            ..Surface::default()
        }
    }
}

/// One step of a transform; the steps of a list apply in order.
///
/// ```toml
/// transform = [ { scale = 0.5 }, { rotate = { axis = [0, 1, 0], degrees = 17 } }, { translate = [1, 0, 2] } ]
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "snake_case")]
pub(crate) enum Step {
    /// Moves by this vector.
    Translate(DVec3),
    /// Turns about an axis through the origin.
    Rotate(Rotation),
    /// Scales about the origin; one factor, or one each for x, y and z. Negative factors mirror.
    Scale(Factors),
}

/// A turn about an axis through the origin.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Rotation {
    /// The axis, of any length but zero.
    pub(crate) axis: DVec3,
    /// The angle in degrees, counter-clockwise seen from the tip of the axis.
    pub(crate) degrees: f64,
}

impl Rotation {
    /// The rotation as a matrix, or what is wrong.
    pub(crate) fn matrix(self) -> Result<DMat3, &'static str> {
        let axis = self.axis.try_normalize().filter(|_| self.degrees.is_finite());
        let axis =
            axis.ok_or("rotate needs an axis that is not zero and a finite angle in degrees")?;
        Ok(DMat3::from_axis_angle(axis, self.degrees.to_radians()))
    }
}

/// Scale factors.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(untagged, expecting = "a number, or three numbers [x, y, z]")]
pub(crate) enum Factors {
    /// The same along all axes.
    Uniform(f64),
    /// One an axis.
    PerAxis(DVec3),
}

impl Surface {
    /// Applies the steps in order, or says which makes no sense.
    pub(crate) fn transform(&mut self, steps: &[Step]) -> Result<(), String> {
        for step in steps {
            match step {
                Step::Translate(by) => self.map(|p| p + by),
                Step::Rotate(rotation) => {
                    let matrix = rotation.matrix()?;
                    self.map(|p| matrix * p);
                    self.map_normals(|n| matrix * n);
                }
                Step::Scale(factors) => {
                    let factors = match *factors {
                        Factors::Uniform(factor) => DVec3::splat(factor),
                        Factors::PerAxis(factors) => factors,
                    };
                    let volume = factors.x * factors.y * factors.z;
                    if volume == 0.0 || !factors.is_finite() {
                        return Err("scale needs finite factors that are not zero".to_owned());
                    }
                    self.map(|p| p * factors);
                    // Normals stay square to surfaces that are stretched.
                    self.map_normals(|n| n / factors);
                    if volume < 0.0 {
                        // A mirror image turns counter-clockwise into clockwise.
                        self.reverse();
                    }
                }
            }
        }
        Ok(())
    }

    /// Turns the front sides to the back.
    pub(crate) fn flip(&mut self) {
        self.reverse();
        self.map_normals(|n| -n);
    }

    /// Turns all triangles round.
    fn reverse(&mut self) {
        self.triangles.iter_mut().for_each(|triangle| triangle.swap(1, 2));
        self.normals.iter_mut().for_each(|triangle| triangle.swap(1, 2));
        self.texcoords.iter_mut().for_each(|triangle| triangle.swap(1, 2));
    }

    fn map_normals(&mut self, f: impl Fn(DVec3) -> DVec3) {
        for normal in self.normals.as_flattened_mut() {
            *normal = f(normal.as_dvec3()).normalize_or_zero().as_vec3();
        }
    }

    fn map(&mut self, f: impl Fn(DVec3) -> DVec3) {
        for position in &mut self.positions {
            *position = f(*position);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Six times the volume that the surface encloses; positive when it faces outwards.
    fn volume(surface: &Surface) -> f64 {
        let corner = |i: u32| surface.positions[i as usize];
        surface.triangles.iter().map(|t| corner(t[0]).dot(corner(t[1]).cross(corner(t[2])))).sum()
    }

    fn brick() -> Surface {
        Cuboid { min: DVec3::new(1.0, 1.0, 1.0), max: DVec3::new(2.0, 3.0, 4.0) }.surface()
    }

    #[test]
    fn a_box_is_closed_and_faces_outwards() {
        let brick = brick();
        assert_eq!(brick.triangles.len(), 12);
        assert!((volume(&brick) - 6.0 * 6.0).abs() < 1e-12, "1 x 2 x 3");
    }

    #[test]
    fn a_rectangle_faces_u_cross_v() {
        let quad = Quad { corner: DVec3::ONE, u: DVec3::X, v: 2.0 * DVec3::Y }.surface();
        let p = &quad.positions;
        assert_eq!((p[1] - p[0]).cross(p[2] - p[0]), 2.0 * DVec3::Z);
    }

    #[test]
    fn steps_apply_in_order_and_keep_the_front_outside() {
        let steps = [
            Step::Scale(Factors::PerAxis(DVec3::new(-2.0, 1.0, 1.0))),
            Step::Rotate(Rotation { axis: 3.0 * DVec3::Y, degrees: 90.0 }),
            Step::Translate(DVec3::new(0.0, -1.0, 0.0)),
        ];
        let mut brick = brick();
        let corner = brick.positions[0];
        brick.transform(&steps).expect("valid");
        assert_eq!(corner, DVec3::ONE);
        let moved = brick.positions[0];
        assert!((moved - DVec3::new(1.0, 0.0, 2.0)).length() < 1e-12, "{moved}");
        assert!((volume(&brick) - 72.0).abs() < 1e-9, "doubled, and not inside out");
    }

    #[test]
    fn senseless_steps_are_refused() {
        let senseless = [
            Step::Scale(Factors::Uniform(0.0)),
            Step::Scale(Factors::Uniform(f64::NAN)),
            Step::Rotate(Rotation { axis: DVec3::ZERO, degrees: 1.0 }),
            Step::Rotate(Rotation { axis: DVec3::X, degrees: f64::INFINITY }),
        ];
        for step in senseless {
            assert!(brick().transform(&[step]).is_err(), "{step:?}");
        }
    }
}
