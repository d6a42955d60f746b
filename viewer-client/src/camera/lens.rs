//! From a standpoint to a picture.

use common::Camera;
use glam::{Mat4, Vec3, Vec4};

/// Distance of the near plane in scene units, of which the scene has a thousand or two.
pub const NEAR: f32 = 0.5;
/// While looking through the render camera, this much more is seen round its picture.
const GATE_MARGIN: f32 = 1.06;

/// An eye: a standpoint, three unit vectors and an opening.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lens {
    /// The standpoint in scene units.
    pub eye: Vec3,
    /// To the right of the picture.
    pub right: Vec3,
    /// To the top of the picture.
    pub up: Vec3,
    /// Into the picture.
    pub forward: Vec3,
    /// Tangent of half the vertical field of view.
    pub tan_y: f32,
    /// Width of the picture over its height.
    pub aspect: f32,
}

impl Lens {
    /// The render camera, opened so far that its whole picture fits into a viewport of `aspect`.
    pub(super) fn through(camera: &Camera, aspect: f32) -> Self {
        Self {
            eye: camera.origin.as_vec3(),
            right: camera.right.as_vec3(),
            up: camera.up.as_vec3(),
            forward: camera.forward.as_vec3(),
            tan_y: Gate::opening(camera, aspect),
            aspect,
        }
    }

    /// The point seen at tangents `right` and `up` from the view direction, at `depth` along it.
    pub fn at(&self, [right, up]: [f32; 2], depth: f32) -> Vec3 {
        self.eye + depth * (self.forward + right * self.right + up * self.up)
    }

    /// From scene units to clip space. Depth is reversed, 1 at the near plane and 0 at infinity,
    /// which spreads the precision of floats evenly over distances.
    pub fn view_projection(&self) -> Mat4 {
        let view = Mat4::from_cols(
            Vec4::new(self.right.x, self.up.x, -self.forward.x, 0.0),
            Vec4::new(self.right.y, self.up.y, -self.forward.y, 0.0),
            Vec4::new(self.right.z, self.up.z, -self.forward.z, 0.0),
            Vec4::new(
                -self.right.dot(self.eye),
                -self.up.dot(self.eye),
                self.forward.dot(self.eye),
                1.0,
            ),
        );
        let projection = Mat4::from_cols(
            Vec4::new(1.0 / (self.tan_y * self.aspect), 0.0, 0.0, 0.0),
            Vec4::new(0.0, 1.0 / self.tan_y, 0.0, 0.0),
            Vec4::new(0.0, 0.0, 0.0, -1.0),
            Vec4::new(0.0, 0.0, NEAR, 0.0),
        );
        projection * view
    }
}

/// The part of a viewport that the render camera's picture fills, as fractions of the viewport's
/// width and height, round its middle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gate {
    /// Fraction of the width.
    pub width: f32,
    /// Fraction of the height.
    pub height: f32,
}

impl Gate {
    pub(super) fn of(camera: &Camera, aspect: f32) -> Self {
        let tan_y = Self::opening(camera, aspect);
        Self { width: camera.tan_x as f32 / (tan_y * aspect), height: camera.tan_y as f32 / tan_y }
    }

    /// Tangent of half the vertical field of view at which the whole picture is seen.
    fn opening(camera: &Camera, aspect: f32) -> f32 {
        GATE_MARGIN * (camera.tan_y as f32).max(camera.tan_x as f32 / aspect)
    }
}
