//! What a user may say of the strategies: weights, switches and sizes.

use thiserror::Error;

use super::{KINDS, Kind, STRATEGY_COUNT, Sizes};

/// Most parameters that a strategy can have.
const MAX_PARAMETERS: usize = 4;

/// A quantity of a strategy that a user may set.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parameter {
    /// Its name in options and scene files.
    pub name: &'static str,
    /// What it means, with its unit.
    pub about: &'static str,
    /// What values look like.
    pub form: Form,
    /// Smallest value that makes sense.
    pub lowest: f64,
    /// Largest value that makes sense.
    pub highest: f64,
}

/// What the values of a parameter look like.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// One number.
    Number,
    /// A smallest and a larger largest size: `0.1..20`.
    Sizes,
}

/// What a user has said of one strategy.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Tuning {
    weight: Option<f64>,
    values: [Option<(&'static str, Sizes)>; MAX_PARAMETERS],
}

impl Tuning {
    /// The sizes that the user wants for a parameter.
    pub fn sizes(&self, parameter: &str) -> Option<Sizes> {
        self.values.iter().flatten().find(|(name, _)| *name == parameter).map(|(_, sizes)| *sizes)
    }

    /// The number that the user wants for a parameter.
    pub fn number(&self, parameter: &str) -> Option<f64> {
        self.sizes(parameter).map(|sizes| sizes.min)
    }

    fn set(&mut self, parameter: &'static str, sizes: Sizes) {
        let held =
            self.values.iter().position(|value| value.is_none_or(|(name, _)| name == parameter));
        // `Kind::check` sees to it that there is room.
        if let Some(slot) = held.and_then(|index| self.values.get_mut(index)) {
            *slot = Some((parameter, sizes));
        }
    }
}

/// What a user has said of all strategies; nothing by default.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StrategyOptions {
    /// Whether a pilot sets the weights; without a word it does unless the user gave weights.
    pub adapt: Option<bool>,
    tunings: [Tuning; STRATEGY_COUNT],
}

/// Why a wish cannot be met.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum OptionError {
    /// No strategy of that name.
    #[error("there is no strategy `{0}`; the strategies are {list}", list = strategy_list())]
    NoStrategy(String),
    /// No parameter of that name.
    #[error("the strategy `{strategy}` has no parameter `{parameter}`; {has}")]
    NoParameter {
        /// The strategy's key.
        strategy: String,
        /// What was asked for.
        parameter: String,
        /// What there is.
        has: String,
    },
    /// A weight that is none.
    #[error(
        "{strategy} = {value}: a weight is a number from 0 (off) to 1e6, relative to the others"
    )]
    Weight {
        /// The strategy's key.
        strategy: String,
        /// What was given.
        value: f64,
    },
    /// A value outside a parameter's bounds.
    #[error("{parameter} = {value}: {wanted}")]
    Value {
        /// Strategy and parameter.
        parameter: String,
        /// What was given.
        value: String,
        /// What would do.
        wanted: String,
    },
    /// Everything was switched off.
    #[error("no strategy is left; the strategies are {list}", list = strategy_list())]
    NothingLeft,
}

/// A strategy's name without spaces: how options and scene files spell it.
pub fn key_of(name: &str) -> String {
    name.replace(' ', "-")
}

fn strategy_list() -> String {
    KINDS.iter().map(Kind::key).collect::<Vec<_>>().join(", ")
}

impl Kind {
    /// The name in options and scene files: without spaces.
    pub fn key(&self) -> String {
        key_of(self.name)
    }

    fn find(key: &str) -> Result<usize, OptionError> {
        let found = KINDS.iter().position(|kind| kind.key() == key || kind.name == key);
        found.ok_or_else(|| OptionError::NoStrategy(key.to_owned()))
    }

    fn parameter(&self, name: &str) -> Result<&'static Parameter, OptionError> {
        self.parameters.iter().find(|parameter| parameter.name == name).ok_or_else(|| {
            let names: Vec<_> = self.parameters.iter().map(|parameter| parameter.name).collect();
            let has = if names.is_empty() {
                "it has none".to_owned()
            } else {
                format!("its parameters: {}", names.join(", "))
            };
            OptionError::NoParameter { strategy: self.key(), parameter: name.to_owned(), has }
        })
    }
}

impl Parameter {
    /// Smallest and largest size of something on the film, in pixels.
    pub const fn on_film(name: &'static str, about: &'static str) -> Self {
        Self { name, about, form: Form::Sizes, lowest: 1e-6, highest: 1e6 }
    }

    /// The bounds in words.
    pub fn wanted(&self) -> String {
        let Self { lowest, highest, .. } = self;
        match self.form {
            Form::Number => format!("give a number from {lowest:e} to {highest:e}"),
            Form::Sizes => format!(
                "give the smallest and the largest size as MIN..MAX with MIN below MAX, from \
                 {lowest:e} to {highest:e}"
            ),
        }
    }

    fn accepts(&self, values: &[f64]) -> Option<Sizes> {
        let inside = |value: f64| (self.lowest..=self.highest).contains(&value);
        match self.form {
            Form::Number => match *values {
                [value] if inside(value) => Some(Sizes { min: value, max: value }),
                _ => None,
            },
            Form::Sizes => match *values {
                [min, max] if inside(min) && inside(max) && min < max => Some(Sizes { min, max }),
                _ => None,
            },
        }
    }
}

impl StrategyOptions {
    /// What was said of the strategy number `index` of [`KINDS`].
    pub fn tuning(&self, index: usize) -> &Tuning {
        &self.tunings[index]
    }

    /// The weight of the strategy number `index`: the user's, or else the strategy's own.
    pub fn weight(&self, index: usize) -> f64 {
        self.tunings[index].weight.unwrap_or(KINDS[index].weight)
    }

    /// True when a pilot is to set the weights.
    pub fn adapts(&self) -> bool {
        let given = |tuning: &Tuning| tuning.weight.is_some_and(|weight| weight > 0.0);
        self.adapt.unwrap_or_else(|| !self.tunings.iter().any(given))
    }

    /// Sets one weight; zero switches the strategy off.
    pub fn set_weight(&mut self, strategy: &str, weight: f64) -> Result<(), OptionError> {
        let index = Kind::find(strategy)?;
        if !(0.0..=1e6).contains(&weight) {
            return Err(OptionError::Weight { strategy: strategy.to_owned(), value: weight });
        }
        self.tunings[index].weight = Some(weight);
        Ok(())
    }

    /// Sets a parameter to one number, or to a smallest and a largest size.
    pub fn set_parameter(
        &mut self,
        strategy: &str,
        parameter: &str,
        values: &[f64],
    ) -> Result<(), OptionError> {
        let index = Kind::find(strategy)?;
        let known = KINDS[index].parameter(parameter)?;
        let sizes = known.accepts(values).ok_or_else(|| OptionError::Value {
            parameter: format!("{strategy}.{parameter}"),
            value: values.iter().map(ToString::to_string).collect::<Vec<_>>().join(".."),
            wanted: known.wanted(),
        })?;
        self.tunings[index].set(known.name, sizes);
        Ok(())
    }

    /// Leaves only the listed strategies on, with the weights given.
    pub fn restrict(&mut self, list: &[(String, Option<f64>)]) -> Result<(), OptionError> {
        let mut listed = [None; STRATEGY_COUNT];
        for (strategy, weight) in list {
            let before = self.tunings[Kind::find(strategy)?].weight;
            if let Some(weight) = *weight {
                self.set_weight(strategy, weight)?;
            }
            let weight = weight.or_else(|| before.filter(|&weight| weight > 0.0));
            listed[Kind::find(strategy)?] = Some(weight);
        }
        for (tuning, listed) in self.tunings.iter_mut().zip(listed) {
            tuning.weight = listed.unwrap_or(Some(0.0));
        }
        Ok(())
    }

    /// Refuses a choice that leaves nothing.
    pub fn check(&self) -> Result<(), OptionError> {
        let left = (0..STRATEGY_COUNT).any(|index| self.weight(index) > 0.0);
        if left { Ok(()) } else { Err(OptionError::NothingLeft) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_unknown_is_told_with_what_there_is() {
        let mut options = StrategyOptions::default();
        let error = options.set_weight("lense", 1.0).expect_err("no such strategy").to_string();
        assert!(error.contains("`lense`") && error.contains("lens-subpath"), "{error}");
        let error = options.set_parameter("lens", "angle", &[1.0]).expect_err("no angle");
        assert!(error.to_string().contains("its parameters: radius"), "{error}");
        for values in [&[1.0][..], &[2.0, 1.0], &[0.0, 1.0], &[1.0, f64::NAN], &[1.0, 1e99]] {
            let error = options.set_parameter("lens", "radius", values).expect_err("no sizes");
            assert!(error.to_string().contains("MIN..MAX"), "{values:?}: {error}");
        }
        for weight in [-1.0, f64::NAN, f64::INFINITY] {
            assert!(options.set_weight("lens", weight).is_err(), "{weight} is no weight");
        }
        assert_eq!(options, StrategyOptions::default(), "a refused wish changes nothing");
    }

    #[test]
    fn a_list_switches_the_others_off() {
        let mut options = StrategyOptions::default();
        options.set_weight("caustic", 0.0).expect("a weight");
        options.set_weight("bidirectional", 0.7).expect("a weight");
        assert!(!options.adapts(), "weights that are given stay");
        let list = [("caustic", None), ("lens", Some(0.2)), ("bidirectional", None)];
        let list = list.map(|(name, weight)| (name.to_owned(), weight));
        options.restrict(&list).expect("a list");
        let weight = |name: &str| options.weight(Kind::find(name).expect("a strategy"));
        assert_eq!(weight("lens"), 0.2);
        assert_eq!(weight("bidirectional"), 0.7, "what was said before stands");
        assert!(weight("caustic") > 0.0, "who lists it wants it");
        assert_eq!(weight("independent"), 0.0);
        options.check().expect("three are left");
        options.restrict(&[]).expect("a list");
        assert_eq!(options.check(), Err(OptionError::NothingLeft));
    }

    #[test]
    fn parameters_are_kept_by_name() {
        let mut options = StrategyOptions::default();
        options.set_parameter("lens", "radius", &[0.5, 4.0]).expect("sizes");
        options.set_parameter("lens", "radius", &[0.5, 8.0]).expect("sizes");
        let tuning = options.tuning(Kind::find("lens").expect("a strategy"));
        assert_eq!(tuning.sizes("radius"), Some(Sizes { min: 0.5, max: 8.0 }), "the last counts");
        assert_eq!(tuning.sizes("angle"), None);
        assert!(options.adapts(), "a size is no weight");
        assert!(KINDS.iter().all(|kind| kind.parameters.len() <= MAX_PARAMETERS), "room for all");
    }
}
