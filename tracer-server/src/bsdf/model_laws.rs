//! Laws that every description of a scattering model must obey.

use common::Rgb;

use super::{BsdfDescription, ColorInput, Given, MODELS, ModelKind, Named, NumberInput};

/// A scene file that gives all parameters but those that are left out, and remembers what it was
/// asked for.
struct Witness<'a> {
    left_out: &'a [&'static str],
    /// Is given another value than the others would have it.
    changed: Option<&'static str>,
    asked: Vec<&'static str>,
}

impl Witness<'_> {
    fn give(&mut self, name: &'static str) -> Option<f64> {
        self.asked.push(name);
        let number = if self.changed == Some(name) { 0.25 } else { 0.5 };
        (!self.left_out.contains(&name)).then_some(number)
    }
}

impl Given for Witness<'_> {
    type Error = String;

    fn color(&mut self, name: &'static str) -> Result<Option<Rgb>, String> {
        Ok(self.give(name).map(Rgb::grey))
    }

    fn color_input(&mut self, name: &'static str) -> Result<Option<ColorInput>, String> {
        let factor = self.color(name)?;
        Ok(factor.map(|factor| ColorInput::Texture { texture: 3, factor }))
    }

    fn number(&mut self, name: &'static str) -> Result<Option<f64>, String> {
        Ok(self.give(name))
    }

    fn number_input(&mut self, name: &'static str) -> Result<Option<NumberInput>, String> {
        let factor = self.give(name);
        Ok(factor.map(|factor| NumberInput::Texture { texture: 3, factor }))
    }

    fn number_or_name(&mut self, name: &'static str) -> Result<Option<Named>, String> {
        Ok(self.give(name).map(Named::Number))
    }

    fn word(&mut self, name: &'static str) -> Result<Option<String>, String> {
        Ok(self.give(name).map(|number| number.to_string()))
    }

    fn flag(&mut self, name: &'static str) -> Result<bool, String> {
        Ok(self.give(name).is_some_and(|number| number < 0.5))
    }

    fn error(&self, name: &'static str, message: &str) -> String {
        format!("{name}: {message}")
    }

    fn warn(&mut self, _: &str) {}
}

/// Every way to give a model's parameters in which at most two are missing.
fn ways_to_give(kind: &ModelKind) -> Vec<Vec<&'static str>> {
    let names = || kind.parameters.iter().map(|parameter| parameter.name);
    let pairs = names().flat_map(|a| names().map(move |b| vec![a, b]));
    std::iter::once(Vec::new()).chain(pairs).collect()
}

/// What a description shows of itself.
fn shown(mut description: BsdfDescription) -> Vec<(&'static str, String)> {
    let mut all = Vec::new();
    description.parameters(&mut |name, value| all.push((name, format!("{value:?}"))));
    all
}

/// A model reads what it tells that it reads and nothing else; and whatever it reads, it shows, so
/// that it is checked, is part of the scene's digest, and takes its textures along.
#[test]
fn a_model_tells_and_shows_what_it_reads() {
    for kind in MODELS {
        let told = |name: &&str| kind.parameters.iter().any(|parameter| parameter.name == *name);
        let (mut asked, mut effective) = (Vec::new(), Vec::new());
        for left_out in ways_to_give(kind) {
            let read = |changed| {
                let mut witness = Witness { left_out: &left_out, changed, asked: Vec::new() };
                let read = BsdfDescription::read(kind.name, &mut witness).expect("a model");
                (read, witness.asked)
            };
            let (description, names) = read(None);
            asked.extend(names);
            let Ok(description) = description else { continue };
            assert!(shown(description).iter().all(|(name, _)| told(name)), "{description:?}");
            for parameter in kind.parameters {
                if let (Ok(other), _) = read(Some(parameter.name))
                    && other != description
                {
                    effective.push(parameter.name);
                    assert_ne!(shown(other), shown(description), "{}", parameter.name);
                }
            }
        }
        assert!(asked.iter().all(told), "{} reads more than it tells: {asked:?}", kind.name);
        for parameter in kind.parameters {
            let (name, of) = (parameter.name, kind.name);
            assert!(asked.contains(&name), "{of} never reads {name}");
            assert!(effective.contains(&name), "{name} makes no difference to {of}");
        }
    }
}

/// What is turned inside out twice is as it was, and textures move with their list.
#[test]
fn descriptions_can_be_turned_and_moved() {
    for kind in MODELS {
        for left_out in ways_to_give(kind) {
            let mut witness = Witness { left_out: &left_out, changed: None, asked: Vec::new() };
            let read = BsdfDescription::read(kind.name, &mut witness).expect("a model");
            let Ok(description) = read else { continue };
            let twice = description.inside_out().map(|turned| turned.inside_out());
            assert!(twice.is_none_or(|twice| twice == Some(description)), "{description:?}");
            let (before, after) = (format!("{description:?}"), description.with_textures_after(4));
            let moved = before.replace("texture: 3", "texture: 7");
            assert_eq!(format!("{after:?}"), moved, "all textures of {before}");
        }
    }
}
