//! What is asked of explorer and chains.

use common::{PathId, Seed, SkipTo, StrategyId, StrategySet};

use super::{CommandError, Value, Words, range};

/// Strategies that can be told apart.
const STRATEGIES: u8 = 64;

impl Value for StrategyId {
    type Limits = ();

    fn form(_: &str, (): &()) -> String {
        "N".to_owned()
    }

    fn read(words: &mut Words<'_>, _: &str, (): &()) -> Result<Self, CommandError> {
        range(0, STRATEGIES - 1).read(words, "N").map(Self)
    }

    fn text(&self) -> String {
        self.0.to_string()
    }

    fn examples((): &()) -> Vec<Self> {
        vec![Self(0), Self(STRATEGIES - 1)]
    }
}

impl Value for Seed {
    type Limits = ();

    fn form(_: &str, (): &()) -> String {
        "CHAIN.EPOCH.STEP|newest".to_owned()
    }

    fn read(words: &mut Words<'_>, name: &str, (): &()) -> Result<Self, CommandError> {
        let word = words.parameter(name)?;
        if word == "newest" {
            return Ok(Self::Newest);
        }
        let id: Option<PathId> = word.parse().ok();
        id.map(Self::Path).ok_or_else(|| CommandError::no_choice(word, "CHAIN.EPOCH.STEP, newest"))
    }

    fn text(&self) -> String {
        match self {
            Self::Newest => "newest".to_owned(),
            Self::Path(id) => id.to_string(),
        }
    }

    fn examples((): &()) -> Vec<Self> {
        let id: Option<PathId> = "3.0.1024".parse().ok();
        id.map(Self::Path).into_iter().chain([Self::Newest]).collect()
    }
}

impl Value for SkipTo {
    type Limits = ();

    fn form(_: &str, (): &()) -> String {
        "accepted|N".to_owned()
    }

    fn read(words: &mut Words<'_>, name: &str, (): &()) -> Result<Self, CommandError> {
        let word = words.parameter(name)?;
        if word == "accepted" {
            return Ok(Self::Acceptance);
        }
        let strategy = strategy(word).map(Self::Strategy);
        strategy.ok_or_else(|| CommandError::no_choice(word, "accepted, the number of a strategy"))
    }

    fn text(&self) -> String {
        match self {
            Self::Acceptance => "accepted".to_owned(),
            Self::Strategy(strategy) => strategy.text(),
        }
    }

    fn examples((): &()) -> Vec<Self> {
        vec![Self::Acceptance, Self::Strategy(StrategyId(3))]
    }
}

impl Value for StrategySet {
    type Limits = ();

    fn form(_: &str, (): &()) -> String {
        "all|N,...".to_owned()
    }

    fn read(words: &mut Words<'_>, name: &str, (): &()) -> Result<Self, CommandError> {
        let word = words.parameter(name)?;
        if word == "all" {
            return Ok(Self::ALL);
        }
        let set = word
            .split(',')
            .try_fold(Self(0), |set, number| Some(set.with(strategy(number)?, true)));
        set.ok_or_else(|| {
            CommandError::no_choice(word, "all, numbers of strategies separated by commas")
        })
    }

    fn text(&self) -> String {
        if *self == Self::ALL {
            return "all".to_owned();
        }
        let numbers = (0..STRATEGIES).filter(|&i| self.contains(StrategyId(i)));
        let numbers: Vec<String> = numbers.map(|i| i.to_string()).collect();
        numbers.join(",")
    }

    fn examples((): &()) -> Vec<Self> {
        vec![Self::ALL, Self(0b10_0101)]
    }
}

/// The number of a step of the explorer, or the newest from now on.
impl Value for Option<u64> {
    type Limits = ();

    fn form(_: &str, (): &()) -> String {
        "NUMBER|live".to_owned()
    }

    fn read(words: &mut Words<'_>, _: &str, (): &()) -> Result<Self, CommandError> {
        if words.skip("live") {
            return Ok(None);
        }
        range(0, u64::MAX).read(words, "NUMBER").map(Some)
    }

    fn text(&self) -> String {
        self.map_or_else(|| "live".to_owned(), |number| number.to_string())
    }

    fn examples((): &()) -> Vec<Self> {
        vec![None, Some(0), Some(u64::MAX)]
    }
}

fn strategy(word: &str) -> Option<StrategyId> {
    word.parse().ok().filter(|&number| number < STRATEGIES).map(StrategyId)
}
