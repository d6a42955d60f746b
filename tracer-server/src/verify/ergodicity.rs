//! Whether the chains get everywhere, as often as they should, and soon.

use std::collections::{BTreeMap, BTreeSet};

use ::tests::{Accumulator, z_limit};
use common::ChainId;

use super::census::Census;
use super::flow::Flows;
use super::judge::{Finding, Verdict};
use crate::chain::{Chain, Ensemble, EnsembleSettings, Kernel};
use crate::film::Film;
use crate::parallel;
use crate::path::ClassKey;
use crate::scene::{Scene, Tracer};

/// Classes with less than this share of the light are not looked at one by one.
const SHARE: f64 = 1e-4;
/// Steps between two looks at a chain's class.
const STRIDE: u64 = 16;
/// A class is judged when at least this many chains were in it.
const MIN_CHAINS: usize = 50;
/// A single path may stand for this share of the image.
const HEAVIEST: f64 = 1e-3;
/// Chains that start at paths of the rarest classes.
const RAREST: usize = 8;
/// Number of the first of them: above those of all other chains.
const RAREST_ID: u32 = 1 << 24;
/// How much wider all of these chains may spread than each of them alone.
const SPREAD: f64 = 1.01;

/// How the chains are run.
#[derive(Clone, Copy, Debug)]
pub struct Plan {
    /// Chains, seed, threads and strategies.
    pub ensemble: EnsembleSettings,
    /// Steps of each chain.
    pub steps: u64,
    /// Findings among which the chance of a false alarm is shared.
    pub family: usize,
}

/// What one class got of the chains' steps.
#[derive(Clone, Debug, serde::Serialize)]
pub struct ClassVisits {
    /// Its letters, the light first.
    pub class: String,
    /// The share of all light that it carries, as bidirectional samples measure it.
    pub energy: f64,
    /// The share of their steps that the chains spent in it.
    pub visits: f64,
    /// The difference in standard errors; `None` when too few chains came by.
    pub z: Option<f64>,
}

/// Compares how often the chains are in each class with the light that it carries.
pub fn visits(
    scene: &Scene,
    census: &Census,
    plan: &Plan,
    on_share: &mut dyn FnMut(f64),
) -> (Vec<Finding>, Vec<ClassVisits>) {
    let mut ensemble = Ensemble::new(scene, &plan.ensemble, |_| ());
    let mut counts: Vec<BTreeMap<ClassKey, u32>> = vec![BTreeMap::new(); ensemble.chain_count()];
    let rounds = (plan.steps / STRIDE).max(1);
    for round in 0..rounds {
        ensemble.advance(scene, STRIDE, None);
        for (chain, counts) in ensemble.chains().zip(&mut counts) {
            *counts.entry(ClassKey::of(chain.current())).or_default() += 1;
        }
        on_share((round + 1) as f64 / rounds as f64);
    }
    let mut rows = Vec::new();
    for (key, class) in &census.classes {
        let (energy, error) = census.share(class);
        if energy < SHARE {
            continue;
        }
        let visits: Accumulator = counts
            .iter()
            .map(|counts| f64::from(counts.get(key).copied().unwrap_or(0)) / rounds as f64)
            .collect();
        let visitors = counts.iter().filter(|counts| counts.contains_key(key)).count();
        let z = (visits.mean() - energy) / visits.standard_error().hypot(error);
        rows.push(ClassVisits {
            class: key.to_string(),
            energy,
            visits: visits.mean(),
            z: (visitors >= MIN_CHAINS).then_some(z),
        });
    }
    rows.sort_by(|a, b| b.energy.total_cmp(&a.energy));
    let dwell = ensemble.statistics().longest_dwell;
    (vec![visits_finding(&rows, plan), dwell_finding(dwell, ensemble.steps())], rows)
}

fn finding(law: &'static str, samples: u64) -> Finding {
    Finding {
        subject: "all together".to_owned(),
        law,
        judged: 0,
        samples,
        worst: 0.0,
        limit: 0.0,
        verdict: Verdict::Pass,
        remark: String::new(),
    }
}

fn visits_finding(rows: &[ClassVisits], plan: &Plan) -> Finding {
    let judged: Vec<_> = rows.iter().filter_map(|row| Some((row, row.z?))).collect();
    let limit = z_limit(judged.len() * plan.family);
    let wrong: Vec<String> = judged
        .iter()
        .filter(|(_, z)| !(z.abs() <= limit))
        .map(|(row, z)| format!("{} (z {z:+.1})", row.class))
        .collect();
    let missed: Vec<&str> =
        rows.iter().filter(|row| row.visits == 0.0).map(|row| row.class.as_str()).collect();
    let (verdict, remark) = match (wrong.is_empty(), missed.is_empty(), judged.is_empty()) {
        (false, ..) => {
            (Verdict::Fail, format!("not as often as light flows: {}", wrong.join(", ")))
        }
        (true, false, _) => (Verdict::Note, some(&missed)),
        (true, true, true) => (Verdict::Unjudged, String::new()),
        (true, true, false) => (Verdict::Pass, String::new()),
    };
    let steps = plan.steps * u64::from(plan.ensemble.chains);
    Finding {
        judged: judged.len(),
        worst: judged.iter().map(|(_, z)| z.abs()).fold(0.0, f64::max),
        limit,
        verdict,
        remark,
        ..finding("visits of classes", steps)
    }
}

fn some(missed: &[&str]) -> String {
    const LISTED: usize = 5;
    let names = missed.iter().take(LISTED).copied().collect::<Vec<_>>().join(", ");
    let more = if missed.len() > LISTED { ", ..." } else { "" };
    format!("{} classes never visited: {names}{more}", missed.len())
}

fn dwell_finding(dwell: u64, steps: u64) -> Finding {
    let share = dwell as f64 / steps.max(1) as f64;
    let verdict = if share > HEAVIEST { Verdict::Note } else { Verdict::Pass };
    let remark = format!("{dwell} steps at one path, {:.3} % of all", 100.0 * share);
    Finding { judged: 1, verdict, remark, ..finding("longest rejection run", steps) }
}

/// Starts chains at paths of the rarest classes, and compares how they spread after a while
/// \[Gelman and Rubin 1992\].
pub fn from_the_rarest(scene: &Scene, census: &Census, kernel: &Kernel, plan: &Plan) -> Finding {
    let mut classes: Vec<_> = census.classes.values().filter(|c| census.share(c).0 > 0.0).collect();
    classes.sort_by(|a, b| census.share(a).0.total_cmp(&census.share(b).0));
    classes.truncate(RAREST);
    let mut spreads = vec![[Accumulator::default(); 5]; classes.len()];
    // As much work as the visits take.
    let steps = plan.steps * u64::from(plan.ensemble.chains) / RAREST as u64;
    parallel::for_each(
        plan.ensemble.threads,
        (RAREST_ID..).zip(classes.iter().zip(&mut spreads)),
        || Tracer::new(scene),
        |scene, (id, (class, spread))| {
            let camera = scene.camera();
            let mut film = Film::new(camera.width, camera.height);
            let start = class.example.clone();
            let mut chain = Chain::new(ChainId(id), plan.ensemble.seed, start, kernel);
            for step in 0..steps {
                chain.step(scene, kernel, &mut film);
                if step >= steps / 2 {
                    let x = chain.current();
                    let (u, v) = (x.film().x, x.film().y);
                    let values = [u, v, u * u, v * v, x.edge_count() as f64];
                    spread.iter_mut().zip(values).for_each(|(sum, value)| sum.push(value));
                }
            }
        },
    );
    let of_all = |i: usize| reduction(&spreads.iter().map(|s| &s[i]).collect::<Vec<_>>());
    let widest = (0..5).map(of_all).fold(1.0, f64::max);
    let verdict = match classes.len() {
        0 | 1 => Verdict::Unjudged,
        _ if widest <= SPREAD => Verdict::Pass,
        _ => Verdict::Note,
    };
    let remark = format!(
        "{} chains together spread {widest:.4} times as wide as each alone; up to {SPREAD} is fine",
        classes.len()
    );
    let samples = steps * classes.len() as u64;
    Finding { judged: 5, verdict, remark, ..finding("from the rarest classes", samples) }
}

/// The factor by which the spread of all chains exceeds that of each.
fn reduction(chains: &[&Accumulator]) -> f64 {
    let within: Accumulator = chains.iter().map(|chain| chain.variance()).collect();
    let means: Accumulator = chains.iter().map(|chain| chain.mean()).collect();
    let n = chains.iter().map(|chain| chain.count()).min().unwrap_or(0) as f64;
    if within.mean() == 0.0 {
        return if means.variance() > 0.0 { f64::INFINITY } else { 1.0 };
    }
    ((n - 1.0) / n + means.variance() / within.mean()).sqrt()
}

/// Whether moves other than fresh starts connect all classes that carry light.
pub fn connectedness(census: &Census, flows: &Flows, samples: u64) -> Finding {
    let bright =
        |key: &ClassKey| census.classes.get(key).is_some_and(|c| census.share(c).0 >= SHARE);
    let mut rest: BTreeSet<ClassKey> = census.classes.keys().copied().filter(bright).collect();
    let count = rest.len();
    let mut islands: Vec<Vec<ClassKey>> = Vec::new();
    while let Some(&first) = rest.first() {
        let reached = reachable(first, flows);
        islands.push(rest.intersection(&reached).copied().collect());
        rest.retain(|key| !reached.contains(key));
    }
    let named = |island: &Vec<ClassKey>| {
        let names: Vec<_> = island.iter().take(4).map(ToString::to_string).collect();
        format!("{}{}", names.join(" "), if island.len() > 4 { " ..." } else { "" })
    };
    let (verdict, remark) = match islands.as_slice() {
        [] => (Verdict::Unjudged, String::new()),
        [_] => (Verdict::Pass, format!("{count} classes are joined")),
        _ => {
            let names: Vec<_> = islands.iter().map(named).collect();
            let text = format!("{} islands: {}", islands.len(), names.join(" | "));
            (Verdict::Note, text)
        }
    };
    Finding { judged: count, verdict, remark, ..finding("ways between classes", samples) }
}

/// All classes that flows join to `first`, be they bright or dark; itself among them.
fn reachable(first: ClassKey, flows: &Flows) -> BTreeSet<ClassKey> {
    let mut reached = BTreeSet::from([first]);
    let mut queue = vec![first];
    while let Some(at) = queue.pop() {
        for (a, b) in flows.pairs.keys() {
            let other = if *a == at { *b } else { *a };
            if (*a == at || *b == at) && reached.insert(other) {
                queue.push(other);
            }
        }
    }
    reached
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn chains_that_stay_apart_spread() {
        let chain = |offset: f64| -> Accumulator {
            (0..1000).map(|i| offset + f64::from(i % 10)).collect()
        };
        let [here, near, far] = [0.0, 0.01, 8.0].map(chain);
        assert!(reduction(&[&here, &near]) < 1.001, "much the same");
        assert!(reduction(&[&here, &far]) > 1.5, "not at all");
    }
}
