//! What the user has chosen; panels read it, [`crate::command::Command`]s change it.

mod filter;
mod layout;
pub mod region;

pub use filter::{FilterSettings, FilterSource, KeptFilter};
pub use layout::{Layout, SCALES, WIDTHS};

use glam::{Vec3, Vec4};

use crate::command::{
    Blend, Channel, ClipSide, CloudCommand, ColorMode, ColorScale, Handles, ImageCommand, Layer,
    Light, Lighting, Marks, SceneCommand, Shading, ToneCurve,
};
use crate::value::Bounds;

/// Every choice.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Settings {
    /// How paths are drawn.
    pub cloud: CloudSettings,
    /// How the scene is drawn.
    pub scene: SceneSettings,
    /// Which paths are shown.
    pub filter: FilterSettings,
    /// How the progressive image is shown.
    pub image: ImageSettings,
    /// What the window holds.
    pub layout: Layout,
}

/// How paths are drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct CloudSettings {
    /// No new paths are taken.
    pub frozen: bool,
    /// Width of the lines in pixels.
    pub width: f32,
    /// Opacity of the newest, brightest path.
    pub opacity: f32,
    /// Relative opacity behind surfaces.
    pub hidden: f32,
    /// Newer paths after which a path has faded to 1/e.
    pub fade: f32,
    /// How many of the newest paths are drawn.
    pub shown: u32,
    /// How many paths may wait to be taken in.
    pub limit: u32,
    /// How many must wait before any is taken in.
    pub threshold: u32,
    /// Memory for paths in MiB, graphics memory included.
    pub budget_mib: u32,
    /// What the colour says.
    pub color: ColorMode,
    /// The light end and the camera end are tinted.
    pub ends: bool,
    /// Radius of the dots at inner vertices in pixels.
    pub dots: f32,
    /// What is drawn of a path.
    pub marks: Marks,
    /// How values become places on the ramp of colours.
    pub scale: ColorScale,
    /// What becomes of paths that cross.
    pub blend: Blend,
    /// How much distance dims paths, from 0 to 1.
    pub cue: f32,
    /// Relative opacity of paths that the filter leaves out; 0 hides them.
    pub dim: f32,
}

impl Default for CloudSettings {
    fn default() -> Self {
        Self {
            frozen: false,
            width: 1.5,
            opacity: 0.55,
            hidden: 0.08,
            fade: 500.0,
            shown: 2500,
            limit: 100_000,
            threshold: 0,
            budget_mib: 128,
            color: ColorMode::Radiance,
            ends: true,
            dots: 0.0,
            marks: Marks::Lines,
            scale: ColorScale::Log,
            blend: Blend::Newest,
            cue: 0.0,
            dim: 0.1,
        }
    }
}

impl CloudSettings {
    /// Follows a command; [`CloudCommand::Clear`] concerns the store alone.
    pub fn apply(&mut self, command: CloudCommand) {
        match command {
            CloudCommand::Freeze(switch) => switch.apply(&mut self.frozen),
            CloudCommand::Clear => {}
            CloudCommand::Width(pixels) => self.width = pixels,
            CloudCommand::Opacity(x) => self.opacity = x,
            CloudCommand::Hidden(x) => self.hidden = x,
            CloudCommand::Fade(paths) => self.fade = paths,
            CloudCommand::Shown(paths) => self.shown = paths,
            CloudCommand::Limit(paths) => self.limit = paths,
            CloudCommand::Threshold(paths) => self.threshold = paths,
            CloudCommand::Budget(mebibytes) => self.budget_mib = mebibytes,
            CloudCommand::Color(mode) => self.color = mode,
            CloudCommand::Ends(switch) => switch.apply(&mut self.ends),
            CloudCommand::Dots(pixels) => self.dots = pixels,
            CloudCommand::Marks(marks) => self.marks = marks,
            CloudCommand::Scale(scale) => self.scale = scale,
            CloudCommand::Blend(blend) => self.blend = blend,
            CloudCommand::Cue(x) => self.cue = x,
            CloudCommand::Dim(x) => self.dim = x,
        }
    }
}

/// How surfaces and drawing aids look.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneSettings {
    /// How surfaces are drawn.
    pub shading: Shading,
    /// Opacity of all surfaces.
    pub opacity: f32,
    /// Surfaces that face away are almost invisible.
    pub cutaway: bool,
    /// Lines that belong to no path.
    pub aids: DrawingAids,
    /// The light that surfaces are seen by.
    pub light: Light,
    /// How surfaces answer it.
    pub lighting: Lighting,
    /// What the handles of selectors do.
    pub handles: Handles,
    /// What a plane cuts away.
    pub clip: ClipSide,
    /// Where the plane lies, from 0 to 1 across the scene.
    pub cut: f32,
}

/// Lines that belong to no path.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DrawingAids {
    /// The model of the render camera.
    pub camera: bool,
    /// The grid on the ground.
    pub grid: bool,
}

impl Default for SceneSettings {
    fn default() -> Self {
        let aids = DrawingAids { camera: true, grid: true };
        Self {
            shading: Shading::Shaded,
            opacity: 1.0,
            cutaway: true,
            aids,
            light: Light::Camera,
            lighting: Lighting::Soft,
            handles: Handles::Move,
            clip: ClipSide::Off,
            cut: 0.5,
        }
    }
}

impl SceneSettings {
    /// Follows a command.
    pub fn apply(&mut self, command: SceneCommand) {
        match command {
            SceneCommand::Shading(shading) => self.shading = shading,
            SceneCommand::Opacity(x) => self.opacity = x,
            SceneCommand::Cutaway(switch) => switch.apply(&mut self.cutaway),
            SceneCommand::Camera(switch) => switch.apply(&mut self.aids.camera),
            SceneCommand::Grid(switch) => switch.apply(&mut self.aids.grid),
            SceneCommand::Light(light) => self.light = light,
            SceneCommand::Lighting(lighting) => self.lighting = lighting,
            SceneCommand::Handles(handles) => self.handles = handles,
            SceneCommand::Clip(side) => self.clip = side,
            SceneCommand::Cut(place) => self.cut = place,
        }
    }

    /// True when surfaces cover what lies behind them.
    pub fn covers(&self) -> bool {
        !matches!(self.shading, Shading::Wireframe | Shading::Off) && self.opacity > 0.5
    }

    /// The plane whose positive side is drawn, in a scene of these bounds.
    pub fn clip_plane(&self, bounds: Bounds) -> Vec4 {
        let Some(normal) = self.clip.normal().map(Vec3::from) else { return Vec4::W };
        let place = bounds.min.lerp(bounds.max, self.cut);
        normal.extend(-normal.dot(place))
    }
}

/// How the progressive image is shown.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImageSettings {
    /// Brightness in stops.
    pub exposure: f32,
    /// The user has chosen the brightness; otherwise it follows the scene.
    pub chosen: bool,
    /// Screen points a film pixel, or as large as fits.
    pub zoom: Option<f32>,
    /// Film point in the middle of the panel while it is zoomed.
    pub centre: [f32; 2],
    /// What is shown.
    pub layer: Layer,
    /// Which part of the light is shown.
    pub channel: Channel,
    /// How light becomes colour.
    pub tone: ToneCurve,
    /// The exponent of [`ToneCurve::Gamma`].
    pub gamma: f32,
}

impl Default for ImageSettings {
    fn default() -> Self {
        Self {
            exposure: 0.0,
            chosen: false,
            zoom: None,
            centre: [0.5; 2],
            layer: Layer::Image,
            channel: Channel::Rgb,
            tone: ToneCurve::Srgb,
            gamma: 2.2,
        }
    }
}

impl ImageSettings {
    /// Suits the brightness to an image of mean luminance `mean`, in half stops, unless the user
    /// has chosen another.
    pub fn suit(&mut self, mean: f64) {
        const SHOWN_MEAN: f64 = 0.25;
        let stops = ((SHOWN_MEAN / mean).log2() * 2.0).round() / 2.0;
        if !self.chosen && stops.is_finite() {
            self.exposure = stops.clamp(-20.0, 20.0) as f32;
        }
    }

    /// Follows a command; those about files and other programs concern the viewer alone.
    pub fn apply(&mut self, command: &ImageCommand) {
        match *command {
            ImageCommand::Exposure(stops) => (self.exposure, self.chosen) = (stops, true),
            ImageCommand::Auto => self.chosen = false,
            ImageCommand::Zoom(factor) => self.zoom = Some(factor),
            ImageCommand::Look(centre) => self.centre = centre,
            ImageCommand::Fit => (self.zoom, self.centre) = (None, [0.5; 2]),
            ImageCommand::Show(layer) => self.layer = layer,
            ImageCommand::Channel(channel) => self.channel = channel,
            ImageCommand::Tone(tone) => self.tone = tone,
            ImageCommand::Gamma(gamma) => self.gamma = gamma,
            ImageCommand::Forget if self.layer.compares() => self.layer = Layer::Image,
            ImageCommand::Reference(_)
            | ImageCommand::Forget
            | ImageCommand::Save(_)
            | ImageCommand::Tev(_) => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn brightness_follows_the_scene_until_it_is_chosen() {
        let mut image = ImageSettings::default();
        image.suit(4.0);
        assert_eq!(image.exposure, -4.0, "sixteen times too bright");
        image.apply(&ImageCommand::Exposure(1.0));
        image.suit(4.0);
        assert_eq!(image.exposure, 1.0, "the user's choice stays");
        image.apply(&ImageCommand::Auto);
        image.suit(0.0);
        assert_eq!(image.exposure, 1.0, "a black image tells nothing");
        image.suit(0.25);
        assert_eq!(image.exposure, 0.0, "and follows again when asked to");
    }
}
