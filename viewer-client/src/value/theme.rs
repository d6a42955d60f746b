//! Colours, spacing and type of the interface.

use common::SelectorKind;
use egui::{Color32, CornerRadius, FontId, Margin, Stroke, TextStyle, Theme, Visuals, vec2};
use glam::Vec3;
use shaders::{PALETTE_SIZE, RAMP_SIZE};

/// The colour of things that can be acted upon.
pub const ACCENT: Color32 = Color32::from_rgb(92, 156, 255);
/// All is well.
pub const GOOD: Color32 = Color32::from_rgb(88, 196, 120);
/// Something is under way.
pub const BUSY: Color32 = Color32::from_rgb(238, 178, 72);
/// Something is wrong.
pub const BAD: Color32 = Color32::from_rgb(236, 96, 88);

/// [`GOOD`] as a text.
pub fn good(dark: bool) -> Color32 {
    if dark { GOOD } else { Color32::from_rgb(20, 112, 52) }
}

/// [`BUSY`] as a text.
pub fn busy(dark: bool) -> Color32 {
    if dark { BUSY } else { Color32::from_rgb(138, 84, 0) }
}

/// [`BAD`] as a text.
pub fn bad(dark: bool) -> Color32 {
    if dark { BAD } else { Color32::from_rgb(176, 32, 28) }
}

/// [`ACCENT`] as a text.
pub fn accent(dark: bool) -> Color32 {
    if dark { ACCENT } else { Color32::from_rgb(24, 88, 190) }
}

/// A kind of selectors: green where paths start, red where they end, yellow for any, white for all.
pub fn selector_color(kind: SelectorKind) -> Color32 {
    match kind {
        SelectorKind::Start => Color32::from_rgb(96, 220, 120),
        SelectorKind::End => Color32::from_rgb(255, 104, 96),
        SelectorKind::Any => Color32::from_rgb(255, 214, 80),
        SelectorKind::All => Color32::from_rgb(236, 240, 245),
    }
}

/// The axes' colours, as everywhere: x red, y green, z blue.
pub fn axis_color(axis: Vec3) -> Color32 {
    match axis.max_element() {
        m if m == axis.x => Color32::from_rgb(236, 92, 86),
        m if m == axis.y => Color32::from_rgb(124, 190, 84),
        _ => Color32::from_rgb(82, 142, 240),
    }
}

/// What stays of the explorer's path.
pub const EXPLORED: Color32 = Color32::from_rgb(120, 200, 255);
/// What a proposal replaces.
pub const DELETED: Color32 = Color32::from_rgb(240, 140, 60);
/// What a proposal brings.
pub const PROPOSED: Color32 = Color32::from_rgb(120, 240, 150);
/// The selected path.
pub const SELECTED: Color32 = Color32::from_rgb(255, 120, 220);
/// The end of a path at the light; as in the shader.
pub const LIGHT_END: Color32 = Color32::from_rgb(255, 204, 117);
/// The end of a path at the camera; as in the shader.
pub const CAMERA_END: Color32 = Color32::from_rgb(129, 194, 255);

/// Colours that stay apart for most kinds of colour vision, on dark and on light ground.
const STRATEGIES: [[u8; 3]; 8] = [
    [86, 180, 233],
    [230, 159, 0],
    [0, 178, 128],
    [240, 112, 80],
    [204, 121, 190],
    [213, 200, 66],
    [122, 130, 240],
    [160, 160, 160],
];

/// The colour of a strategy, a chain or a class in tables and in the cloud. Beyond the first eight the
/// hues come again, greyer: what comes later is rarer, as a rule.
pub fn strategy_color(index: usize) -> Color32 {
    let index = index.min(PALETTE_SIZE - 1);
    let [r, g, b] = STRATEGIES[index % STRATEGIES.len()];
    let color = Color32::from_rgb(r, g, b);
    if index < STRATEGIES.len() {
        color
    } else {
        color.lerp_to_gamma(Color32::from_gray(100), 0.55)
    }
}

/// Reasons of failure: muted, so that they are not taken for strategies, and apart in lightness.
const REASONS: [[u8; 3]; 8] = [
    [112, 112, 120],
    [136, 204, 238],
    [68, 130, 120],
    [98, 92, 160],
    [204, 102, 119],
    [186, 160, 214],
    [150, 110, 60],
    [240, 240, 240],
];

/// The colour of a reason why proposals fail.
pub fn reason_color(index: usize) -> Color32 {
    let [r, g, b] = REASONS[index % REASONS.len()];
    Color32::from_rgb(r, g, b)
}

/// From low to high on dark ground: blue to yellow, ever lighter, so that it also reads in grey and
/// with any kind of colour vision.
const RAMP_ON_DARK: [[u8; 3]; RAMP_SIZE] = [
    [84, 92, 190],
    [64, 126, 196],
    [52, 156, 182],
    [58, 182, 150],
    [104, 204, 112],
    [168, 220, 80],
    [222, 228, 72],
    [255, 238, 130],
];
/// The same on light ground, where the lightest must still be seen.
const RAMP_ON_LIGHT: [[u8; 3]; RAMP_SIZE] = [
    [68, 1, 84],
    [70, 50, 126],
    [54, 92, 141],
    [39, 127, 142],
    [31, 150, 120],
    [74, 170, 80],
    [140, 172, 40],
    [190, 160, 0],
];

/// The colours from low to high.
pub fn ramp(dark: bool) -> [Color32; RAMP_SIZE] {
    let ramp = if dark { RAMP_ON_DARK } else { RAMP_ON_LIGHT };
    ramp.map(|[r, g, b]| Color32::from_rgb(r, g, b))
}

/// Sets up both themes.
pub fn install(ctx: &egui::Context) {
    ctx.set_visuals_of(Theme::Dark, dark());
    ctx.set_visuals_of(Theme::Light, light());
    // The size of the interface is a setting like others, with keys of its own.
    ctx.options_mut(|options| options.zoom_with_keyboard = false);
    ctx.all_styles_mut(|style| {
        let spacing = &mut style.spacing;
        spacing.item_spacing = vec2(8.0, 5.0);
        spacing.button_padding = vec2(8.0, 3.0);
        spacing.interact_size.y = 22.0;
        // The bar has room of its own: over the panels it would hide the ends of their rows.
        spacing.scroll.floating_allocated_width = 8.0;
        spacing.slider_rail_height = 5.0;
        spacing.menu_margin = Margin::same(6);
        spacing.window_margin = Margin::same(14);
        style.interaction.tooltip_delay = 0.35;
        let proportional = [
            (TextStyle::Heading, 15.0),
            (TextStyle::Body, 13.0),
            (TextStyle::Button, 13.0),
            (TextStyle::Small, 11.0),
        ];
        for (text_style, size) in proportional {
            style.text_styles.insert(text_style, FontId::proportional(size));
        }
        style.text_styles.insert(TextStyle::Monospace, FontId::monospace(12.0));
    });
}

fn dark() -> Visuals {
    let mut visuals = Visuals::dark();
    visuals.panel_fill = Color32::from_rgb(27, 29, 33);
    visuals.window_fill = Color32::from_rgb(32, 34, 39);
    visuals.extreme_bg_color = Color32::from_rgb(17, 18, 21);
    visuals.faint_bg_color = Color32::from_rgb(33, 35, 40);
    let line = Color32::from_rgb(48, 51, 58);
    let text = Color32::from_rgb(203, 207, 214);
    visuals.widgets.inactive.bg_fill = Color32::from_rgb(52, 55, 62);
    visuals.widgets.inactive.weak_bg_fill = Color32::from_rgb(44, 47, 53);
    visuals.widgets.hovered.weak_bg_fill = Color32::from_rgb(57, 61, 69);
    finish(visuals, line, text)
}

fn light() -> Visuals {
    let mut visuals = Visuals::light();
    visuals.panel_fill = Color32::from_rgb(242, 243, 245);
    visuals.window_fill = Color32::from_rgb(250, 250, 251);
    visuals.extreme_bg_color = Color32::from_rgb(255, 255, 255);
    visuals.faint_bg_color = Color32::from_rgb(234, 236, 239);
    let line = Color32::from_rgb(212, 215, 220);
    let text = Color32::from_rgb(52, 56, 63);
    visuals.widgets.inactive.bg_fill = Color32::from_rgb(208, 212, 218);
    visuals.widgets.inactive.weak_bg_fill = Color32::from_rgb(226, 229, 233);
    finish(visuals, line, text)
}

fn finish(mut visuals: Visuals, line: Color32, text: Color32) -> Visuals {
    visuals.widgets.noninteractive.bg_stroke = Stroke::new(1.0, line);
    visuals.widgets.noninteractive.fg_stroke = Stroke::new(1.0, text);
    visuals.widgets.inactive.fg_stroke = Stroke::new(1.0, text);
    visuals.window_stroke = Stroke::new(1.0, line);
    visuals.selection.bg_fill = ACCENT.gamma_multiply(if visuals.dark_mode { 0.55 } else { 0.45 });
    visuals.selection.stroke =
        Stroke::new(1.0, if visuals.dark_mode { Color32::WHITE } else { Color32::BLACK });
    visuals.slider_trailing_fill = true;
    visuals.hyperlink_color = ACCENT;
    visuals.window_corner_radius = CornerRadius::same(8);
    visuals.menu_corner_radius = CornerRadius::same(6);
    visuals
}
