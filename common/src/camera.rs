//! The render camera: an ideal pinhole or a thin lens, that both sides project with.

use glam::{DVec2, DVec3};
use serde::{Deserialize, Serialize};
use thiserror::Error;

/// Where a camera stands and looks, as a person writes it down.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct CameraPose {
    /// The eye point.
    pub origin: DVec3,
    /// A point in the middle of the picture.
    pub target: DVec3,
    /// A direction that points up in the picture; need not be perpendicular to the view.
    pub up: DVec3,
    /// Full vertical field of view in degrees.
    pub vertical_fov: f64,
}

/// Why a pose makes no camera.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum CameraError {
    /// A coordinate or an angle is NaN or infinite.
    #[error("the camera has a coordinate that is not a finite number")]
    NotFinite,
    /// Origin and target coincide.
    #[error("the camera's origin and target are the same point")]
    NoDirection,
    /// `up` is parallel to the view or zero.
    #[error("the camera's up vector is zero or parallel to its view direction")]
    BadUp,
    /// The field of view is not in (0, 180) degrees.
    #[error("the camera's vertical field of view is {0} degrees; it must lie between 0 and 180")]
    BadFieldOfView(f64),
    /// The film has no pixels.
    #[error("the film is {0} x {1} pixels; both sides must be at least 1")]
    EmptyFilm(u32, u32),
}

/// A camera with its film.
///
/// Film coordinates are normalised to area one: `u` grows to the right and `v` downwards, both in
/// [0, 1). The film plane lies at distance one from the pinhole.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Camera {
    /// The pinhole, or the middle of the lens.
    pub origin: DVec3,
    /// Unit vector to the right of the picture.
    pub right: DVec3,
    /// Unit vector to the top of the picture.
    pub up: DVec3,
    /// Unit view direction.
    pub forward: DVec3,
    /// Tangent of half the horizontal field of view.
    pub tan_x: f64,
    /// Tangent of half the vertical field of view.
    pub tan_y: f64,
    /// Film width in pixels.
    pub width: u32,
    /// Film height in pixels.
    pub height: u32,
    /// Radius of the lens; zero for a pinhole.
    pub aperture: f64,
    /// Distance along the view direction of the plane that is sharp; any positive number for a
    /// pinhole.
    pub focus: f64,
}

impl Camera {
    /// A camera at `pose` with a film of `width` x `height` square pixels.
    pub fn new(pose: &CameraPose, width: u32, height: u32) -> Result<Self, CameraError> {
        let finite = pose.origin.is_finite() && pose.target.is_finite() && pose.up.is_finite();
        if !finite || !pose.vertical_fov.is_finite() {
            return Err(CameraError::NotFinite);
        }
        if width == 0 || height == 0 {
            return Err(CameraError::EmptyFilm(width, height));
        }
        if !(pose.vertical_fov > 0.0 && pose.vertical_fov < 180.0) {
            return Err(CameraError::BadFieldOfView(pose.vertical_fov));
        }
        let forward =
            (pose.target - pose.origin).try_normalize().ok_or(CameraError::NoDirection)?;
        let up = pose.up.try_normalize().ok_or(CameraError::BadUp)?;
        let right = forward.cross(up);
        if right.length() < 1e-9 {
            return Err(CameraError::BadUp);
        }
        let right = right.normalize_or_zero();
        let tan_y = (0.5 * pose.vertical_fov.to_radians()).tan();
        let tan_x = tan_y * f64::from(width) / f64::from(height);
        let up = right.cross(forward);
        Ok(Self {
            origin: pose.origin,
            right,
            up,
            forward,
            tan_x,
            tan_y,
            width,
            height,
            aperture: 0.0,
            focus: 1.0,
        })
    }

    /// Area of the film window in the plane at distance one.
    pub fn film_area(&self) -> f64 {
        4.0 * self.tan_x * self.tan_y
    }

    /// The number of pixels.
    pub fn pixel_count(&self) -> usize {
        self.width as usize * self.height as usize
    }

    /// True when the lens has an area.
    #[inline]
    pub fn has_aperture(&self) -> bool {
        self.aperture > 0.0
    }

    /// The point of the lens that two uniform numbers stand for, uniform over its area.
    pub fn lens_point(&self, [u, v]: [f64; 2]) -> DVec3 {
        let radius = self.aperture * u.sqrt();
        let (sin, cos) = (std::f64::consts::TAU * v).sin_cos();
        self.origin + radius * cos * self.right + radius * sin * self.up
    }

    /// The numbers from which [`Camera::lens_point`] makes a point of the lens.
    pub fn invert_lens_point(&self, point: DVec3) -> [f64; 2] {
        let offset = (point - self.origin) / self.aperture;
        let (x, y) = (offset.dot(self.right), offset.dot(self.up));
        let turn = y.atan2(x) / std::f64::consts::TAU;
        let turn = if turn < 0.0 { turn + 1.0 } else { turn };
        [x * x + y * y, turn].map(|u| u.clamp(0.0, 1.0 - 0.5 * f64::EPSILON))
    }

    /// Unit direction from a point of the lens through the film point `(u, v)`: the film point
    /// stands for the point of the sharp plane that the middle of the lens sees through it.
    #[inline]
    pub fn direction_from(&self, lens: DVec3, film: DVec2) -> DVec3 {
        let direction = self.direction(film);
        if !self.has_aperture() {
            return direction;
        }
        let sharp = direction * (self.focus / direction.dot(self.forward));
        (self.origin + sharp - lens).normalize()
    }

    /// The film point seen from a point of the lens in `direction`, or `None` when it lies behind
    /// or beside the film.
    #[inline]
    pub fn project_from(&self, lens: DVec3, direction: DVec3) -> Option<DVec2> {
        let z = direction.dot(self.forward);
        if !self.has_aperture() || !(z > 0.0) {
            return self.project(direction);
        }
        self.project(lens - self.origin + direction * (self.focus / z))
    }

    /// Unit direction through the film point `(u, v)`.
    pub fn direction(&self, film: DVec2) -> DVec3 {
        let x = (2.0 * film.x - 1.0) * self.tan_x;
        let y = (1.0 - 2.0 * film.y) * self.tan_y;
        // The sum has length of at least one: `forward` is a unit vector perpendicular to the rest.
        let d = self.forward + x * self.right + y * self.up;
        d / d.length()
    }

    /// The film point seen in `direction`, or `None` when it lies behind or beside the film.
    pub fn project(&self, direction: DVec3) -> Option<DVec2> {
        let z = direction.dot(self.forward);
        if !(z > 0.0) {
            return None;
        }
        let u = 0.5 + 0.5 * direction.dot(self.right) / (z * self.tan_x);
        let v = 0.5 - 0.5 * direction.dot(self.up) / (z * self.tan_y);
        let inside = (0.0..1.0).contains(&u) && (0.0..1.0).contains(&v);
        inside.then(|| DVec2::new(u, v))
    }

    /// Density of film points over solid angle: `1 / (A_film cos^3)`, `cosine` measured from the
    /// view direction. A film point drawn uniformly has this solid-angle density at the pinhole and
    /// at every point of a thin lens.
    pub fn film_per_solid_angle(&self, cosine: f64) -> f64 {
        1.0 / (self.film_area() * cosine * cosine * cosine)
    }

    /// Index of the pixel that holds `film`, row by row from the top left.
    pub fn pixel(&self, film: DVec2) -> usize {
        let x = ((film.x * f64::from(self.width)) as usize).min(self.width as usize - 1);
        let y = ((film.y * f64::from(self.height)) as usize).min(self.height as usize - 1);
        y * self.width as usize + x
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn camera() -> Camera {
        let pose = CameraPose {
            origin: DVec3::new(1.0, 2.0, 3.0),
            target: DVec3::new(0.0, 2.5, -1.0),
            up: DVec3::Y,
            vertical_fov: 40.0,
        };
        Camera::new(&pose, 64, 48).expect("a valid pose")
    }

    #[test]
    fn projection_undoes_direction() {
        let camera = camera();
        for (u, v) in [(0.001, 0.001), (0.5, 0.5), (0.9, 0.1), (0.999, 0.999)] {
            let film = camera.project(camera.direction(DVec2::new(u, v))).expect("on the film");
            assert!((film - DVec2::new(u, v)).length() < 1e-12, "{film} is not ({u}, {v})");
        }
        assert_eq!(camera.project(-camera.forward), None, "behind the camera");
    }

    #[test]
    fn a_lens_is_sharp_in_one_plane() {
        let pinhole = camera();
        let camera = Camera { aperture: 0.3, focus: 4.0, ..pinhole };
        let film = DVec2::new(0.3, 0.8);
        let sharp = pinhole.direction(film);
        let sharp = pinhole.origin + sharp * (4.0 / sharp.dot(pinhole.forward));
        for u in [[0.0, 0.0], [0.5, 0.3], [0.99, 0.9]] {
            let lens = camera.lens_point(u);
            let direction = camera.direction_from(lens, film);
            let off = (sharp - lens).normalize().distance(direction);
            assert!(off < 1e-12, "the ray from {lens} misses the sharp point");
            let back = camera.project_from(lens, direction).expect("on the film");
            assert!((back - film).length() < 1e-12, "{back} is not {film}");
            let again = camera.invert_lens_point(lens);
            let off = (again[0] - u[0]).abs().max((again[1] - u[1]).abs());
            assert!(u[0] == 0.0 || off < 1e-12, "{again:?} is not {u:?}");
        }
    }

    #[test]
    fn right_is_right_and_down_is_down() {
        let camera = camera();
        let to_the_right = camera.project(camera.forward + 0.1 * camera.right).expect("on film");
        let below = camera.project(camera.forward - 0.1 * camera.up).expect("on film");
        assert!(to_the_right.x > 0.5 && below.y > 0.5, "u grows rightwards, v downwards");
    }

    #[test]
    fn bad_poses_are_refused() {
        let good =
            CameraPose { origin: DVec3::ZERO, target: DVec3::Z, up: DVec3::Y, vertical_fov: 40.0 };
        let bad = |pose| Camera::new(&pose, 4, 4).expect_err("must be refused");
        assert_eq!(bad(CameraPose { target: DVec3::ZERO, ..good }), CameraError::NoDirection);
        assert_eq!(bad(CameraPose { up: DVec3::Z, ..good }), CameraError::BadUp);
        assert_eq!(bad(CameraPose { origin: DVec3::NAN, ..good }), CameraError::NotFinite);
        let wide = CameraPose { vertical_fov: 180.0, ..good };
        assert_eq!(bad(wide), CameraError::BadFieldOfView(180.0));
        assert_eq!(Camera::new(&good, 0, 4), Err(CameraError::EmptyFilm(0, 4)));
    }
}
