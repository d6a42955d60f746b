//! Sections that fold, move, explain and are copied; the bar at the foot; what is copied.

use common::{Attendee, Author, ChainState, FilterText, Notice, Presence, Role};
use egui::accesskit::Role as WidgetRole;
use egui::{Modifiers, PointerButton};

use super::*;
use crate::command::{DesktopCommand, FilterCommand, LayoutCommand};
use crate::panel::{heading, image, status, text_of, viewport};
use crate::source::status::LinkState;
use crate::synthetic::{batch, welcome};
use crate::value::MousePreset;
use crate::value::{Move, Part, Switch};

/// A heading alone.
#[derive(Debug)]
struct Heading;

impl Panel for Heading {
    fn ui(&mut self, ui: &mut Ui, world: &World<'_>, commands: &mut Vec<Command>) {
        heading::show(ui, PanelName::Statistics, world, commands);
    }
}

#[test]
fn a_section_is_folded_moved_explained_copied_and_closed_at_its_heading() {
    let mut harness = Fixture::new(Heading).harness();
    harness.run_steps(2);
    let mut click = |labels: &[&str]| {
        for label in labels {
            harness.get_by_label(label).click();
            harness.run_steps(4);
        }
        std::mem::take(&mut harness.state_mut().said)
    };
    let name = PanelName::Statistics;
    let layout = |command| vec![Command::Layout(command)];
    assert_eq!(click(&["Statistics"]), layout(LayoutCommand::Fold(name, Switch::On)));
    let closed = layout(LayoutCommand::Panel(name, Switch::Off));
    assert_eq!(click(&["×"]), closed, "close");
    let copied = vec![Command::Desktop(DesktopCommand::Copy(Part::Panel(name)))];
    assert_eq!(click(&["…", "Copy as text"]), copied, "copy");
    let left = layout(LayoutCommand::Arrange(name, Move::Left));
    assert_eq!(click(&["…", "Move to the left side"]), left, "move");
    assert_eq!(click(&["?"]), [], "a sheet");
    assert!(shows(&harness, "Counts over all chains since the epoch began"), "what it is for");
}

#[test]
fn the_bar_at_the_foot_tells_who_drives_what() {
    let mut fixture = Fixture::new(status::StatusBar);
    fixture.status.welcome(welcome());
    fixture.status.link = LinkState::Connected;
    fixture.status.statistics(statistics());
    fixture.status.latency = Some(std::time::Duration::from_micros(2500));
    let chains = ChainState { running: false, ..ChainState::default() };
    fixture.status.steering.accept(Notice::Chains(chains));
    let author = Author { session: 9, name: "Ada".to_owned() };
    let driver = Attendee { author, role: Role::Driver, ..Attendee::default() };
    fixture.status.steering.accept(Notice::Presence(Presence { viewers: vec![driver] }));
    let mut harness = fixture.harness();
    harness.set_size(vec2(1280.0, 40.0));
    harness.run_steps(3);
    for text in ["Connected to", "Chains paused", "Ada drives", "2.5", "dropped", "mutations/s"] {
        assert!(shows(&harness, text), "`{text}` is missing");
    }
}

#[test]
fn every_part_has_a_text_for_the_clipboard() {
    let mut fixture = Fixture::new(status::StatusBar);
    fixture.status.welcome(welcome());
    fixture.status.link = LinkState::Connected;
    fixture.status.statistics(diagnosed());
    fixture.settings.filter.apply(&FilterCommand::Set(FilterText::read("edges >= 3")));
    let paths = batch(&[&[[1.0, 2.0, 3.0], [4.0, 6.0, 3.0]]]);
    let mut reader = paths.reader();
    let path = reader.next().expect("a path");
    fixture.selection = Some(Selection::new(path.header, path.vertices.to_vec()));
    let text = |source| text_of(&fixture.world(), source);
    for (source, expected) in [
        (Part::Status, "daemon\t127.0.0.1:50061"),
        (Part::Panel(PanelName::Statistics), "bidirectional\t2000\t1500\t250\t0.45"),
        (Part::Panel(PanelName::Filter), "edges >= 3"),
        (Part::Panel(PanelName::Path), "x1 D"),
        (Part::Panel(PanelName::Diagnostics), "R-hat of the worst tile\t1.37"),
        (Part::Panel(PanelName::Image), "exposure"),
        (Part::Panel(PanelName::Explorer), "accepted"),
    ] {
        let text = text(source);
        assert!(text.contains(expected), "{source:?}: `{expected}` is missing in\n{text}");
    }
    for source in [PanelName::Cloud, PanelName::Scene] {
        let script = text(Part::Panel(source));
        assert!(script.lines().count() > 5, "{script}");
        for line in script.lines() {
            assert!(line.parse::<Command>().is_ok(), "`{line}` is no command");
        }
    }
}

#[test]
fn the_raw_values_of_a_pixel_are_copied() {
    let mut fixture = Fixture::new(image::ImagePanel::default());
    let rgb = [0.125, 0.25, 0.5].repeat(40 * 30);
    let tile =
        common::FilmTile { sequence: 1, width: 40, height: 30, first_row: 0, steps: 99, rgb };
    assert!(fixture.film.accept(&tile), "a whole image");
    let mut harness = fixture.harness();
    harness.run_steps(3);
    let film = harness.get_by_role(WidgetRole::Image).rect();
    harness.hover_at(film.center());
    harness.run_steps(2);
    harness.event(Event::Copy);
    harness.step();
    let copied = harness.output().platform_output.commands.iter().find_map(|c| match c {
        egui::OutputCommand::CopyText(text) => Some(text.clone()),
        _ => None,
    });
    let copied = copied.expect("something was copied");
    assert!(copied.contains("1.25e-1\t2.5e-1\t5e-1"), "{copied}");
}

#[test]
fn channels_and_visible_differences_are_asked_for() {
    use crate::command::ImageCommand;
    use crate::value::{Channel, Layer};
    let mut fixture = Fixture::new(image::ImagePanel::default());
    let tile = common::FilmTile {
        sequence: 1,
        width: 40,
        height: 30,
        first_row: 0,
        steps: 99,
        rgb: vec![0.5; 3600],
    };
    assert!(fixture.film.accept(&tile), "a whole image");
    let pixels = vec![common::Rgb::grey(0.25); 1200];
    fixture.reference = Some(Reference { name: "r.exr".to_owned(), width: 40, height: 30, pixels });
    let mut harness = fixture.harness();
    harness.run_steps(3);
    for label in ["Y", "Measure"] {
        harness.get_by_label(label).click();
        harness.run_steps(3);
    }
    let expected = [ImageCommand::Channel(Channel::Luminance), ImageCommand::Show(Layer::Flip)];
    assert_eq!(harness.state().said, expected.map(Command::Image));
    let state = harness.state_mut();
    let errors = vec![0.25; 1200];
    state.flip = Some(crate::imaging::FlipMap { errors, mean: 0.25, steps: 99 });
    state.settings.image.layer = Layer::Flip;
    harness.run_steps(3);
    assert!(shows(&harness, "0.2500"), "the mean");
    assert!(shows(&harness, "FLIP: the difference that a person perceives"), "a legend");
}

/// What a drag with a button and modifiers does to the camera.
fn dragged(mouse: MousePreset, button: PointerButton, modifiers: Modifiers) -> Vec<String> {
    let mut fixture = Fixture::new(viewport::Viewport::default());
    fixture.settings.window.mouse = mouse;
    let mut harness = fixture.harness();
    harness.run_steps(2);
    let view = harness.get_by_role_and_label(WidgetRole::Canvas, "Viewport").rect();
    let press = |pos, pressed| Event::PointerButton { pos, button, pressed, modifiers };
    let (from, to) = (view.center(), view.center() + vec2(60.0, 40.0));
    let held = Event::ModifiersChanged(modifiers);
    for event in [held, Event::PointerMoved(from), press(from, true), Event::PointerMoved(to)] {
        harness.event(event);
        harness.step();
    }
    harness.event(press(to, false));
    harness.run_steps(2);
    let said = harness.state().said.iter().map(ToString::to_string);
    let words = said.map(|text| text.split(' ').take(2).collect::<Vec<_>>().join(" "));
    let mut verbs: Vec<String> = words.filter(|words| words.starts_with("camera")).collect();
    verbs.dedup();
    verbs
}

#[test]
fn dragging_does_what_other_programs_made_a_habit() {
    use PointerButton::{Middle, Primary, Secondary};
    let (plain, alt) = (Modifiers::NONE, Modifiers::ALT);
    let (shift, ctrl) = (Modifiers::SHIFT, Modifiers::CTRL | Modifiers::COMMAND);
    for (mouse, button, modifiers, expected) in [
        (MousePreset::Rerun, Primary, plain, "camera orbit"),
        (MousePreset::Rerun, Secondary, plain, "camera pan"),
        (MousePreset::Rerun, Primary, shift, "camera pan"),
        (MousePreset::Blender, Primary, plain, ""),
        (MousePreset::Blender, Middle, plain, "camera orbit"),
        (MousePreset::Blender, Middle, shift, "camera pan"),
        (MousePreset::Blender, Middle, ctrl, "camera zoom"),
        (MousePreset::Maya, Primary, plain, ""),
        (MousePreset::Maya, Primary, alt, "camera orbit"),
        (MousePreset::Maya, Middle, alt, "camera pan"),
        (MousePreset::Maya, Secondary, alt, "camera zoom"),
    ] {
        let verbs = dragged(mouse, button, modifiers);
        assert_eq!(verbs.join(" "), expected, "{mouse} {button:?} {modifiers:?}");
    }
}

#[test]
fn every_name_has_its_section() {
    let names: Vec<_> = SECTIONS.iter().map(|about| about.name).collect();
    assert_eq!(names, PanelName::ALL, "each once, and in the same order");
    for about in SECTIONS {
        let said = std::iter::once(about.title).chain(about.help.iter().copied());
        assert!(about.help.len() <= 3 && said.clone().all(|text| !text.is_empty()), "{about:?}");
    }
}
