//! `edges >= 4`: a number compares to another, or lies in a range.

use super::attribute::{Attribute, Comparison};
use super::{Condition, Described, Form, Gap, NumberPart, Predicate, Proposal, Spot, Unit, choose};
use crate::filter::word::{Walk, Word, Worded as _};
use crate::filter::{FilterError, FilterScene, MARGIN};
use crate::{PathHeader, VertexRecord};

/// A number compares to another, or lies in a range.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NumberCondition {
    /// The number.
    pub attribute: Attribute,
    /// What it should be.
    pub relation: Relation,
}

/// What a number should be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Relation {
    /// It compares to another.
    Compares(Comparison, f64),
    /// It lies in a range, both ends included.
    Within {
        /// The least value.
        least: f64,
        /// The largest value.
        most: f64,
    },
}

impl From<Attribute> for NumberCondition {
    /// What is usually asked of a number.
    fn from(attribute: Attribute) -> Self {
        let (comparison, value) = attribute.usual();
        Self { attribute, relation: Relation::Compares(comparison, value) }
    }
}

impl Default for NumberCondition {
    fn default() -> Self {
        Self::from(Attribute::Edges)
    }
}

impl Described for NumberCondition {
    fn describe(&mut self, form: &mut dyn Form) -> Walk {
        choose(form, &mut self.attribute)?;
        self.relation.choose(form)?;
        let attribute = self.attribute;
        let part = |least, most| {
            let unit = if attribute.is_whole() { Unit::Count } else { Unit::Plain };
            NumberPart { about: attribute.word().meaning, least, most, unit }
        };
        const MOST: f64 = 1e12;
        match &mut self.relation {
            Relation::Compares(_, value) => form.number(&part(0.0, MOST), value),
            Relation::Within { least, most } => {
                let start = form.mark();
                form.number(&part(0.0, *most), least)?;
                form.sign("..", "")?;
                form.number(&part(*least, MOST), most)?;
                let complaint = "the range is empty; write the smaller number first";
                form.check(start, (!(least <= most)).then_some(complaint))
            }
        }
    }
}

impl Relation {
    /// Lets the form choose how the number is asked for; what it is compared with stays.
    fn choose(&mut self, form: &mut dyn Form) -> Walk {
        const IN: Word = Word::new("in", "LEAST..MOST");
        let words: Vec<Word> =
            Comparison::WORDS.iter().map(|&(_, word)| word).chain([IN]).collect();
        let mut chosen = match *self {
            Self::Compares(comparison, _) => Comparison::all().position(|c| c == comparison),
            Self::Within { .. } => None,
        }
        .unwrap_or(words.len() - 1);
        form.choice(Comparison::ABOUT, &words, &mut chosen)?;
        *self = match (Comparison::all().nth(chosen), *self) {
            (Some(comparison), Self::Compares(_, value) | Self::Within { least: value, .. }) => {
                Self::Compares(comparison, value)
            }
            (None, Self::Compares(_, value)) => Self::Within { least: value, most: value },
            (None, within @ Self::Within { .. }) => within,
        };
        Ok(())
    }
}

impl Condition for NumberCondition {
    type Predicate = NumberPredicate;
    const EXAMPLE: &'static str = "edges >= 4";

    fn bind(&self, scene: &FilterScene) -> Result<NumberPredicate, FilterError> {
        let Self { attribute, relation } = *self;
        let rounded = |value| attribute.rounded(value);
        let relation = match relation {
            Relation::Compares(comparison, value) => Relation::Compares(comparison, rounded(value)),
            Relation::Within { least, most } => {
                Relation::Within { least: rounded(least), most: rounded(most) }
            }
        };
        Ok(NumberPredicate { attribute, scale: attribute.scale(scene.frame), relation })
    }

    fn proposals(_: &FilterScene, _: Spot) -> Vec<Proposal<Self>> {
        let proposal = |attribute: Attribute| Proposal {
            menu: Some("Number"),
            label: attribute.word().text.to_owned(),
            meaning: attribute.word().meaning,
            made: Some(Self::from(attribute)),
        };
        Attribute::all().map(proposal).collect()
    }

    fn widened(&self, by: f64) -> Option<(&'static str, Self)> {
        let by = if self.attribute.is_whole() { by } else { by * MARGIN };
        let relation = match self.relation {
            Relation::Compares(Comparison::AtLeast | Comparison::Greater, value) => {
                Relation::Compares(Comparison::AtLeast, value - by)
            }
            Relation::Compares(Comparison::AtMost | Comparison::Less, value) => {
                Relation::Compares(Comparison::AtMost, value + by)
            }
            Relation::Within { least, most } => {
                Relation::Within { least: (least - by).max(0.0), most: most + by }
            }
            Relation::Compares(Comparison::Equal | Comparison::NotEqual, _) => return None,
        };
        Some(("Loosen the bound", Self { relation, ..*self }))
    }
}

/// A number as precise as it travels, `scale` times as large as in the units of the file.
#[derive(Clone, Copy, Debug)]
pub(in crate::filter) struct NumberPredicate {
    attribute: Attribute,
    scale: f64,
    relation: Relation,
}

impl NumberPredicate {
    #[inline]
    fn own(&self, header: &PathHeader, path: &[VertexRecord]) -> f64 {
        self.attribute.value(header, path, self.scale)
    }
}

impl Predicate for NumberPredicate {
    #[inline]
    fn holds(&self, header: &PathHeader, path: &[VertexRecord]) -> bool {
        let own = self.attribute.rounded(self.own(header, path));
        match self.relation {
            Relation::Compares(comparison, value) => comparison.holds(own, value),
            Relation::Within { least, most } => (least..=most).contains(&own),
        }
    }

    fn gap(&self, header: &PathHeader, path: &[VertexRecord]) -> Option<Gap> {
        let own = self.own(header, path);
        let (by, asked) = match self.relation {
            Relation::Compares(Comparison::NotEqual, _) => return None,
            Relation::Compares(_, value) => ((own - value).abs(), value),
            Relation::Within { least, most } => ((least - own).max(own - most).max(0.0), least),
        };
        // How much of a number is much.
        let floor = if self.attribute.is_whole() { 1.0 } else { f64::MIN_POSITIVE };
        Some(Gap { by, relative: by / asked.abs().max(floor) })
    }
}
