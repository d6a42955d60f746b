//! The story of a render, for people and for the headers of images.

use std::io::{self, Write};

use comfy_table::Table;
use comfy_table::presets::UTF8_FULL_CONDENSED;

use crate::image_file::Destination;
use crate::render::Report;

/// Kurtosis over replicates above which their spread tells little.
const HEAVY: f64 = 12.0;

/// What the header of an EXR file says about the image.
pub(super) fn metadata(report: &Report) -> Vec<(String, String)> {
    let entries: [(&str, &dyn std::fmt::Display); 12] = [
        ("version", &env!("CARGO_PKG_VERSION")),
        ("scene", &report.scene),
        ("scene_hash", &report.scene_hash),
        ("integrator", &report.integrator),
        ("seed", &report.seed),
        ("max_edges", &report.max_edges),
        ("chains", &report.chains),
        ("mutations", &report.mutations),
        ("normalization", &report.normalization),
        ("normalization_error", &report.normalization_error),
        ("wall_seconds", &report.wall_seconds),
        ("cpu_seconds", &report.cpu_seconds),
    ];
    let weights = report.prospects.iter().map(|p| format!("{}={:.4}", p.name, p.weight));
    let weights = Some(weights.collect::<Vec<_>>().join(",")).filter(|list| !list.is_empty());
    let outlook = report.outlook;
    let base = outlook.map(|o| o.base.map_or("none", |base| base.name()).to_owned());
    let of_replicates = [
        ("strategies", weights),
        ("base", base),
        ("tau", outlook.map(|o| o.tau.to_string())),
        ("replicates", outlook.map(|_| report.selection.clone())),
        ("noise", report.noise.map(|noise| noise.to_string())),
        ("mean_error", report.mean_error.map(|error| error.to_string())),
    ];
    let of_replicates = of_replicates.into_iter().filter_map(|(key, value)| Some((key, value?)));
    let sampler = report.primary_sampler.map(|name| ("primary_sampler", name.to_owned()));
    let large_step = report.large_step.map(|share| ("large_step", share.to_string()));
    let entries = entries.into_iter().map(|(key, value)| (key, value.to_string()));
    entries
        .chain(of_replicates)
        .chain(sampler)
        .chain(large_step)
        .map(|(key, value)| (format!("lvis.{key}"), value))
        .collect()
}

/// What the integrator counts.
pub(super) fn work(report: &Report) -> &'static str {
    if report.chains > 0 { "mutations" } else { "samples" }
}

pub(super) fn print(out: &mut impl Write, report: &Report, file: &Destination) -> io::Result<()> {
    if !report.strategies.is_empty() {
        writeln!(out, "Strategies; rates are relative to all proposals, failures included")?;
        writeln!(out, "{}", strategy_table(report).trim_fmt())?;
    }
    let work = work(report);
    let per = |n: u64| n as f64 / report.mutations.max(1) as f64;
    writeln!(
        out,
        "{:>12} {work}, {} a second on {} threads; {:.2} s of wall clock, {:.2} s of CPU",
        report.mutations,
        short(report.rate),
        report.threads,
        report.wall_seconds,
        report.cpu_seconds,
    )?;
    writeln!(
        out,
        "{:>12} rays and {} shadow rays: {:.2} and {:.2} for each of the {work}",
        report.rays,
        report.shadow_rays,
        per(report.rays),
        per(report.shadow_rays),
    )?;
    if report.outlook.is_some() {
        print_replicates(out, report)?;
    } else if report.chains > 0 {
        writeln!(
            out,
            "mean luminance b = {:.6} +- {:.6} ({:.2} %) from {} samples in {:.2} s; {} chains, \
             longest stay at one path {} steps; {} proposals were not finite",
            report.normalization,
            report.normalization_error,
            100.0 * report.normalization_error / report.normalization.max(f64::MIN_POSITIVE),
            report.bootstrap_samples,
            report.seeding_seconds,
            report.chains,
            report.longest_dwell,
            report.not_finite,
        )?;
    }
    let [r, g, b] = report.mean;
    writeln!(out, "mean of the image: {r:.6} {g:.6} {b:.6}")?;
    if let (Some(error), Some(ratio)) = (report.relative_mse, report.mean_ratio) {
        writeln!(
            out,
            "against the reference: relMSE {error:.3e}, relMSE x CPU seconds {:.3e}, mean ratio \
             {ratio:.5}",
            error * report.cpu_seconds,
        )?;
        if report.reference_missing > 0 {
            let missing = report.reference_missing;
            writeln!(out, "the reference has no value for {missing} pixels, which are ignored")?;
        }
    }
    writeln!(out, "written to {}", file.path().display())
}

/// How the work was divided, what came of it, and how to make the same picture again.
fn print_replicates(out: &mut impl Write, report: &Report) -> io::Result<()> {
    if let Some(outlook) = report.outlook {
        let base = outlook.base.map_or("no base samples", |base| base.name());
        writeln!(
            out,
            "base: {base}, tau {:.3}; chains carry {:.2} % of the light, with {:.2} mutations per \
            base sample; {}",
            outlook.tau,
            100.0 * outlook.chains_share,
            outlook.mutations_per_sample,
            match (report.chains, outlook.is_equalised) {
                (0, _) => "chains would not pay off, so there are none".to_owned(),
                (n, false) => format!("{n} chains in each replicate"),
                (n, true) => format!(
                    "{n} chains in each replicate, which visit dark parts as often as bright ones"
                ),
            },
        )?;
    }
    if report.chains > 0 {
        writeln!(
            out,
            "mean luminance of the chains' share, b = {:.6} +- {}; pools of {} samples; longest stay at \
             one path {} steps; {} proposals were not finite",
            report.normalization,
            // A single replicate has no spread.
            match report.normalization_error {
                error if error.is_finite() => format!("{error:.6}"),
                _ => "unknown".to_owned(),
            },
            report.bootstrap_samples,
            report.longest_dwell,
            report.not_finite,
        )?;
    }
    let noise = report
        .noise
        .map_or_else(|| "unknown".to_owned(), |noise| format!("{:.2} %", 100.0 * noise));
    writeln!(
        out,
        "{} replicates after {:.2} s of pilot; noise {noise}; reproduce with --replicates {}",
        report.replicates, report.seeding_seconds, report.selection,
    )?;
    if report.mean_kurtosis.is_some_and(|kurtosis| kurtosis > HEAVY) {
        writeln!(
            out,
            "a few replicates carry most of the light (kurtosis {:.0}): the error estimates \
            cannot be trusted",
            report.mean_kurtosis.unwrap_or(0.0)
        )?;
    }
    Ok(())
}

/// What each strategy did. Every rate is a share of all tries of the strategy, failures included.
fn strategy_table(report: &Report) -> Table {
    let mut table = Table::new();
    table.load_style(UTF8_FULL_CONDENSED).set_header([
        "strategy",
        "weight",
        "proposals",
        "generated",
        "of proposals",
        "accepted",
        "of proposals",
        "mean a of proposals",
        "why proposals failed",
    ]);
    let percent =
        |part: u64, whole: u64| format!("{:.2} %", 100.0 * part as f64 / whole.max(1) as f64);
    for (index, strategy) in report.strategies.iter().enumerate() {
        let weight = report.prospects.get(index).map(|prospect| format!("{:.3}", prospect.weight));
        let failures: Vec<String> = strategy
            .failures
            .iter()
            .map(|(reason, count)| format!("{reason} {}", percent(*count, strategy.proposed)))
            .collect();
        table.add_row([
            strategy.name.clone(),
            weight.unwrap_or_default(),
            strategy.proposed.to_string(),
            strategy.generated.to_string(),
            percent(strategy.generated, strategy.proposed),
            strategy.accepted.to_string(),
            percent(strategy.accepted, strategy.proposed),
            format!("{:.4}", strategy.mean_acceptance),
            failures.join(", "),
        ]);
    }
    table
}

/// A rate with a unit prefix.
fn short(rate: f64) -> String {
    match rate {
        r if r >= 1e6 => format!("{:.2} M", r / 1e6),
        r if r >= 1e3 => format!("{:.1} k", r / 1e3),
        r => format!("{r:.1}"),
    }
}
