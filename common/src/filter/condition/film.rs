//! `film in rect(...)`: the film point lies in a rectangle.

use super::{Condition, Described, Form, Gap, NumberPart, Predicate, Proposal, Spot, Unit};
use crate::filter::word::{Walk, Word};
use crate::filter::{FilterError, FilterScene, MARGIN};
use crate::{PathHeader, VertexRecord};

/// The film point lies in a rectangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FilmCondition {
    /// Least `u` (to the right) and `v` (downwards).
    pub min: [f64; 2],
    /// Largest `u` and `v`.
    pub max: [f64; 2],
}

impl Default for FilmCondition {
    fn default() -> Self {
        Self { min: [0.25; 2], max: [0.75; 2] }
    }
}

impl Described for FilmCondition {
    fn describe(&mut self, form: &mut dyn Form) -> Walk {
        const FILM: Word = Word::new("film", "where on the film");
        const IN: Word = Word::new("in", "lies within");
        const RECT: Word = Word::new("rect", "left, top, right, bottom; 0 to 1");
        let coordinate = |about, least, most| NumberPart { about, least, most, unit: Unit::Film };
        form.word(&FILM)?;
        form.word(&IN)?;
        form.word(&RECT)?;
        let start = form.mark();
        form.sign("(", "")?;
        form.number(&coordinate("left", 0.0, self.max[0]), &mut self.min[0])?;
        form.sign(", ", "")?;
        form.number(&coordinate("top", 0.0, self.max[1]), &mut self.min[1])?;
        form.sign(", ", "")?;
        form.number(&coordinate("right", self.min[0], 1.0), &mut self.max[0])?;
        form.sign(", ", "")?;
        form.number(&coordinate("bottom", self.min[1], 1.0), &mut self.max[1])?;
        form.sign(")", "")?;
        let ordered = self.min[0] <= self.max[0] && self.min[1] <= self.max[1];
        let complaint = "a rectangle is left, top, right, bottom, each from 0 to 1";
        form.check(start, (!ordered).then_some(complaint))
    }
}

impl Condition for FilmCondition {
    type Predicate = OnFilm;
    const EXAMPLE: &'static str = "film in rect(0.25, 0.25, 0.75, 0.75)";

    fn bind(&self, _: &FilterScene) -> Result<OnFilm, FilterError> {
        let single = |coordinates: [f64; 2]| coordinates.map(|coordinate| coordinate as f32);
        Ok(OnFilm { min: single(self.min), max: single(self.max) })
    }

    fn proposals(_: &FilterScene, _: Spot) -> Vec<Proposal<Self>> {
        vec![Proposal {
            menu: None,
            label: "Part of the film".to_owned(),
            meaning: "Where on the film the path arrives",
            made: Some(Self::default()),
        }]
    }

    fn widened(&self, by: f64) -> Option<(&'static str, Self)> {
        let by = by * MARGIN;
        let min = self.min.map(|least| (least - by).max(0.0));
        let max = self.max.map(|most| (most + by).min(1.0));
        Some(("Widen the rectangle", Self { min, max }))
    }
}

/// A rectangle, in the precision of film points.
#[derive(Clone, Copy, Debug)]
pub(in crate::filter) struct OnFilm {
    min: [f32; 2],
    max: [f32; 2],
}

impl Predicate for OnFilm {
    fn holds(&self, header: &PathHeader, _: &[VertexRecord]) -> bool {
        (0..2).all(|i| (self.min[i]..=self.max[i]).contains(&header.film[i]))
    }

    fn gap(&self, header: &PathHeader, _: &[VertexRecord]) -> Option<Gap> {
        let outside =
            |i: usize| (self.min[i] - header.film[i]).max(header.film[i] - self.max[i]).max(0.0);
        let by = f64::from(outside(0).hypot(outside(1)));
        Some(Gap { by, relative: by })
    }
}
