//! The macros that make tables of commands.
//!
//! A row is written once and is variant, parser, printer, help, entry of the palette and copied text;
//! a row that sets something is field, default, range and slider, too:
//!
//! ```text
//! /// How far apart the lines of the grid are.
//! Spacing "scene spacing" (units: f32 [range(0.1, 10.0).log()]) sets spacing = 1.0, "Spacing";
//! ```

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
                parameters: || vec![$(
                    $crate::command::form::Parameter::new::<$type>(
                        stringify!($parameter),
                        $crate::command::table::limits!($($limits)?),
                    )
                ),*],
                label: $label,
                traits: &[$($crate::command::Trait::$trait),*],
                read: |_words| {
                    $(
                        let $parameter = <$type as $crate::value::Value>::read(
                            _words,
                            stringify!($parameter),
                            $crate::command::table::limits!($($limits)?),
                        )?;
                    )*
                    Ok($($command)+)
                },
                write: |command| {
                    let $($command)+ = command else { return None };
                    Some(vec![$($crate::value::Value::text($parameter)),*])
                },
                examples: || $crate::command::table::forms!(
                    @examples { $($command)+ }
                    $($parameter : $type, $crate::command::table::limits!($($limits)?)),*
                ),
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
                => { $crate::command::Command::$wrap($name::$variant($parameter)) }
                $label $(, $trait)*;
            )+
            $(
                $(#[doc = $command_doc])+
                $command_words $(| $command_alias)*
                ( $($($operand : $operand_type $([ $operand_limits ])?),+)? )
                => { $crate::command::Command::$wrap($name::$command $(($($operand),+))?) }
                "" $(, $command_trait)*;
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
            => { $crate::command::Command::$wrap($name::$variant $(($($parameter),+))?) }
            "" $(, $trait)*;
        )+}
    };
}
pub(super) use table;
