//! Filters drawn at random: another form that descriptions are walked with, so that every registered
//! condition takes part in every law.

use proptest::prelude::*;

use super::super::condition::Leaves;
use super::*;

/// Names as scenes have them, and as nobody expects them.
const NAMES: [&str; 10] = [
    "glass",
    "wall",
    "lamp",
    "table",
    "lens subpath",
    "Material #25",
    "a;b 100%",
    "O'Brien \"glass\"",
    "стекло",
    "back\\slash  and two blanks",
];

/// Expressions of every kind.
const EXPRESSIONS: [&str; 6] = [
    "C.*L",
    "CD*L",
    "L.*'gl\"ass'S{2,}C",
    ".*",
    "C([DG]|<TS>)+L",
    "C.*<.S'O\\'Brien \"glass\"'>[^'#']?L",
];

/// Numbers that stand for what is drawn; where they end, the first and simplest is.
#[derive(Debug)]
struct Tape {
    numbers: Vec<u32>,
    at: usize,
    /// Groups within groups that are still allowed.
    depth: usize,
}

impl Tape {
    fn below(&mut self, count: usize) -> usize {
        let number = self.numbers.get(self.at).copied().unwrap_or(0);
        self.at += 1;
        number as usize % count
    }

    fn tree<T: Leaves>(&mut self) -> Tree<T> {
        let kinds: Vec<_> = T::kinds().collect();
        let choices = if self.depth == 0 { 4 } else { 8 };
        match self.below(choices) {
            7 => Tree::Or(self.parts()),
            6 => Tree::And(self.parts()),
            5 => {
                self.depth -= 1;
                let part = self.tree();
                self.depth += 1;
                Tree::Not(Box::new(part))
            }
            4 => Tree::Constant(self.below(2) == 0),
            _ => {
                let number = self.below(kinds.len());
                let (mut leaf, _) = kinds.into_iter().nth(number).expect("some kind");
                assert_eq!(leaf.describe(self), Ok(()), "whatever is drawn makes sense");
                Tree::Leaf(leaf)
            }
        }
    }

    fn parts<T: Leaves>(&mut self) -> Vec<Tree<T>> {
        self.depth -= 1;
        let parts = (0..2 + self.below(2)).map(|_| self.tree()).collect();
        self.depth += 1;
        parts
    }
}

impl Form for Tape {
    fn word(&mut self, _: &'static Word) -> Walk {
        Ok(())
    }

    fn sign(&mut self, _: &'static str, _: &'static str) -> Walk {
        Ok(())
    }

    fn choice(&mut self, _: &'static str, words: &[Word], chosen: &mut usize) -> Walk {
        *chosen = self.below(words.len());
        Ok(())
    }

    fn number(&mut self, about: &NumberPart, value: &mut f64) -> Walk {
        let fraction = self.below(1 << 16) as f64 / f64::from(1 << 16);
        let drawn = match self.below(4) {
            0 => fraction.mul_add(8.0, -2.0),
            1 => 1.7 * 10_f64.powf(self.below(300) as f64 - 200.0),
            2 => -fraction * 10_f64.powf(self.below(12) as f64),
            _ => (fraction * 1e4).round(),
        };
        *value = drawn.clamp(about.least, about.most);
        Ok(())
    }

    fn name(&mut self, _: NameList, name: &mut Name) -> Walk {
        *name = Name::from(NAMES[self.below(NAMES.len())]);
        Ok(())
    }

    fn names(&mut self, list: NameList, names: &mut Vec<Name>) -> Walk {
        names.resize(1 + self.below(3), Name::default());
        names.iter_mut().try_for_each(|name| self.name(list, name))
    }

    fn expression(&mut self, expression: &mut LightPathExpression) -> Walk {
        let text = EXPRESSIONS[self.below(EXPRESSIONS.len())];
        *expression = LightPathExpression::parse(text).expect(text);
        Ok(())
    }

    fn vertex(&mut self, test: &mut VertexTest) -> Walk {
        *test = self.tree();
        Ok(())
    }

    /// The ranges that numbers are drawn from must be such that nothing is wrong.
    fn check(&mut self, _: usize, complaint: Option<&'static str>) -> Walk {
        assert_eq!(complaint, None, "a number within its range");
        Ok(())
    }
}

/// Any filter, of every registered condition.
pub(super) fn filter() -> impl Strategy<Value = Filter> {
    prop::collection::vec(any::<u32>(), 0..160)
        .prop_map(|numbers| Tape { numbers, at: 0, depth: 4 }.tree())
}
