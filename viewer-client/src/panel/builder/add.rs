//! New conditions, from a menu.

use common::{
    Attribute, Comparison, Filter, Leaf, LightPathExpression, Name, Named, Place, VertexClass,
    VertexTest, Volume,
};
use egui::Ui;
use glam::DVec3;

use super::Context;
use crate::panel::widgets::capitalised;

/// A button with every kind of condition; answers the one that was chosen.
pub(super) fn menu(ui: &mut Ui, label: &str, context: &Context) -> Option<Filter> {
    let menu = ui.menu_button(label, |ui| choices(ui, context));
    menu.response.on_hover_text("Add a condition");
    menu.inner.flatten()
}

/// The menu's lines.
pub(super) fn choices(ui: &mut Ui, context: &Context) -> Option<Filter> {
    let mut chosen = None;
    let region = |place, test| Leaf::Vertex { place, test };
    let sphere = Volume::Sphere { centre: DVec3::from(context.centre), radius: context.radius };
    let (middle, half) = (DVec3::from(context.centre), DVec3::splat(context.radius));
    let cube = Volume::Box { min: middle - half, max: middle + half };
    let mut add = |ui: &mut Ui, label: &str, tip: &str, leaf: Leaf| {
        if item(ui, label, tip) {
            chosen = Some(Filter::Leaf(leaf));
        }
    };
    let tip = "A vertex lies in it";
    add(ui, "Sphere", tip, region(Place::Any, VertexTest::Inside(sphere)));
    add(ui, "Box", tip, region(Place::Any, VertexTest::Inside(cube)));
    let tip = "A segment passes through it";
    add(ui, "Segment through a box", tip, Leaf::Segment { place: Place::Any, volume: cube });
    let tip = "The events along the path, such as `CDS+L`";
    if let Ok(expression) = LightPathExpression::parse("C.*L") {
        add(ui, "Light path expression", tip, Leaf::LightPath(expression));
    }
    let tip = "Where on the film the path arrives";
    add(ui, "Part of the film", tip, Leaf::Film { min: [0.25; 2], max: [0.75; 2] });
    ui.separator();
    for kind in Named::ALL {
        let place = if kind == Named::Light { Place::Start } else { Place::Any };
        if let Some(name) = named(ui, kind, context.names.named(kind)) {
            chosen = Some(Filter::Leaf(region(place, VertexTest::On(kind, name))));
        }
    }
    let mut item = |ui: &mut Ui, label: &str, tip: &str, leaf: Leaf| {
        if item(ui, label, tip) {
            chosen = Some(Filter::Leaf(leaf));
        }
    };
    ui.menu_button("Scattering", |ui| {
        for class in VertexClass::ALL {
            let test = VertexTest::Is(class);
            item(ui, class.name(), "A vertex does so", region(Place::Any, test));
        }
    });
    ui.menu_button("Number", |ui| {
        for attribute in Attribute::ALL {
            let (comparison, value) = usual(attribute);
            let leaf = Leaf::Number { attribute, comparison, value };
            item(ui, attribute.name(), meaning(attribute), leaf);
        }
    });
    ui.menu_button("Strategy", |ui| {
        for strategy in context.names.strategies.iter().map(String::as_str).chain(["seed"]) {
            let leaf = Leaf::Strategy(vec![Name::from(strategy)]);
            item(ui, strategy, "It made the path", leaf);
        }
    });
    chosen
}

/// A line of a menu; true when it was clicked, which closes the menu.
fn item(ui: &mut Ui, label: &str, tip: &str) -> bool {
    let button = ui.button(label);
    let clicked = if tip.is_empty() { button } else { button.on_hover_text(tip) }.clicked();
    if clicked {
        ui.close();
    }
    clicked
}

/// A menu of the names of a kind.
fn named(ui: &mut Ui, kind: Named, names: &[String]) -> Option<Name> {
    let list = |ui: &mut Ui| {
        let clicked = names.iter().filter(|name| item(ui, name, "")).last();
        clicked.map(|name| Name::from(name.as_str()))
    };
    let menu = ui.add_enabled_ui(!names.is_empty(), |ui| {
        ui.menu_button(capitalised(kind.name()), |ui| {
            egui::ScrollArea::vertical().max_height(320.0).show(ui, list).inner
        })
    });
    let menu = menu.inner;
    menu.response.on_disabled_hover_text("The scene has none with a name");
    menu.inner.flatten()
}

/// What is usually asked of a number.
fn usual(attribute: Attribute) -> (Comparison, f64) {
    match attribute {
        Attribute::Edges => (Comparison::AtLeast, 3.0),
        Attribute::Acceptance => (Comparison::AtMost, 0.1),
        Attribute::Dwell => (Comparison::AtLeast, 100.0),
        Attribute::Chain | Attribute::Epoch => (Comparison::Equal, 0.0),
        _ => (Comparison::AtLeast, 1.0),
    }
}

/// What a number says.
pub(super) fn meaning(attribute: Attribute) -> &'static str {
    match attribute {
        Attribute::Edges => "Edges of the path; 1 is a lamp seen directly",
        Attribute::Length => "Length of the line, in the units of the scene file",
        Attribute::Luminance => "Luminance that the path carries",
        Attribute::Acceptance => "Probability with which the path was accepted",
        Attribute::Dwell => "Steps that the chain stayed at the path",
        Attribute::Chain => "Number of the chain",
        Attribute::Epoch => "Number of the epoch",
        Attribute::Step => "Step of the chain at which the path was accepted",
        Attribute::Diffuse => "Diffuse vertices",
        Attribute::Glossy => "Glossy vertices",
        Attribute::Specular => "Vertices on mirrors and clear glass",
    }
}
