//! What it is worth to leave out what a scene does not contain, and what it costs to look at every
//! step for the diagnostics: `cargo bench -p tracer-server --bench features`.
//!
//! One thread, CPU time. Each feature is hidden in the scene where no light gets to it, so that the
//! same chains run through general code; plain and general rounds alternate.

#[path = "../tests/decoy/mod.rs"]
mod decoy;

use std::io::{self, Write as _};

use comfy_table::Table;
use comfy_table::presets::UTF8_FULL_CONDENSED;
use cpu_time::ProcessTime;
use tracer_server::chain::{Ensemble, EnsembleSettings};
use tracer_server::scene::Scene;

/// Pairs of rounds; an odd number has a median.
const PAIRS: usize = 31;
/// Steps of a chain in a round.
const STEPS: u64 = 6000;

fn main() -> anyhow::Result<()> {
    let plain = decoy::cornell(256, None)?;
    let mut table = Table::new();
    table.load_style(UTF8_FULL_CONDENSED).set_header([
        "left out",
        "mutations per CPU second",
        "with it",
        "gain of leaving it out",
        "half of the pairs lie in",
    ]);
    let monitored = decoy::cornell(256, None)?;
    let mut compared = vec![("a look at every step", monitored, true)];
    for (name, _) in decoy::FEATURES {
        compared.push((name, decoy::cornell(256, Some(name))?, false));
    }
    for (name, general, is_monitored) in &compared {
        let pairs = pairs(&plain, general, *is_monitored);
        let mut gains: Vec<f64> = pairs.iter().map(|(a, b)| 100.0 * (a / b - 1.0)).collect();
        gains.sort_by(f64::total_cmp);
        let best = |rates: &dyn Fn(&(f64, f64)) -> f64| pairs.iter().map(rates).fold(0.0, f64::max);
        table.add_row([
            (*name).to_owned(),
            format!("{:.3} M", best(&|pair| pair.0) / 1e6),
            format!("{:.3} M", best(&|pair| pair.1) / 1e6),
            format!("{:+.1} %", gains[PAIRS / 2]),
            format!("{:+.1} % to {:+.1} %", gains[PAIRS / 4], gains[3 * PAIRS / 4]),
        ]);
    }
    writeln!(io::stdout().lock(), "{}", table.trim_fmt())?;
    Ok(())
}

/// Mutations per CPU second of both scenes, in alternation; of the second one perhaps monitored.
fn pairs(plain: &Scene, general: &Scene, is_monitored: bool) -> Vec<(f64, f64)> {
    // As many chains as a daemon has, where it matters.
    let chains = if is_monitored { EnsembleSettings::default().chains } else { 16 };
    let steps = 16 * STEPS / u64::from(chains);
    let settings = EnsembleSettings {
        seed: 1,
        chains,
        threads: 1,
        bootstrap_samples: 1 << 16,
        ..Default::default()
    };
    let ensemble = |scene| Ensemble::new(scene, &settings, |_| ());
    let (mut a, mut b) = (ensemble(plain), ensemble(general));
    if is_monitored {
        b.monitor();
    }
    let rate = |ensemble: &mut Ensemble, scene: &Scene| {
        let start = ProcessTime::now();
        drop(ensemble.advance(scene, steps, None));
        (steps * u64::from(chains)) as f64 / start.elapsed().as_secs_f64()
    };
    rate(&mut a, plain);
    rate(&mut b, general);
    (0..PAIRS).map(|_| (rate(&mut a, plain), rate(&mut b, general))).collect()
}
