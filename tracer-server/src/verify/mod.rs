//! Statistical checks of mutation strategies on any scene: what `tracer-server verify` runs, and
//! what the tests hold every strategy to.

pub mod census;
pub mod ergodicity;
pub mod flow;
pub mod functionals;
pub mod invariance;
pub mod judge;
pub mod reversal;

use std::sync::atomic::{AtomicU64, Ordering};

use serde::Serialize;

use crate::chain::{EnsembleSettings, Kernel};
use crate::mutation::{
    Independent, KINDS, Mixture, MixtureBasis, Mutation as _, StrategyOptions, key_of,
};
use crate::scene::Scene;
use crate::target::Target;
use census::Census;
use flow::Flows;
use invariance::{Gathered, Run, Test, Walk, by_itself};
use judge::{Law, Subject, examine};

pub use ergodicity::ClassVisits;
pub use judge::{Finding, Verdict};
pub use reversal::{Reversals, reversals};

/// Steps of the test of invariance that tosses the chain's coin.
pub const STEPS: usize = 3;
/// Proposals from each path in the test that weighs them with their acceptance.
pub const PROPOSALS: usize = 10;
/// Findings for each strategy among which the chance of a false alarm is shared.
const LAWS: usize = 3;
/// Chains that the visits of classes are counted of.
const CHAINS: u32 = 256;
/// Pairs of classes that a report lists for each strategy.
const LISTED_FLOWS: usize = 6;

/// What is checked, and how thoroughly.
#[derive(Clone, Debug)]
pub struct Settings {
    /// Names of the strategies; all of the mixture when empty.
    pub strategies: Vec<String>,
    /// Weights and parameters of all strategies.
    pub options: StrategyOptions,
    /// Bidirectional samples of each test.
    pub samples: u64,
    /// Seed of the random numbers: the same seed gives the same report.
    pub seed: u64,
    /// Worker threads; the report does not depend on it.
    pub threads: usize,
}

/// Everything that was found.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// The scene's name.
    pub scene: String,
    /// Digest of its content.
    pub scene_hash: String,
    /// Number of the check.
    pub seed: u64,
    /// Bidirectional samples of each test.
    pub samples: u64,
    /// Strategies that this scene has no path for.
    pub switched_off: Vec<String>,
    /// One entry a strategy and law, and those of the mixture as a whole.
    pub findings: Vec<Finding>,
    /// The largest flows between classes.
    pub flows: Vec<FlowRow>,
    /// What each class got of the chains' steps; empty unless the whole mixture was checked.
    pub visits: Vec<ClassVisits>,
}

/// Light that a strategy moves between two classes in one step.
#[derive(Clone, Debug, Serialize)]
pub struct FlowRow {
    /// The strategy.
    pub strategy: String,
    /// The classes.
    pub classes: [String; 2],
    /// Proposals from the first to the second.
    pub forth: u64,
    /// Proposals from the second to the first.
    pub back: u64,
    /// Light moved either way, as a share of all.
    pub share: f64,
    /// The difference of both ways in standard errors.
    pub z: f64,
}

impl Report {
    /// True when a law is broken.
    pub fn has_failed(&self) -> bool {
        self.findings.iter().any(|finding| finding.verdict == Verdict::Fail)
    }
}

/// Why there is nothing to check.
#[derive(Clone, Debug, thiserror::Error, PartialEq, Eq)]
pub enum VerifyError {
    /// No sample carries light.
    #[error(
        "no light reaches the film in {0} samples, so there is no path to start from; check the \
        lights and the camera with `tracer-server info`"
    )]
    Dark(u64),
    /// The strategy is off.
    #[error("the strategy `{0}` does not apply to this scene, or is switched off; enabled: {1}")]
    NotThere(String, String),
}

/// Checks the strategies on a scene; `on_progress` hears the share of the work that is done and
/// what is being worked on.
pub fn verify(
    scene: &Scene,
    settings: &Settings,
    on_progress: &(dyn Fn(f64, &str) + Sync),
) -> Result<Report, VerifyError> {
    let &Settings { samples, seed, threads, .. } = settings;
    on_progress(0.0, "census of the light");
    let census = Census::new(scene, seed, samples, threads);
    if census.is_dark() {
        return Err(VerifyError::Dark(samples));
    }
    let energy = census.lengths(scene.max_edges());
    let basis = MixtureBasis::of(scene, &energy);
    let mixture = Mixture::new(&settings.options, &basis);
    let wanted = select(&mixture, &settings.strategies)?;
    let mut report = empty_report(scene, settings, &mixture);
    let is_whole = wanted.len() == mixture.len();
    let parts = wanted.len() + if is_whole { 2 } else { 0 };
    let mut joined = Flows::default();
    for (done, &index) in wanted.iter().enumerate() {
        let strategy = mixture.get(index);
        let progress = |share: f64, law: &str| {
            let share = (done as f64 + share) / parts as f64;
            on_progress(share, &format!("{}: {law}", strategy.name()));
        };
        let flows = verify_one(scene, &mixture, index, settings, &mut report, &progress);
        if strategy.name() != Independent::NAME {
            joined.merge(&flows.flows);
        }
        report.flows.extend(largest_flows(strategy.name(), &flows, &census));
    }
    if is_whole {
        report.findings.push(ergodicity::connectedness(&census, &joined, samples));
        let (before, parts) = (wanted.len() as f64, parts as f64);
        let on_share = |share: f64, what: &str| on_progress((before + share) / parts, what);
        verify_mixture(scene, &census, &mixture, settings, &mut report, &on_share);
    }
    on_progress(1.0, "done");
    Ok(report)
}

fn empty_report(scene: &Scene, settings: &Settings, mixture: &Mixture) -> Report {
    let on = mixture.names();
    let off = KINDS.iter().map(|kind| kind.name.to_owned()).filter(|name| !on.contains(name));
    Report {
        scene: scene.name().to_owned(),
        scene_hash: scene.hash().to_owned(),
        seed: settings.seed,
        samples: settings.samples,
        switched_off: off.collect(),
        findings: Vec::new(),
        flows: Vec::new(),
        visits: Vec::new(),
    }
}

/// Runs chains with all strategies, and adds where they went to the report. `on_share` hears the
/// work done, from 0 to 2.
fn verify_mixture(
    scene: &Scene,
    census: &Census,
    mixture: &Mixture,
    settings: &Settings,
    report: &mut Report,
    on_share: &dyn Fn(f64, &str),
) {
    let plan = ergodicity::Plan {
        ensemble: EnsembleSettings {
            seed: settings.seed,
            chains: CHAINS,
            threads: settings.threads,
            strategies: settings.options,
            ..EnsembleSettings::default()
        },
        steps: settings.samples / 16,
        family: LAWS * mixture.len() + 1,
    };
    let mut on_visits = |share: f64| on_share(share, "visits of classes");
    let (findings, visits) = ergodicity::visits(scene, census, &plan, &mut on_visits);
    report.findings.extend(findings);
    report.visits = visits;
    on_share(1.0, "chains from the rarest classes");
    let kernel = Kernel::whole(mixture.clone());
    report.findings.push(ergodicity::from_the_rarest(scene, census, &kernel, &plan));
}

/// The mixture's strategies with the given names, or all of them.
fn select(mixture: &Mixture, names: &[String]) -> Result<Vec<usize>, VerifyError> {
    let on = mixture.names();
    let find = |name: &String| {
        on.iter()
            .position(|other| key_of(other) == key_of(name))
            .ok_or_else(|| VerifyError::NotThere(name.clone(), on.join(", ")))
    };
    let found: Vec<usize> = names.iter().map(find).collect::<Result<_, _>>()?;
    Ok(if names.is_empty() { (0..mixture.len()).collect() } else { found })
}

/// Puts one strategy of the mixture to all tests, and adds what was found to the report.
fn verify_one(
    scene: &Scene,
    mixture: &Mixture,
    index: usize,
    settings: &Settings,
    report: &mut Report,
    on_progress: &(dyn Fn(f64, &str) + Sync),
) -> Gathered {
    let &Settings { samples, seed, threads, .. } = settings;
    let (strategy, family) = (mixture.get(index), LAWS * mixture.len() + 1);
    let propose = by_itself(strategy);
    let walk = Walk { propose: &propose, target: &Target::Whole };
    let subject = Subject { name: strategy.name(), walk, family };
    let drawn = AtomicU64::new(0);
    let listen = |law: &'static str| {
        let drawn = &drawn;
        move |n: u64| {
            let drawn = n + drawn.fetch_add(n, Ordering::Relaxed);
            on_progress(drawn as f64 / (1.5 * samples as f64), law);
        }
    };
    let number = 4 * index as u64;
    let run = Run { test: Test::Steps(STEPS), samples, seed, number, threads };
    let laws = [(Law::Invariance, "invariance, 3 steps")];
    let (findings, steps) = examine(scene, &subject, &run, &laws, &listen("3 steps"));
    report.findings.extend(findings);

    let test = Test::Proposals(PROPOSALS);
    let run = Run { test, samples: samples / 2, number: number + 2, ..run };
    let laws = [(Law::Invariance, "invariance, proposals"), (Law::Flow, "flow between classes")];
    let (mut findings, proposals) = examine(scene, &subject, &run, &laws, &listen("proposals"));
    if let Some(flow) = findings.last_mut().filter(|flow| flow.verdict == Verdict::Unjudged) {
        let moves = proposals.flows.pairs.values().map(|flow| flow.forth + flow.back).sum::<u64>();
        if moves == 0 {
            flow.verdict = Verdict::Pass;
            "the strategy never leaves a class".clone_into(&mut flow.remark);
        }
    }
    report.findings.extend(findings);

    let looked_at = (samples / 10).min(5000);
    let mut reversal =
        reversals(scene, strategy, seed, looked_at).finding(strategy.name(), looked_at);
    let not_finite = steps.not_finite + proposals.not_finite;
    if not_finite > 0 {
        reversal.verdict = Verdict::Fail;
        reversal.remark = format!("{not_finite} ratios were NaN or negative");
    }
    report.findings.push(reversal);
    proposals
}

fn largest_flows(name: &str, gathered: &Gathered, census: &Census) -> Vec<FlowRow> {
    let total = census.mean();
    let mut rows: Vec<FlowRow> = gathered
        .flows
        .pairs
        .iter()
        .filter(|(_, flow)| flow.is_judged())
        .map(|((a, b), flow)| FlowRow {
            strategy: name.to_owned(),
            classes: [a.to_string(), b.to_string()],
            forth: flow.forth,
            back: flow.back,
            share: flow.mean_gross(gathered.samples) / total,
            z: flow.z(gathered.samples),
        })
        .collect();
    rows.sort_by(|a, b| b.share.total_cmp(&a.share));
    rows.truncate(LISTED_FLOWS);
    rows
}
