//! One condition, whose every part can be chosen.

use common::{
    Attribute, Comparison, Leaf, LightPathExpression, Name, Named, Place, VertexClass, VertexTest,
    Volume,
};
use egui::{ComboBox, DragValue, RichText, TextEdit, Ui};

use super::{Context, add, fixed, joined_tests};
use crate::value::theme;

/// Shows a condition; true when it was changed.
pub(super) fn edit(ui: &mut Ui, leaf: &mut Leaf, context: &Context) -> bool {
    match leaf {
        Leaf::Vertex { place, test } => {
            // Both are shown, whatever was changed.
            let placed =
                choose(ui, "Which vertices or segments", place, &Place::ALL, ToString::to_string);
            edit_test(ui, test, context) | placed
        }
        Leaf::Segment { place, volume } => {
            let placed =
                choose(ui, "Which vertices or segments", place, &Place::ALL, ToString::to_string);
            ui.label("through");
            edit_volume(ui, volume, context) | placed
        }
        Leaf::LightPath(expression) => edit_expression(ui, expression),
        Leaf::Film { min, max } => {
            ui.label("film in");
            let mut changed = false;
            let tip = ["Left", "Top", "Right", "Bottom"];
            let [u0, v0] = *min;
            let [u1, v1] = *max;
            let ranges = [0.0..=u1, 0.0..=v1, u0..=1.0, v0..=1.0];
            let values = min.iter_mut().chain(max.iter_mut());
            for ((value, range), tip) in values.zip(ranges).zip(tip) {
                let drag = DragValue::new(value).speed(0.002).range(range).max_decimals(4);
                changed |= ui.add(drag).on_hover_text(tip).changed();
            }
            changed
        }
        Leaf::Number { attribute, comparison, value } => {
            let chosen = edit_attribute(ui, attribute);
            let sign = |c: &Comparison| c.sign().to_owned();
            let compared = choose(ui, "How it compares", comparison, &Comparison::ALL, sign);
            edit_value(ui, *attribute, value) | compared | chosen
        }
        Leaf::Range { attribute, least, most } => {
            let chosen = edit_attribute(ui, attribute);
            ui.label("in");
            let mut changed = edit_value(ui, *attribute, least);
            ui.label("..");
            changed |= edit_value(ui, *attribute, most);
            if changed && *least > *most {
                std::mem::swap(least, most);
            }
            changed | chosen
        }
        Leaf::Strategy(names) => edit_strategies(ui, names, context),
    }
}

/// Shows what is asked of a vertex; true when it was changed.
pub(super) fn edit_test(ui: &mut Ui, test: &mut VertexTest, context: &Context) -> bool {
    let mut changed = match test {
        VertexTest::Inside(volume) => {
            ui.label("in");
            edit_volume(ui, volume, context)
        }
        VertexTest::On(kind, name) => {
            ui.label("on");
            edit_name(ui, kind, name, context)
        }
        VertexTest::Is(class) => {
            ui.label("is");
            let word = |class: &VertexClass| class.name().to_owned();
            choose(
                ui,
                "How light scatters there, or which end it is",
                class,
                &VertexClass::ALL,
                word,
            )
        }
        VertexTest::Not(inner) => {
            ui.label("not");
            edit_test(ui, inner, context)
        }
        VertexTest::And(parts) | VertexTest::Or(parts) if parts.is_empty() => {
            fixed(ui, "anything".to_owned());
            false
        }
        VertexTest::And(_) | VertexTest::Or(_) => edit_joined(ui, test, context),
    };
    if !matches!(test, VertexTest::And(_) | VertexTest::Or(_)) {
        changed |= more_at_vertex(ui, test, context);
    }
    changed
}

/// Several tests at one vertex.
fn edit_joined(ui: &mut Ui, test: &mut VertexTest, context: &Context) -> bool {
    let mut either = matches!(test, VertexTest::Or(_));
    let (VertexTest::And(parts) | VertexTest::Or(parts)) = test else { return false };
    let mut parts = std::mem::take(parts);
    let changed = joined_tests(ui, &mut parts, &mut either, context);
    *test = match parts.len() {
        1 => parts.remove(0),
        _ if either => VertexTest::Or(parts),
        _ => VertexTest::And(parts),
    };
    changed
}

/// A menu that asks for more of the same vertex.
fn more_at_vertex(ui: &mut Ui, test: &mut VertexTest, context: &Context) -> bool {
    let mut more = None;
    ui.menu_button("&", |ui| {
        for class in VertexClass::ALL {
            if ui.button(format!("is {}", class.name())).clicked() {
                more = Some(VertexTest::Is(class));
            }
        }
        for name in &context.names.materials {
            if ui.button(format!("on material {name}")).clicked() {
                more = Some(VertexTest::On(Named::Material, Name::from(name.as_str())));
            }
        }
    })
    .response
    .on_hover_text("Ask for more at the same vertex");
    let Some(more) = more else { return false };
    let first = std::mem::replace(test, VertexTest::And(Vec::new()));
    *test = VertexTest::And(vec![first, more]);
    true
}

/// A list of choices; true when another one was chosen.
fn choose<T: Clone + PartialEq>(
    ui: &mut Ui,
    tip: &str,
    value: &mut T,
    all: &[T],
    text: impl Fn(&T) -> String,
) -> bool {
    let before = value.clone();
    let list = ComboBox::from_id_salt(tip).width(0.0).selected_text(text(value));
    let list = list.show_ui(ui, |ui| {
        for choice in all {
            ui.selectable_value(value, choice.clone(), text(choice));
        }
    });
    list.response.on_hover_text(tip);
    *value != before
}

fn edit_attribute(ui: &mut Ui, attribute: &mut Attribute) -> bool {
    let name = |attribute: &Attribute| attribute.name().to_owned();
    choose(ui, "The number that is asked for", attribute, &Attribute::ALL, name)
}

fn edit_value(ui: &mut Ui, attribute: Attribute, value: &mut f64) -> bool {
    let speed = if attribute.is_whole() { 0.1 } else { (value.abs() * 0.01).max(1e-4) };
    let mut drag = DragValue::new(value).speed(speed).range(0.0..=1e12);
    if attribute.is_whole() {
        drag = drag.max_decimals(0);
    }
    let changed = ui.add(drag).on_hover_text(add::meaning(attribute)).changed();
    if changed && attribute.is_whole() {
        *value = value.round();
    }
    changed
}

/// The kind of thing and its name.
fn edit_name(ui: &mut Ui, kind: &mut Named, name: &mut Name, context: &Context) -> bool {
    let word = |kind: &Named| kind.name().to_owned();
    let mut changed = choose(ui, "What kind of thing it lies on", kind, &Named::ALL, word);
    let names = context.names.named(*kind);
    if changed && let Some(first) = names.first() {
        *name = Name::from(first.as_str());
    }
    let list = ComboBox::from_id_salt("name").width(0.0).selected_text(&name.text);
    let list = list.show_ui(ui, |ui| {
        for known in names {
            if ui.selectable_label(*known == name.text, known).clicked() {
                *name = Name::from(known.as_str());
                changed = true;
            }
        }
        if names.is_empty() {
            ui.label(RichText::new("The scene has none with a name").weak());
        }
    });
    list.response.on_hover_text("Its name in the scene");
    changed
}

/// A sphere or a box, with its numbers.
fn edit_volume(ui: &mut Ui, volume: &mut Volume, context: &Context) -> bool {
    let mut is_sphere = matches!(volume, Volume::Sphere { .. });
    let before = is_sphere;
    let word = |sphere: &bool| if *sphere { "sphere" } else { "box" }.to_owned();
    let mut changed = choose(ui, "The shape of the region", &mut is_sphere, &[true, false], word);
    if before != is_sphere {
        *volume = match *volume {
            Volume::Sphere { centre, radius } => {
                Volume::Box { min: centre - radius, max: centre + radius }
            }
            Volume::Box { min, max } => {
                let radius = (0.5 * (max - min).length()).max(f64::MIN_POSITIVE);
                Volume::Sphere { centre: 0.5 * (min + max), radius }
            }
        };
    }
    let speed = context.radius.max(1e-6) * 0.05;
    let number = |ui: &mut Ui, value: &mut f64, range: std::ops::RangeInclusive<f64>, tip: &str| {
        let drag = DragValue::new(value).speed(speed).range(range).max_decimals(4);
        ui.add(drag).on_hover_text(tip).changed()
    };
    const FAR: f64 = 1e12;
    match volume {
        Volume::Sphere { centre, radius } => {
            for (value, tip) in
                [&mut centre.x, &mut centre.y, &mut centre.z].into_iter().zip(["x", "y", "z"])
            {
                changed |= number(ui, value, -FAR..=FAR, tip);
            }
            changed |= number(ui, radius, f64::MIN_POSITIVE..=FAR, "Radius");
        }
        Volume::Box { min, max } => {
            let (low, high) = (*min, *max);
            for (i, tip) in ["Least x", "Least y", "Least z"].into_iter().enumerate() {
                changed |= number(ui, &mut min[i], -FAR..=high[i], tip);
            }
            for (i, tip) in ["Largest x", "Largest y", "Largest z"].into_iter().enumerate() {
                changed |= number(ui, &mut max[i], low[i]..=FAR, tip);
            }
        }
    }
    changed
}

/// The expression as a text, which counts once it can be read.
fn edit_expression(ui: &mut Ui, expression: &mut LightPathExpression) -> bool {
    ui.label("lpe");
    let id = ui.scope_id().with("draft");
    let own = expression.text().to_owned();
    let mut draft = ui.data(|data| data.get_temp::<String>(id)).unwrap_or_else(|| own.clone());
    let response = ui.add(TextEdit::singleline(&mut draft).desired_width(110.0).code_editor());
    response.widget_info(|| {
        egui::WidgetInfo::labeled(egui::Role::TextInput, true, "Light path expression")
    });
    let writes = response.has_focus();
    let read = LightPathExpression::parse(&draft);
    match &read {
        Err(error) if draft != own => {
            let text = RichText::new(&error.message).small();
            ui.label(text.color(theme::bad(ui.visuals().dark_mode)));
        }
        _ => {
            response.on_hover_text(
                "Read from the camera C or the light L. `RD` is two vertices, `<RD>` one that is \
                 both; `.` is any, `*` any number of times.",
            );
        }
    }
    ui.data_mut(|data| {
        if writes {
            data.insert_temp(id, draft.clone());
        } else {
            data.remove::<String>(id);
        }
    });
    let enter = ui.input(|input| input.key_pressed(egui::Key::Enter));
    match read {
        Ok(read) if draft != own && (!writes || enter) => {
            *expression = read;
            true
        }
        _ => false,
    }
}

/// Which strategies made the path.
fn edit_strategies(ui: &mut Ui, names: &mut Vec<Name>, context: &Context) -> bool {
    ui.label("strategy");
    let plain = |text: &str| text.replace(['-', '_'], " ");
    let title = names.iter().map(|name| name.text.as_str()).collect::<Vec<_>>().join(" or ");
    let mut changed = false;
    let menu = ui.menu_button(title, |ui| {
        for known in context.names.strategies.iter().map(String::as_str).chain(["seed"]) {
            let place = names.iter().position(|name| plain(&name.text) == plain(known));
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
    });
    menu.response.on_hover_text("Any of these made the path");
    changed
}
