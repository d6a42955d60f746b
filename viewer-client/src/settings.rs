//! What the user has chosen; panels read it, [`crate::command::Command`]s change it.

use common::Filter;
use glam::{Vec3, Vec4};

use crate::camera::Bounds;
use crate::command::{
    Channel, ClipSide, CloudCommand, ColorMode, ColorScale, FilterCommand, ImageCommand, Layer,
    LayoutCommand, MOST_KEPT, MOST_SELECTORS, Marks, Move, PanelName, SceneCommand, Shading,
    Sphere, ThemeName, ToneCurve, WindowSide,
};
use crate::keys::{KeyPreset, MousePreset};

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
            budget_mib: 128,
            color: ColorMode::Radiance,
            ends: true,
            dots: 0.0,
            marks: Marks::Lines,
            scale: ColorScale::Log,
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
            CloudCommand::Budget(mebibytes) => self.budget_mib = mebibytes,
            CloudCommand::Color(mode) => self.color = mode,
            CloudCommand::Ends(switch) => switch.apply(&mut self.ends),
            CloudCommand::Dots(pixels) => self.dots = pixels,
            CloudCommand::Marks(marks) => self.marks = marks,
            CloudCommand::Scale(scale) => self.scale = scale,
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
            SceneCommand::Clip(side) => self.clip = side,
            SceneCommand::Cut(place) => self.cut = place,
        }
    }

    /// True when surfaces cover what lies behind them.
    pub fn covers(&self) -> bool {
        matches!(self.shading, Shading::Shaded | Shading::Edges) && self.opacity > 0.5
    }

    /// True when surfaces hide what lies behind them.
    pub fn hides(&self) -> bool {
        matches!(self.shading, Shading::Shaded | Shading::Edges) && self.opacity > 0.5
    }

    /// The plane whose positive side is drawn, in a scene of these bounds.
    pub fn clip_plane(&self, bounds: Bounds) -> Vec4 {
        let Some(normal) = self.clip.normal().map(Vec3::from) else { return Vec4::W };
        let place = bounds.min.lerp(bounds.max, self.cut);
        normal.extend(-normal.dot(place))
    }
}

/// Which paths are shown.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FilterSettings {
    /// The text that the user wrote; blank for all paths.
    pub text: String,
    /// Spheres that paths are selected by, too.
    pub selectors: Vec<Sphere>,
    /// The selector whose handles are shown.
    pub chosen: Option<usize>,
    /// All paths are wanted in spite of the above.
    pub off: bool,
    /// What text and selectors leave out is wanted instead.
    pub inverted: bool,
    /// Filters that have names; each of those that are on must hold, too.
    pub kept: Vec<KeptFilter>,
}

/// A filter that has a name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct KeptFilter {
    /// Its name.
    pub name: String,
    /// Its text.
    pub text: String,
    /// It holds.
    pub on: bool,
    /// Its opposite does.
    pub inverted: bool,
}

impl FilterSettings {
    /// Follows a command.
    pub fn apply(&mut self, command: &FilterCommand) {
        match command {
            FilterCommand::Set(text) if text == "true" => self.text.clear(),
            FilterCommand::Set(text) => self.text.clone_from(text),
            FilterCommand::Clear => {
                let mut kept = std::mem::take(&mut self.kept);
                for filter in &mut kept {
                    filter.on = false;
                }
                *self = Self { kept, ..Self::default() };
            }
            FilterCommand::Enable(switch) => {
                let mut on = !self.off;
                switch.apply(&mut on);
                self.off = !on;
            }
            FilterCommand::Invert(switch) => switch.apply(&mut self.inverted),
            FilterCommand::Add(sphere) => {
                if self.selectors.len() < MOST_SELECTORS as usize {
                    self.selectors.push(*sphere);
                    self.chosen = Some(self.selectors.len() - 1);
                }
            }
            FilterCommand::Move(number, place) => {
                if let Some(sphere) = self.selectors.get_mut(*number as usize) {
                    sphere.place = *place;
                }
            }
            FilterCommand::Choose(number) => {
                let number = *number as usize;
                self.chosen = (number < self.selectors.len()).then_some(number);
            }
            FilterCommand::Delete(number) => {
                if (*number as usize) < self.selectors.len() {
                    self.selectors.remove(*number as usize);
                    self.chosen = None;
                }
            }
            FilterCommand::DeleteAll => {
                self.selectors.clear();
                self.chosen = None;
            }
            FilterCommand::Keep(name) => self.keep(name),
            FilterCommand::Use(name, switch) => {
                self.named(name).into_iter().for_each(|kept| switch.apply(&mut kept.on));
            }
            FilterCommand::Reverse(name, switch) => {
                self.named(name).into_iter().for_each(|kept| switch.apply(&mut kept.inverted));
            }
            FilterCommand::Load(name) => {
                if let Some(kept) = self.named(name) {
                    // It would hold twice.
                    kept.on = false;
                    let KeptFilter { text, inverted, .. } = kept.clone();
                    let kept = std::mem::take(&mut self.kept);
                    *self = Self { text, inverted, kept, ..Self::default() };
                }
            }
            FilterCommand::Forget(name) => self.kept.retain(|kept| kept.name != *name),
        }
    }

    /// The kept filter of this name.
    fn named(&mut self, name: &str) -> Option<&mut KeptFilter> {
        self.kept.iter_mut().find(|kept| kept.name == name)
    }

    /// Keeps text and selectors under a name, in the place of what had it before.
    fn keep(&mut self, name: &str) {
        let text = self.own().to_string();
        let (inverted, has_room) = (self.inverted, self.kept.len() < MOST_KEPT);
        let kept = KeptFilter { name: name.to_owned(), text, on: false, inverted };
        match self.named(name) {
            Some(known) => *known = kept,
            None if has_room => self.kept.push(kept),
            None => {}
        }
    }

    /// Text and selectors together.
    fn own(&self) -> Filter {
        let selectors: Vec<_> = self.selectors.iter().map(|sphere| sphere.selector()).collect();
        let text = Filter::parse(&self.text).unwrap_or_default();
        all_of(vec![Filter::from_selectors(&selectors), text])
    }

    /// The text of everything together, as the daemon gets it; blank for all paths.
    pub fn wanted(&self) -> String {
        if self.off {
            return String::new();
        }
        let kept = self.kept.iter().filter(|kept| kept.on).map(|kept| {
            let filter = Filter::parse(&kept.text).unwrap_or_default();
            opposite_if(kept.inverted, filter)
        });
        let parts = std::iter::once(opposite_if(self.inverted, self.own())).chain(kept).collect();
        match all_of(parts) {
            Filter::Constant(true) => String::new(),
            all => all.to_string(),
        }
    }
}

/// What all parts want together.
fn all_of(mut parts: Vec<Filter>) -> Filter {
    parts.retain(|part| *part != Filter::Constant(true));
    if parts.len() > 1 { Filter::And(parts) } else { parts.pop().unwrap_or_default() }
}

/// The filter or, where `inverted` and it leaves out something, its opposite.
fn opposite_if(inverted: bool, filter: Filter) -> Filter {
    if inverted && filter != Filter::Constant(true) {
        Filter::Not(Box::new(filter))
    } else {
        filter
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

/// What the window holds.
#[expect(clippy::struct_excessive_bools, reason = "switches of one window")]
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Layout {
    /// Which panels are open, in the order of [`PanelName::ALL`].
    pub open: [bool; PanelName::ALL.len()],
    /// Which of them are nothing but their heading.
    pub folded: [bool; PanelName::ALL.len()],
    /// All panels from the top of the left side on; where the left side ends, see [`Self::left`].
    pub order: [PanelName; PanelName::ALL.len()],
    /// Which of them are on the left side.
    pub left: [bool; PanelName::ALL.len()],
    /// Widths of the left and of the right side in points, within [`WIDTHS`].
    pub widths: [u16; 2],
    /// What dragging with the mouse does to the camera.
    pub mouse: MousePreset,
    /// Light on dark.
    pub dark: bool,
    /// The sheet of keys is open.
    pub help: bool,
    /// Which keys there are.
    pub keys: KeyPreset,
    /// Others see where this viewer looks, and its filter.
    pub seen: bool,
    /// The palette of commands is open.
    pub palette: bool,
    /// The first steps are shown.
    pub hint: bool,
    /// Size of texts and buttons in percent, within [`SCALES`].
    pub scale: u16,
}

/// Sizes of the interface in percent.
pub const SCALES: std::ops::RangeInclusive<u16> = 50..=300;
/// Widths of a side in points.
pub const WIDTHS: std::ops::RangeInclusive<u16> = 200..=900;
/// Usual widths of the sides.
const USUAL_WIDTHS: [u16; 2] = [260, 352];

impl Default for Layout {
    fn default() -> Self {
        let open = [true; PanelName::ALL.len()];
        Self {
            open,
            folded: [false; PanelName::ALL.len()],
            order: PanelName::ALL,
            left: PanelName::ALL.map(PanelName::is_usually_left),
            widths: USUAL_WIDTHS,
            mouse: MousePreset::Rerun,
            dark: true,
            help: false,
            keys: KeyPreset::Today,
            seen: false,
            palette: false,
            hint: false,
            scale: 100,
        }
    }
}

impl Layout {
    /// True when the panel is open.
    pub fn is_open(&self, panel: PanelName) -> bool {
        self.open[panel as usize]
    }

    /// True when nothing of the panel is shown but its heading.
    pub fn is_folded(&self, panel: PanelName) -> bool {
        self.folded[panel as usize]
    }

    /// True when the panel belongs to the left side.
    pub fn is_left(&self, panel: PanelName) -> bool {
        self.left[panel as usize]
    }

    /// The panels of a side from the top on, open or not.
    pub fn side(&self, side: WindowSide) -> impl Iterator<Item = PanelName> + '_ {
        let left = side == WindowSide::Left;
        self.order.into_iter().filter(move |name| self.is_left(*name) == left)
    }

    /// The width of a side in points.
    pub fn width(&self, side: WindowSide) -> u16 {
        self.widths[side as usize]
    }

    /// Puts a panel elsewhere.
    fn arrange(&mut self, name: PanelName, place: Move) {
        let side = if self.is_left(name) { WindowSide::Left } else { WindowSide::Right };
        let near: Vec<PanelName> = self.side(side).filter(|near| self.is_open(*near)).collect();
        let at = near.iter().position(|near| *near == name);
        let neighbour = |step: isize| near.get(at?.checked_add_signed(step)?).copied();
        let before = match place {
            Move::Left | Move::Right => {
                self.left[name as usize] = place == Move::Left;
                None
            }
            Move::Before(other) => {
                self.left[name as usize] = self.is_left(other);
                Some(other)
            }
            Move::Up => match neighbour(-1) {
                Some(above) => Some(above),
                None => return,
            },
            Move::Down if neighbour(1).is_none() => return,
            Move::Down => neighbour(2),
        };
        if before == Some(name) {
            return;
        }
        let mut order: Vec<PanelName> = self.order.into_iter().filter(|n| *n != name).collect();
        let index = before.and_then(|before| order.iter().position(|n| *n == before));
        order.insert(index.unwrap_or(order.len()), name);
        if let Ok(order) = order.try_into() {
            self.order = order;
        }
    }

    /// Follows a command.
    pub fn apply(&mut self, command: LayoutCommand) {
        match command {
            LayoutCommand::Fold(name, switch) => switch.apply(&mut self.folded[name as usize]),
            LayoutCommand::Arrange(name, place) => self.arrange(name, place),
            LayoutCommand::Width(side, points) => self.widths[side as usize] = points,
            LayoutCommand::Usual => {
                let Self { order, left, widths, folded, .. } = Self::default();
                (self.order, self.left) = (order, left);
                (self.widths, self.folded) = (widths, folded);
            }
            LayoutCommand::Mouse(preset) => self.mouse = preset,
            LayoutCommand::Panel(name, switch) => switch.apply(&mut self.open[name as usize]),
            LayoutCommand::Theme(ThemeName::Dark) => self.dark = true,
            LayoutCommand::Theme(ThemeName::Light) => self.dark = false,
            LayoutCommand::Theme(ThemeName::Toggle) => self.dark = !self.dark,
            LayoutCommand::Help(switch) => switch.apply(&mut self.help),
            LayoutCommand::Keys(preset) => self.keys = preset,
            LayoutCommand::Seen(switch) => switch.apply(&mut self.seen),
            LayoutCommand::Palette(switch) => switch.apply(&mut self.palette),
            LayoutCommand::Hint(switch) => switch.apply(&mut self.hint),
            LayoutCommand::Scale(percent) => self.scale = percent,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn panels_are_put_elsewhere_and_back() {
        let mut layout = Layout::default();
        let side = |layout: &Layout, side| layout.side(side).collect::<Vec<_>>();
        use PanelName::{Cloud, Filter, Image, Path, Scene, Statistics};
        use WindowSide::{Left, Right};
        let usual = layout.clone();
        let mut run = |command: &str| {
            let command = command.parse().expect(command);
            if let crate::command::Command::Layout(command) = command {
                layout.apply(command);
            }
            layout.clone()
        };
        assert_eq!(side(&run("arrange scene up"), Left), [Cloud, Scene, Filter], "up");
        assert_eq!(run("arrange cloud up"), run("arrange cloud up"), "it is the first");
        assert_eq!(side(&run("arrange cloud down"), Left), [Scene, Cloud, Filter], "down");
        assert_eq!(run("arrange filter down").order, run("arrange filter down").order, "the last");
        let moved = run("arrange statistics before cloud");
        assert_eq!(side(&moved, Left), [Scene, Statistics, Cloud, Filter], "to the other side");
        assert_eq!(side(&moved, Right)[..2], [Image, Path], "the others stay");
        // What is closed is passed over.
        run("panel statistics off");
        assert_eq!(side(&run("arrange scene down"), Left)[..3], [Statistics, Cloud, Scene], "down");
        run("panel statistics on");
        run("width right 500");
        assert!(run("fold image on").is_folded(Image), "folded");
        assert_eq!(run("usual"), usual, "as it was");
    }

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
