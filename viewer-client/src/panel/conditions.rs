//! The conditions of the filter's text as a list that can be added to.

use common::{Attribute, Comparison, Filter, Leaf, Name, Named, Place, VertexTest};
use egui::{ComboBox, DragValue, Label, RichText, Ui};

use crate::command::FilterCommand;
use crate::world::World;

/// Numbers that can be asked for, with their names.
const NUMBERS: [&str; 9] = [
    "edges",
    "length",
    "luminance",
    "acceptance",
    "dwell",
    "diffuse",
    "glossy",
    "specular",
    "chain",
];
const COMPARISONS: [(Comparison, &str); 3] =
    [(Comparison::AtLeast, "≥"), (Comparison::AtMost, "≤"), (Comparison::Equal, "=")];

/// A condition that is being put together.
#[derive(Debug)]
pub(super) struct Builder {
    number: usize,
    comparison: usize,
    value: f64,
}

impl Default for Builder {
    fn default() -> Self {
        Self { number: 0, comparison: 0, value: 3.0 }
    }
}

/// The parts of a filter, and whether any of them is enough.
fn parts(text: &str) -> (Vec<Filter>, bool) {
    if text.trim().is_empty() {
        return (Vec::new(), false);
    }
    match Filter::parse(text) {
        Ok(Filter::And(parts)) => (parts, false),
        Ok(Filter::Or(parts)) => (parts, true),
        Ok(other) => (vec![other], false),
        Err(_) => (Vec::new(), false),
    }
}

/// The command that makes these parts the filter's text.
fn together(mut parts: Vec<Filter>, any: bool) -> FilterCommand {
    match parts.len() {
        0 => FilterCommand::text(String::new()),
        1 => FilterCommand::Set(parts.remove(0).to_string()),
        _ if any => FilterCommand::Set(Filter::Or(parts).to_string()),
        _ => FilterCommand::Set(Filter::And(parts).to_string()),
    }
}

fn negated(part: Filter) -> Filter {
    match part {
        Filter::Not(inner) => *inner,
        other => Filter::Not(Box::new(other)),
    }
}

impl Builder {
    pub(super) fn ui(
        &mut self,
        ui: &mut Ui,
        world: &World<'_>,
        push: &mut impl FnMut(FilterCommand),
    ) {
        let (mut parts, mut any) = parts(&world.settings.filter.text);
        let mut changed = list(ui, &mut parts);
        if parts.len() > 1 {
            ui.horizontal(|ui| {
                changed |= ui.radio_value(&mut any, false, "all of these").changed();
                changed |= ui.radio_value(&mut any, true, "any of these").changed();
            });
        }
        let more = [self.number(ui), name(ui, world)];
        for part in more.into_iter().flatten() {
            parts.push(part);
            changed = true;
        }
        if changed {
            push(together(parts, any));
        }
    }

    /// A condition about a number.
    fn number(&mut self, ui: &mut Ui) -> Option<Filter> {
        ui.horizontal(|ui| {
            let name = NUMBERS.get(self.number).copied().unwrap_or("edges");
            ComboBox::from_id_salt("number")
                .width(92.0)
                .selected_text(name)
                .show_ui(ui, |ui| {
                    for (index, name) in NUMBERS.into_iter().enumerate() {
                        ui.selectable_value(&mut self.number, index, name);
                    }
                })
                .response
                .on_hover_text("The number that is asked for");
            let (comparison, sign) =
                COMPARISONS.get(self.comparison).copied().unwrap_or(COMPARISONS[0]);
            ComboBox::from_id_salt("sign")
                .width(40.0)
                .selected_text(sign)
                .show_ui(ui, |ui| {
                    for (index, (_, sign)) in COMPARISONS.into_iter().enumerate() {
                        ui.selectable_value(&mut self.comparison, index, sign);
                    }
                })
                .response
                .on_hover_text("How it compares");
            let value = DragValue::new(&mut self.value).speed(0.1).range(0.0..=1e12);
            ui.add(value).on_hover_text("What it is compared to");
            let attribute = Attribute::named(name).unwrap_or(Attribute::Edges);
            let value = if attribute.is_whole() { self.value.round() } else { self.value };
            let leaf = Leaf::Number { attribute, comparison, value };
            let add = ui.button("Add").on_hover_text("Add this condition");
            add.clicked().then_some(Filter::Leaf(leaf))
        })
        .inner
    }
}

/// The conditions, each of which can be negated and taken away. True when something was changed.
fn list(ui: &mut Ui, parts: &mut Vec<Filter>) -> bool {
    let mut changed = false;
    let mut gone = None;
    for (index, part) in parts.iter_mut().enumerate() {
        ui.horizontal(|ui| {
            if ui.small_button("×").on_hover_text("Take this condition away").clicked() {
                gone = Some(index);
            }
            if ui.small_button("not").on_hover_text("Want the opposite").clicked() {
                *part = negated(std::mem::take(part));
                changed = true;
            }
            let text = RichText::new(part.to_string()).monospace().size(11.0);
            ui.add(Label::new(text).truncate());
        });
    }
    if let Some(index) = gone {
        parts.remove(index);
    }
    changed || gone.is_some()
}

/// A condition about a name of the scene, or a strategy.
fn name(ui: &mut Ui, world: &World<'_>) -> Option<Filter> {
    let mut chosen = None;
    ui.horizontal(|ui| {
        let materials = world.names().mesh.map(|m| m.materials.as_slice()).unwrap_or_default();
        let pick = |salt: &str, title: &str| {
            ComboBox::from_id_salt(salt.to_owned()).width(130.0).selected_text(title.to_owned())
        };
        pick("material", "+ material")
            .show_ui(ui, |ui| {
                for material in materials {
                    if ui.selectable_label(false, &material.name).clicked() {
                        let test =
                            VertexTest::On(Named::Material, Name::from(material.name.as_str()));
                        chosen = Some(Filter::Leaf(Leaf::Vertex { place: Place::Any, test }));
                    }
                }
            })
            .response
            .on_hover_text("A vertex lies on this material");
        pick("strategy", "+ strategy")
            .show_ui(ui, |ui| {
                for strategy in world.names().strategies {
                    if ui.selectable_label(false, strategy).clicked() {
                        let names = vec![Name::from(strategy.as_str())];
                        chosen = Some(Filter::Leaf(Leaf::Strategy(names)));
                    }
                }
            })
            .response
            .on_hover_text("This strategy made the path");
    });
    chosen
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_list_of_conditions_is_the_same_filter() {
        let round = |text: &str| {
            let (parts, any) = parts(text);
            let count = parts.len();
            (count, together(parts, any))
        };
        for (text, count) in
            [("edges >= 3 and any is specular", 2), ("edges == 2 or dwell >= 9", 2)]
        {
            assert_eq!(round(text), (count, FilterCommand::Set(text.to_owned())), "{text}");
        }
        assert_eq!(round(""), (0, FilterCommand::Set("true".to_owned())), "all paths");
        let part = parts("edges == 2").0.remove(0);
        assert_eq!(negated(negated(part.clone())), part, "twice is none");
    }
}
