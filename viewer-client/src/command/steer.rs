//! `explorer ...`, `chains ...` and `lease ...`: what is asked of the daemon.

use std::fmt;

use common::{
    ChainCommand, ExplorerCommand, LEAST_PRECISION, LeaseRequest, MAX_FAN, MAX_RATE, MAX_STEPS,
    MAX_WEIGHT, MIN_RATE, MOST_PRECISION, Order, Seed, SkipTo, StrategyId, StrategySet,
};

use super::Form;
use super::words::{CommandError, Words};

pub(super) const FORMS: &[Form] = &[
    ("explorer seed CHAIN.EPOCH.STEP|newest", "make a path the explorer's current one"),
    ("explorer play RATE", "let the explorer take so many steps a second"),
    ("explorer pause", "let it stand still"),
    ("explorer step COUNT", "let it take steps, and stand still"),
    ("explorer skip accepted|N", "step to the next acceptance, or to strategy number N"),
    ("explorer allow all|N,...", "let only the strategies of these numbers act"),
    ("explorer fan N COUNT", "show proposals of strategy number N without moving"),
    ("explorer show NUMBER|live", "show a step by its number, or the newest from now on"),
    ("chains pause", "stop the chains"),
    ("chains resume", "let them go on"),
    ("chains weight N WEIGHT", "change how often strategy number N is chosen"),
    ("chains precision ERROR", "start anew, with b known to this relative error"),
    ("chains restart SEED", "start anew with this number of the run"),
    ("lease ask", "ask to be the driver"),
    ("lease release", "be the driver no more"),
    ("lease give SESSION", "make another viewer the driver"),
];

/// The text form of an order.
pub(super) struct Text(pub(super) Order);

impl fmt::Display for Text {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            Order::Explorer(command) => write_explorer(f, command),
            Order::Chains(command) => match command {
                ChainCommand::Pause => write!(f, "chains pause"),
                ChainCommand::Resume => write!(f, "chains resume"),
                ChainCommand::SetWeight { strategy, weight } => {
                    write!(f, "chains weight {} {weight}", strategy.0)
                }
                ChainCommand::SetPrecision(precision) => write!(f, "chains precision {precision}"),
                ChainCommand::Restart { seed } => write!(f, "chains restart {seed}"),
            },
            Order::Lease(request) => match request {
                LeaseRequest::Ask => write!(f, "lease ask"),
                LeaseRequest::Release => write!(f, "lease release"),
                LeaseRequest::HandOver(session) => write!(f, "lease give {session}"),
            },
        }
    }
}

fn write_explorer(f: &mut fmt::Formatter<'_>, command: ExplorerCommand) -> fmt::Result {
    match command {
        ExplorerCommand::Seed(Seed::Newest) => write!(f, "explorer seed newest"),
        ExplorerCommand::Seed(Seed::Path(id)) => write!(f, "explorer seed {id}"),
        ExplorerCommand::Play(rate) => write!(f, "explorer play {rate}"),
        ExplorerCommand::Pause => write!(f, "explorer pause"),
        ExplorerCommand::Step(count) => write!(f, "explorer step {count}"),
        ExplorerCommand::Skip(SkipTo::Acceptance) => write!(f, "explorer skip accepted"),
        ExplorerCommand::Skip(SkipTo::Strategy(s)) => write!(f, "explorer skip {}", s.0),
        ExplorerCommand::Allow(StrategySet::ALL) => write!(f, "explorer allow all"),
        ExplorerCommand::Allow(set) => {
            let numbers = (0..64).filter(|&i| set.contains(StrategyId(i)));
            let numbers: Vec<String> = numbers.map(|i| i.to_string()).collect();
            write!(f, "explorer allow {}", numbers.join(","))
        }
        ExplorerCommand::Fan { strategy, count } => {
            write!(f, "explorer fan {} {count}", strategy.0)
        }
    }
}

/// Reads what follows `group`, which is `explorer`, `chains` or `lease`.
pub(super) fn parse(group: &str, words: &mut Words<'_>) -> Result<Order, CommandError> {
    let verb = words.next("command")?;
    Ok(match (group, verb) {
        ("chains", "pause") => Order::Chains(ChainCommand::Pause),
        ("chains", "resume") => Order::Chains(ChainCommand::Resume),
        ("chains", "weight") => Order::Chains(ChainCommand::SetWeight {
            strategy: strategy(words)?,
            weight: words.within("WEIGHT", 0.0..=MAX_WEIGHT)?,
        }),
        ("chains", "precision") => {
            let precision = words.within("ERROR", LEAST_PRECISION..=MOST_PRECISION)?;
            Order::Chains(ChainCommand::SetPrecision(precision))
        }
        ("chains", "restart") => {
            Order::Chains(ChainCommand::Restart { seed: words.within("SEED", 0..=u64::MAX)? })
        }
        ("lease", "ask") => Order::Lease(LeaseRequest::Ask),
        ("lease", "release") => Order::Lease(LeaseRequest::Release),
        ("lease", "give") => {
            Order::Lease(LeaseRequest::HandOver(words.within("SESSION", 0..=u64::MAX)?))
        }
        ("explorer", verb) => Order::Explorer(explorer(verb, words)?),
        (group, verb) => return Err(CommandError::Unknown(format!("{group} {verb}"))),
    })
}

/// Reads `show NUMBER|live`: what concerns the viewer alone.
pub(super) fn parse_show(words: &mut Words<'_>) -> Result<Option<u64>, CommandError> {
    words.next("show")?;
    if words.peek() == Some("live") {
        return words.next("live").map(|_| None);
    }
    words.within("NUMBER", 0..=u64::MAX).map(Some)
}

fn explorer(verb: &str, words: &mut Words<'_>) -> Result<ExplorerCommand, CommandError> {
    Ok(match verb {
        "seed" => {
            let word = words.next("path")?;
            let seed = match word {
                "newest" => Some(Seed::Newest),
                id => id.parse().ok().map(Seed::Path),
            };
            ExplorerCommand::Seed(seed.ok_or_else(|| no_choice(word, "CHAIN.EPOCH.STEP, newest"))?)
        }
        "play" => ExplorerCommand::Play(words.number("RATE", MIN_RATE..=MAX_RATE)?),
        "pause" => ExplorerCommand::Pause,
        "step" => ExplorerCommand::Step(words.count("COUNT", 1..=MAX_STEPS)?),
        "skip" => {
            let word = words.next("goal")?;
            let strategy = || word.parse().ok().filter(|&n| n < 64).map(StrategyId);
            ExplorerCommand::Skip(match word {
                "accepted" => SkipTo::Acceptance,
                _ => SkipTo::Strategy(
                    strategy()
                        .ok_or_else(|| no_choice(word, "accepted, the number of a strategy"))?,
                ),
            })
        }
        "allow" => {
            let word = words.next("list of strategies")?;
            let set = if word == "all" { Some(StrategySet::ALL) } else { strategy_set(word) };
            let complaint = || no_choice(word, "all, numbers of strategies with commas");
            ExplorerCommand::Allow(set.ok_or_else(complaint)?)
        }
        "fan" => ExplorerCommand::Fan {
            strategy: strategy(words)?,
            count: words.count("COUNT", 1..=MAX_FAN)?,
        },
        other => return Err(CommandError::Unknown(format!("explorer {other}"))),
    })
}

fn strategy(words: &mut Words<'_>) -> Result<StrategyId, CommandError> {
    Ok(StrategyId(words.count("N", 0..=63)? as u8))
}

fn strategy_set(word: &str) -> Option<StrategySet> {
    word.split(',').try_fold(StrategySet(0), |set, number| {
        let number: u8 = number.parse().ok().filter(|&n| n < 64)?;
        Some(set.with(StrategyId(number), true))
    })
}

fn no_choice(found: &str, choices: &str) -> CommandError {
    CommandError::NoChoice { found: found.to_owned(), choices: choices.to_owned() }
}
