//! What a condition looks like, told once: its words, signs, numbers and names in the order of its
//! text.
//!
//! A condition describes itself to a [`Form`]. Whoever implements that trait reads it from a text,
//! prints it, lets a user edit it or draws one at random; completion and complaints come from the
//! reader. So none of them has to know any condition, and none can disagree with another.

use super::{LightPathExpression, Name, VertexTest};
use glam::DVec3;

/// The description ends here: what should follow is not there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stop;

/// A description that was followed to its end, or not.
pub type Walk = Result<(), Stop>;

/// Something that describes itself to a form.
pub trait Described {
    /// Names every part in the order of the text. A part may decide which parts follow it: they are
    /// read, shown and changed one after the other.
    fn describe(&mut self, form: &mut dyn Form) -> Walk;
}

/// Whoever follows a description.
pub trait Form {
    /// A word that is always the same.
    fn word(&mut self, word: &'static Word) -> Walk;

    /// A sign between the other parts, with the blanks that are printed around it. What it means is
    /// blank where nobody needs to be told.
    fn sign(&mut self, sign: &'static str, meaning: &'static str) -> Walk;

    /// One of several words, by its number; `about` tells what is chosen.
    fn choice(&mut self, about: &'static str, words: &[Word], chosen: &mut usize) -> Walk;

    /// A number.
    fn number(&mut self, about: &NumberPart, value: &mut f64) -> Walk;

    /// The name of something in the scene.
    fn name(&mut self, list: NameList, name: &mut Name) -> Walk;

    /// One or several such names, separated by commas.
    fn names(&mut self, list: NameList, names: &mut Vec<Name>) -> Walk;

    /// A light path expression in quotes.
    fn expression(&mut self, expression: &mut LightPathExpression) -> Walk;

    /// What is asked of one vertex.
    fn vertex(&mut self, test: &mut VertexTest) -> Walk;

    /// A place in what was followed so far, for [`Self::check`].
    fn mark(&self) -> usize {
        0
    }

    /// What is wrong with the parts since a mark, where something is.
    fn check(&mut self, since: usize, complaint: Option<&'static str>) -> Walk;

    /// Where a region lies that is asked for without telling where.
    fn spot(&self) -> Spot {
        Spot::default()
    }
}

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

/// Lets the form choose among the values of a closed set.
pub(super) fn choose<T: Worded>(form: &mut dyn Form, value: &mut T) -> Walk {
    let words: Vec<Word> = T::WORDS.iter().map(|&(_, word)| word).collect();
    let mut chosen = T::WORDS.iter().position(|(known, _)| known == value).unwrap_or(0);
    form.choice(T::ABOUT, &words, &mut chosen)?;
    if let Some(&(found, _)) = T::WORDS.get(chosen) {
        *value = found;
    }
    Ok(())
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

        impl $crate::filter::form::Worded for $name {
            const ABOUT: &'static str = $about;
            const WORDS: &'static [(Self, $crate::filter::form::Word)] = &[
                $((Self::$value, $crate::filter::form::Word {
                    text: $text,
                    also: &[$($also)?],
                    meaning: $meaning,
                }),)*
            ];

            fn word(self) -> &'static $crate::filter::form::Word {
                // The table is made of the same list, in the order of the values.
                &Self::WORDS[self as usize].1
            }
        }
    };
}
pub(super) use words;

/// What a number in a condition is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NumberPart {
    /// What it says.
    pub about: &'static str,
    /// The least value that makes sense beside its neighbours.
    pub least: f64,
    /// The largest.
    pub most: f64,
    /// Its unit.
    pub unit: Unit,
}

/// What a number counts or measures, which tells in which steps it changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unit {
    /// Whole things.
    Count,
    /// Lengths in the scene.
    Length,
    /// Coordinates on the film, where 1 is all of it.
    Film,
    /// Anything else.
    Plain,
}

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

/// A place in a scene and a length, in the units of its file: where a new region lies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spot {
    /// The place.
    pub centre: DVec3,
    /// The length.
    pub radius: f64,
}

impl Default for Spot {
    fn default() -> Self {
        Self { centre: DVec3::ZERO, radius: 1.0 }
    }
}

/// Something new that a menu can offer.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Proposal<T> {
    /// The menu that it stands in, or the topmost one.
    pub menu: Option<&'static str>,
    /// The line of the menu.
    pub label: String,
    /// What it means.
    pub meaning: &'static str,
    /// What is made; nothing where the line only tells that there is nothing to choose.
    pub made: Option<T>,
}

impl<T> Proposal<T> {
    /// The same line, which makes something else of it.
    pub(super) fn map<U>(self, make: impl FnOnce(T) -> U) -> Proposal<U> {
        let Self { menu, label, meaning, made } = self;
        Proposal { menu, label, meaning, made: made.map(make) }
    }
}
