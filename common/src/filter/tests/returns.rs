//! `returns within LENGTH`: the path ends near its start.

use super::volume::point;
use super::{Condition, Described, Form, Gap, NumberPart, Predicate, Proposal, Spot, Unit};
use crate::filter::word::{Walk, Word};
use crate::filter::{FilterError, FilterScene};
use crate::{PathHeader, VertexRecord};

/// The path ends near its start.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReturnsCondition {
    /// How far away, in the units of the scene file.
    pub reach: f64,
}

impl Default for ReturnsCondition {
    fn default() -> Self {
        Self { reach: 1.0 }
    }
}

impl Described for ReturnsCondition {
    fn describe(&mut self, form: &mut dyn Form) -> Walk {
        const RETURNS: Word = Word::new("returns", "ends near its start");
        const WITHIN: Word = Word::new("within", "a length in the units of the scene file");
        form.word(&RETURNS)?;
        form.word(&WITHIN)?;
        let about = "distance from start to end";
        let part = NumberPart { about, least: 0.0, most: 1e12, unit: Unit::Length };
        let start = form.mark();
        form.number(&part, &mut self.reach)?;
        form.check(start, (self.reach < 0.0).then_some("a distance is not negative"))
    }
}

impl Condition for ReturnsCondition {
    type Predicate = Returns;
    const EXAMPLE: &'static str = "returns within 0.5";

    fn bind(&self, scene: &FilterScene) -> Result<Returns, FilterError> {
        Ok(Returns { reach: self.reach * scene.frame.scale, scale: scene.frame.scale })
    }

    fn proposals(_: &FilterScene, spot: Spot) -> Vec<Proposal<Self>> {
        vec![Proposal {
            menu: None,
            label: "Ends near its start".to_owned(),
            meaning: "The lens is near the light",
            made: Some(Self { reach: spot.radius }),
        }]
    }
}

/// A length in scene units, `scale` of which make one of the file.
#[derive(Clone, Copy, Debug)]
pub(in crate::filter) struct Returns {
    reach: f64,
    scale: f64,
}

impl Returns {
    fn distance(path: &[VertexRecord]) -> Option<f64> {
        Some((point(path.last()?) - point(path.first()?)).length())
    }
}

impl Predicate for Returns {
    fn holds(&self, _: &PathHeader, path: &[VertexRecord]) -> bool {
        Self::distance(path).is_some_and(|distance| distance <= self.reach)
    }

    fn gap(&self, _: &PathHeader, path: &[VertexRecord]) -> Option<Gap> {
        let beyond = (Self::distance(path)? - self.reach).max(0.0);
        let by = beyond / self.scale;
        Some(Gap { by, relative: beyond / self.reach.max(f64::MIN_POSITIVE) })
    }
}
