//! From deviations to a verdict that cries wolf once in a million times.

use serde::Serialize;
use tests::z_limit;

use super::flow::Pair;
use super::functionals;
use super::invariance::{Gathered, Run, Walk, gather};
use crate::scene::Scene;

/// A deviation above this calls for a second, larger run.
const SUSPICIOUS: f64 = 4.0;
/// A deviation above this needs no second look.
const CERTAIN: f64 = 12.0;
/// How much larger the second run is.
const LARGER: u64 = 4;
/// What the second run alone may show of a quantity that was suspicious in the first.
const SECOND_LIMIT: f64 = 5.0;
/// Lowest limit on what both runs together may show.
const POOLED_LIMIT: f64 = 6.0;

/// What a check came to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Verdict {
    /// Nothing was found.
    Pass,
    /// Nothing is wrong, but something is worth knowing.
    Note,
    /// There was too little to judge by.
    Unjudged,
    /// A law is broken.
    Fail,
}

impl Verdict {
    /// The word in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Pass => "pass",
            Self::Note => "note",
            Self::Unjudged => "not judged",
            Self::Fail => "FAIL",
        }
    }
}

/// The outcome of one check.
#[derive(Clone, Debug, Serialize)]
pub struct Finding {
    /// The strategy, or what else was checked.
    pub subject: String,
    /// The law.
    pub law: &'static str,
    /// Quantities that were compared.
    pub judged: usize,
    /// Bidirectional samples, or steps.
    pub samples: u64,
    /// Largest deviation in standard errors; zero where none was measured.
    pub worst: f64,
    /// What it may be.
    pub limit: f64,
    /// What came of it.
    pub verdict: Verdict,
    /// The quantities that were found, or a remark.
    pub remark: String,
}

/// A quantity that is compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Quantity {
    /// A function of the path, by number.
    Function(usize),
    /// The flow between two classes.
    Flow(Pair),
}

impl Quantity {
    fn name(self) -> String {
        match self {
            Self::Function(index) => functionals::names().swap_remove(index),
            Self::Flow((a, b)) => format!("flow between {a} and {b}"),
        }
    }
}

/// Which quantities of a run a law speaks of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Law {
    /// Functions of the path keep their expectations.
    Invariance,
    /// Between any two classes as much light flows forth as back.
    Flow,
}

fn scores(gathered: &Gathered, law: Law) -> Vec<(Quantity, f64)> {
    match law {
        Law::Invariance => {
            let scores = gathered.function_scores().into_iter();
            scores.map(|(index, z)| (Quantity::Function(index), z)).collect()
        }
        Law::Flow => {
            let judged = gathered.flows.pairs.iter().filter(|(_, flow)| flow.is_judged());
            judged.map(|(pair, flow)| (Quantity::Flow(*pair), flow.z(gathered.samples))).collect()
        }
    }
}

/// What is examined, and how many such examinations there are in all.
#[expect(missing_debug_implementations, reason = "it holds a closure")]
pub struct Subject<'a> {
    /// The strategy's name.
    pub name: &'a str,
    /// The strategy, and what its chain is to visit.
    pub walk: Walk<'a>,
    /// Findings of the whole check, among which the chance of a false alarm is shared.
    pub family: usize,
}

/// Runs a test, and once more where something is suspicious; one finding for each law.
///
/// `on_samples` hears how many samples were drawn, those of a second run included.
pub fn examine(
    scene: &Scene,
    subject: &Subject<'_>,
    run: &Run,
    laws: &[(Law, &'static str)],
    on_samples: &(dyn Fn(u64) + Sync),
) -> (Vec<Finding>, Gathered) {
    let first = gather(scene, subject.walk, run, on_samples);
    let all: Vec<_> = laws.iter().map(|(law, _)| scores(&first, *law)).collect();
    let exceeds = |limit: f64| all.iter().flatten().any(|(_, z)| !(z.abs() <= limit));
    let second = (exceeds(SUSPICIOUS) && !exceeds(CERTAIN)).then(|| {
        // Its random numbers are others.
        let again = Run { samples: LARGER * run.samples, number: run.number | 1 << 12, ..*run };
        gather(scene, subject.walk, &again, &|_| ())
    });
    let findings = laws.iter().zip(&all).map(|((law, name), scores)| {
        judge(subject, name, &first, scores, second.as_ref().map(|second| (second, *law)))
    });
    (findings.collect(), first)
}

fn judge(
    subject: &Subject<'_>,
    law: &'static str,
    first: &Gathered,
    scored: &[(Quantity, f64)],
    second: Option<(&Gathered, Law)>,
) -> Finding {
    let limit = z_limit(scored.len() * subject.family);
    let again = second.map_or_else(Vec::new, |(second, law)| scores(second, law));
    let mut finding = Finding {
        subject: subject.name.to_owned(),
        law,
        judged: scored.len(),
        samples: first.samples + second.map_or(0, |(second, _)| second.samples),
        worst: scored.iter().map(|(_, z)| z.abs()).fold(0.0, worse),
        limit,
        verdict: if scored.is_empty() { Verdict::Unjudged } else { Verdict::Pass },
        remark: String::new(),
    };
    let mut offenders: Vec<(Quantity, f64)> = Vec::new();
    for &(quantity, z) in scored.iter().filter(|(_, z)| !(z.abs() <= SUSPICIOUS)) {
        match again.iter().find(|(other, _)| *other == quantity) {
            Some((_, larger)) => {
                let pooled = (z + (LARGER as f64).sqrt() * larger) / (1.0 + LARGER as f64).sqrt();
                let is_wrong =
                    !(larger.abs() <= SECOND_LIMIT) || !(pooled.abs() <= POOLED_LIMIT.max(limit));
                if is_wrong {
                    offenders.push((quantity, pooled));
                }
            }
            None if !(z.abs() <= limit) => offenders.push((quantity, z)),
            None => {}
        }
    }
    if !offenders.is_empty() {
        offenders.sort_by(|(_, a), (_, b)| b.abs().total_cmp(&a.abs()));
        finding.worst = offenders.iter().map(|(_, z)| z.abs()).fold(0.0, worse);
        finding.verdict = Verdict::Fail;
        finding.remark = list(&offenders);
    }
    finding
}

/// The larger one; NaN, once met, stays.
fn worse(a: f64, b: f64) -> f64 {
    if a.is_nan() || a >= b { a } else { b }
}

fn list(offenders: &[(Quantity, f64)]) -> String {
    const LISTED: usize = 4;
    let named = offenders.iter().take(LISTED);
    let mut text: Vec<_> = named.map(|(q, z)| format!("{} (z {z:+.1})", q.name())).collect();
    if offenders.len() > LISTED {
        text.push(format!("and {} more", offenders.len() - LISTED));
    }
    text.join(", ")
}
