//! The tree under a user's hand: every condition can be made without writing.

use common::Filter;
use egui::accesskit::Role;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;

use super::*;
use crate::command::Command;
use crate::panel::Panel;
use crate::panel::tests::Fixture;
use crate::source::model::Model;
use crate::synthetic::{mesh, welcome};

/// The builder alone.
#[derive(Debug)]
struct Alone;

impl Panel for Alone {
    fn ui(&mut self, ui: &mut Ui, world: &World<'_>, commands: &mut Vec<Command>) {
        super::ui(ui, world, &mut |command| commands.push(Command::Filter(command)));
    }
}

fn builder(text: &str) -> Harness<'static, Fixture> {
    let mut fixture = Fixture::new(Alone);
    fixture.status.welcome(welcome());
    fixture.model = Model::new(mesh());
    fixture.settings.filter.apply(&FilterCommand::Set(FilterText::read(text)));
    let mut harness = fixture.harness();
    harness.run_steps(3);
    harness
}

/// The text after the panel's commands.
fn text(harness: &mut Harness<'_, Fixture>) -> String {
    harness.run_steps(3);
    for command in std::mem::take(&mut harness.state_mut().said) {
        if let Command::Filter(command) = command {
            harness.state_mut().settings.filter.apply(&command);
        }
    }
    harness.run_steps(3);
    harness.state().settings.filter.text().to_string()
}

fn click(harness: &mut Harness<'_, Fixture>, label: &str) -> String {
    harness.get_all_by_label(label).last().expect(label).click();
    text(harness)
}

/// Follows a menu into its submenus.
fn choose(harness: &mut Harness<'_, Fixture>, labels: &[&str]) -> String {
    let mut last = String::new();
    for label in labels {
        last = click(harness, label);
    }
    last
}

#[test]
fn every_condition_can_be_made_from_the_menu() {
    for (labels, begins) in [
        (["Sphere", ""], "any in sphere("),
        (["Box", ""], "any in box("),
        (["Segment through a box", ""], "any through box("),
        (["Light path expression", ""], "lpe \"C.*L\""),
        (["Part of the film", ""], "film in rect(0.25, 0.25, 0.75, 0.75)"),
        (["Object", "room"], "any on object \"room\""),
        (["Material", "wall"], "any on material \"wall\""),
        (["Light", "lamp"], "start on light \"lamp\""),
        (["Scattering", "glossy"], "any is glossy"),
        (["Number", "acceptance"], "acceptance <= 0.1"),
        (["Strategy", "lens"], "strategy == \"lens\""),
    ] {
        let mut harness = builder("");
        click(&mut harness, "+ Condition");
        let labels: Vec<&str> = labels.into_iter().filter(|label| !label.is_empty()).collect();
        let text = choose(&mut harness, &labels);
        assert!(text.starts_with(begins), "{labels:?} make `{text}`");
        assert!(Filter::parse(&text).is_ok(), "{text}");
    }
}

#[test]
fn groups_are_made_joined_turned_and_dissolved() {
    let mut harness = builder("edges >= 3");
    click(&mut harness, "+ Condition");
    let two = choose(&mut harness, &["Scattering", "glossy"]);
    assert_eq!(two, "edges >= 3 and any is glossy", "both");
    harness.get_all_by_role(Role::ComboBox).next().expect("how they are joined").click();
    harness.run_steps(3);
    let either = click(&mut harness, "any of");
    assert_eq!(either, "edges >= 3 or any is glossy", "either");
    // The first `not` is that of the whole group.
    harness.get_all_by_label("not").next().expect("a group").click();
    assert_eq!(text(&mut harness), "not (edges >= 3 or any is glossy)", "neither");
    harness.get_all_by_label("not").next().expect("a group").click();
    assert_eq!(text(&mut harness), "edges >= 3 or any is glossy", "and back");
    assert_eq!(click(&mut harness, "not"), "edges >= 3 or not any is glossy", "the last");
    // A group within the group.
    harness.get_all_by_label("…").next().expect("a condition").click();
    harness.run_steps(3);
    let nested = choose(&mut harness, &["and …", "Number", "dwell"]);
    assert_eq!(nested, "edges >= 3 and dwell >= 100 or not any is glossy", "a group");
    assert_eq!(click(&mut harness, "×"), "edges >= 3 and dwell >= 100", "without the last");
    harness.get_all_by_label("×").next().expect("a group").click();
    assert_eq!(text(&mut harness), "", "all paths");
}

#[test]
fn text_and_tree_are_the_same_filter() {
    for filter in [
        "any in sphere(0, 1, 0, 0.5) and start on light \"lamp\"",
        "any (on material \"wall\" and in box(0, 0, 0, 1, 1, 1)) and edges in 3..6",
        "not (all through sphere(1, 2, 3, 4) or lpe \"C.*<RD>L\")",
        "strategy in (\"lens\", \"seed\") or film in rect(0, 0, 0.5, 0.5)",
        "any not (is diffuse or is glossy) and chain != 3 and false",
    ] {
        let mut harness = builder(filter);
        assert_eq!(text(&mut harness), filter, "showing it changes nothing");
        assert_eq!(harness.state().said, [], "{filter}");
    }
    let beyond = "film in rect(-0.5, 0, 2, 0.5) and luminance >= -1";
    assert_eq!(text(&mut builder(beyond)), beyond, "not even what no hand would choose");
    let mut harness = builder("any (on material \"wall\" and is diffuse)");
    assert_eq!(click(&mut harness, "and"), "any (on material \"wall\" or is diffuse)", "a click");
    let mut harness = builder("any is diffuse");
    let same = choose(&mut harness, &["&", "Material", "wall"]);
    assert_eq!(same, "any (is diffuse and on material \"wall\")", "at the same vertex");
}

/// Chooses in the list of this number within a row.
fn select(harness: &mut Harness<'_, Fixture>, list: usize, label: &str) -> String {
    harness.get_all_by_role(Role::ComboBox).nth(list).expect("a list").click();
    harness.run_steps(3);
    click(harness, label)
}

#[test]
fn every_part_of_a_condition_can_be_changed_in_its_place() {
    let mut harness = builder("any in sphere(0, 1, 0, 0.5)");
    assert_eq!(select(&mut harness, 0, "all"), "all in sphere(0, 1, 0, 0.5)", "the place");
    let cube = "all in box(-0.5, 0.5, -0.5, 0.5, 1.5, 0.5)";
    assert_eq!(select(&mut harness, 2, "box"), cube, "the shape, around the same point");
    assert_eq!(select(&mut harness, 1, "is"), "all is specular", "what is asked");
    assert_eq!(select(&mut harness, 1, "on"), "all on material \"lamp\"", "a name of the scene");
    assert_eq!(select(&mut harness, 2, "object"), "all on object \"room\"", "of each kind");
    let mut harness = builder("edges >= 3");
    assert_eq!(select(&mut harness, 1, "in"), "edges in 3..3", "a range from the number");
    assert_eq!(select(&mut harness, 0, "dwell"), "dwell in 3..3", "of another one");
    assert_eq!(select(&mut harness, 1, "<"), "dwell < 3", "and back");
    let mut harness = builder("strategy == \"lens\"");
    assert_eq!(select(&mut harness, 0, "!="), "strategy != \"lens\"", "all but this one");
    assert_eq!(select(&mut harness, 0, "in"), "strategy in (\"lens\")", "several");
}

#[test]
fn tests_of_one_vertex_have_lines_of_their_own() {
    let text = "any (in sphere(0, 1, 0, 0.5) and on material \"lamp\" and not is diffuse)";
    let mut harness = builder(text);
    harness.set_size(vec2(268.0, 600.0));
    harness.run_steps(3);
    let lists: Vec<_> = harness.get_all_by_role(Role::ComboBox).map(|node| node.rect()).collect();
    assert_eq!(lists.len(), 8, "place; in, sphere; on, material, lamp; is, diffuse");
    for list in &lists {
        assert!(list.height() < 30.0 && list.right() <= 268.0, "a narrow place: {list}");
    }
    assert!(lists[3].top() > lists[2].bottom() && lists[6].top() > lists[5].bottom(), "lines");
}

#[test]
fn the_menu_of_a_condition_stays_at_the_end_of_its_line() {
    let width = 268.0;
    for filter in ["edges >= 3", "any in sphere(0, 1, 0, 0.5)", "any through box(0, 0, 0, 1, 1, 1)"]
    {
        let mut harness = builder(filter);
        harness.set_size(vec2(width, 600.0));
        harness.run_steps(3);
        let first = harness.get_by_label("×").rect();
        let menu = harness.get_by_label("…").rect();
        let off = (menu.center().y - first.center().y).abs();
        assert!(off < 6.0, "{filter}: {off} points below the line");
        // The harness leaves eight points round everything.
        let end = width - 8.0;
        assert!(
            (end - 24.0..=end).contains(&menu.right()),
            "{filter}: it ends at {}",
            menu.right()
        );
    }
}
