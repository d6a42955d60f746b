//! Vectors, colours, cameras and frames.

use common::{Camera, CameraError, Rgb, SceneFrame};
use glam::DVec3;

use super::{WireError, check};
use crate::v1;

/// How far the axes of a camera may be from unit length and from right angles.
const AXIS_TOLERANCE: f64 = 1e-6;

impl From<DVec3> for v1::Vector {
    fn from(v: DVec3) -> Self {
        Self { x: v.x, y: v.y, z: v.z }
    }
}

/// A vector of finite coordinates.
pub(super) fn vector(field: &'static str, wire: Option<v1::Vector>) -> Result<DVec3, WireError> {
    let v1::Vector { x, y, z } = check::required(field, wire)?;
    for coordinate in [x, y, z] {
        check::finite(field, coordinate)?;
    }
    Ok(DVec3::new(x, y, z))
}

impl From<Rgb> for v1::Color {
    fn from(c: Rgb) -> Self {
        Self { r: c.r, g: c.g, b: c.b }
    }
}

/// A colour of finite channels, none negative.
pub(super) fn color(field: &'static str, wire: Option<v1::Color>) -> Result<Rgb, WireError> {
    let v1::Color { r, g, b } = check::required(field, wire)?;
    for found in [r, g, b] {
        if !(found.is_finite() && found >= 0.0) {
            return Err(WireError::BadNumber { field, found, wanted: "finite, non-negative" });
        }
    }
    Ok(Rgb::new(r, g, b))
}

impl From<SceneFrame> for v1::SceneFrame {
    fn from(frame: SceneFrame) -> Self {
        Self { centre: Some(frame.centre.into()), scale: frame.scale, light: frame.light }
    }
}

impl TryFrom<v1::SceneFrame> for SceneFrame {
    type Error = WireError;

    fn try_from(wire: v1::SceneFrame) -> Result<Self, WireError> {
        Ok(Self {
            centre: vector("frame.centre", wire.centre)?,
            scale: check::positive("frame.scale", wire.scale)?,
            // Daemons before 1.4 do not tell.
            light: match wire.light {
                0.0 => 1.0,
                told => check::positive("frame.light", told)?,
            },
        })
    }
}

impl From<Camera> for v1::Camera {
    fn from(camera: Camera) -> Self {
        Self {
            origin: Some(camera.origin.into()),
            right: Some(camera.right.into()),
            up: Some(camera.up.into()),
            forward: Some(camera.forward.into()),
            tan_x: camera.tan_x,
            tan_y: camera.tan_y,
            width: camera.width,
            height: camera.height,
            aperture: camera.aperture,
            focus: camera.focus,
        }
    }
}

impl TryFrom<v1::Camera> for Camera {
    type Error = WireError;

    fn try_from(wire: v1::Camera) -> Result<Self, WireError> {
        let camera = Self {
            origin: vector("camera.origin", wire.origin)?,
            right: vector("camera.right", wire.right)?,
            up: vector("camera.up", wire.up)?,
            forward: vector("camera.forward", wire.forward)?,
            tan_x: check::positive("camera.tan_x", wire.tan_x)?,
            tan_y: check::positive("camera.tan_y", wire.tan_y)?,
            width: check::within("camera.width", wire.width, 1, check::MAX_FILM_SIDE)?,
            height: check::within("camera.height", wire.height, 1, check::MAX_FILM_SIDE)?,
            aperture: check::not_negative("camera.aperture", wire.aperture)?,
            focus: match wire.focus {
                0.0 => 1.0,
                focus => check::positive("camera.focus", focus)?,
            },
        };
        let unit = |axis: DVec3| (axis.length_squared() - 1.0).abs() < AXIS_TOLERANCE;
        if !unit(camera.forward) {
            return Err(CameraError::NoDirection.into());
        }
        // Right-handed and orthonormal: `right x forward` is `up`.
        let skew = (camera.right.cross(camera.forward) - camera.up).length_squared();
        if !(unit(camera.right) && skew < AXIS_TOLERANCE) {
            return Err(CameraError::BadUp.into());
        }
        Ok(camera)
    }
}
