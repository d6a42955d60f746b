//! The image, its comparison and its maps.

use common::{FilmTile, FilterText};
use egui::accesskit::Role as WidgetRole;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;

use super::{Fixture, diagnosed, shows};
use crate::command::{Command, FilterCommand, ImageCommand};
use crate::imaging::Reference;
use crate::panel::hover::{self, Pointed};
use crate::panel::{Panel, image};
use crate::world::World;

/// The image between others, on a side that scrolls.
#[derive(Debug)]
struct Scrolled(image::ImagePanel);

impl Panel for Scrolled {
    fn ui(&mut self, ui: &mut egui::Ui, world: &World<'_>, commands: &mut Vec<Command>) {
        egui::ScrollArea::vertical().show(ui, |ui| {
            ui.add_space(300.0);
            self.0.ui(ui, world, commands);
            ui.add_space(900.0);
        });
    }
}

#[test]
fn who_scrolls_the_side_does_not_zoom_the_image_that_comes_by() {
    let mut fixture = Fixture::new(Scrolled(image::ImagePanel::default()));
    fixture.film = image_stage(false).film;
    let mut harness = fixture.harness();
    harness.run_steps(3);
    let turn = |points: f32| egui::Event::MouseWheel {
        unit: egui::MouseWheelUnit::Point,
        delta: egui::vec2(0.0, points),
        phase: egui::TouchPhase::Move,
        source: egui::MouseWheelSource::Unknown,
        modifiers: egui::Modifiers::NONE,
    };
    let film = harness.get_by_role_and_label(WidgetRole::Image, "Film").rect();
    let place = egui::pos2(film.center().x, film.top() - 50.0);
    harness.hover_at(place);
    harness.run_steps(2);
    for _ in 0..5 {
        harness.event(turn(-40.0));
        harness.step();
    }
    harness.run_steps(6);
    let film = harness.get_by_role_and_label(WidgetRole::Image, "Film").rect();
    assert!(film.contains(place), "the image has come under the cursor: {film:?}");
    assert_eq!(harness.state().said, [], "and is as it was");
    harness.hover_at(place + egui::vec2(20.0, 0.0));
    harness.step();
    harness.event(turn(40.0));
    harness.run_steps(2);
    let zooms = |c: &Command| matches!(c, Command::Image(ImageCommand::Zoom(_)));
    assert!(harness.state().said.iter().any(zooms), "a hand that moved there zooms");
}

#[test]
fn the_image_panel_shows_the_film() {
    let mut fixture = Fixture::new(image::ImagePanel::default());
    let rgb = vec![0.5; 40 * 30 * 3];
    let tile = FilmTile { sequence: 1, width: 40, height: 30, first_row: 0, steps: 2400, rgb };
    assert!(fixture.film.accept(&tile), "a whole image");
    let mut harness = fixture.harness();
    harness.run();
    assert!(shows(&harness, "40 × 30, 2 mutations per pixel"), "size and effort");
    harness.get_by_label("2:1").click();
    harness.run();
    assert_eq!(harness.state().said, [Command::Image(ImageCommand::Zoom(2.0))], "zoom");
}

/// An image panel with a whole film, and perhaps a reference that is a tenth darker.
pub(super) fn image_stage(compared: bool) -> Fixture {
    let mut fixture = Fixture::new(image::ImagePanel::default());
    let rgb = vec![0.5; 40 * 30 * 3];
    let tile = FilmTile { sequence: 1, width: 40, height: 30, first_row: 0, steps: 2400, rgb };
    assert!(fixture.film.accept(&tile), "a whole image");
    let pixels = vec![common::Rgb::grey(0.4); 40 * 30];
    let reference = Reference { name: "right.exr".to_owned(), width: 40, height: 30, pixels };
    fixture.reference = compared.then_some(reference);
    fixture
}

#[test]
fn a_pixel_or_a_rectangle_of_the_image_becomes_the_filter() {
    let mut fixture = image_stage(false);
    let set = |text| FilterCommand::Set(FilterText::read(text));
    fixture.settings.filter.apply(&set("edges >= 3"));
    let mut harness = fixture.harness();
    harness.run();
    let film = harness.get_by_role_and_label(WidgetRole::Image, "Film").rect();
    let pixel = film.height() / 30.0;
    let corner = egui::pos2(film.center().x - 20.0 * pixel, film.top());
    let at = |x: f32, y: f32| corner + pixel * egui::vec2(x, y);
    let filter = |harness: &mut Harness<'_, Fixture>| {
        let said = harness.state_mut().said.drain(..).collect::<Vec<_>>();
        match said.as_slice() {
            [Command::Filter(FilterCommand::Set(text))] => text.clone(),
            other => panic!("{other:?} instead of a filter"),
        }
    };
    harness.hover_at(at(10.5, 5.5));
    harness.run();
    assert!(shows(&harness, "10, 5") && shows(&harness, "0.5000"), "the values of a pixel");
    harness.drag_at(at(10.5, 5.5));
    harness.run();
    harness.drop_at(at(10.5, 5.5));
    harness.run();
    let text = filter(&mut harness);
    let [u0, v0, u1, v1] = crate::settings::region::region_of(&text).expect("a rectangle");
    assert!((u0 - 0.25).abs() < 1e-7 && (v0 - 5.0 / 30.0).abs() < 1e-7, "{text}");
    assert!((u1 - 11.0 / 40.0).abs() < 1e-6 && (v1 - 6.0 / 30.0).abs() < 1e-6, "{text}");
    assert!(text.text().contains("edges >= 3"), "the other condition stays: {text}");
    harness.drag_at(at(4.5, 3.5));
    harness.run_steps(1);
    harness.hover_at(at(20.5, 10.5));
    harness.run_steps(2);
    harness.drop_at(at(20.5, 10.5));
    harness.run();
    let text = filter(&mut harness);
    let [u0, v0, u1, v1] = crate::settings::region::region_of(&text).expect("a rectangle");
    let expected = [4.0 / 40.0, 3.0 / 30.0, 21.0 / 40.0, 11.0 / 30.0];
    for (value, expected) in [u0, v0, u1, v1].into_iter().zip(expected) {
        assert!((value - expected).abs() < 1e-6, "{text}");
    }
    harness.state_mut().settings.filter.apply(&FilterCommand::Set(text));
    harness.run();
    assert!(shows(&harness, "Paths to 17 × 8 pixels"), "what is wanted");
    harness.get_by_label("All").click();
    harness.run();
    assert_eq!(filter(&mut harness).text(), "edges >= 3", "and back");
}

#[test]
fn the_image_is_compared_with_a_reference() {
    let mut harness = image_stage(false).harness();
    harness.run();
    harness.get_by_label("Difference").click();
    harness.run();
    assert_eq!(harness.state().said, [], "there is nothing to compare with");
    let mut harness = image_stage(true).harness();
    harness.run();
    // 0.1^2 / (0.4^2 + 0.01)
    for text in ["right.exr", "relMSE", "0.059", "125.00 %"] {
        assert!(shows(&harness, text), "`{text}` is missing");
    }
    for label in ["Difference", "False colour", "Forget"] {
        harness.get_by_label(label).click();
        harness.run();
    }
    let expected = [
        ImageCommand::Show(crate::value::Layer::Difference),
        ImageCommand::Tone(crate::value::ToneCurve::False),
        ImageCommand::Forget,
    ];
    assert_eq!(harness.state().said, expected.map(Command::Image), "three clicks");
    harness.state_mut().settings.image.layer = crate::value::Layer::Error;
    harness.run();
    assert!(shows(&harness, "relative squared error"), "its colours are explained");
}

#[test]
fn maps_wait_for_the_daemon() {
    let mut fixture = image_stage(false);
    fixture.settings.image.layer = crate::value::Layer::Dwell;
    fixture.status.statistics(diagnosed());
    let mut harness = fixture.harness();
    harness.run();
    assert!(shows(&harness, "mean stay at a path"), "its colours are explained");
    let film = harness.get_by_role_and_label(WidgetRole::Image, "Film").rect();
    harness.hover_at(film.center());
    harness.run();
    assert!(shows(&harness, "dwell") && shows(&harness, "8"), "the value under the cursor");
    let mut harness = image_stage(false).harness();
    harness.run();
    harness.get_by_label("Dwell").click();
    harness.run();
    assert_eq!(harness.state().said, [], "there is no map yet");
}

#[test]
fn a_pixel_that_is_pointed_at_is_told_to_the_view() {
    let mut fixture = image_stage(false);
    fixture.selection = Some(super::paths::selected(crate::source::selection::Detail::Unasked));
    let mut harness = fixture.harness();
    harness.run();
    let film = harness.get_by_role_and_label(WidgetRole::Image, "Film").rect();
    harness.hover_at(film.center());
    harness.run_steps(3);
    let Some(Pointed::Film([u, v])) = hover::pointed(&harness.ctx) else {
        panic!("the view draws the ray through it")
    };
    assert!((u - 0.5).abs() < 0.01 && (v - 0.5).abs() < 0.01, "the middle: {u} {v}");
}
