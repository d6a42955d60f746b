//! What is written over the view: axes, legend, the render camera's gate, and why it is empty.

use egui::text::LayoutJob;
use egui::{
    Align, Align2, Color32, CornerRadius, FontId, Painter, Pos2, Rect, Stroke, StrokeKind, Ui,
    pos2, vec2,
};
use glam::Vec3;

use super::ground::{DISC, MARGIN, veil};
use super::project::Projector;
use super::{ghost, highlight, legend, light, others, pointed, selectors};
use crate::source::status::LinkState;
use crate::value::format;
use crate::value::theme;
use crate::world::World;

/// Distance of lines in the middle of the view, in points.
const GAP: f32 = 6.0;

/// Writes over the view.
pub(super) fn paint(ui: &Ui, projector: &Projector, rect: Rect, world: &World<'_>) {
    let painter = ui.painter().with_clip_rect(rect);
    let ink = if world.settings.window.is_dark() {
        Color32::from_rgb(214, 219, 227)
    } else {
        Color32::from_rgb(40, 44, 50)
    };
    gate(&painter, rect, world);
    if world.model.is_none() {
        nothing_yet(&painter, rect, world, ink);
        return;
    }
    nothing_found(&painter, rect, world, ink);
    others::paint(&painter, projector, world, ink);
    light::paint(&painter, projector, world);
    selectors::paint(&painter, projector, world);
    ghost::paint(&painter, projector, rect, world);
    highlight::paint(&painter, projector, world, ink);
    pointed::paint(&painter, projector, world, ink);
    axes(&painter, rect, world, ink);
    captions(&painter, rect, world, ink);
    legend::paint(&painter, rect, world, ink);
}

/// Darkens what the render camera does not see.
fn gate(painter: &Painter, rect: Rect, world: &World<'_>) {
    let Some(gate) = world.camera.gate(rect.aspect_ratio()) else { return };
    let size = vec2(rect.width() * gate.width, rect.height() * gate.height);
    let inner = Rect::from_center_size(rect.center(), size);
    let shade = Color32::from_black_alpha(120);
    let bands = [
        Rect::from_min_max(rect.min, pos2(rect.right(), inner.top())),
        Rect::from_min_max(pos2(rect.left(), inner.bottom()), rect.max),
        Rect::from_min_max(pos2(rect.left(), inner.top()), inner.left_bottom()),
        Rect::from_min_max(inner.right_top(), pos2(rect.right(), inner.bottom())),
    ];
    for band in bands {
        painter.rect_filled(band, CornerRadius::ZERO, shade);
    }
    let stroke = Stroke::new(1.0, Color32::from_white_alpha(110));
    painter.rect_stroke(inner, CornerRadius::ZERO, stroke, StrokeKind::Outside);
}

/// Why there is no scene, and what to do.
fn nothing_yet(painter: &Painter, rect: Rect, world: &World<'_>, ink: Color32) {
    let status = world.status;
    let (title, lines) = match &status.link {
        LinkState::Idle => {
            let remedy = "Use the Connection menu to connect to a daemon.".to_owned();
            ("Nothing is open".to_owned(), vec![remedy])
        }
        LinkState::Connecting => (
            format!("Connecting to {} …", status.address),
            vec!["This may take a moment.".to_owned()],
        ),
        LinkState::Connected => {
            ("Connected".to_owned(), vec!["Receiving the scene ...".to_owned()])
        }
        LinkState::Disconnected { reason, retry_at } => {
            let seconds = retry_at.saturating_duration_since(world.now).as_secs_f32().ceil();
            let lines = vec![
                format::sentence(reason),
                format!("Retrying in {seconds:.0} s; press R to connect now."),
            ];
            ("No connection".to_owned(), lines)
        }
    };
    tell(painter, rect, ink, &title, lines);
}

/// That the filter leaves nothing to be seen, and where to read why.
fn nothing_found(painter: &Painter, rect: Rect, world: &World<'_>, ink: Color32) {
    let Some(counts) = world.filter_counts() else { return };
    let is_refused = world.status.filter.as_ref().is_some_and(|reply| reply.error.is_some());
    let is_filtered = !world.settings.filter.whole().wants_all() && !is_refused;
    if is_filtered && world.store.matched() == 0 && counts.matched == 0 && counts.seen > 0 {
        let seen = format::count(counts.seen as f64);
        let lines = vec![
            format!("None of {seen} so far. The Filter panel shows the nearest path"),
            "and what to do about it; Ctrl+Z undoes the last change.".to_owned(),
        ];
        tell(painter, rect, ink, "No path matches the filter", lines);
    }
}

/// A title and lines in the middle of the view, broken where the view is too narrow for them.
fn tell(painter: &Painter, rect: Rect, ink: Color32, title: &str, lines: Vec<String>) {
    let faint = ink.gamma_multiply(0.7);
    let width = (rect.width() - 2.0 * MARGIN).max(0.0);
    let wrapped = |line, size, color| {
        let mut job = LayoutJob::simple(line, FontId::proportional(size), color, width);
        job.halign = Align::Center;
        painter.layout_job(job)
    };
    let title = wrapped(title.to_owned(), 22.0, ink);
    let lines: Vec<_> = lines.into_iter().map(|line| wrapped(line, 14.0, faint)).collect();
    let height: f32 = lines.iter().map(|line| line.size().y + GAP).sum();
    let mut place = rect.center() - vec2(0.0, 0.5 * height);
    painter.galley(place - vec2(0.0, title.size().y), title, ink);
    place.y += 2.0 * GAP;
    for line in lines {
        let below = line.size().y + GAP;
        painter.galley(place, line, faint);
        place.y += below;
    }
}

/// Three short axes in the lower left corner, as the eye sees them.
fn axes(painter: &Painter, rect: Rect, world: &World<'_>, ink: Color32) {
    let lens = world.camera.lens(1.0);
    let centre = rect.left_bottom() + vec2(MARGIN + 26.0, -MARGIN - 26.0);
    let mut arms = [
        (Vec3::X, "x", theme::axis_color(Vec3::X)),
        (Vec3::Y, "y", theme::axis_color(Vec3::Y)),
        (Vec3::Z, "z", theme::axis_color(Vec3::Z)),
    ];
    // The farthest first, so that nearer arms lie on top.
    arms.sort_by(|a, b| b.0.dot(lens.forward).total_cmp(&a.0.dot(lens.forward)));
    painter.circle_filled(centre, DISC, Color32::from_black_alpha(36));
    for (axis, name, color) in arms {
        let tip = centre + 24.0 * vec2(axis.dot(lens.right), -axis.dot(lens.up));
        let away = axis.dot(lens.forward) > 0.2;
        let color = if away { color.gamma_multiply(0.55) } else { color };
        painter.line_segment([centre, tip], Stroke::new(2.0, color));
        painter.circle_filled(tip, 6.5, color);
        let font = FontId::proportional(10.0);
        painter.text(tip, Align2::CENTER_CENTER, name, font, Color32::from_black_alpha(220));
    }
    painter.circle_filled(centre, 1.5, ink);
}

/// How one looks, and what is shown, in the upper corners.
fn captions(painter: &Painter, rect: Rect, world: &World<'_>, ink: Color32) {
    let camera = world.camera;
    let mode = match (camera.is_through(), camera.is_flying()) {
        (true, _) => "Render camera",
        (false, true) => "Fly   W A S D  Q E",
        (false, false) => "Orbit",
    };
    let corner = rect.left_top() + vec2(MARGIN, MARGIN);
    text(painter, corner, Align2::LEFT_TOP, mode, ink);
    let shown = (world.settings.cloud.shown as usize).min(world.store.len());
    let paths = format!(
        "{} of {} paths",
        format::count(shown as f64),
        format::count(world.store.len() as f64)
    );
    let corner = rect.right_top() + vec2(-MARGIN, MARGIN);
    text(painter, corner, Align2::RIGHT_TOP, &paths, ink);
    if world.settings.cloud.frozen {
        let place = corner + vec2(0.0, 24.0);
        text(painter, place, Align2::RIGHT_TOP, "Frozen; press Space to resume", theme::BUSY);
    } else if !world.status.is_connected() {
        let place = corner + vec2(0.0, 24.0);
        text(painter, place, Align2::RIGHT_TOP, "Not connected", theme::BAD);
    }
}

/// A text on a veil, so that paths behind it do not blur it.
fn text(painter: &Painter, place: Pos2, anchor: Align2, text: &str, color: Color32) {
    let galley = painter.layout_no_wrap(text.to_owned(), FontId::proportional(13.0), color);
    let rect = anchor.anchor_size(place, galley.size());
    veil(painter, rect, color);
    painter.galley(rect.min, galley, color);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_told_in_a_narrow_view_is_not_cut_off() {
        let view = Rect::from_min_size(pos2(40.0, 30.0), vec2(220.0, 400.0));
        let title = "Connecting to a-machine-with-a-long-name.far-away.example:50061 …";
        let reason = "the daemon at a-machine-with-a-long-name.far-away.example:50061 encrypts: \
                      give the fingerprint that it told when it started (--fingerprint)";
        let mut output = egui::Context::default().run_ui(egui::RawInput::default(), |ui| {
            let painter = ui.painter().with_clip_rect(view);
            tell(&painter, view, Color32::WHITE, title, vec![reason.to_owned()]);
        });
        // Nothing is drawn.
        output.textures_delta.clear();
        let written = output.shapes.iter().map(|clipped| clipped.shape.visual_bounding_rect());
        let written = written.reduce(Rect::union).expect("something is told");
        assert!(view.contains_rect(written), "{written:?} lies in {view:?}");
    }
}
