//! The image itself: zoomed, shifted, and pointed at.

use egui::{
    Color32, PointerButton, Pos2, Rect, Response, Role, Sense, Stroke, StrokeKind, TextureId, Ui,
    Vec2, WidgetInfo, pos2, vec2,
};

use super::marks;
use crate::command::{Command, FilterCommand, ImageCommand};
use crate::panel::hover::{self, Pointed};
use crate::settings::region;
use crate::value::theme;
use crate::world::World;

/// Tallest that the image gets, in shares of the window's height: the rest is for the statistics.
const TALLEST: f32 = 0.36;
/// Points of the wheel that come closer by a factor of e.
const WHEEL: f32 = 240.0;
/// Closest zoom, in screen points a pixel of the film.
const CLOSEST: f32 = 64.0;

/// Seconds without the wheel after which a turn of it is another gesture.
const PAUSE: f64 = 0.5;
/// A cursor that moves further begins another gesture, in points.
const STILL: f32 = 4.0;

/// What is under way from frame to frame.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct FrameState {
    /// The pixel where a rectangle began.
    corner: Option<[usize; 2]>,
    /// The newest turn of the wheel.
    turn: Option<Turn>,
}

/// Turns of the wheel that belong together.
#[derive(Clone, Copy, Debug)]
struct Turn {
    /// Where the cursor was when they began.
    place: Pos2,
    /// When the last one was, in seconds.
    last: f64,
    /// They began on the image.
    is_ours: bool,
}

/// How film pixels lie on the screen.
#[derive(Clone, Copy, Debug)]
struct Placement {
    /// What may be drawn on.
    frame: Rect,
    /// Width and height of the film in pixels.
    film: Vec2,
    /// Where its upper left corner lies, perhaps outside the frame.
    origin: Pos2,
    /// Screen points a pixel.
    scale: f32,
    /// The scale at which the film fills the frame.
    fit: f32,
}

impl Placement {
    fn new(frame: Rect, film: Vec2, zoom: Option<f32>, centre: [f32; 2]) -> Self {
        let fit = (frame.width() / film.x).min(frame.height() / film.y);
        let scale = zoom.unwrap_or(fit);
        let half = frame.size() / scale / 2.0;
        let middle = |side: f32, half: f32, share: f32| {
            if side <= 2.0 * half { side / 2.0 } else { (share * side).clamp(half, side - half) }
        };
        let centre = vec2(middle(film.x, half.x, centre[0]), middle(film.y, half.y, centre[1]));
        Self { frame, film, origin: frame.center() - centre * scale, scale, fit }
    }

    /// The point of the film under a point of the screen, in pixels.
    fn film_point(&self, place: Pos2) -> Vec2 {
        (place - self.origin) / self.scale
    }

    /// The pixel under a point of the screen; the nearest one where it lies outside.
    fn nearest(&self, place: Pos2) -> [usize; 2] {
        let point = self.film_point(place).max(Vec2::ZERO).min(self.film - Vec2::splat(1.0));
        [point.x as usize, point.y as usize]
    }

    /// The pixel under a point of the screen.
    fn pixel(&self, place: Pos2) -> Option<[usize; 2]> {
        let image = Rect::from_min_size(self.origin, self.film * self.scale);
        (self.frame.contains(place) && image.contains(place)).then(|| self.nearest(place))
    }

    /// The film point in the middle after the film was shifted by `shift` points at `scale`.
    fn centre(&self, shift: Vec2, scale: f32) -> [f32; 2] {
        let centre = self.film_point(self.frame.center()) - shift / scale;
        [centre.x / self.film.x, centre.y / self.film.y].map(|share| share.clamp(0.0, 1.0))
    }

    /// A point of film coordinates on the screen.
    fn on_screen_point(&self, [u, v]: [f32; 2]) -> Pos2 {
        self.origin + vec2(u, v) * self.film * self.scale
    }

    /// A rectangle of film coordinates on the screen.
    fn on_screen(&self, [u0, v0, u1, v1]: region::Region) -> Rect {
        let place = |u: f64, v: f64| {
            self.origin + vec2(u as f32 * self.film.x, v as f32 * self.film.y) * self.scale
        };
        Rect::from_min_max(place(u0, v0), place(u1, v1))
    }
}

impl FrameState {
    /// Shows the image; the answer is the pixel under the cursor.
    pub(super) fn show(
        &mut self,
        ui: &mut Ui,
        world: &World<'_>,
        texture: TextureId,
        commands: &mut Vec<Command>,
    ) -> Option<[usize; 2]> {
        let [width, height] = world.film.size();
        let film = vec2(width as f32, height as f32);
        let tallest = TALLEST * ui.ctx().content_rect().height();
        let fit = (ui.available_width() / film.x).min(tallest / film.y);
        let size = vec2(ui.available_width(), film.y * fit);
        let (rect, response) = ui.allocate_exact_size(size, Sense::click_and_drag());
        response.widget_info(|| WidgetInfo::labeled(Role::Image, true, "Film"));
        let look = &world.settings.image;
        let placement = Placement::new(rect, film, look.zoom, look.centre);
        let painter = ui.painter_at(rect);
        let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
        let place = Rect::from_min_size(placement.origin, film * placement.scale);
        painter.image(texture, place, whole, Color32::WHITE);
        let hovered = response.hover_pos().and_then(|p| placement.pixel(p));
        let is_ours = self.takes_wheel(ui, &response);
        wheel(ui, &response, placement, is_ours, commands);
        pan(&response, placement, commands);
        self.choose(&response, placement, world, commands);
        let chosen = match (self.corner, response.interact_pointer_pos()) {
            (Some(corner), Some(p)) => {
                Some(region::pixels([width, height], corner, placement.nearest(p)))
            }
            _ => region::region_of(world.settings.filter.text()),
        };
        if let Some(region) = chosen {
            outline(&painter, placement.on_screen(region).expand(1.0));
        }
        marks::paint(&painter, world, |film| placement.on_screen_point(film));
        if let Some(p) = response.hover_pos().filter(|_| hovered.is_some()) {
            let point = placement.film_point(p) / film;
            hover::point(ui.ctx(), Pointed::Film([point.x, point.y]));
        }
        hovered
    }

    /// True where the wheel comes closer. Who scrolls the side goes on with that when the image comes
    /// under a cursor that rests.
    fn takes_wheel(&mut self, ui: &Ui, response: &Response) -> bool {
        let is_over = response.hover_pos().is_some();
        let (scroll, time) = ui.input(|i| (i.smooth_scroll_delta, i.time));
        if scroll == Vec2::ZERO {
            return is_over;
        }
        let Some(place) = ui.input(|i| i.pointer.latest_pos()) else { return false };
        let goes_on = |turn: &Turn| time - turn.last < PAUSE && turn.place.distance(place) < STILL;
        let turn = match self.turn.filter(goes_on) {
            Some(turn) => Turn { last: time, ..turn },
            None => Turn { place, last: time, is_ours: is_over },
        };
        self.turn = Some(turn);
        turn.is_ours && is_over
    }

    /// A click wants the paths to a pixel, a drag those to a rectangle.
    fn choose(
        &mut self,
        response: &Response,
        placement: Placement,
        world: &World<'_>,
        commands: &mut Vec<Command>,
    ) {
        let Some(place) = response.interact_pointer_pos() else {
            self.corner = None;
            return;
        };
        if response.drag_started_by(PointerButton::Primary) {
            // The drag begins where the button went down, not where it was told from a click.
            let start = response.ctx.input(|i| i.pointer.press_origin()).unwrap_or(place);
            self.corner = Some(placement.nearest(start));
        }
        let pixels = if response.clicked() {
            placement.pixel(place).map(|pixel| (pixel, pixel))
        } else if response.drag_stopped_by(PointerButton::Primary) {
            self.corner.take().map(|corner| (corner, placement.nearest(place)))
        } else {
            None
        };
        if let Some((from, to)) = pixels {
            let region = region::pixels(world.film.size(), from, to);
            let text = region::with_region(world.settings.filter.text(), Some(region));
            commands.push(Command::Filter(FilterCommand::Set(text)));
        }
    }
}

fn wheel(
    ui: &Ui,
    response: &Response,
    placement: Placement,
    is_ours: bool,
    commands: &mut Vec<Command>,
) {
    let Some(place) = response.hover_pos() else { return };
    let (scroll, pinch) = ui.input(|i| (i.smooth_scroll_delta.y, i.zoom_delta()));
    let scroll = if is_ours { scroll } else { 0.0 };
    let factor = (scroll / WHEEL).exp() * pinch;
    if factor == 1.0 {
        return;
    }
    if is_ours {
        // The wheel is used up, so that the panel stays where it is.
        ui.input_mut(|i| i.smooth_scroll_delta = Vec2::ZERO);
    }
    let scale = placement.scale * factor;
    if scale <= placement.fit {
        commands.push(Command::Image(ImageCommand::Fit));
        return;
    }
    let scale = scale.min(CLOSEST);
    // The point under the cursor stays there.
    let point = placement.film_point(place);
    let centre = point - (place - placement.frame.center()) / scale;
    let share = [centre.x / placement.film.x, centre.y / placement.film.y];
    commands.push(Command::Image(ImageCommand::Zoom(scale)));
    commands.push(Command::Image(ImageCommand::Look(share.map(|s| s.clamp(0.0, 1.0)))));
}

fn pan(response: &Response, placement: Placement, commands: &mut Vec<Command>) {
    let by_hand = [PointerButton::Secondary, PointerButton::Middle];
    let delta = response.drag_delta();
    if delta != Vec2::ZERO && by_hand.into_iter().any(|button| response.dragged_by(button)) {
        let centre = placement.centre(delta, placement.scale);
        commands.push(Command::Image(ImageCommand::Look(centre)));
    }
}

/// A rectangle that shows on any image.
fn outline(painter: &egui::Painter, rect: Rect) {
    let dark = Stroke::new(3.0, Color32::from_black_alpha(170));
    painter.rect_stroke(rect, 0.0, dark, StrokeKind::Outside);
    painter.rect_stroke(rect, 0.0, Stroke::new(1.5, theme::ACCENT), StrokeKind::Outside);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pixels_and_places_agree() {
        let frame = Rect::from_min_size(pos2(10.0, 20.0), vec2(400.0, 300.0));
        let film = vec2(40.0, 30.0);
        let whole = Placement::new(frame, film, None, [0.5; 2]);
        assert_eq!(whole.pixel(pos2(10.5, 20.5)), Some([0, 0]), "the upper left corner");
        assert_eq!(whole.pixel(pos2(409.0, 319.0)), Some([39, 29]), "the lower right one");
        assert_eq!(whole.pixel(pos2(500.0, 100.0)), None, "outside");
        assert_eq!(whole.nearest(pos2(500.0, -100.0)), [39, 0], "the nearest one");
        let near = Placement::new(frame, film, Some(40.0), [0.0, 0.0]);
        assert_eq!(near.pixel(frame.min), Some([0, 0]), "no empty margin at the edge");
        let middle = Placement::new(frame, film, Some(40.0), [0.5, 0.5]);
        assert_eq!(middle.pixel(frame.center()), Some([20, 15]), "the middle");
        let [u, v] = middle.centre(vec2(40.0, -40.0), 40.0);
        assert!((u - 19.0 / 40.0).abs() < 1e-6 && (v - 16.0 / 30.0).abs() < 1e-6, "{u} {v}");
        let region = region::pixels([40, 30], [3, 4], [5, 6]);
        let rect = whole.on_screen(region);
        assert!((rect.min - pos2(40.0, 60.0)).length() < 1e-3, "{rect:?}");
        assert!((rect.max - pos2(70.0, 90.0)).length() < 1e-3, "{rect:?}");
    }
}
