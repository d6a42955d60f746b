//! What a scene file asks of the mutation strategies, as it stands there: names are not looked up
//! here, because a scene does not know how it is sampled.

use std::collections::BTreeMap;
use std::path::Path;

use serde::Deserialize;
use toml::Spanned;

use super::diagnostic::Place;

/// One wish of a scene's author about a strategy.
#[derive(Clone, Debug, PartialEq)]
pub struct StrategySetting {
    /// Where it stands.
    pub place: Place,
    /// Name of the strategy.
    pub strategy: String,
    /// What is wished.
    pub wish: Wish,
}

/// What is wished of a strategy.
#[derive(Clone, Debug, PartialEq)]
pub enum Wish {
    /// A weight; zero switches the strategy off.
    Weight(f64),
    /// One number, or a smallest and a largest size, for a parameter.
    Parameter(String, Vec<f64>),
}

/// `[strategies]`: by name a weight, or a table with `weight` and the strategy's parameters.
pub(super) type StrategyTable = BTreeMap<Spanned<String>, StrategyEntry>;

/// `lens = 0.3` or `lens = { weight = 0.3, radius = [0.1, 20] }`.
#[derive(Clone, Debug, Deserialize)]
#[serde(untagged, expecting = "a weight, or a table of weight and parameters")]
pub(super) enum StrategyEntry {
    /// A weight.
    Weight(f64),
    /// Weight and parameters.
    Table(BTreeMap<String, Values>),
}

/// One number, or a smallest and a largest size.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(untagged, expecting = "a number, or two numbers [smallest, largest]")]
pub(super) enum Values {
    /// One number.
    Number(f64),
    /// Sizes.
    Sizes([f64; 2]),
}

/// The wishes in a file's `[strategies]`, with their places.
pub(super) fn settings(table: &StrategyTable, text: &str, file: &Path) -> Vec<StrategySetting> {
    let mut settings = Vec::new();
    for (name, entry) in table {
        let place = Place::offset(file, text, name.span().start);
        let strategy = name.get_ref().clone();
        let setting =
            |wish| StrategySetting { place: place.clone(), strategy: strategy.clone(), wish };
        match entry {
            StrategyEntry::Weight(weight) => settings.push(setting(Wish::Weight(*weight))),
            StrategyEntry::Table(entries) => {
                settings.extend(entries.iter().map(|(key, values)| setting(wish(key, values))));
            }
        }
    }
    settings
}

fn wish(key: &str, values: &Values) -> Wish {
    match values {
        Values::Number(weight) if key == "weight" => Wish::Weight(*weight),
        Values::Number(number) => Wish::Parameter(key.to_owned(), vec![*number]),
        Values::Sizes(sizes) => Wish::Parameter(key.to_owned(), sizes.to_vec()),
    }
}
