//! The sides of the window: which sections they hold, how wide they are, and how they are scrolled.

use egui::text_selection::LabelSelectionState;
use egui::{
    Button, CursorIcon, Event, Frame, Id, Margin, Rect, Response, Role, ScrollArea, Sense, Ui,
    WidgetInfo, vec2,
};

use super::{Placed, Slot, about, heading};
use crate::command::{Command, DesktopCommand, LayoutCommand};
use crate::settings::Layout as Settled;
use crate::value::WIDTHS;
use crate::value::{Move, PanelName, Part, Switch, WindowSide};
use crate::world::World;

/// Height of the room below the last section, in points.
const FOOT: f32 = 40.0;

/// A section is read where so many points of it are seen.
const READABLE: f32 = 120.0;
/// How far from the edge of a side it can be dragged, in points.
const GRIP: f32 = 4.0;

/// What a side is shown with.
#[derive(Debug)]
pub(super) struct Window<'a> {
    pub(super) panels: &'a mut [Placed],
    pub(super) world: &'a World<'a>,
    pub(super) commands: &'a mut Vec<Command>,
}

/// What the sides of the window hold, and how wide they are in this frame.
#[derive(Debug)]
pub(super) struct Sides {
    /// The sections of the left and of the right side that are to be shown.
    names: [Vec<PanelName>; 2],
    /// In points; `None` for a side without sections, and for one that is folded to a strip.
    widths: [Option<f32>; 2],
    /// Points for both.
    room: f32,
}

/// A drag of the edge of a side.
#[derive(Clone, Copy, Debug)]
struct Pull {
    side: WindowSide,
    /// Its width in points when the drag began, and now.
    from: f32,
    now: f32,
}

impl Sides {
    pub(super) fn of(ui: &Ui, world: &World<'_>) -> Self {
        let layout = &world.settings.layout;
        let is_shown = |name: &PanelName| layout.is_open(*name) && (about(*name).applies)(world);
        let names =
            WindowSide::ALL.map(|side| layout.side(side).filter(is_shown).collect::<Vec<_>>());
        show_side_of_opened(ui, &names);
        let window = ui.available_width();
        let room = Settled::room(window);
        let wished = WindowSide::ALL.map(|side| {
            let has_any = !names[side as usize].is_empty();
            has_any.then(|| f32::from(layout.width(side)))
        });
        let in_use = ui.data(|data| data.get_temp(in_use())).unwrap_or(WindowSide::Left);
        let mut widths = Settled::fit(wished, window, in_use);
        let pull: Option<Pull> = ui.data(|data| data.get_temp(pulled()));
        if let Some(Pull { side, now, .. }) = pull.filter(|p| widths[p.side as usize].is_some()) {
            widths[side as usize] = Some(now);
            let other = opposite(side) as usize;
            // The other side yields to the hand, and comes back with it.
            widths[other] = widths[other].and(wished[other]).map(|wish| wish.min(room - now));
        }
        Self { names, widths, room }
    }

    /// Widest that the user can make a side.
    fn most(&self, side: WindowSide, layout: &Settled) -> f32 {
        let other = opposite(side);
        let taken = match self.widths[other as usize] {
            Some(_) => Settled::NARROW.min(f32::from(layout.width(other))),
            None if self.names[other as usize].is_empty() => 0.0,
            None => Settled::STRIP,
        };
        (self.room - taken).min(f32::from(WIDTHS.high))
    }
}

fn opposite(side: WindowSide) -> WindowSide {
    match side {
        WindowSide::Left => WindowSide::Right,
        WindowSide::Right => WindowSide::Left,
    }
}

/// Where the [`WindowSide`] is kept that was used last.
fn in_use() -> Id {
    Id::unique("side in use")
}

/// Where the [`Pull`] is kept that is under way.
fn pulled() -> Id {
    Id::unique("pulled side")
}

/// Notes that a side is used: where there is no room for both, it is the one that stays.
fn use_side(ui: &Ui, side: WindowSide) {
    ui.data_mut(|data| data.insert_temp(in_use(), side));
}

/// A section that has just been opened is to be seen.
fn show_side_of_opened(ui: &Ui, names: &[Vec<PanelName>; 2]) {
    let id = Id::unique("sections before");
    let before: Option<[Vec<PanelName>; 2]> = ui.data(|data| data.get_temp(id));
    if before.as_ref() == Some(names) {
        return;
    }
    for side in WindowSide::ALL {
        let is_new = |name: &PanelName| {
            before.as_ref().is_some_and(|before| !before.iter().any(|side| side.contains(name)))
        };
        if names[side as usize].iter().any(is_new) {
            use_side(ui, side);
        }
    }
    ui.data_mut(|data| data.insert_temp(id, names.clone()));
}

/// One side of the window, where it has anything to show; the answer is where it lies, unless it is
/// folded to a strip.
pub(super) fn one_side(
    ui: &mut Ui,
    window: &mut Window<'_>,
    frame: Frame,
    side: WindowSide,
    sides: &Sides,
) -> Option<Rect> {
    let names = sides.names[side as usize].as_slice();
    if names.is_empty() {
        return None;
    }
    let panel = match side {
        WindowSide::Left => egui::Panel::left("left"),
        WindowSide::Right => egui::Panel::right("right"),
    };
    // Edges are dragged by [`edge`]: the panel's own handle lies below the view.
    let panel = panel.resizable(false);
    let Some(width) = sides.widths[side as usize] else {
        let frame = frame.inner_margin(Margin::symmetric(2, 8));
        panel.frame(frame).exact_size(Settled::STRIP).show(ui, |ui| strip(ui, side, names));
        return None;
    };
    let panel = panel.frame(frame).exact_size(width);
    let shown = panel.show(ui, |ui| sections(ui, window, names, side));
    let rect = shown.response.rect;
    if ui.input(|input| input.pointer.any_pressed()) && ui.rect_contains_pointer(rect) {
        use_side(ui, side);
    }
    Some(rect)
}

/// What is left of a side for which there is no room: the button that opens it, and folds the other.
fn strip(ui: &mut Ui, side: WindowSide, names: &[PanelName]) {
    ui.spacing_mut().button_padding.x = 3.0;
    let arrow = match side {
        WindowSide::Left => "»",
        WindowSide::Right => "«",
    };
    let titles: Vec<&str> = names.iter().map(|name| about(*name).title).collect();
    let tip = format!("Open {}; the window has no room for both sides", titles.join(", "));
    let button = Button::new(arrow).min_size(vec2(ui.available_width(), 60.0));
    if ui.add(button).on_hover_text(tip).clicked() {
        use_side(ui, side);
        ui.ctx().request_repaint();
    }
}

/// The edge of a side, which the user may drag from a little inside and outside of it.
pub(super) fn edge(
    ui: &Ui,
    side: WindowSide,
    rect: Rect,
    sides: &Sides,
    world: &World<'_>,
    commands: &mut Vec<Command>,
) {
    let (x, outwards) = match side {
        WindowSide::Left => (rect.right(), 1.0),
        WindowSide::Right => (rect.left(), -1.0),
    };
    let grip = Rect::from_x_y_ranges(x - GRIP..=x + GRIP, rect.y_range());
    let response = ui.interact(grip, Id::unique(("edge", side as usize)), Sense::DRAG);
    let name = format!("Edge of the {side} side");
    response.widget_info(|| WidgetInfo::labeled(Role::Splitter, true, name.as_str()));
    if response.hovered() || response.dragged() {
        ui.ctx().set_cursor_icon(CursorIcon::ResizeHorizontal);
        ui.painter().vline(x, rect.y_range(), ui.visuals().widgets.hovered.fg_stroke);
    }
    if response.drag_started() {
        let pull = Pull { side, from: rect.width(), now: rect.width() };
        ui.data_mut(|data| data.insert_temp(pulled(), pull));
    }
    let pull: Option<Pull> = ui.data(|data| data.get_temp(pulled()));
    let Some(pull) = pull.filter(|pull| pull.side == side) else { return };
    let layout = &world.settings.layout;
    if let Some(by) = response.total_drag_delta() {
        let least = f32::from(WIDTHS.low);
        let now = (pull.from + outwards * by.x).max(least).min(sides.most(side, layout)).round();
        if now != pull.now {
            ui.data_mut(|data| data.insert_temp(pulled(), Pull { now, ..pull }));
            // The sides were laid out before.
            ui.ctx().request_repaint();
        }
    } else {
        ui.data_mut(|data| data.remove::<Pull>(pulled()));
        if (pull.now - pull.from).abs() >= 2.0 {
            keep_widths(sides, layout, commands);
        }
    }
}

/// Remembers the widths that the user has made: the other side's, too, where it had to yield.
fn keep_widths(sides: &Sides, layout: &Settled, commands: &mut Vec<Command>) {
    for side in WindowSide::ALL {
        let Some(width) = sides.widths[side as usize] else { continue };
        let points = (width.round() as u16).clamp(WIDTHS.low, WIDTHS.high);
        if points != layout.width(side) {
            commands.push(Command::Layout(LayoutCommand::Width(side, points)));
        }
    }
}

/// The sections of one side, each under its heading.
fn sections(ui: &mut Ui, window: &mut Window<'_>, names: &[PanelName], side: WindowSide) {
    let Window { panels, world, commands } = window;
    // To the side as well: rows that do not wrap may be wider than a side in a small window.
    ScrollArea::both().auto_shrink(false).show(ui, |ui| {
        let width = ui.available_width();
        let mut pointed = None;
        for &name in names {
            let found = panels.iter_mut().find(|(slot, _)| *slot == Slot::Section(name));
            let Some((_, panel)) = found else { continue };
            let shown = ui.scope(|ui| {
                // A row that is too wide does not widen the sections below it.
                ui.set_max_width(width);
                heading::show(ui, name, world, commands);
                if !world.settings.layout.is_folded(name) {
                    ui.push_id(name as usize, |ui| panel.ui(ui, world, commands));
                    ui.add_space(14.0);
                }
            });
            let above = shown.response.rect.top() - ui.min_rect().top();
            hold(ui, name, above);
            let is_asked = ui.data(|data| data.get_temp(revealed())) == Some(name);
            if is_asked {
                ui.data_mut(|data| data.remove::<PanelName>(revealed()));
            }
            let is_picked = name == PanelName::Path && picked_anew(ui, world);
            let is_hidden = shown.response.rect.top() + READABLE > ui.clip_rect().bottom()
                || shown.response.rect.top() < ui.clip_rect().top();
            if is_asked || is_picked && is_hidden {
                shown.response.scroll_to_me(Some(egui::Align::Min));
            }
            if shown.response.contains_pointer() {
                pointed = Some((name, above));
            }
            heading::receive(ui, &shown.response, name, commands);
            copy_by_key(ui, &shown.response, name, commands);
        }
        ui.data_mut(|data| data.insert_temp(ui.scope_id(), pointed));
        // What is dropped below the last one goes to the foot of the side.
        let foot = vec2(width, FOOT);
        let (_, rest) = ui.allocate_exact_size(foot, Sense::hover());
        if let Some(dragged) = rest.dnd_release_payload::<PanelName>() {
            let place = match side {
                WindowSide::Left => Move::Left,
                WindowSide::Right => Move::Right,
            };
            commands.push(Command::Layout(LayoutCommand::Arrange(*dragged, place)));
        }
    });
}

/// Opens a section and scrolls to it: what someone asked to see appears there.
pub(super) fn reveal(ui: &Ui, name: PanelName, world: &World<'_>, commands: &mut Vec<Command>) {
    let layout = &world.settings.layout;
    if !layout.is_open(name) {
        commands.push(Command::Layout(LayoutCommand::Panel(name, Switch::On)));
    }
    if layout.is_folded(name) {
        commands.push(Command::Layout(LayoutCommand::Fold(name, Switch::Off)));
    }
    use_side(ui, if layout.is_left(name) { WindowSide::Left } else { WindowSide::Right });
    ui.data_mut(|data| data.insert_temp(revealed(), name));
}

/// Notes that the user has clicked on a path in the view, whose section is to be seen.
pub(super) fn reveal_pick(ui: &Ui) {
    ui.data_mut(|data| data.insert_temp(Id::unique("picked in the view"), true));
}

/// True once after a click on a path in the view.
fn picked_anew(ui: &Ui, world: &World<'_>) -> bool {
    let id = Id::unique("picked in the view");
    let clicked: Option<bool> = ui.data_mut(|data| data.remove_temp(id));
    clicked.is_some() && world.selection.is_some()
}

/// Where the section is kept that is to be scrolled to.
fn revealed() -> Id {
    Id::unique("revealed section")
}

/// Scrolls by as much as the sections above the one under the cursor have grown since the last frame,
/// which began it `above` points below the first: no button runs away from who is about to press it.
fn hold(ui: &Ui, name: PanelName, above: f32) {
    let pointed: Option<(PanelName, f32)> = ui.data(|data| data.get_temp(ui.scope_id())).flatten();
    if let Some((_, before)) =
        pointed.filter(|(pointed, before)| *pointed == name && *before != above)
    {
        let moved = vec2(0.0, before - above);
        ui.scroll_with_delta_animation(moved, egui::style::ScrollAnimation::none());
    }
}

/// Ctrl+C over a section copies what it says, unless a text is selected or written.
fn copy_by_key(ui: &Ui, response: &Response, name: PanelName, commands: &mut Vec<Command>) {
    let ctx = ui.ctx();
    let is_copy = |event: &Event| matches!(event, Event::Copy);
    if !response.contains_pointer() || !ui.input(|input| input.events.iter().any(is_copy)) {
        return;
    }
    let selects = ctx.plugin::<LabelSelectionState>().lock().has_selection();
    if !selects && !ctx.egui_wants_keyboard_input() {
        ui.input_mut(|input| input.events.retain(|event| !is_copy(event)));
        commands.push(Command::Desktop(DesktopCommand::Copy(Part::Panel(name))));
    }
}
