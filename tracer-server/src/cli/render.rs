//! `tracer-server render`: one image, and the story of how it was made.

use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Duration;

use anyhow::{Context as _, ensure};
use clap::builder::RangedU64ValueParser;
use clap::{Args, ValueEnum};
use comfy_table::Table;
use comfy_table::presets::UTF8_FULL_CONDENSED;
use common::{mean_ratio, relative_mse};

use super::chains::ChainArgs;
use super::input::{self, FilmSize};
use super::meter::Meter;
use crate::film::Film;
use crate::image_file;
use crate::integrator::pssmlt::{PrimarySampler, PrimarySettings};
use crate::render::{
    Budget, Integrator, Progress, RenderSettings, Rendering, Report, Wish, auto, render,
};
use crate::replicate::{Dial, Part, Selection};
use crate::scene::{MAX_EDGES, Scene};
use crate::target::Base;

/// Kurtosis over replicates above which their spread tells little.
const HEAVY: f64 = 12.0;
/// Mutations, or samples, for each pixel unless the user says otherwise.
const DEFAULT_PER_PIXEL: u64 = 256;

/// Renders one image, with a table of what the chains did.
///
/// The same scene, seed and options give the same image, whatever the number of threads.
#[derive(Args, Clone, Debug)]
#[command(after_help = "\
Examples:
  tracer-server render door -o door.png
  tracer-server render door -o door.exr --until 1% --film-out door.lvf
  tracer-server render door -o door.exr --time 60 --film-out door.lvf --resume
  tracer-server render door -o a.exr --replicates 0..8 --film-out a.lvf
  tracer-server render cornell -o cornell.exr --integrator bdpt --mutations-per-pixel 64
  tracer-server render caustic -o caustic.exr --time 30 --reference reference.exr
  tracer-server render caustic -o plain.exr --without caustic,multi-chain --tune lens.radius=0.5..8
  tracer-server render door -o pss.exr --integrator pssmlt --primary-sampler path --large-step 0.2
  tracer-server render scenes/room.toml -o room.exr --width 640 --height 480 --stats-json room.json")]
pub struct RenderArgs {
    /// A built-in scene, a .toml, .obj or Mitsuba .xml file, or a directory that holds one.
    pub scene: String,
    /// Where to put the image: .exr keeps linear radiance, .png is exposed to be looked at.
    #[arg(short, long, value_name = "FILE")]
    pub output: PathBuf,
    /// How to render.
    #[arg(long, value_enum, default_value = "auto")]
    pub integrator: IntegratorName,
    /// Mutations, or samples, for each pixel [default: 256].
    #[arg(long, value_name = "N", conflicts_with = "time")]
    #[arg(value_parser = RangedU64ValueParser::<u64>::new().range(1..=1 << 32))]
    pub mutations_per_pixel: Option<u64>,
    /// Render for so many seconds, seeding included.
    #[arg(long, value_name = "SECONDS", value_parser = seconds)]
    pub time: Option<Duration>,
    /// The chains.
    #[command(flatten)]
    pub chains: ChainArgs,
    /// What `--integrator pssmlt` needs besides.
    #[command(flatten)]
    pub primary: PrimaryArgs,
    /// Which replicates `--integrator auto` makes.
    #[command(flatten)]
    pub replicates: ReplicateArgs,
    /// The film.
    #[command(flatten)]
    pub film: FilmSize,
    /// Longest path in edges from light to camera (1: a lamp seen directly); the scene's own
    /// without.
    #[arg(long, value_name = "EDGES")]
    #[arg(value_parser = RangedU64ValueParser::<usize>::new().range(1..=MAX_EDGES as u64))]
    pub max_depth: Option<usize>,
    /// An image to measure the error against.
    #[arg(long, value_name = "REF.exr")]
    pub reference: Option<PathBuf>,
    /// Where to put the report as JSON.
    #[arg(long, value_name = "FILE")]
    pub stats_json: Option<PathBuf>,
}

/// How chains move in primary-sample space.
#[derive(Args, Clone, Debug, Default)]
pub struct PrimaryArgs {
    /// The renderer whose random numbers `--integrator pssmlt` moves [default: bdpt].
    #[arg(long, value_enum, value_name = "RENDERER")]
    pub primary_sampler: Option<PrimarySamplerName>,
    /// Share of the steps of `--integrator pssmlt` that draw all numbers anew [default: 0.3].
    #[arg(long, value_name = "SHARE", value_parser = share)]
    pub large_step: Option<f64>,
}

/// Which replicates `--integrator auto` makes, what becomes of them, and how it divides the work.
#[derive(Args, Clone, Debug, Default)]
pub struct ReplicateArgs {
    /// Make these replicates only, such as `0..8`, `8..` (to the last that `--mutations-per-pixel`
    /// asks for), or what an earlier render has printed.
    #[arg(long, value_name = "A..B", conflicts_with = "until", help_heading = REPLICATES)]
    pub replicates: Option<Selection>,
    /// Render until the noise is down to this, as `1%` or `0.01`: the root of the relative mean squared
    /// error that the spread of replicates tells.
    #[arg(long, value_name = "NOISE", value_parser = noise, help_heading = REPLICATES)]
    pub until: Option<f64>,
    /// Keep the sums over replicates in this file, every few seconds and at the end; `merge` adds such
    /// files up.
    #[arg(long, value_name = "FILE.lvf", help_heading = REPLICATES)]
    pub film_out: Option<PathBuf>,
    /// Go on from the file of `--film-out`, where it is there.
    #[arg(long, requires = "film_out", help_heading = REPLICATES)]
    pub resume: bool,
    /// How it divides the work.
    #[command(flatten)]
    pub dial: DialArgs,
}

/// How `--integrator auto` divides the work between base samples and chains.
#[derive(Args, Clone, Debug, Default)]
pub struct DialArgs {
    /// Who draws the base samples; the pilot's choice without.
    #[arg(long, value_enum, value_name = "SAMPLER", help_heading = REPLICATES)]
    pub base: Option<BaseName>,
    /// Leave light to the chains that base samples would show brighter than this many times the mean
    /// luminance of the picture, from 0 (all light for the chains) to `inf` (only what base samples
    /// cannot find); the pilot's choice without.
    #[arg(long, value_name = "TAU", value_parser = tau, help_heading = REPLICATES)]
    pub tau: Option<f64>,
}

const REPLICATES: &str = "Replicates of --integrator auto";

/// The base samplers by the names they have on the command line.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum BaseName {
    /// Path tracing with light sampling.
    Path,
    /// All splits of two walks.
    Bidirectional,
}

impl DialArgs {
    /// What the user says of the division of the work; refused where `integrator` divides nothing.
    pub(super) fn settings(&self, integrator: IntegratorName) -> anyhow::Result<Dial> {
        ensure!(
            (self.base.is_none() && self.tau.is_none()) || integrator == IntegratorName::Auto,
            "--base and --tau are for --integrator auto"
        );
        let base = self.base.map(|name| match name {
            BaseName::Path => Base::Path,
            BaseName::Bidirectional => Base::Bidirectional,
        });
        Ok(Dial { base, tau: self.tau })
    }
}

impl ReplicateArgs {
    /// The division of the work; all of this is refused where `integrator` has no replicates.
    fn dial(&self, integrator: IntegratorName) -> anyhow::Result<Dial> {
        let silent = self.replicates.is_none() && self.until.is_none() && self.film_out.is_none();
        ensure!(
            silent || integrator == IntegratorName::Auto,
            "--replicates, --until and --film-out are for --integrator auto"
        );
        self.dial.settings(integrator)
    }

    /// What was kept of an earlier render.
    fn begun(&self) -> anyhow::Result<Option<Part>> {
        let Some(file) = self.film_out.as_ref().filter(|file| file.exists()) else {
            return Ok(None);
        };
        ensure!(
            self.resume,
            "`{}` is there already: give --resume to go on from it, or another name",
            file.display()
        );
        super::merge::read(file).map(Some)
    }
}

/// A noise as a number, or in per cent.
fn noise(text: &str) -> Result<f64, String> {
    let (number, unit) = text.strip_suffix('%').map_or((text, 1.0), |number| (number, 0.01));
    let noise = number.trim().parse::<f64>().ok().map(|number| number * unit);
    let noise = noise.filter(|noise| *noise > 0.0 && *noise < 10.0);
    noise.ok_or_else(|| "give a noise such as 1% or 0.01".to_owned())
}

fn tau(text: &str) -> Result<f64, String> {
    let tau = text.parse::<f64>().ok().filter(|tau| *tau >= 0.0);
    tau.ok_or_else(|| "give a number from 0 on, or inf".to_owned())
}

/// The renderers behind primary-sample space.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum PrimarySamplerName {
    /// Bidirectional path tracing.
    Bdpt,
    /// Path tracing with light sampling; cannot find caustics of lights that nothing can hit.
    Path,
}

impl PrimaryArgs {
    /// The settings, refused where `integrator` needs none.
    pub(super) fn settings(&self, integrator: IntegratorName) -> anyhow::Result<PrimarySettings> {
        let usual = PrimarySettings::default();
        let silent = self.primary_sampler.is_none() && self.large_step.is_none();
        ensure!(
            silent || integrator == IntegratorName::Pssmlt,
            "--primary-sampler and --large-step are for --integrator pssmlt"
        );
        let sampler = self.primary_sampler.map_or(usual.sampler, |name| match name {
            PrimarySamplerName::Bdpt => PrimarySampler::Bdpt,
            PrimarySamplerName::Path => PrimarySampler::Path,
        });
        Ok(PrimarySettings { sampler, large_step: self.large_step.unwrap_or(usual.large_step) })
    }
}

fn share(text: &str) -> Result<f64, String> {
    let share = text.parse().ok().filter(|share| (0.0..=1.0).contains(share));
    share.ok_or_else(|| "give a number from 0 to 1".to_owned())
}

/// The integrators by the names they have on the command line.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum IntegratorName {
    /// Base samples for what they find well, Metropolis light transport for the rest.
    Auto,
    /// Metropolis light transport.
    Mlt,
    /// Metropolis light transport over the random numbers of a renderer.
    Pssmlt,
    /// Bidirectional path tracing.
    Bdpt,
    /// Path tracing with light sampling.
    Path,
}

impl From<IntegratorName> for Integrator {
    fn from(name: IntegratorName) -> Self {
        match name {
            IntegratorName::Auto => Self::Auto,
            IntegratorName::Mlt => Self::Mlt,
            IntegratorName::Pssmlt => Self::Pssmlt,
            IntegratorName::Bdpt => Self::Bdpt,
            IntegratorName::Path => Self::Path,
        }
    }
}

/// A positive number of seconds.
pub(super) fn seconds(text: &str) -> Result<Duration, String> {
    let time = text.parse().ok().and_then(|seconds| Duration::try_from_secs_f64(seconds).ok());
    time.filter(|time| !time.is_zero()).ok_or_else(|| "give a positive number".to_owned())
}

/// Renders, writes the image and prints the report.
pub fn run(args: &RenderArgs) -> anyhow::Result<ExitCode> {
    // What would only fail after the work is looked at before it.
    image_file::Format::of(&args.output)?;
    for file in [Some(&args.output), args.stats_json.as_ref()].into_iter().flatten() {
        check_folder(file)?;
    }
    let (scene, wishes) = input::scene_with_depth(&args.scene, args.film, args.max_depth)?;
    let reference = args.reference.as_deref().map(image_file::read_exr).transpose()?;
    if let Some(reference) = &reference {
        check_reference(reference, &scene)?;
    }
    let settings = RenderSettings {
        integrator: args.integrator.into(),
        budget: match (args.time, args.mutations_per_pixel) {
            (Some(time), _) => Budget::Time(time),
            (None, mutations) => Budget::PerPixel(mutations.unwrap_or(DEFAULT_PER_PIXEL)),
        },
        ensemble: args.chains.for_a_picture(&scene, &wishes)?,
        primary: args.primary.settings(args.integrator)?,
        dial: args.replicates.dial(args.integrator)?,
    };
    let what = format!("{}, {}", scene.name(), settings.integrator.name());
    let meter = Meter::new(what, "rendered");
    let Rendering { image, mut report, .. } = make(args, &scene, &settings, &meter)?;
    meter.finish();
    if let Some(reference) = &reference {
        report.relative_mse = Some(relative_mse(image.pixels(), reference.pixels()));
        report.mean_ratio = Some(mean_ratio(image.pixels(), reference.pixels()));
    }
    image_file::write(&args.output, &image, &metadata(&report))?;
    if let Some(file) = &args.stats_json {
        std::fs::write(file, serde_json::to_string_pretty(&report)?)
            .with_context(|| format!("`{}` could not be written", file.display()))?;
    }
    print(&mut io::stdout().lock(), &report, &args.output)?;
    Ok(ExitCode::SUCCESS)
}

/// Makes the picture, and keeps its replicates where that is wanted.
fn make(
    args: &RenderArgs,
    scene: &Scene,
    settings: &RenderSettings,
    meter: &Meter,
) -> anyhow::Result<Rendering> {
    if settings.integrator != Integrator::Auto {
        return Ok(render(scene, settings, |at| show(meter, at)));
    }
    let wanted = &args.replicates;
    let begun = wanted.begun()?;
    let mut save = |part: &Part| match &wanted.film_out {
        Some(file) => super::merge::write(file, part),
        None => Ok(()),
    };
    let wish = Wish {
        selection: wanted.replicates.clone(),
        begun,
        until: wanted.until,
        save: wanted.film_out.is_some().then_some(&mut save),
        ..Wish::none()
    };
    auto::render(scene, settings, wish, &mut |at| show(meter, at))
}

/// Refuses a reference of another size than the scene's film.
pub(super) fn check_reference(reference: &Film, scene: &Scene) -> anyhow::Result<()> {
    let camera = scene.camera();
    ensure!(
        (reference.width(), reference.height()) == (camera.width, camera.height),
        "the reference has {} x {} pixels and the film {} x {}; choose the film with --width and \
         --height",
        reference.width(),
        reference.height(),
        camera.width,
        camera.height,
    );
    Ok(())
}

fn check_folder(file: &Path) -> anyhow::Result<()> {
    let folder = match file.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    ensure!(folder.is_dir(), "`{}`: there is no folder `{}`", file.display(), folder.display());
    Ok(())
}

/// What an EXR file's header tells of the image.
fn metadata(report: &Report) -> Vec<(String, String)> {
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
    let sampler = report.primary_sampler.map(|name| ("primary_sampler", name.to_owned()));
    let large_step = report.large_step.map(|share| ("large_step", share.to_string()));
    let entries = entries.into_iter().map(|(key, value)| (key, value.to_string()));
    entries
        .chain(sampler)
        .chain(large_step)
        .map(|(key, value)| (format!("lvis.{key}"), value))
        .collect()
}

fn show(meter: &Meter, progress: Progress) {
    match progress {
        Progress::Seeding(samples) => meter.tell(format!("seeding: {samples} samples")),
        Progress::Rendering(share) => meter.show(share, ""),
    }
}

fn print(out: &mut impl Write, report: &Report, file: &Path) -> io::Result<()> {
    if !report.strategies.is_empty() {
        writeln!(out, "Strategies; rates are shares of all tries, failures included")?;
        writeln!(out, "{}", strategy_table(report).trim_fmt())?;
    }
    let work = if report.chains > 0 { "mutations" } else { "samples" };
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
    if report.replicates > 0 || !report.selection.is_empty() {
        print_replicates(out, report)?;
    } else if report.chains > 0 {
        writeln!(
            out,
            "mean luminance b = {:.6} +- {:.6} ({:.2} %) from {} samples in {:.2} s; {} chains, \
             longest stay at one path {} steps; {} proposals were no number",
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
    }
    writeln!(out, "written to {}", file.display())
}

/// How the work was divided, what came of it, and how to make the same picture again.
fn print_replicates(out: &mut impl Write, report: &Report) -> io::Result<()> {
    if let Some(outlook) = report.outlook {
        let base = outlook.base.map_or("no base samples", |base| base.name());
        writeln!(
            out,
            "base: {base}, tau {:.3}; chains have {:.2} % of the light, with {:.2} mutations for each \
             base sample; {}",
            outlook.tau,
            100.0 * outlook.chains_share,
            outlook.mutations_per_sample,
            match (report.chains, outlook.is_equalised) {
                (0, _) => "chains would not pay, so there are none".to_owned(),
                (n, false) => format!("{n} chains in each replicate"),
                (n, true) =>
                    format!("{n} chains in each replicate, dark parts as often as bright ones"),
            },
        )?;
    }
    if report.chains > 0 {
        writeln!(
            out,
            "mean luminance of what chains have, b = {:.6} +- {:.6}; pools of {} samples; longest stay \
             at one path {} steps; {} proposals were no number",
            report.normalization,
            report.normalization_error,
            report.bootstrap_samples,
            report.longest_dwell,
            report.not_finite,
        )?;
    }
    let noise =
        report.noise.map_or("unknown".to_owned(), |noise| format!("{:.2} %", 100.0 * noise));
    writeln!(
        out,
        "{} replicates after {:.2} s of pilot; noise {noise}; again with --replicates {}",
        report.replicates, report.seeding_seconds, report.selection,
    )?;
    if report.mean_kurtosis.is_some_and(|kurtosis| kurtosis > HEAVY) {
        writeln!(
            out,
            "few replicates have most of the light (kurtosis {:.0}): the errors are not to be trusted",
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
        "tries",
        "generated",
        "of tries",
        "accepted",
        "of tries",
        "mean a of tries",
        "why tries failed, of tries",
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

#[cfg(test)]
mod tests {
    use clap::Parser as _;

    use super::*;
    use crate::cli::{Cli, Command};

    fn parse(line: &str) -> Result<RenderArgs, String> {
        let cli = Cli::try_parse_from(line.split(' ')).map_err(|error| error.to_string())?;
        match cli.command {
            Command::Render(args) => Ok(args),
            _ => Err("another subcommand".to_owned()),
        }
    }

    #[test]
    fn budgets_exclude_each_other() {
        let line = "tracer-server render cornell -o a.exr --time 3 --mutations-per-pixel 4";
        assert!(parse(line).expect_err("both budgets").contains("cannot be used with"));
        for bad in ["0", "-1", "nan", "inf", "soon"] {
            let line = format!("tracer-server render cornell -o a.exr --time={bad}");
            assert!(parse(&line).is_err(), "--time {bad} must be refused");
        }
        let args = parse("tracer-server render cornell -o a.exr --time 0.5").expect("a budget");
        assert_eq!(args.time, Some(Duration::from_millis(500)));
    }

    #[test]
    fn a_render_leaves_an_image_and_a_report() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let image = folder.path().join("a.exr");
        let json = folder.path().join("a.json");
        for integrator in ["auto", "mlt", "pssmlt", "bdpt", "path"] {
            let line = format!(
                "tracer-server render cornell --width 16 --height 16 --mutations-per-pixel 4 \
                 --chains 16 --integrator {integrator} -o {} --stats-json {}",
                image.display(),
                json.display(),
            );
            let line = line.split_whitespace().collect::<Vec<_>>().join(" ");
            run(&parse(&line).expect("valid arguments")).expect("a render");
            let film = image_file::read_exr(&image).expect("an image");
            assert!(film.mean().luminance() > 0.0, "{integrator}: the image is black");
            let text = std::fs::read_to_string(&json).expect("a report");
            let report: serde_json::Value = serde_json::from_str(&text).expect("JSON");
            assert_eq!(report["integrator"], integrator);
            assert!(report["mutations"].as_u64() >= Some(1024), "{integrator}: {text}");
        }
        let line =
            format!("tracer-server render cornell -o {}/no/such/a.png", folder.path().display());
        let error = run(&parse(&line).expect("valid arguments")).expect_err("no folder");
        assert!(error.to_string().contains("there is no folder"), "{error}");
    }
}
