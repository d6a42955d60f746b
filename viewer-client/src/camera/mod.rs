//! Where the user looks from: orbiting, flying, or through the render camera. Pure arithmetic.

mod lens;
#[cfg(test)]
mod tests;

pub use lens::{Gate, Lens, NEAR};

use common::Camera;
use glam::Vec3;

use crate::command::CameraCommand;
use crate::value::Bounds;
use crate::value::{Side, Viewpoint};

/// Half the vertical field of view of the user's eye, as a tangent: 45 degrees in all.
const TAN_Y: f32 = 0.414_213_56;
/// Closest to the zenith that the view may turn, in degrees.
const STEEPEST: f32 = 89.0;

/// The user's eye.
#[derive(Clone, Debug, PartialEq)]
pub struct ViewCamera {
    /// What the view turns round.
    pivot: Vec3,
    /// From the eye to the pivot.
    distance: f32,
    /// Degrees to the left of the front, seen from above.
    yaw: f32,
    /// Degrees above the horizon.
    pitch: f32,
    /// The scene's own axes.
    axes: Axes,
    /// What there is to see.
    bounds: Bounds,
    /// The camera that the picture is rendered with.
    render: Option<Camera>,
    flying: bool,
    through: bool,
}

/// The scene's own axes, all unit vectors.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Axes {
    front: Vec3,
    left: Vec3,
    up: Vec3,
}

impl Axes {
    /// Up is the coordinate axis nearest to the render camera's up, and front the one nearest to
    /// where it looks: files disagree whether y or z points up.
    fn of(camera: &Camera) -> Self {
        let up = nearest_axis(camera.up.as_vec3(), None);
        let front = nearest_axis(camera.forward.as_vec3(), Some(up));
        Self { front, left: up.cross(front), up }
    }
}

fn nearest_axis(v: Vec3, other_than: Option<Vec3>) -> Vec3 {
    let axes = [Vec3::X, -Vec3::X, Vec3::Y, -Vec3::Y, Vec3::Z, -Vec3::Z];
    let allowed = axes.into_iter().filter(|a| other_than.is_none_or(|o| a.dot(o) == 0.0));
    allowed.max_by(|a, b| a.dot(v).total_cmp(&b.dot(v))).unwrap_or(Vec3::Y)
}

impl Default for ViewCamera {
    fn default() -> Self {
        let axes = Axes { front: -Vec3::Z, left: -Vec3::X, up: Vec3::Y };
        let bounds = Bounds { min: Vec3::splat(-512.0), max: Vec3::splat(512.0) };
        let mut camera = Self {
            pivot: Vec3::ZERO,
            distance: 1.0,
            yaw: 0.0,
            pitch: 0.0,
            axes,
            bounds,
            render: None,
            flying: false,
            through: false,
        };
        camera.look_over_the_shoulder();
        camera
    }
}

impl ViewCamera {
    /// Follows a command.
    pub fn apply(&mut self, command: CameraCommand) {
        match command {
            CameraCommand::Orbit(right, up) => self.orbit(right, up),
            CameraCommand::Pan(right, up) => self.pan(right, up),
            CameraCommand::Zoom(factor, at) => self.zoom(factor, at),
            CameraCommand::Look(right, up) => self.look_around(right, up),
            CameraCommand::Move(step) => self.step(step),
            CameraCommand::Fly(switch) => switch.apply(&mut self.flying),
            CameraCommand::Through(switch) => {
                switch.apply(&mut self.through);
                self.through &= self.render.is_some();
            }
            CameraCommand::Focus(point, distance) => {
                self.leave_render_camera();
                self.pivot = point.into();
                self.distance = self.distance.min(distance);
            }
            CameraCommand::Frame => {
                self.through = false;
                self.frame();
            }
            CameraCommand::Place(place) => {
                self.through = false;
                self.pivot = Vec3::from(place.pivot);
                (self.distance, self.yaw, self.pitch) = (place.distance, place.yaw, place.pitch);
            }
            CameraCommand::View(side) => self.view(side),
        }
    }

    /// Where the eye is when it does not look through the render camera.
    pub fn place(&self) -> Viewpoint {
        let &Self { pivot, distance, yaw, pitch, .. } = self;
        Viewpoint { pivot: pivot.to_array(), distance, yaw, pitch }
    }

    /// Takes a new scene, and starts behind the render camera's shoulder.
    pub fn set_scene(&mut self, bounds: Bounds, render: Option<Camera>) {
        if let Some(camera) = &render {
            self.axes = Axes::of(camera);
        }
        self.bounds = bounds;
        self.render = render;
        self.through = false;
        self.look_over_the_shoulder();
    }

    /// True when the user flies.
    pub fn is_flying(&self) -> bool {
        self.flying
    }

    /// True when the user looks through the render camera.
    pub fn is_through(&self) -> bool {
        self.through
    }

    /// The render camera.
    pub fn render_camera(&self) -> Option<&Camera> {
        self.render.as_ref()
    }

    /// The scene's up direction.
    pub fn up(&self) -> Vec3 {
        self.axes.up
    }

    /// What there is to see.
    pub fn bounds(&self) -> Bounds {
        self.bounds
    }

    /// The eye as the picture needs it.
    pub fn lens(&self, aspect: f32) -> Lens {
        if let Some(camera) = self.render.as_ref().filter(|_| self.through) {
            return Lens::through(camera, aspect);
        }
        let forward = self.forward();
        let right = self.right();
        let up = right.cross(forward);
        Lens { eye: self.eye(), right, up, forward, tan_y: TAN_Y, aspect }
    }

    /// Where the render camera's picture lies in a viewport of `aspect`, while looking through it.
    pub fn gate(&self, aspect: f32) -> Option<Gate> {
        self.render.as_ref().filter(|_| self.through).map(|camera| Gate::of(camera, aspect))
    }

    fn eye(&self) -> Vec3 {
        self.pivot - self.distance * self.forward()
    }

    fn forward(&self) -> Vec3 {
        let (sin_yaw, cos_yaw) = self.yaw.to_radians().sin_cos();
        let (sin_pitch, cos_pitch) = self.pitch.to_radians().sin_cos();
        cos_pitch * (cos_yaw * self.axes.front + sin_yaw * self.axes.left)
            + sin_pitch * self.axes.up
    }

    fn right(&self) -> Vec3 {
        self.forward().cross(self.axes.up).normalize_or(-self.axes.left)
    }

    /// Whoever moves while looking through the render camera goes on from where it stands.
    fn leave_render_camera(&mut self) {
        let Some(camera) = self.render.as_ref().filter(|_| self.through) else { return };
        let (eye, forward) = (camera.origin.as_vec3(), camera.forward.as_vec3());
        self.through = false;
        self.distance = (self.bounds.centre() - eye).dot(forward).max(0.1 * self.bounds.radius());
        self.aim(forward);
        self.pivot = eye + self.distance * forward;
    }

    fn aim(&mut self, forward: Vec3) {
        let (x, y) = (forward.dot(self.axes.front), forward.dot(self.axes.left));
        if x != 0.0 || y != 0.0 {
            self.yaw = y.atan2(x).to_degrees();
        }
        let up = forward.dot(self.axes.up).clamp(-1.0, 1.0);
        self.pitch = up.asin().to_degrees().clamp(-STEEPEST, STEEPEST);
    }

    fn turn(&mut self, right: f32, up: f32) {
        self.yaw = (self.yaw - right).rem_euclid(360.0);
        self.pitch = (self.pitch + up).clamp(-STEEPEST, STEEPEST);
    }

    fn orbit(&mut self, right: f32, up: f32) {
        self.leave_render_camera();
        self.turn(right, up);
    }

    fn look_around(&mut self, right: f32, up: f32) {
        self.leave_render_camera();
        let eye = self.eye();
        self.turn(right, up);
        self.pivot = eye + self.distance * self.forward();
    }

    /// The height of the viewport in the plane of the pivot.
    fn height_at_pivot(&self) -> f32 {
        2.0 * self.distance * TAN_Y
    }

    fn pan(&mut self, right: f32, up: f32) {
        self.leave_render_camera();
        let height = self.height_at_pivot();
        let up_axis = self.right().cross(self.forward());
        self.pivot -= height * (right * self.right() + up * up_axis);
    }

    fn step(&mut self, [forward, right, up]: [f32; 3]) {
        self.leave_render_camera();
        let step = forward * self.forward() + right * self.right() + up * self.axes.up;
        self.pivot += 2.0 * self.bounds.radius() * step;
    }

    /// `at` is measured in half heights of the viewport, so that no aspect is needed.
    fn zoom(&mut self, factor: f32, at: [f32; 2]) {
        self.leave_render_camera();
        let radius = self.bounds.radius();
        let distance = (self.distance / factor).clamp(1e-3 * radius, 50.0 * radius);
        let up_axis = self.right().cross(self.forward());
        let half_height = 0.5 * self.height_at_pivot();
        let under_cursor = half_height * (at[0] * self.right() + at[1] * up_axis);
        self.pivot += under_cursor * (1.0 - distance / self.distance);
        self.distance = distance;
    }

    fn frame(&mut self) {
        self.pivot = self.bounds.centre();
        // The sphere round the bounds touches the upper and lower edge of the picture.
        let sine = TAN_Y / (1.0 + TAN_Y * TAN_Y).sqrt();
        self.distance = self.bounds.radius() / sine;
    }

    fn view(&mut self, side: Side) {
        self.through = false;
        (self.yaw, self.pitch) = match side {
            Side::Front => (0.0, 0.0),
            Side::Back => (180.0, 0.0),
            Side::Left => (270.0, 0.0),
            Side::Right => (90.0, 0.0),
            Side::Top => (0.0, -STEEPEST),
            Side::Bottom => (0.0, STEEPEST),
        };
        self.frame();
    }

    /// The first view: from behind and beside the render camera, so that the scene, the camera and
    /// the light between them are all seen. A camera far away stays out of the picture.
    fn look_over_the_shoulder(&mut self) {
        let Some((origin, forward)) =
            self.render.as_ref().map(|c| (c.origin.as_vec3(), c.forward.as_vec3()))
        else {
            self.turn(-26.0, -12.0);
            self.frame();
            return;
        };
        self.aim(forward);
        self.turn(-33.0, -15.0);
        self.frame();
        let to_camera = (origin - self.pivot).clamp_length_max(4.0 * self.bounds.radius());
        self.pivot += 0.4 * to_camera;
        self.distance *= 1.5;
    }
}
