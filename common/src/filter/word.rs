//! The words of the grammar, and lists of what has them.

/// The description ends here: what should follow is not there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stop;

/// A description that was followed to its end, or not.
pub type Walk = Result<(), Stop>;

/// A word of the grammar, and what it means.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Word {
    /// The word.
    pub text: &'static str,
    /// Other ways to write it, which are read and never printed.
    pub also: &'static [&'static str],
    /// What it means, in a few words.
    pub meaning: &'static str,
}

impl Word {
    /// A word that is written in one way.
    pub const fn new(text: &'static str, meaning: &'static str) -> Self {
        Self { text, also: &[], meaning }
    }
}

/// A closed set of values, each of which has a word.
pub trait Worded: Copy + PartialEq + 'static {
    /// What is chosen when one of them is.
    const ABOUT: &'static str;
    /// All of them with their words, in the order of menus.
    const WORDS: &'static [(Self, Word)];

    /// Its word.
    fn word(self) -> &'static Word;

    /// All of them, in the order of menus.
    fn all() -> impl Iterator<Item = Self> {
        Self::WORDS.iter().map(|&(value, _)| value)
    }
}

/// Makes an enum whose values have words; the word's meaning is the value's documentation.
macro_rules! words {
    (
        $(#[$doc:meta])*
        $visibility:vis enum $name:ident: $about:literal {
            $($(#[$attribute:meta])* $value:ident = $text:literal $(or $also:literal)?, $meaning:literal;)*
        }
    ) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        $visibility enum $name {
            $($(#[$attribute])* #[doc = $meaning] $value,)*
        }

        impl $crate::filter::word::Worded for $name {
            const ABOUT: &'static str = $about;
            const WORDS: &'static [(Self, $crate::filter::word::Word)] = &[
                $((Self::$value, $crate::filter::word::Word {
                    text: $text,
                    also: &[$($also)?],
                    meaning: $meaning,
                }),)*
            ];

            fn word(self) -> &'static $crate::filter::word::Word {
                // The table is made of the same list, in the order of the values.
                &Self::WORDS[self as usize].1
            }
        }
    };
}
pub(super) use words;

/// Which of a scene's names.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NameList {
    /// Those of its objects.
    Objects,
    /// Those of its materials.
    Materials,
    /// Those of its lights.
    Lights,
    /// Those of the strategies that make its paths.
    Strategies,
}

impl NameList {
    /// All lists.
    pub const ALL: [Self; 4] = [Self::Objects, Self::Materials, Self::Lights, Self::Strategies];

    /// What one of them names.
    pub fn kind(self) -> &'static str {
        match self {
            Self::Objects => "object",
            Self::Materials => "material",
            Self::Lights => "light",
            Self::Strategies => "strategy",
        }
    }
}

/// True for what words consist of.
pub(super) fn in_word(c: char) -> bool {
    c.is_alphanumeric() || c == '_'
}
