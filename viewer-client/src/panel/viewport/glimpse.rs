//! What lies under the cursor when it rests: a word on it, before anybody clicks.

use std::time::Duration;

use egui::{Color32, Painter, Pos2, Response, RichText, Stroke, Ui};

use super::TOLERANCE;
use super::highlight::arrow_head;
use super::project::Projector;
use crate::draw::pick::Sight;
use crate::panel::hover::{self, Pointed};
use crate::panel::widgets::dot;
use crate::source::selection::Selection;
use crate::value::format;
use crate::value::theme;
use crate::world::World;

/// A cursor that has not moved for so long rests.
const REST: Duration = Duration::from_millis(220);
/// Paths that are searched: looking at more would be felt.
const MOST_PATHS: usize = 200_000;
/// How near to a vertex or an edge of the selected path the cursor must be, in points.
const REACH: f32 = 8.0;

/// Where the cursor is, since when, and what was found there.
#[derive(Debug, Default)]
pub(super) struct Glimpse {
    place: Pos2,
    since: f64,
    looked: bool,
    found: Option<Selection>,
}

impl Glimpse {
    /// Looks where the cursor rests; then, and until it moves, tells what is there.
    pub(super) fn show(
        &mut self,
        ui: &Ui,
        response: &Response,
        projector: &Projector,
        world: &World<'_>,
    ) {
        let busy = ui.input(|input| input.pointer.any_down() || input.smooth_scroll_delta.y != 0.0);
        let place = response.hover_pos().filter(|_| response.hovered() && !busy);
        let Some(place) = place else {
            *self = Self::default();
            return;
        };
        if let Some(pointed) = part_at(projector, place, world) {
            hover::point(ui.ctx(), pointed);
            response.clone().on_hover_ui_at_pointer(|ui| tell_part(ui, world, pointed));
            return;
        }
        let time = ui.input(|input| input.time);
        if place.distance(self.place) > 2.0 {
            *self = Self { place, since: time, ..Self::default() };
        }
        let rested = Duration::try_from_secs_f64(time - self.since).unwrap_or_default();
        if let Some(left) = REST.checked_sub(rested) {
            ui.ctx().request_repaint_after(left);
            return;
        }
        if !self.looked {
            self.looked = true;
            self.found = path_at(projector, place, world);
        }
        let Some(found) = &self.found else { return };
        let [u, v] = found.header.film;
        hover::point(ui.ctx(), Pointed::Path([u, v]));
        paint(&ui.painter_at(response.rect), projector, found);
        response.clone().on_hover_ui_at_pointer(|ui| tell(ui, world, found));
    }
}

/// The nearest vertex or edge of the selected path.
fn part_at(projector: &Projector, place: Pos2, world: &World<'_>) -> Option<Pointed> {
    let vertices = &world.selection?.vertices;
    let seen = |i: usize| projector.point(vertices.get(i)?.position.into());
    let near = |i: usize| seen(i).is_some_and(|p| p.distance(place) <= REACH);
    if let Some(i) = (0..vertices.len()).find(|&i| near(i)) {
        return Some(Pointed::Vertex(i));
    }
    let edges = vertices.windows(2).enumerate().filter_map(|(i, pair)| {
        let [a, b] = pair.first_chunk::<2>()?;
        let [a, b] = projector.segment(a.position.into(), b.position.into())?;
        Some((i, off(place, [a, b])))
    });
    let (i, off) = edges.min_by(|a, b| a.1.total_cmp(&b.1))?;
    (off <= 0.5 * REACH).then_some(Pointed::Edge(i))
}

/// Distance of a point from a segment.
fn off(place: Pos2, [a, b]: [Pos2; 2]) -> f32 {
    let along = b - a;
    let t = ((place - a).dot(along) / along.length_sq().max(1e-6)).clamp(0.0, 1.0);
    (a + t * along).distance(place)
}

fn path_at(projector: &Projector, place: Pos2, world: &World<'_>) -> Option<Selection> {
    let sight = Sight {
        store: world.store,
        lens: &projector.lens,
        bounds: world.camera.bounds(),
        scene: &world.settings.scene,
        mesh: world.model.map(|model| &model.mesh),
        newest: (world.settings.cloud.shown as usize).min(MOST_PATHS),
    };
    sight.paths(projector.pointer(place, TOLERANCE)).into_iter().next()
}

fn paint(painter: &Painter, projector: &Projector, found: &Selection) {
    let color = theme::SELECTED.gamma_multiply(0.75);
    for (stroke, arrow) in
        [(Stroke::new(4.5, Color32::from_black_alpha(130)), false), (Stroke::new(1.8, color), true)]
    {
        for pair in found.vertices.windows(2) {
            if let [a, b] = pair
                && let Some(line) = projector.segment(a.position.into(), b.position.into())
            {
                painter.line_segment(line, stroke);
                if arrow {
                    arrow_head(painter, line, color);
                }
            }
        }
    }
}

fn tell(ui: &mut Ui, world: &World<'_>, found: &Selection) {
    let names = world.names();
    ui.label(RichText::new(found.class()).monospace().strong());
    let h = &found.header;
    // A file does not tell these.
    if world.playback.is_none() {
        ui.horizontal(|ui| {
            dot(ui, theme::strategy_color(usize::from(h.strategy.0)));
            ui.label(names.strategy(h));
        });
        let stay = format::steps(u64::from(h.dwell));
        ui.label(format!("Luminance {}, stayed {stay}", format::exact(names.luminance(h))));
    }
    ui.label(RichText::new(format!("Path {}", h.id)).weak());
    let (_, of) = found.place;
    let more = if of > 1 { format!(" (1 of {of} here)") } else { String::new() };
    ui.label(RichText::new(format!("Click to select it{more}")).small().weak());
}

/// A word on a vertex or an edge of the selected path.
fn tell_part(ui: &mut Ui, world: &World<'_>, pointed: Pointed) {
    let Some(selection) = world.selection else { return };
    let names = world.names();
    let detail = selection.numbers();
    match pointed {
        Pointed::Vertex(i) => {
            let Some(vertex) = selection.vertices.get(i) else { return };
            let title = format!("x{i}, {}", vertex.kind.name());
            ui.label(RichText::new(title).strong());
            let object = names.object(vertex).map_or(String::new(), |name| format!(" of {name}"));
            ui.label(format!("{} on {}{object}", vertex.event.name(), names.material(vertex)));
            if let Some(numbers) = detail.and_then(|detail| detail.vertices.get(i)) {
                let density = |p: f64| if p > 0.0 { format::exact(p) } else { "–".to_owned() };
                let (light, eye) = (density(numbers.light_pdf), density(numbers.eye_pdf));
                ui.label(format!("p from the light {light}, from the eye {eye}"));
            }
        }
        Pointed::Edge(i) => {
            ui.label(RichText::new(format!("Edge x{i} to x{}", i + 1)).strong());
            if let Some(length) = selection.edge_length(i + 1, &names) {
                ui.label(format!("Length {length:.4}"));
            }
            if let Some(geometry) = detail.and_then(|detail| detail.geometry.get(i)) {
                let share = detail.map_or(0.0, |detail| detail.share(i + 1));
                ui.label(format!("G {}", format::exact(*geometry)));
                ui.label(format!("Connecting here has weight {}", format::percent(share, 1.0)));
            }
        }
        _ => {}
    }
}

#[cfg(test)]
mod tests {
    use egui::pos2;

    use super::*;

    #[test]
    fn distances_from_segments() {
        let line = [pos2(0.0, 0.0), pos2(10.0, 0.0)];
        assert_eq!(off(pos2(5.0, 3.0), line), 3.0, "beside it");
        assert_eq!(off(pos2(14.0, 3.0), line), 5.0, "beyond its end");
        assert_eq!(off(pos2(3.0, 4.0), [pos2(0.0, 0.0); 2]), 5.0, "a point");
    }
}
