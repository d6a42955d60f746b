//! A word to the user at the foot of the window, gone after some seconds.

use std::time::Duration;

use egui::{Align2, Area, Frame, Id, Label, Order, RichText, Stroke, Ui, vec2};

use super::Panel;
use super::widgets::dot;
use crate::command::Command;
use crate::source::status::Notice;
use crate::value::theme;
use crate::world::World;

/// How long a word stays.
pub const NOTICE_TIME: Duration = Duration::from_secs(8);
/// Widest that it gets, in points.
const WIDTH: f32 = 520.0;

/// The newest word.
#[derive(Debug)]
pub(super) struct NoticePanel;

impl Panel for NoticePanel {
    fn ui(&mut self, ui: &mut Ui, world: &World<'_>, _commands: &mut Vec<Command>) {
        let Some(notice) = &world.status.notice else { return };
        if world.now.saturating_duration_since(notice.at) >= NOTICE_TIME {
            return;
        }
        Area::new(Id::unique("notice"))
            .order(Order::Foreground)
            .anchor(Align2::CENTER_BOTTOM, vec2(0.0, -56.0))
            .show(ui.ctx(), |ui| word(ui, notice));
    }
}

fn word(ui: &mut Ui, notice: &Notice) {
    let color = if notice.is_bad { theme::BAD } else { theme::GOOD };
    let frame = Frame::popup(ui.style()).inner_margin(10).stroke(Stroke::new(1.0, color));
    frame.show(ui, |ui| {
        ui.set_max_width(WIDTH);
        ui.horizontal(|ui| {
            dot(ui, color);
            ui.add(Label::new(RichText::new(&notice.text).strong()).wrap());
        });
    });
}
