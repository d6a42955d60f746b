//! `cloud ...`: which paths are on screen, and how they are drawn.

use super::table::table;
use crate::value::{Blend, ColorMode, ColorScale, Marks, Range, range};

const SHARE: Range<f32> = range(0.0, 1.0).decimals(2);
const MANY: Range<u32> = range(0, 10_000_000).log();

table! {
    /// What may be done to the paths on screen.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub enum CloudCommand in Cloud;

    /// How paths are drawn.
    #[derive(Clone, Debug, PartialEq)]
    pub struct CloudSettings {
        /// Freezes the paths on screen; the chains go on.
        Freeze "cloud freeze" (switch: bool) sets frozen = false, "Freeze";
        /// What the colour of a path means; the legend explains it.
        Color "cloud color" (mode: ColorMode) sets color = ColorMode::Radiance, "Colour", Linked;
        /// Whether equal ratios or equal differences make equal steps of colour.
        Scale "cloud scale" (scale: ColorScale) sets scale = ColorScale::Log, "Scale", Linked;
        /// What is drawn of a path.
        Marks "cloud marks" (marks: Marks) sets marks = Marks::Lines, "Draw", Linked;
        /// How paths that cross on the screen are combined.
        Blend "cloud blend" (blend: Blend) sets blend = Blend::Newest, "Crossing", Linked;
        /// Width of the lines on screen, independent of their distance.
        Width "cloud width" (pixels: f32 [range(0.25, 20.0).log().decimals(2).unit("px")])
            sets width = 1.5, "Width", Linked;
        /// Opacity of the newest, brightest path.
        Opacity "cloud opacity" (x: f32 [SHARE]) sets opacity = 0.55, "Opacity", Linked;
        /// Opacity of the parts that lie behind surfaces.
        Hidden "cloud hidden" (x: f32 [SHARE]) sets hidden = 0.08, "Hidden", Linked;
        /// How much distance dims paths, so that near ones stand out.
        Cue "cloud cue" (x: f32 [SHARE]) sets cue = 0.0, "Depth cue", Linked;
        /// Opacity of the paths that the filter leaves out; 0 hides them.
        Dim "cloud dim" (x: f32 [SHARE]) sets dim = 0.1, "Left out", Linked;
        /// After how many newer paths a path has faded to 1/e.
        Fade "cloud fade" (paths: f32 [range(1.0, 1e7).log()])
            sets fade = 500.0, "Fade after", Linked;
        /// Radius of the dots at inner vertices; 0 for none.
        Dots "cloud dots" (pixels: f32 [range(0.0, 20.0).decimals(1).unit("px")])
            sets dots = 0.0, "Dots", Linked;
        /// Tints the start of each path, on the light, amber and its end, at the camera, blue.
        Ends "cloud ends" (switch: bool) sets ends = true, "Tint start and end", Linked;
        /// How many of the newest paths are drawn at once (draw limit of 2014).
        Shown "cloud shown" (paths: u32 [MANY]) sets shown = 2500, "Drawn", Linked;
        /// Memory for paths, graphics memory included; when it is full, the oldest are dropped.
        Budget "cloud budget" (mib: u32 [range(8, 65_536).log().unit("MiB")])
            sets budget_mib = 128, "Keep";
        /// How many paths must be waiting before all of them are taken in and filtered at once; 0
        /// takes in each one as it arrives (threshold of 2014).
        Threshold "cloud threshold" (paths: u32 [MANY]) sets threshold = 0, "Take in at";
        /// How many paths may wait to be taken in; beyond that the oldest are dropped, and the
        /// status bar counts them (limit of 2014).
        Limit "cloud limit" (paths: u32 [range(10, 10_000_000).log()])
            sets limit = 100_000, "Wait";
    }

    commands {
        /// Removes every path from the view.
        Clear "cloud clear";
    }
}
