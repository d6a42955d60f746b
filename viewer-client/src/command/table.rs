//! What a row of a table of commands yields, and the two macros that make tables.
//!
//! A row is written once and is variant, parser, printer, help, entry of the palette and copied text;
//! a row that sets something is field, default, range and slider, too:
//!
//! ```text
//! /// How far apart the lines of the grid are.
//! Spacing "scene spacing" (units: f32 [range(0.1, 10.0).log()]) sets spacing = 1.0, "Spacing";
//! ```

use std::fmt;

use super::Command;
use crate::value::{CommandError, Range, Settable, Shape, Words};

/// A command in general: how it is written, and what it does.
pub struct Form {
    /// What it begins with, such as `cloud width`.
    pub words: &'static str,
    /// What scripts and links may begin with instead: what it was called in the past.
    pub(super) aliases: &'static [&'static str],
    /// What it does, as its documentation says.
    pub(super) documentation: &'static str,
    pub(super) parameters: &'static [Parameter],
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
    pub(super) form: fn(&str) -> String,
    pub(super) shape: fn() -> Shape,
}

/// Something that is special about a command.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Trait {
    /// A link to a view may hold it: it looks, and does nothing else.
    Linked,
    /// It opens or closes what is before the eyes for a moment, so that there is nothing to undo.
    Passing,
    /// It sets something that is remembered from one day to the next.
    Kept,
}

impl Form {
    /// How it is written, with its parameters in capitals: `cloud width PIXELS`.
    pub fn text(&self) -> String {
        let parameters = self.parameters.iter().map(|p| (p.form)(p.name));
        std::iter::once(self.words.to_owned()).chain(parameters).collect::<Vec<_>>().join(" ")
    }

    /// What it does, in one line, with its range.
    pub fn help(&self) -> String {
        let words: Vec<&str> = self.documentation.split_whitespace().collect();
        let mut text = words.join(" ").trim_end_matches('.').to_owned();
        for parameter in self.parameters {
            let form = (parameter.form)(parameter.name);
            match (parameter.shape)() {
                Shape::Number(range) if self.is_setting() => {
                    text = format!("{text} ({range})");
                }
                Shape::Choice(words) if form == parameter.name.to_uppercase() => {
                    text = format!("{text}; {form} is one of {}", words.join(", "));
                }
                Shape::Number(_) | Shape::Choice(_) | Shape::Other => {}
            }
        }
        text
    }

    /// The range of its number, if it has one.
    pub fn range(&self) -> Option<Range<f64>> {
        self.parameters.iter().find_map(|parameter| match (parameter.shape)() {
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

/// The limits of a parameter; none where none are written.
macro_rules! limits {
    () => {
        &()
    };
    ($limits:expr) => {
        &const { $limits }
    };
}
pub(super) use limits;

/// Makes rows `words (parameters) => { command };` the forms `FORMS`.
macro_rules! forms {
    ($(
        $(#[doc = $doc:literal])+
        $words:literal $(| $alias:literal)*
        ( $($parameter:ident : $type:ty $([ $limits:expr ])?),* ) => { $($command:tt)+ }
        $label:literal $(, $trait:ident)* ;
    )+) => {
        pub(super) const FORMS: &[$crate::command::Form] = &[$(
            $crate::command::Form {
                words: $words,
                aliases: &[$($alias),*],
                documentation: concat!($($doc, "\n"),+),
                parameters: &[$(
                    $crate::command::table::Parameter {
                        name: stringify!($parameter),
                        form: |name| <$type as $crate::value::Value>::form(name, $crate::command::table::limits!($($limits)?)),
                        shape: || <$type as $crate::value::Value>::shape($crate::command::table::limits!($($limits)?)),
                    }
                ),*],
                label: $label,
                traits: &[$($crate::command::table::Trait::$trait),*],
                read: |_words| {
                    $(
                        let name = stringify!($parameter);
                        let $parameter =
                            <$type as $crate::value::Value>::read(_words, name, $crate::command::table::limits!($($limits)?))?;
                    )*
                    Ok($($command)+)
                },
                write: |command| {
                    let $($command)+ = command else { return None };
                    Some(vec![$($crate::value::Value::text($parameter)),*])
                },
                examples: || $crate::command::table::forms!(@examples { $($command)+ }
                    $($parameter : $type, $crate::command::table::limits!($($limits)?)),*),
            }
        ),+];
    };
    // Each example of the last parameter with the first of the others, and so on: no need for all pairs.
    (@examples { $($command:tt)+ }) => { vec![$($command)+] };
    (@examples { $($command:tt)+ } $($parameter:ident : $type:ty, $limits:expr),+) => {{
        $( let $parameter = <$type as $crate::value::Value>::examples($limits); )+
        let most = [$($parameter.len()),+].into_iter().max().unwrap_or(0);
        let examples = (0..most).map(|i| {
            $( let $parameter = $parameter.get(i).or($parameter.last())?.clone(); )+
            Some($($command)+)
        });
        examples.flatten().collect()
    }};
}
pub(super) use forms;

/// Makes a table of commands, and of settings if it has any: the enum of what may be asked for, its
/// forms and, from the rows with `sets`, the struct of what is set with its defaults.
macro_rules! table {
    (
        $(#[$meta:meta])* pub enum $name:ident in $wrap:ident;
        $(#[$struct_meta:meta])* pub struct $settings:ident {$(
            $(#[doc = $doc:literal])+
            $variant:ident $words:literal $(| $alias:literal)*
            ( $parameter:ident : $type:ty $([ $limits:expr ])? )
            sets $field:ident = $default:expr, $label:literal $(, $trait:ident)* ;
        )+}
        commands {$(
            $(#[doc = $command_doc:literal])+
            $command:ident $command_words:literal $(| $command_alias:literal)*
            $(( $($operand:ident : $operand_type:ty $([ $operand_limits:expr ])?),+ ))?
            $(, $command_trait:ident)* ;
        )*}
    ) => {
        $(#[$meta])*
        pub enum $name {
            $( $(#[doc = $doc])+ $variant(<$type as $crate::value::Settable>::Change), )+
            $( $(#[doc = $command_doc])+ $command $(($($operand_type),+))?, )*
        }

        $crate::command::table::forms! {
            $(
                $(#[doc = $doc])+
                $words $(| $alias)*
                ( $parameter : <$type as $crate::value::Settable>::Change $([ $limits ])? )
                => { $crate::command::Command::$wrap($name::$variant($parameter)) } $label $(, $trait)*;
            )+
            $(
                $(#[doc = $command_doc])+
                $command_words $(| $command_alias)*
                ( $($($operand : $operand_type $([ $operand_limits ])?),+)? )
                => { $crate::command::Command::$wrap($name::$command $(($($operand),+))?) } "" $(, $command_trait)*;
            )*
        }

        $(#[$struct_meta])*
        pub struct $settings {
            $( $(#[doc = $doc])+ pub $field: $type, )+
        }

        impl Default for $settings {
            fn default() -> Self {
                Self { $($field: $default),+ }
            }
        }

        impl $settings {
            $(
                $(#[doc = $doc])+
                pub fn $field() -> $crate::command::Setting<Self, $type> {
                    $crate::command::Setting {
                        form: $crate::command::form($words),
                        get: |settings| &settings.$field,
                        set: |to| $crate::command::Command::$wrap($name::$variant(to)),
                    }
                }
            )+

            /// Sets what the command sets; nothing where it does something else.
            pub fn set(&mut self, command: &$name) {
                $(
                    if let $name::$variant(to) = command {
                        $crate::value::Settable::change(&mut self.$field, to.clone());
                    }
                )+
            }

            /// The commands that lead here from anywhere.
            pub fn commands(&self) -> Vec<$crate::command::Command> {
                let commands = [
                    $( $crate::value::Settable::as_change(&self.$field).map($name::$variant) ),+
                ];
                commands.into_iter().flatten().map($crate::command::Command::$wrap).collect()
            }
        }
    };
    (
        $(#[$meta:meta])* pub enum $name:ident in $wrap:ident;
        commands {$(
            $(#[doc = $doc:literal])+
            $variant:ident $words:literal $(| $alias:literal)*
            $(( $($parameter:ident : $type:ty $([ $limits:expr ])?),+ ))? $(, $trait:ident)* ;
        )+}
    ) => {
        $(#[$meta])*
        pub enum $name {
            $( $(#[doc = $doc])+ $variant $(($($type),+))?, )+
        }

        $crate::command::table::forms! {$(
            $(#[doc = $doc])+
            $words $(| $alias)*
            ( $($($parameter : $type $([ $limits ])?),+)? )
            => { $crate::command::Command::$wrap($name::$variant $(($($parameter),+))?) } "" $(, $trait)*;
        )+}
    };
}
pub(super) use table;
