//! Room for what is written over the view, and the ground that it is written on.

use egui::{Color32, Painter, Rect, vec2};

/// Distance of texts from the edge in points.
pub(super) const MARGIN: f32 = 14.0;
/// Radius of the disc that the axes lie on, in points.
pub(super) const DISC: f32 = 33.0;
/// Height above the lower edge, in points, from which on nothing of the axes is in the way.
pub(super) const AXES: f32 = MARGIN + 26.0 + DISC + 8.0;

/// Dims what lies behind light texts, and brightens it behind dark ones.
pub(super) fn veil(painter: &Painter, rect: Rect, ink: Color32) {
    let light_ink = ink.intensity() > 0.4;
    let shade =
        if light_ink { Color32::from_black_alpha(130) } else { Color32::from_white_alpha(150) };
    painter.rect_filled(rect.expand2(vec2(7.0, 3.0)), 5.0, shade);
}
