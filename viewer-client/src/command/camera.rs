//! `camera ...`: how the camera of the view moves.

use super::table::table;
use crate::value::{Axes, Range, Side, Switch, Viewpoint, axes, range};

const DEGREES: Range<f32> = range(-3600.0, 3600.0);
const STEP: Range<f32> = range(-100.0, 100.0);
/// A point of the viewport, in half heights.
const AT: Axes<f32, 2> = axes(["X", "Y"], range(-20.0, 20.0));
const STEPS: Axes<f32, 3> = axes(["FORWARD", "RIGHT", "UP"], STEP);
const POINT: Axes<f32, 3> = axes(["X", "Y", "Z"], range(-1e6, 1e6));

table! {
    /// What the camera of the view may do.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub enum CameraCommand in Camera;

    commands {
        /// Orbits around the pivot, in degrees.
        Orbit "camera orbit" (right: f32 [DEGREES], up: f32 [DEGREES]), Linked;
        /// Pans the view, in heights of the viewport.
        Pan "camera pan" (right: f32 [STEP], up: f32 [STEP]), Linked;
        /// Zooms towards a point of the viewport, given in half heights from its centre.
        Zoom "camera zoom" (factor: f32 [range(0.001, 1000.0)], at: [f32; 2] [AT]), Linked;
        /// Looks around from where the camera stands, in degrees.
        Look "camera look" (right: f32 [DEGREES], up: f32 [DEGREES]), Linked;
        /// Moves the camera, in sizes of the scene.
        Move "camera move" (step: [f32; 3] [STEPS]), Linked;
        /// Flies instead of orbiting.
        Fly "camera fly" (switch: Switch), Linked;
        /// Looks through the render camera.
        Through "camera through" (switch: Switch), Linked;
        /// Makes a point the pivot, in scene units, without moving farther away from it.
        Focus "camera focus" (point: [f32; 3] [POINT], distance: f32 [range(0.01, 1e6)]), Linked;
        /// Shows the whole scene.
        Frame "camera frame", Linked;
        /// Places the camera, in scene units and degrees.
        Place "camera place" (viewpoint: Viewpoint), Linked;
        /// Shows the whole scene from one side.
        View "camera view" (side: Side), Linked;
    }
}
