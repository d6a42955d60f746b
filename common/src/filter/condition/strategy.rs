//! `strategy == NAME`: which strategy made the path.

use super::{Condition, Described, Form, Predicate, Proposal, Spot, choose};
use crate::filter::word::{NameList, Walk, Word, words};
use crate::filter::{FilterError, FilterScene, Name};
use crate::{PathHeader, VertexRecord};

words! {
    /// How strategies are asked for.
    pub enum Among: "How the strategy is asked for" {
        Is = "==" or "=", "this one";
        IsNot = "!=", "another one";
        In = "in", "one of several";
    }
}

/// A strategy made the path; `seed` means none did.
#[derive(Clone, Debug, PartialEq)]
pub struct StrategyCondition {
    /// How they are asked for.
    pub among: Among,
    /// Which; a single one except for [`Among::In`].
    pub names: Vec<Name>,
}

impl Default for StrategyCondition {
    fn default() -> Self {
        Self { among: Among::Is, names: vec![Name::from("seed")] }
    }
}

impl Described for StrategyCondition {
    fn describe(&mut self, form: &mut dyn Form) -> Walk {
        const STRATEGY: Word = Word::new("strategy", "the strategy that made the path");
        form.word(&STRATEGY)?;
        choose(form, &mut self.among)?;
        if self.among == Among::In {
            form.sign(" (", "")?;
            form.names(NameList::Strategies, &mut self.names)?;
            return form.sign(")", "the end of the list");
        }
        self.names.truncate(1);
        let mut name = self.names.pop().unwrap_or_default();
        form.name(NameList::Strategies, &mut name)?;
        self.names.push(name);
        Ok(())
    }
}

impl Condition for StrategyCondition {
    type Predicate = MadeBy;
    const EXAMPLE: &'static str = "strategy == lens";

    fn bind(&self, scene: &FilterScene) -> Result<MadeBy, FilterError> {
        let indices = self.names.iter().map(|name| scene.strategy_named(name));
        let indices = indices.collect::<Result<_, _>>()?;
        Ok(MadeBy { indices, wanted: self.among != Among::IsNot })
    }

    fn proposals(scene: &FilterScene, _: Spot) -> Vec<Proposal<Self>> {
        let proposal = |name| Proposal {
            menu: Some("Strategy"),
            label: String::from(name),
            meaning: "It made the path",
            made: Some(Self { among: Among::Is, names: vec![Name::from(name)] }),
        };
        scene.names(NameList::Strategies).into_iter().map(proposal).collect()
    }
}

/// Strategies by their indices, and whether one of them is wanted or none.
#[derive(Clone, Debug)]
pub(in crate::filter) struct MadeBy {
    indices: Vec<u8>,
    wanted: bool,
}

impl Predicate for MadeBy {
    fn holds(&self, header: &PathHeader, _: &[VertexRecord]) -> bool {
        self.indices.contains(&header.strategy.0) == self.wanted
    }
}
