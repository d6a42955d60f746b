//! What a scene file asks of the mutation strategies, as it stands there: names are not looked up
//! here, because a scene does not know how it is sampled.

use std::collections::BTreeMap;
use std::path::Path;

use serde::Deserialize;
use toml::Spanned;

use crate::scene::reading::diagnostic::Place;
use crate::scene::reading::{StrategySetting, Wish};

/// `[strategies]`: by name a weight, or a table with `weight` and the strategy's parameters.
pub(crate) type StrategyTable = BTreeMap<Spanned<String>, StrategyEntry>;

/// `lens = 0.3` or `lens = { weight = 0.3, radius = [0.1, 20] }`.
#[derive(Clone, Debug, Deserialize)]
#[serde(untagged, expecting = "a weight, or a table of weight and parameters")]
pub(crate) enum StrategyEntry {
    /// A weight.
    Weight(f64),
    /// Weight and parameters.
    Table(BTreeMap<String, Values>),
}

/// One number, or a smallest and a largest size.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(untagged, expecting = "a number, or two numbers [smallest, largest]")]
pub(crate) enum Values {
    /// One number.
    Number(f64),
    /// Sizes.
    Sizes([f64; 2]),
}

/// The settings in a file's `[strategies]`, with their places.
pub(crate) fn settings(table: &StrategyTable, text: &str, file: &Path) -> Vec<StrategySetting> {
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
