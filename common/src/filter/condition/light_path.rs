//! `lpe "..."`: the sequence of events fits an expression.

use super::{Condition, Described, Form, Predicate, Proposal, Spot};
use crate::filter::lpe::LightPathAutomaton;
use crate::filter::word::{Walk, Word};
use crate::filter::{FilterError, FilterScene, LightPathExpression};
use crate::{PathHeader, VertexRecord};

/// The sequence of events fits an expression.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LightPathCondition(pub LightPathExpression);

impl Described for LightPathCondition {
    fn describe(&mut self, form: &mut dyn Form) -> Walk {
        const LPE: Word = Word::new("lpe", "a light path expression");
        form.word(&LPE)?;
        form.expression(&mut self.0)
    }
}

impl Condition for LightPathCondition {
    type Predicate = Box<LightPathAutomaton>;
    const EXAMPLE: &'static str = "lpe \"CDS+L\"";

    fn bind(&self, scene: &FilterScene) -> Result<Box<LightPathAutomaton>, FilterError> {
        self.0.compile(scene).map(Box::new)
    }

    fn proposals(_: &FilterScene, _: Spot) -> Vec<Proposal<Self>> {
        vec![Proposal {
            menu: None,
            label: "Light path expression".to_owned(),
            meaning: "The events along the path, such as `CDS+L`",
            made: Some(Self::default()),
        }]
    }

    fn remark(&self) -> Option<&'static str> {
        self.0.is_likely_mistaken().then_some(
            "`RD` is two vertices, a reflection and then something diffuse; `<RD>` is one vertex \
             that is both.",
        )
    }
}

impl Predicate for Box<LightPathAutomaton> {
    fn holds(&self, _: &PathHeader, path: &[VertexRecord]) -> bool {
        self.matches(path)
    }
}
