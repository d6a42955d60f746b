//! The filter panel under a user's hand, without a window.

use common::{
    ChainId, ExplorerCommand, Filter, FilterCounts, FilterReply, NearestMiss, Order, PathId, Seed,
    Shortfall, Statistics,
};
use egui::Key;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;

use super::*;
use crate::panel::tests::{Fixture, shows};
use crate::source::model::Model;
use crate::synthetic::{mesh, welcome};
use crate::value::{Sphere, Switch};

fn set(text: &str) -> FilterCommand {
    FilterCommand::Set(FilterText::read(text))
}

/// The panel before a scene with names.
fn fixture() -> Fixture {
    let mut fixture = Fixture::new(FilterPanel::default());
    fixture.status.welcome(welcome());
    fixture.model = Model::new(mesh());
    fixture
}

/// Does what the panel asked for, as the viewer does; answers it.
fn obey(harness: &mut Harness<'_, Fixture>) -> Vec<Command> {
    harness.run_steps(3);
    let said = std::mem::take(&mut harness.state_mut().said);
    for command in &said {
        if let Command::Filter(command) = command {
            harness.state_mut().settings.filter.apply(command);
        }
    }
    harness.run_steps(3);
    said
}

fn click(harness: &mut Harness<'_, Fixture>, label: &str) -> Vec<Command> {
    harness.get_by_label(label).click();
    obey(harness)
}

/// A filter of a sphere and a text, which no path passes.
fn fruitless() -> Fixture {
    let mut fixture = fixture();
    let sphere = Sphere { kind: SelectorKind::Any, place: [0.0, 1.0, 0.0, 0.5] };
    fixture.settings.filter.apply(&FilterCommand::Add(sphere));
    fixture.settings.filter.apply(&set("edges >= 4 and dwell > 2"));
    let path = PathId { chain: ChainId(3), epoch: 0, step: 77 };
    let failed =
        vec![Shortfall { condition: 0, by: Some(0.25) }, Shortfall { condition: 1, by: Some(2.0) }];
    let nearest = Some(NearestMiss { path, asked: 3, failed });
    let conditions = vec![0, 250, 900];
    let counts = FilterCounts { seen: 1000, conditions, nearest, ..Default::default() };
    fixture.status.statistics(Statistics { filter: counts, ..Statistics::default() });
    let conditions = ["any in sphere(0, 1, 0, 0.5)", "edges >= 4", "dwell > 2"];
    let conditions = conditions.map(str::to_owned).to_vec();
    fixture.status.filter = Some(FilterReply { conditions, ..FilterReply::default() });
    fixture
}

#[test]
fn an_empty_result_explains_the_nearest_miss_and_offers_what_to_do() {
    let mut harness = fruitless().harness();
    harness.run_steps(3);
    for text in [
        "0 matching of 1.00 k seen",
        "No path matches",
        "1 of 3 conditions hold for the nearest path; fails sphere 1 by 0.25, and fails `edges >= 4` by 2",
        "25.0 %",
    ] {
        assert!(shows(&harness, text), "`{text}` is missing");
    }
    let sphere = |radius: f64| Command::Filter(FilterCommand::Move(0, [0.0, 1.0, 0.0, radius]));
    assert_eq!(click(&mut harness, "Widen sphere 1"), [sphere(0.765)], "0.75, and a little more");
    let text = |text: &str| Command::Filter(set(text));
    let loosened = text("edges >= 2 and dwell > 2");
    assert_eq!(click(&mut harness, "Loosen the bound"), [loosened], "as the nearest has");
    assert_eq!(click(&mut harness, "Drop this condition"), [text("dwell > 2")], "without it");
    let id = PathId { chain: ChainId(3), epoch: 0, step: 77 };
    let seed = Command::Order(Order::Explorer(ExplorerCommand::Seed(Seed::Path(id))));
    assert_eq!(click(&mut harness, "Explore from the nearest path"), [seed], "by its name");
    let off = Command::Filter(FilterCommand::Enable(Switch::Off));
    assert_eq!(click(&mut harness, "Show all paths"), [off], "the way out");
    let invert = Command::Filter(FilterCommand::Invert(Switch::On));
    harness.get_all_by_label("Invert").last().expect("a button").click();
    assert_eq!(obey(&mut harness), [invert], "the others");
    let delete = Command::Filter(FilterCommand::Delete(0));
    assert_eq!(click(&mut harness, "Delete sphere 1"), [delete], "without the sphere");
}

#[test]
fn what_is_wanted_follows_every_switch() {
    let mut filter = crate::settings::FilterSettings::default();
    assert_eq!(filter.whole().text(), "", "all paths");
    filter.apply(&FilterCommand::Invert(Switch::On));
    assert_eq!(filter.whole().text(), "", "there is nothing to invert");
    filter.apply(&set("edges == 2"));
    assert_eq!(filter.whole().text(), "not edges == 2");
    filter.apply(&FilterCommand::Keep("longer".to_owned()));
    filter.apply(&FilterCommand::Clear);
    assert_eq!(filter.whole().text(), "", "what is kept does not hold by itself");
    filter.apply(&FilterCommand::Use(Switch::On, "longer".to_owned()));
    assert_eq!(filter.whole().text(), "not edges == 2", "now it does");
    filter.apply(&set("dwell > 3"));
    filter.apply(&FilterCommand::Reverse(Switch::Toggle, "longer".to_owned()));
    assert_eq!(filter.whole().text(), "dwell > 3 and edges == 2", "beside the text, turned round");
    filter.apply(&FilterCommand::Enable(Switch::Off));
    assert_eq!(filter.whole().text(), "", "switched off");
    filter.apply(&FilterCommand::Load("longer".to_owned()));
    assert_eq!((filter.text().text(), filter.whole().text()), ("edges == 2", "edges == 2"));
    for (name, text, _) in PRESETS {
        assert!(Filter::parse(text).is_ok(), "{name}");
    }
}

/// Writes into the text of the filter.
fn write(harness: &mut Harness<'_, Fixture>, text: &str) {
    harness.get_by_label("Text of the filter").focus();
    harness.run_steps(2);
    harness.get_by_label("Text of the filter").type_text(text);
    harness.run_steps(3);
}

fn press(harness: &mut Harness<'_, Fixture>, key: Key) -> Vec<Command> {
    harness.key_press(key);
    obey(harness)
}

#[test]
fn words_and_names_are_completed_by_tab() {
    let mut harness = fixture().harness();
    harness.run_steps(3);
    write(&mut harness, "any on ma");
    assert!(shows(&harness, "material"), "a word of the grammar");
    press(&mut harness, Key::Tab);
    assert!(shows(&harness, "\"lamp\""), "a name of the scene");
    press(&mut harness, Key::ArrowDown);
    press(&mut harness, Key::Tab);
    assert_eq!(press(&mut harness, Key::Escape), [], "what is offered next is sent away");
    let set = set("any on material \"wall\"");
    // It is asked for in every frame until it is done.
    let said = press(&mut harness, Key::Enter);
    assert_eq!(said.first(), Some(&Command::Filter(set)), "Press Enter to apply");
}

#[test]
fn a_mistake_is_told_with_its_place_and_changes_nothing() {
    let mut harness = fixture().harness();
    harness.run_steps(3);
    write(&mut harness, "edges >= 3 and any in spere(0, 0, 0, 1)");
    assert!(shows(&harness, "Character 23"), "where");
    assert!(shows(&harness, "found `spere`"), "what");
    assert_eq!(press(&mut harness, Key::Enter), [], "no filter");
    press(&mut harness, Key::Escape);
    assert!(!shows(&harness, "Character"), "taken back");
}

#[test]
fn two_vertices_that_were_meant_to_be_one_are_pointed_out() {
    let mut fixture = fixture();
    fixture.settings.filter.apply(&set("lpe \"CRDL\""));
    let mut harness = fixture.harness();
    harness.run_steps(3);
    assert!(shows(&harness, "`<RD>` is one vertex"), "a hint");
}

#[test]
fn filters_are_kept_used_turned_written_and_forgotten() {
    let mut fixture = fixture();
    fixture.settings.filter.apply(&set("edges >= 4"));
    let mut harness = fixture.harness();
    harness.run_steps(3);
    harness.get_by_label("Name of the filter").focus();
    harness.run_steps(2);
    harness.get_by_label("Name of the filter").type_text("long  ones");
    harness.run_steps(2);
    let command = |command| [Command::Filter(command)];
    let name = || "long ones".to_owned();
    assert_eq!(click(&mut harness, "Keep"), command(FilterCommand::Keep(name())));
    assert!(shows(&harness, "long ones"), "it is listed");
    let switch = harness.get_all_by_role(egui::accesskit::Role::CheckBox).next();
    switch.expect("its switch").click();
    assert_eq!(obey(&mut harness), command(FilterCommand::Use(Switch::On, name())));
    harness.get_all_by_label("not").last().expect("its not").click();
    assert_eq!(obey(&mut harness), command(FilterCommand::Reverse(Switch::Toggle, name())));
    assert_eq!(click(&mut harness, "Edit"), command(FilterCommand::Load(name())));
    assert_eq!(harness.state().settings.filter.whole().text(), "not edges >= 4", "turned round");
    harness.get_all_by_label("×").last().expect("its cross").click();
    assert_eq!(obey(&mut harness), command(FilterCommand::Forget(name())));
}
