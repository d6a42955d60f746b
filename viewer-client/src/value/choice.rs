//! Choices: closed sets of words.

use std::fmt::{Debug, Display};
use std::str::FromStr;

use strum::{EnumMessage, VariantArray};

use super::{CommandError, Shape, Value, Words};

/// One of a closed set of words; `choices!` makes such a type.
pub trait Choice:
    Copy + PartialEq + Debug + Display + FromStr + EnumMessage + VariantArray + 'static
{
    /// What it means, as its documentation says: one line.
    fn meaning(self) -> String {
        let text = self.get_documentation().unwrap_or_default();
        let words: Vec<&str> = text.split_whitespace().collect();
        words.join(" ").trim_end_matches('.').to_owned()
    }

    /// What panels call it: its message, or else its word with a capital.
    fn label(self) -> String {
        if let Some(label) = self.get_message() {
            return label.to_owned();
        }
        let word = self.to_string();
        let mut letters = word.chars();
        letters
            .next()
            .map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
    }

    /// The choice behind this one, round and round.
    #[must_use]
    fn next(self) -> Self {
        let all = Self::VARIANTS;
        let next = all.iter().position(|choice| *choice == self).map_or(0, |i| i + 1);
        all.get(next).or_else(|| all.first()).copied().unwrap_or(self)
    }
}

/// Makes an enum a [`Choice`]: its words are the names of its variants in lower case, and what is
/// documented of a variant is what users read when they point at it.
macro_rules! choices {
    (
        $(#[$meta:meta])*
        pub enum $name:ident { $($(#[$variant_meta:meta])* $variant:ident,)+ }
    ) => {
        $(#[$meta])*
        #[derive(
            Clone, Copy, Debug, PartialEq, Eq, serde::Deserialize, serde::Serialize,
            strum::Display, strum::EnumMessage, strum::EnumString, strum::VariantArray,
        )]
        #[serde(rename_all = "kebab-case")]
        #[strum(serialize_all = "kebab-case")]
        pub enum $name { $($(#[$variant_meta])* $variant,)+ }

        impl $name {
            /// All of them.
            pub const ALL: [Self; <Self as strum::VariantArray>::VARIANTS.len()] =
                [$(Self::$variant),+];
        }

        impl $crate::value::Choice for $name {}

        $crate::value::settable!($name);
    };
}
pub(super) use choices;

impl<T: Choice> Value for T {
    type Limits = ();

    fn form(name: &str, (): &()) -> String {
        /// More words than this are listed after the form.
        const MOST: usize = 7;
        if T::VARIANTS.len() > MOST { name.to_uppercase() } else { all_words::<T>().join("|") }
    }

    fn read(words: &mut Words<'_>, name: &str, (): &()) -> Result<Self, CommandError> {
        let word = words.parameter(name)?;
        word.parse().ok().ok_or_else(|| CommandError::no_choice(word, &all_words::<T>().join(", ")))
    }

    fn text(&self) -> String {
        self.to_string()
    }

    fn examples((): &()) -> Vec<Self> {
        T::VARIANTS.to_vec()
    }

    fn shape((): &()) -> Shape {
        Shape::Choice(all_words::<T>())
    }
}

/// The words of a choice.
fn all_words<T: Choice>() -> Vec<String> {
    T::VARIANTS.iter().map(ToString::to_string).collect()
}
