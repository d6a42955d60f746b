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
    /// Lets the explorer take so many steps a second.
    "explorer play" (rate: f32 [range(MIN_RATE, MAX_RATE).log().decimals(2).unit("/s")])
        => { Command::Order(Order::Explorer(Explorer::Play(rate))) } "";
    /// Lets the explorer stand still.
    "explorer pause" () => { Command::Order(Order::Explorer(Explorer::Pause)) } "";
    /// Lets the explorer take steps, and then stand still.
    "explorer step" (count: u32 [range(1, MAX_STEPS)])
        => { Command::Order(Order::Explorer(Explorer::Step(count))) } "";
    /// Steps to the next acceptance, or to the next step of strategy number N.
    "explorer skip" (goal: SkipTo) => { Command::Order(Order::Explorer(Explorer::Skip(goal))) } "";
    /// Lets only the strategies of these numbers act.
    "explorer allow" (set: StrategySet)
        => { Command::Order(Order::Explorer(Explorer::Allow(set))) } "";
    /// Shows proposals of strategy number N without moving.
    "explorer fan" (strategy: StrategyId, count: u32 [range(1, MAX_FAN)])
        => { Command::Order(Order::Explorer(Explorer::Fan { strategy, count })) } "";
    /// Shows a step of the explorer by its number, or the newest from now on.
    "explorer show" (step: Option<u64>) => { Command::Scrub(step) } "";
    /// Stops the chains.
    "chains pause" () => { Command::Order(Order::Chains(Chains::Pause)) } "";
    /// Lets the chains go on.
    "chains resume" () => { Command::Order(Order::Chains(Chains::Resume)) } "";
    /// Changes how often strategy number N is chosen.
    "chains weight" (strategy: StrategyId, weight: f64 [range(0.0, MAX_WEIGHT)])
        => { Command::Order(Order::Chains(Chains::SetWeight { strategy, weight })) } "";
    /// Starts the chains anew, with b known to this relative error.
    "chains precision" (error: f64 [range(LEAST_PRECISION, MOST_PRECISION)])
        => { Command::Order(Order::Chains(Chains::SetPrecision(error))) } "";
    /// Starts the chains anew with this number of the run.
    "chains restart" (seed: u64 [ANY])
        => { Command::Order(Order::Chains(Chains::Restart { seed })) } "";
    /// Asks to be the driver.
    "lease ask" () => { Command::Order(Order::Lease(LeaseRequest::Ask)) } "";
    /// Gives up the controls, so that you are no longer the driver.
    "lease release" () => { Command::Order(Order::Lease(LeaseRequest::Release)) } "";
    /// Makes another viewer the driver.
    "lease give" (session: u64 [ANY])
        => { Command::Order(Order::Lease(LeaseRequest::HandOver(session))) } "";
}
