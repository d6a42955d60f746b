//! `scene ...`: how surfaces and drawing aids look.

use super::table::table;
use crate::value::{ClipSide, Handles, Light, Lighting, Range, Shading, range};

const SHARE: Range<f32> = range(0.0, 1.0).decimals(2);

table! {
    /// What may be done to the look of the scene.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub enum SceneCommand in Scene;

    /// How surfaces and drawing aids look.
    #[derive(Clone, Debug, PartialEq)]
    pub struct SceneSettings {
        /// How surfaces are drawn.
        Shading "scene shading" (shading: Shading)
            sets shading = Shading::Shaded, "Surfaces", Linked;
        /// How surfaces are lit in the preview.
        Lighting "scene lighting" (lighting: Lighting)
            sets lighting = Lighting::Soft, "Lighting", Linked;
        /// Where the light of the preview is, in the units of the scene file; the scene's own
        /// lights are unaffected.
        Light "scene light" (light: Light) sets light = Light::Camera, "Light", Linked;
        /// Opacity of all surfaces; below 1, paths inside and behind them show through.
        Opacity "scene opacity" (x: f32 [SHARE]) sets opacity = 1.0, "Opacity", Linked;
        /// Makes surfaces seen from behind transparent, so that you can look into rooms.
        Cutaway "scene cutaway" (switch: bool) sets cutaway = true, "Cut away backs", Linked;
        /// What a plane across an axis cuts away.
        Clip "scene clip" (side: ClipSide) sets clip = ClipSide::Off, "Clip", Linked;
        /// Where the cutting plane lies across the scene.
        Cut "scene cut" (x: f32 [SHARE]) sets cut = 0.5, "Cut at", Linked;
        /// Shows a wireframe model of the camera that takes the picture.
        Camera "scene camera" (switch: bool) sets camera = true, "Camera model", Linked;
        /// Shows the ground below the scene as a grid.
        Grid "scene grid" (switch: bool) sets grid = true, "Grid", Linked;
        /// What the handles of selectors do.
        Handles "scene handles" (handles: Handles) sets handles = Handles::Move, "Handles", Linked;
    }

    commands {}
}
