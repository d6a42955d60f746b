//! What a row of a table yields.

use std::fmt;

use super::Command;
use crate::value::{CommandError, Range, Settable, Shape, Value, Words};

/// A command in general: how it is written, and what it does.
pub struct Form {
    /// What it begins with, such as `cloud width`.
    pub words: &'static str,
    /// What scripts and links may begin with instead: what it was called in the past.
    pub(super) aliases: &'static [&'static str],
    /// What it does, as its documentation says.
    pub(super) documentation: &'static str,
    pub(super) parameters: fn() -> Vec<Parameter>,
    /// What panels call it; blank where it sets nothing.
    pub label: &'static str,
    pub(super) traits: &'static [Trait],
    pub(super) read: fn(&mut Words<'_>) -> Result<Command, CommandError>,
    /// The texts of its parameters, if the command is of this form.
    pub(super) write: fn(&Command) -> Option<Vec<String>>,
    /// Some commands of this form, with the extreme values among them.
    pub examples: fn() -> Vec<Command>,
}

/// A parameter of a form.
pub(super) struct Parameter {
    pub(super) name: &'static str,
    /// How help texts show it.
    pub(super) form: String,
    pub(super) shape: Shape,
}

impl Parameter {
    /// The parameter `name` with values of the type `T` within limits.
    pub(super) fn new<T: Value>(name: &'static str, limits: &T::Limits) -> Self {
        Self { name, form: T::form(name, limits), shape: T::shape(limits) }
    }
}

/// Something that is special about a command.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Trait {
    /// A link to a view may hold it: it looks, and does nothing else.
    Linked,
    /// It opens or closes something transient, so that there is nothing to undo.
    Passing,
    /// Its result leaves the viewer.
    Gives,
    /// It sets something that is remembered from one day to the next.
    Kept,
}

impl Form {
    /// How it is written, with its parameters in capitals: `cloud width PIXELS`.
    pub fn text(&self) -> String {
        let parameters = (self.parameters)().into_iter().map(|parameter| parameter.form);
        std::iter::once(self.words.to_owned()).chain(parameters).collect::<Vec<_>>().join(" ")
    }

    /// What it does, in one line, with its range.
    pub fn help(&self) -> String {
        let words: Vec<&str> = self.documentation.split_whitespace().collect();
        let mut text = words.join(" ").trim_end_matches('.').to_owned();
        for Parameter { name, form, shape } in (self.parameters)() {
            match shape {
                Shape::Number(range) if self.is_setting() => {
                    text = format!("{text} ({range})");
                }
                Shape::Choice(words) if form == name.to_uppercase() => {
                    text = format!("{text}; {form} is one of {}", words.join(", "));
                }
                Shape::Number(_) | Shape::Choice(_) | Shape::Other => {}
            }
        }
        text
    }

    /// The range of its number, if it has one.
    pub fn range(&self) -> Option<Range<f64>> {
        (self.parameters)().into_iter().find_map(|parameter| match parameter.shape {
            Shape::Number(range) => Some(range),
            Shape::Choice(_) | Shape::Other => None,
        })
    }

    /// True for commands of which this is special.
    pub fn is(&self, special: Trait) -> bool {
        self.traits.contains(&special)
    }

    /// True for the commands that set something of the viewer.
    pub fn is_setting(&self) -> bool {
        !self.label.is_empty()
    }

    /// True for commands of this form.
    pub fn is_of(&self, command: &Command) -> bool {
        (self.write)(command).is_some()
    }
}

impl fmt::Debug for Form {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Form").field(&self.text()).finish()
    }
}

/// A setting of the group `G`, which holds a `T`: what a panel needs to show it.
pub struct Setting<G, T: Settable> {
    /// The form of the command that sets it.
    pub form: &'static Form,
    /// Its value.
    pub get: fn(&G) -> &T,
    /// The command that changes it.
    pub set: fn(T::Change) -> Command,
}

impl<G, T: Settable> fmt::Debug for Setting<G, T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Setting").field(&self.form).finish()
    }
}
