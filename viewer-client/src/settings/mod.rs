//! What the user has chosen; panels read it, [`crate::command::Command`]s change it.

mod filter;
mod layout;
pub mod region;

pub use filter::{FilterSettings, FilterSource, KeptFilter};
pub use layout::Layout;

use glam::{Vec3, Vec4};

pub use crate::command::{CloudSettings, ImageSettings, SceneSettings, WindowSettings};

use crate::command::{Command, ImageCommand, Setting};

use crate::value::{Bounds, Exposure, Layer, Settable, Shading, Theme};

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
    /// How the window looks, and what it listens to.
    pub window: WindowSettings,
    /// Where the panels of the window are.
    pub layout: Layout,
}

impl Settings {
    /// Follows a command as far as it sets something.
    pub fn apply(&mut self, command: &Command) {
        match command {
            Command::Cloud(command) => self.cloud.set(command),
            Command::Scene(command) => self.scene.set(command),
            Command::Image(command) => self.image.apply(command),
            Command::Window(command) => self.window.set(command),
            Command::Filter(command) => self.filter.apply(command),
            Command::Layout(command) => self.layout.apply(*command),
            Command::Camera(_)
            | Command::Path(_)
            | Command::Play(_)
            | Command::Desktop(_)
            | Command::Order(_)
            | Command::Scrub(_)
            | Command::Session(_) => {}
        }
    }

    /// The commands that lead from the defaults to these settings, but for the filter and the
    /// arrangement of the panels.
    pub fn commands(&self) -> Vec<Command> {
        let Self { cloud, scene, image, window, .. } = self;
        [cloud.commands(), scene.commands(), image.commands(), window.commands()].concat()
    }
}

/// The settings of one table.
pub trait Group: Sized {
    /// Those among all of them.
    fn of(settings: &Settings) -> &Self;
}

macro_rules! groups {
    ($($field:ident: $group:ident),+) => {$(
        impl Group for $group {
            fn of(settings: &Settings) -> &Self {
                &settings.$field
            }
        }
    )+};
}

groups!(cloud: CloudSettings, scene: SceneSettings, image: ImageSettings, window: WindowSettings);

impl<G: Group, T: Settable> Setting<G, T> {
    /// What it is set to.
    pub fn value(&self, settings: &Settings) -> T {
        (self.get)(G::of(settings)).clone()
    }
}

impl SceneSettings {
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

impl WindowSettings {
    /// True for light on dark.
    pub fn is_dark(&self) -> bool {
        self.theme == Theme::Dark
    }
}

impl ImageSettings {
    /// Suits the brightness to an image of mean luminance `mean`, in half stops, unless the user
    /// has chosen another.
    pub fn suit(&mut self, mean: f64) {
        const SHOWN_MEAN: f64 = 0.25;
        let stops = ((SHOWN_MEAN / mean).log2() * 2.0).round() / 2.0;
        if !self.exposure.is_chosen() && stops.is_finite() {
            self.exposure = Exposure::Auto(stops.clamp(-20.0, 20.0) as f32);
        }
    }

    /// Follows a command; those about files and other programs concern the viewer alone.
    pub fn apply(&mut self, command: &ImageCommand) {
        self.set(command);
        match command {
            ImageCommand::Auto => self.exposure = Exposure::Auto(self.exposure.stops()),
            ImageCommand::Fit => (self.zoom, self.centre) = (None, [0.5; 2]),
            ImageCommand::Forget if self.layer.compares() => self.layer = Layer::Image,
            _ => {}
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
        assert_eq!(image.exposure.stops(), -4.0, "sixteen times too bright");
        image.apply(&ImageCommand::Exposure(1.0));
        image.suit(4.0);
        assert_eq!(image.exposure.stops(), 1.0, "the user's choice stays");
        image.apply(&ImageCommand::Auto);
        image.suit(0.0);
        assert_eq!(image.exposure.stops(), 1.0, "a black image tells nothing");
        image.suit(0.25);
        assert_eq!(image.exposure.stops(), 0.0, "and follows again when asked to");
    }
}
