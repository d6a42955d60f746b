//! `explorer ...`, `chains ...` and `lease ...`: what is asked of the daemon.

use common::{
    ChainCommand as Chains, ExplorerCommand as Explorer, LEAST_PRECISION, LeaseRequest, MAX_FAN,
    MAX_RATE, MAX_STEPS, MAX_WEIGHT, MIN_RATE, MOST_PRECISION, Order, Seed, SkipTo, StrategyId,
    StrategySet,
};

use super::Command;
use super::table::forms;
use crate::value::{Range, range};

const ANY: Range<u64> = range(0, u64::MAX);

forms! {
    /// Makes a path the explorer's current one.
    "explorer seed" (seed: Seed) => { Command::Order(Order::Explorer(Explorer::Seed(seed))) } "";
    /// Makes the explorer take this many steps per second.
    "explorer play" (rate: f32 [range(MIN_RATE, MAX_RATE).log().decimals(2).unit("/s")])
        => { Command::Order(Order::Explorer(Explorer::Play(rate))) } "";
    /// Pauses the explorer.
    "explorer pause" () => { Command::Order(Order::Explorer(Explorer::Pause)) } "";
    /// Makes the explorer take this many steps, then pause.
    "explorer step" (count: u32 [range(1, MAX_STEPS)])
        => { Command::Order(Order::Explorer(Explorer::Step(count))) } "";
    /// Steps to the next acceptance, or to the next step of strategy number N.
    "explorer skip" (goal: SkipTo) => { Command::Order(Order::Explorer(Explorer::Skip(goal))) } "";
    /// Restricts the explorer to the strategies with these numbers.
    "explorer allow" (set: StrategySet)
        => { Command::Order(Order::Explorer(Explorer::Allow(set))) } "";
    /// Shows proposals of strategy number N without moving.
    "explorer fan" (strategy: StrategyId, count: u32 [range(1, MAX_FAN)])
        => { Command::Order(Order::Explorer(Explorer::Fan { strategy, count })) } "";
    /// Shows a step of the explorer by its number, or the newest from now on.
    "explorer show" (step: Option<u64>) => { Command::Scrub(step) } "";
    /// Pauses the chains.
    "chains pause" () => { Command::Order(Order::Chains(Chains::Pause)) } "";
    /// Resumes the chains.
    "chains resume" () => { Command::Order(Order::Chains(Chains::Resume)) } "";
    /// Changes how often strategy number N is chosen.
    "chains weight" (strategy: StrategyId, weight: f64 [range(0.0, MAX_WEIGHT)])
        => { Command::Order(Order::Chains(Chains::SetWeight { strategy, weight })) } "";
    /// Restarts the chains, with b estimated to this relative error.
    "chains precision" (error: f64 [range(LEAST_PRECISION, MOST_PRECISION)])
        => { Command::Order(Order::Chains(Chains::SetPrecision(error))) } "";
    /// Restarts the chains with this seed.
    "chains restart" (seed: u64 [ANY])
        => { Command::Order(Order::Chains(Chains::Restart { seed })) } "";
    /// Asks to be the driver.
    "lease ask" () => { Command::Order(Order::Lease(LeaseRequest::Ask)) } "";
    /// Stops driving, so that another viewer can.
    "lease release" () => { Command::Order(Order::Lease(LeaseRequest::Release)) } "";
    /// Makes another viewer the driver.
    "lease give" (session: u64 [ANY])
        => { Command::Order(Order::Lease(LeaseRequest::HandOver(session))) } "";
}
