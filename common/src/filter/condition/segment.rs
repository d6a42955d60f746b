//! `any through sphere(...)`: segments pass through a region.

use super::place::{Place, least, most};
use super::volume::{Volume, point};
use super::{Condition, Described, Form, Gap, Predicate, Proposal, Spot, choose};
use crate::filter::word::{Walk, Word};
use crate::filter::{FilterError, FilterScene};
use crate::{PathHeader, VertexRecord};

/// Segments pass through a region.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SegmentCondition {
    /// Which.
    pub place: Place,
    /// The region.
    pub volume: Volume,
}

impl Described for SegmentCondition {
    fn describe(&mut self, form: &mut dyn Form) -> Walk {
        const THROUGH: Word = Word::new("through", "a segment passes a region");
        choose(form, &mut self.place)?;
        form.word(&THROUGH)?;
        self.volume.describe(form)
    }
}

impl Condition for SegmentCondition {
    type Predicate = SegmentPredicate;
    const EXAMPLE: &'static str = "any through box(-1, 0, -1, 1, 0.1, 1)";

    fn bind(&self, scene: &FilterScene) -> Result<SegmentPredicate, FilterError> {
        let volume = self.volume.bind(scene.frame)?;
        Ok(SegmentPredicate { place: self.place, volume, scale: scene.frame.scale })
    }

    fn proposals(_: &FilterScene, spot: Spot) -> Vec<Proposal<Self>> {
        vec![Proposal {
            menu: None,
            label: "Segment through a box".to_owned(),
            meaning: "A segment passes through it",
            made: Some(Self { place: Place::Any, volume: Volume::cube(spot) }),
        }]
    }

    fn widened(&self, by: f64) -> Option<(&'static str, Self)> {
        let (label, volume) = self.volume.widened(by);
        Some((label, Self { volume, ..*self }))
    }
}

/// A region in scene units, `scale` of which make one of the file.
#[derive(Clone, Debug)]
pub(in crate::filter) struct SegmentPredicate {
    place: Place,
    volume: Volume,
    scale: f64,
}

impl Predicate for SegmentPredicate {
    fn holds(&self, _: &PathHeader, path: &[VertexRecord]) -> bool {
        let meets = |i: usize| match path.get(i..i + 2) {
            Some([a, b]) => self.volume.meets_segment(point(a), point(b)),
            _ => false,
        };
        let count = path.len().saturating_sub(1);
        match self.place {
            Place::Start => meets(0),
            Place::End => count > 0 && meets(count - 1),
            Place::Any => (0..count).any(meets),
            Place::All => (0..count).all(meets),
        }
    }

    fn gap(&self, _: &PathHeader, path: &[VertexRecord]) -> Option<Gap> {
        let gap = |pair: &[VertexRecord]| match pair {
            [a, b] => Some(self.volume.distance_to_segment(point(a), point(b))),
            _ => None,
        };
        let mut pairs = path.windows(2);
        let gap = match self.place {
            Place::Start => pairs.next().and_then(gap),
            Place::End => pairs.next_back().and_then(gap),
            Place::Any => least(pairs.map(gap)),
            Place::All => most(pairs.map(gap)),
        }?;
        Some(Gap { by: gap / self.scale, relative: gap / self.volume.reach() })
    }
}
