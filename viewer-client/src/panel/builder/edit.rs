//! A row for everything that describes itself: each of its parts can be chosen.

use std::ops::RangeInclusive;

use common::{
    Described, FilterError, Form, LightPathExpression, Name, NameList, NumberPart, Spot, Tree,
    Unit, VertexCheck, VertexTest, Walk, Word, is_same_strategy,
};
use egui::{ComboBox, DragValue, RichText, TextEdit, Ui};

use super::{Context, add, fixed, joined_tests};
use crate::panel::widgets::capitalised;
use crate::value::theme;

/// Shows a condition or a part of it; true when it was changed. A change that makes no sense is not
/// made.
pub(super) fn edit<T: Described + Clone>(
    ui: &mut Ui,
    edited: &mut T,
    context: &Context<'_>,
) -> bool {
    let before = edited.clone();
    let mut editor = Editor { ui, context, parts: 0, changed: false, refused: false };
    let walked = edited.describe(&mut editor);
    let (changed, refused) = (editor.changed, editor.refused || walked.is_err());
    if refused {
        *edited = before;
    }
    changed && !refused
}

/// Puts every part under the user's hand.
struct Editor<'a> {
    ui: &'a mut Ui,
    context: &'a Context<'a>,
    /// Parts so far, which tell lists apart.
    parts: usize,
    changed: bool,
    refused: bool,
}

impl Form for Editor<'_> {
    fn word(&mut self, word: &'static Word) -> Walk {
        self.ui.label(word.text).on_hover_text(capitalised(word.meaning));
        Ok(())
    }

    /// Parentheses and commas are for texts.
    fn sign(&mut self, sign: &'static str, _: &'static str) -> Walk {
        if !matches!(sign.trim(), "(" | ")" | ",") {
            self.ui.label(sign);
        }
        Ok(())
    }

    fn choice(&mut self, about: &'static str, words: &[Word], chosen: &mut usize) -> Walk {
        let before = *chosen;
        let text = words.get(before).map_or("", |word| word.text);
        self.list(text, about, |ui| {
            for (number, word) in words.iter().enumerate() {
                let line = ui.selectable_value(chosen, number, word.text);
                line.on_hover_text(capitalised(word.meaning));
            }
        });
        self.changed |= *chosen != before;
        Ok(())
    }

    fn number(&mut self, about: &NumberPart, value: &mut f64) -> Walk {
        let (speed, decimals) = match about.unit {
            Unit::Count => (0.1, Some(0)),
            Unit::Length => (self.context.spot.radius.max(1e-6) * 0.05, Some(4)),
            Unit::Film => (0.002, Some(4)),
            Unit::Plain => ((value.abs() * 0.01).max(1e-4), None),
        };
        let range: RangeInclusive<f64> = about.least..=about.most;
        // What was written may lie beyond; only a hand on it is held back.
        let drag = DragValue::new(value).speed(speed).range(range).clamp_existing_to_range(false);
        let drag = match decimals {
            Some(most) => drag.max_decimals(most),
            None => drag,
        };
        if self.ui.add(drag).on_hover_text(capitalised(about.about)).changed() {
            self.changed = true;
            if about.unit == Unit::Count {
                *value = value.round();
            }
        }
        Ok(())
    }

    fn name(&mut self, list: NameList, name: &mut Name) -> Walk {
        let names = self.context.scene.names(list);
        if name.text.is_empty()
            && let Some(first) = names.first()
        {
            *name = Name::from(*first);
            self.changed = true;
        }
        let mut chosen = None;
        self.list(&name.text, "Its name in the scene", |ui| {
            for known in &names {
                if ui.selectable_label(is_same(list, known, &name.text), *known).clicked() {
                    chosen = Some(Name::from(*known));
                }
            }
            if names.is_empty() {
                ui.weak("The scene has none that is named");
            }
        });
        if let Some(chosen) = chosen {
            *name = chosen;
            self.changed = true;
        }
        Ok(())
    }

    fn names(&mut self, list: NameList, names: &mut Vec<Name>) -> Walk {
        let known = self.context.scene.names(list);
        let title = names.iter().map(|name| name.text.as_str()).collect::<Vec<_>>().join(" or ");
        let menu = self.ui.menu_button(title, |ui| {
            let mut changed = false;
            for known in known {
                let place = names.iter().position(|name| is_same(list, known, &name.text));
                let mut on = place.is_some();
                if !ui.checkbox(&mut on, known).changed() {
                    continue;
                }
                match place {
                    // One must be left, or no path could match.
                    Some(place) if names.len() > 1 => drop(names.remove(place)),
                    Some(_) => continue,
                    None => names.push(Name::from(known)),
                }
                changed = true;
            }
            changed
        });
        menu.response.on_hover_text("Any of these");
        self.changed |= menu.inner == Some(true);
        Ok(())
    }

    fn expression(&mut self, expression: &mut LightPathExpression) -> Walk {
        self.changed |= edit_expression(self.ui, expression);
        Ok(())
    }

    fn vertex(&mut self, test: &mut VertexTest) -> Walk {
        self.changed |= edit_test(self.ui, test, self.context);
        Ok(())
    }

    fn check(&mut self, _: usize, complaint: Option<&'static str>) -> Walk {
        self.refused |= complaint.is_some();
        Ok(())
    }

    fn spot(&self) -> Spot {
        self.context.spot
    }
}

impl Editor<'_> {
    /// A list of choices.
    fn list(&mut self, text: &str, tip: &str, lines: impl FnOnce(&mut Ui)) {
        self.parts += 1;
        let list = ComboBox::from_id_salt((tip, self.parts)).width(0.0).selected_text(text);
        list.show_ui(self.ui, lines).response.on_hover_text(tip);
    }
}

fn is_same(list: NameList, known: &str, name: &str) -> bool {
    known == name || (list == NameList::Strategies && is_same_strategy(known, name))
}

/// Shows what is asked of a vertex; true when it was changed.
pub(super) fn edit_test(ui: &mut Ui, test: &mut VertexTest, context: &Context<'_>) -> bool {
    match test {
        Tree::Leaf(check) => {
            let changed = edit(ui, check, context);
            changed | more_at_vertex(ui, test, context)
        }
        Tree::Not(inner) => {
            ui.label("not");
            let changed = edit_test(ui, inner, context);
            changed | more_at_vertex(ui, test, context)
        }
        Tree::Constant(_) => {
            fixed(ui, test.to_string());
            more_at_vertex(ui, test, context)
        }
        Tree::And(_) | Tree::Or(_) => edit_joined(ui, test, context),
    }
}

/// Several tests at one vertex.
fn edit_joined(ui: &mut Ui, test: &mut VertexTest, context: &Context<'_>) -> bool {
    let mut either = matches!(test, Tree::Or(_));
    let (Tree::And(parts) | Tree::Or(parts)) = test else { return false };
    let mut parts = std::mem::take(parts);
    let changed = joined_tests(ui, &mut parts, &mut either, context);
    *test = match parts.len() {
        1 => parts.remove(0),
        _ if either => Tree::Or(parts),
        _ => Tree::And(parts),
    };
    changed
}

/// A menu that asks for more of the same vertex.
fn more_at_vertex(ui: &mut Ui, test: &mut VertexTest, context: &Context<'_>) -> bool {
    let proposals = || VertexCheck::proposals(context.scene, context.spot);
    let menu = ui.menu_button("&", |ui| add::lines(ui, proposals()));
    menu.response.on_hover_text("Add a test at the same vertex");
    let Some(more) = menu.inner.flatten() else { return false };
    *test = Tree::And(vec![std::mem::take(test), Tree::Leaf(more)]);
    true
}

/// An expression that is being written, and what was read of it.
#[derive(Clone, Debug)]
struct Draft {
    text: String,
    read: Result<LightPathExpression, FilterError>,
}

/// The expression as a text, which counts once it can be read.
fn edit_expression(ui: &mut Ui, expression: &mut LightPathExpression) -> bool {
    let id = ui.scope_id().with("draft");
    let draft = ui.data(|data| data.get_temp::<Draft>(id));
    let mut draft = draft.unwrap_or_else(|| Draft {
        text: expression.text().to_owned(),
        read: Ok(expression.clone()),
    });
    let edit = TextEdit::singleline(&mut draft.text).desired_width(110.0).code_editor();
    let response = ui.add(edit);
    response.widget_info(|| {
        egui::WidgetInfo::labeled(egui::Role::TextInput, true, "Light path expression")
    });
    if response.changed() {
        draft.read = LightPathExpression::parse(&draft.text);
    }
    let writes = response.has_focus();
    match &draft.read {
        Err(error) => {
            let text = RichText::new(&error.message).small();
            ui.label(text.color(theme::bad(ui.visuals().dark_mode)));
        }
        Ok(_) => {
            response.on_hover_text(
                "Read from the camera C or the light L. `RD` is two vertices, `<RD>` is one \
                vertex that is both; `.` is anything, `*` repeats any number of times.",
            );
        }
    }
    ui.data_mut(|data| {
        if writes {
            data.insert_temp(id, draft.clone());
        } else {
            data.remove::<Draft>(id);
        }
    });
    let enter = ui.input(|input| input.key_pressed(egui::Key::Enter));
    match draft.read {
        Ok(read) if read != *expression && (!writes || enter) => {
            *expression = read;
            true
        }
        _ => false,
    }
}
