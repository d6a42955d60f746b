//! What the colours say, in the lower right corner.

use common::VertexKind;
use egui::epaint::Mesh;
use egui::text::{LayoutJob, TextWrapping};
use egui::{Color32, FontId, Painter, Pos2, Rect, Shape, Stroke, pos2, vec2};

use super::ground::{AXES, MARGIN, veil};
use crate::value::format;
use crate::value::theme;
use crate::value::{ColorMode, ColorScale};
use crate::world::World;

/// Room for the dot before an entry, in points.
const DOT: f32 = 16.0;
/// Width of the ramp in points.
const RAMP_WIDTH: f32 = 168.0;
/// In a narrower view, in points, the legend is above the axes, not beside them.
const NARROW: f32 = 320.0;
/// Chains that have a colour of their own.
const CHAIN_COLORS: usize = 16;

/// Writes the legend.
pub(super) fn paint(painter: &Painter, rect: Rect, world: &World<'_>, ink: Color32) {
    let lift = if rect.width() < NARROW { AXES } else { MARGIN };
    let place = rect.right_bottom() - vec2(MARGIN, lift);
    let most = (rect.width() - 2.0 * MARGIN).max(0.0);
    let mut column = Column { painter, place, most, ink };
    let cloud = &world.settings.cloud;
    if cloud.ends {
        column.entry("end, at the camera", theme::CAMERA_END);
        column.entry("start, on the light", theme::LIGHT_END);
    }
    let ramp = theme::ramp(world.settings.window.is_dark());
    let scale = cloud.scale;
    match cloud.color {
        ColorMode::Radiance | ColorMode::Constant => {}
        ColorMode::Strategy => {
            let names = world.status.welcome.as_ref().map(|w| w.strategies.as_slice());
            for (index, name) in names.unwrap_or_default().iter().enumerate().rev() {
                column.entry(name, theme::strategy_color(index));
            }
        }
        ColorMode::Length => {
            column.ramp(&format!("edges ({scale})"), "1", "10 or more", &ramp);
        }
        ColorMode::Luminance => {
            let light = world.names().frame.map_or(1.0, |frame| frame.light) as f32;
            let (low, high) = world.store.tone().range();
            let lowest = match scale {
                ColorScale::Log => format!("{:.1e}", light * low.exp2()),
                ColorScale::Linear => "0".to_owned(),
            };
            let title = format!("luminance ({scale})");
            column.ramp(&title, &lowest, &format!("{:.1e}", light * high.exp2()), &ramp);
        }
        ColorMode::Throughput => {
            let lowest = if scale == ColorScale::Log { "0.001 or less" } else { "0" };
            column.ramp(&format!("throughput to the lens ({scale})"), lowest, "1", &ramp);
        }
        ColorMode::Dwell => column.ramp("steps stayed (log)", "1", "16 or more", &ramp),
        ColorMode::Acceptance => column.ramp("acceptance", "0", "1", &ramp),
        ColorMode::Age => {
            let oldest =
                format!("{} or more paths ago", format::count(3.0 * f64::from(cloud.fade)));
            column.ramp("age", &oldest, "now", &ramp);
        }
        ColorMode::Kind => kinds(&mut column),
        ColorMode::Chain => {
            column.entry(
                &format!("every {CHAIN_COLORS}th chain looks the same"),
                theme::strategy_color(0),
            );
        }
        ColorMode::Class => {
            let names = world.store.classes().names();
            if names.len() == CHAIN_COLORS - 1 {
                column.entry("other classes", theme::strategy_color(CHAIN_COLORS - 1));
            }
            for (index, name) in names.iter().enumerate().rev() {
                column.entry(name, theme::strategy_color(index));
            }
        }
    }
}

fn kinds(column: &mut Column<'_>) {
    // Kinds travel as numbers below eight.
    for code in (0..8).rev() {
        if let Some(kind) = VertexKind::from_code(code) {
            let label = format!("{}  {kind:?}", kind.letter());
            column.entry(&label, theme::strategy_color(usize::from(code)));
        }
    }
}

/// Entries one over the other, from the bottom up.
struct Column<'a> {
    painter: &'a Painter,
    place: Pos2,
    /// Widest that an entry may be, in points.
    most: f32,
    ink: Color32,
}

impl Column<'_> {
    fn entry(&mut self, label: &str, color: Color32) {
        let font = FontId::proportional(12.0);
        let mut job = LayoutJob::simple_singleline(label.to_owned(), font, self.ink);
        job.wrap = TextWrapping::truncate_at_width((self.most - DOT).max(0.0));
        let galley = self.painter.layout_job(job);
        let left = self.place - galley.size();
        let rect = Rect::from_min_max(left - vec2(DOT, 0.0), self.place);
        veil(self.painter, rect, self.ink);
        self.painter.circle_filled(left + vec2(-10.0, 0.5 * galley.size().y), 4.0, color);
        self.painter.galley(left, galley, self.ink);
        self.place.y -= 22.0;
    }

    fn ramp(&mut self, title: &str, low: &str, high: &str, colors: &[Color32]) {
        let font = FontId::proportional(12.0);
        let height = 46.0;
        let width = RAMP_WIDTH.min(self.most);
        let rect = Rect::from_min_max(self.place - vec2(width, height), self.place);
        veil(self.painter, rect, self.ink);
        let text = |place: Pos2, anchor: egui::Align2, text: &str| {
            self.painter.text(place, anchor, text, font.clone(), self.ink);
        };
        text(rect.center_top(), egui::Align2::CENTER_TOP, title);
        text(rect.left_bottom(), egui::Align2::LEFT_BOTTOM, low);
        text(rect.right_bottom(), egui::Align2::RIGHT_BOTTOM, high);
        let band = Rect::from_min_max(
            pos2(rect.left(), rect.top() + 18.0),
            pos2(rect.right(), rect.top() + 28.0),
        );
        self.painter.add(Shape::mesh(gradient(band, colors)));
        let edge = Stroke::new(1.0, self.ink.gamma_multiply(0.4));
        self.painter.rect_stroke(band, 0.0, edge, egui::StrokeKind::Outside);
        self.place.y -= height + 8.0;
    }
}

fn gradient(band: Rect, colors: &[Color32]) -> Mesh {
    let mut mesh = Mesh::default();
    let last = colors.len().saturating_sub(1).max(1) as f32;
    for (i, color) in (0_u32..).zip(colors) {
        let x = band.left() + band.width() * i as f32 / last;
        mesh.colored_vertex(pos2(x, band.top()), *color);
        mesh.colored_vertex(pos2(x, band.bottom()), *color);
        if i > 0 {
            mesh.add_triangle(2 * i - 2, 2 * i - 1, 2 * i);
            mesh.add_triangle(2 * i - 1, 2 * i, 2 * i + 1);
        }
    }
    mesh
}
