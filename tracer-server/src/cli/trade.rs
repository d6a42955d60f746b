//! `tracer-server trade`: speed against accuracy, measured.

use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::str::FromStr;
use std::time::Duration;

use anyhow::{Context as _, ensure};
use clap::builder::RangedU64ValueParser;
use clap::{Args, Parser};
use comfy_table::Table;
use comfy_table::presets::UTF8_FULL_CONDENSED;
use common::Floor;
use host::file::{Growing, Place};
use serde::Serialize;

use super::chains::ChainArgs;
use super::input::{self, FilmSize};
use super::integrator::IntegratorName;
use super::meter::Meter;
use super::render::{DialArgs, PrimaryArgs, check_reference, missing, seconds};
use crate::chain::EnsembleSettings;
use crate::image_file;
use crate::integrator::pssmlt::PrimarySettings;
use crate::render::{Budget, Integrator, RenderSettings};
use crate::replicate::Dial;
use crate::scene::{MAX_EDGES, Scene, StrategySetting};
use crate::trade::{Plan, Point, Reference, Run, Setting, Summary, draw, slope, summarize};

/// Measures what error a setting reaches in what time: a table, a CSV file of all runs and a chart.
#[derive(Args, Clone, Debug)]
#[command(after_help = "\
Examples:
  tracer-server trade cornell --out trade
  tracer-server trade room.xml --reference reference.exr --times 2,8 --runs 8 --out trade
  tracer-server trade caustic --per-pixel 16,64,256 --out trade \\
      --setting 'all=' --setting 'plain=--without caustic,multi-chain' \\
      --setting 'space=--integrator pssmlt --primary-sampler path'

Files in DIR: trade.csv (one line per run; trade.csv.part until all are done), trade.json (one record
per point), trade.svg (the chart), reference.exr, and the first picture of every point.

The error is the mean over the pixels of |I - R|^2 / (|R|^2 + 0.01 mean |R|^2), and \"trimmed\" leaves
out the worst pixel in a thousand. \"bias\" is the squared systematic error as a share of the error of
one run; it scatters about zero for a setting without bias.")]
pub struct TradeArgs {
    /// A built-in scene, a scene file, or a directory that holds one.
    pub scene: String,
    /// The folder for the results; created if it is missing.
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
    /// What to measure, as NAME=OPTIONS with the options of `render`; may be repeated. The others
    /// are compared with the first [default: all integrators].
    #[arg(long = "setting", value_name = "NAME=OPTIONS")]
    pub settings: Vec<SettingText>,
    /// What each run may spend, in seconds of wall clock [default: 1,2,4].
    #[arg(long, value_name = "S,...", value_delimiter = ',', value_parser = seconds)]
    #[arg(conflicts_with = "per_pixel")]
    pub times: Vec<Duration>,
    /// The same in mutations, or samples, for each pixel.
    #[arg(long, value_name = "N,...", value_delimiter = ',')]
    #[arg(value_parser = RangedU64ValueParser::<u64>::new().range(1..=1 << 32))]
    pub per_pixel: Vec<u64>,
    /// Independent runs of each setting with each budget.
    #[arg(long, value_name = "N", default_value_t = 8)]
    #[arg(value_parser = RangedU64ValueParser::<u64>::new().range(1..=10_000))]
    pub runs: u64,
    /// Seed of the first run.
    #[arg(long, default_value_t = 0)]
    #[arg(value_parser = RangedU64ValueParser::<u64>::new().range(0..=1 << 48))]
    pub seed: u64,
    /// Worker threads; one keeps CPU seconds comparable.
    #[arg(long, value_name = "N", default_value_t = 1)]
    #[arg(value_parser = RangedU64ValueParser::<usize>::new().range(1..=1024))]
    pub threads: usize,
    /// The picture to measure errors against; made by bidirectional path tracing without.
    #[arg(long, value_name = "REF.exr")]
    pub reference: Option<PathBuf>,
    /// Seconds of wall clock, with all cores, to make the reference in.
    #[arg(long, value_name = "SECONDS", default_value = "60", value_parser = seconds)]
    #[arg(conflicts_with = "reference")]
    pub reference_time: Duration,
    /// Take (I - R)^2 / (R^2 + F) in each channel for the error instead; others publish theirs with
    /// F = 0.01.
    #[arg(long, value_name = "F", value_parser = floor)]
    pub floor: Option<f64>,
    /// The film.
    #[command(flatten)]
    pub film: FilmSize,
    /// Longest path in edges from light to camera [default: the scene's own].
    #[arg(long, value_name = "EDGES")]
    #[arg(value_parser = RangedU64ValueParser::<usize>::new().range(1..=MAX_EDGES as u64))]
    pub max_depth: Option<usize>,
    /// Print JSON instead of the table.
    #[arg(long)]
    pub json: bool,
}

/// `NAME=OPTIONS`.
#[derive(Clone, Debug)]
pub struct SettingText {
    name: String,
    options: SettingOptions,
}

/// What one setting can be.
#[derive(Clone, Debug, Parser)]
#[command(no_binary_name = true, disable_help_flag = true)]
struct SettingOptions {
    #[arg(long, value_enum, default_value = "auto")]
    integrator: IntegratorName,
    #[command(flatten)]
    chains: ChainArgs,
    #[command(flatten)]
    primary: PrimaryArgs,
    #[command(flatten)]
    dial: DialArgs,
}

impl FromStr for SettingText {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (name, options) = text.split_once('=').ok_or("give NAME=OPTIONS")?;
        let plain = |c: char| c.is_alphanumeric() || matches!(c, '-' | '_' | '.' | '+');
        if name.is_empty() || !name.chars().all(plain) {
            return Err(format!("`{name}` is not a valid name: use letters, digits, - _ . +"));
        }
        let words = shlex::split(options).ok_or("a quote is not closed")?;
        if let Some(word) = words.iter().find(|w| is_common(w)) {
            return Err(format!("{word} applies to all settings: give it outside of --setting"));
        }
        let options = SettingOptions::try_parse_from(words).map_err(|error| error.to_string())?;
        Ok(Self { name: name.to_owned(), options })
    }
}

/// True for options that all settings must have in common.
fn is_common(word: &str) -> bool {
    let name = word.split_once('=').map_or(word, |(name, _)| name);
    matches!(name, "--seed" | "--threads")
}

fn floor(text: &str) -> Result<f64, String> {
    let floor = text.parse().ok().filter(|floor: &f64| *floor > 0.0 && floor.is_finite());
    floor.ok_or_else(|| "give a positive number".to_owned())
}

impl TradeArgs {
    fn budgets(&self) -> Vec<Budget> {
        let usual = [1, 2, 4].map(Duration::from_secs);
        let times = if self.times.is_empty() { &usual[..] } else { &self.times };
        let mut budgets: Vec<Budget> = match self.per_pixel.as_slice() {
            [] => times.iter().copied().map(Budget::Time).collect(),
            counts => counts.iter().copied().map(Budget::PerPixel).collect(),
        };
        budgets.sort_by_key(|budget| match *budget {
            Budget::Time(time) => time.as_nanos(),
            Budget::PerPixel(count) => u128::from(count),
        });
        budgets.dedup();
        budgets
    }

    fn settings(&self, scene: &Scene, wishes: &[StrategySetting]) -> anyhow::Result<Vec<Setting>> {
        let usual = ["auto", "path", "bdpt", "pssmlt", "mlt"];
        let usual = usual.map(|name| format!("{name}=--integrator {name}").parse());
        let usual: Vec<SettingText> = usual.into_iter().flatten().collect();
        let texts = if self.settings.is_empty() { &usual } else { &self.settings };
        let mut settings: Vec<Setting> = Vec::new();
        for SettingText { name, options } in texts {
            ensure!(
                !settings.iter().any(|s| s.name == *name),
                "two settings have the name `{name}`"
            );
            let heeded = options.chains.check(options.integrator);
            heeded.with_context(|| format!("--setting {name}"))?;
            let ensemble = options.chains.for_a_picture(scene, wishes);
            let ensemble = ensemble.with_context(|| format!("--setting {name}"))?;
            let primary = options.primary.settings(options.integrator);
            let render = RenderSettings {
                integrator: options.integrator.into(),
                budget: Budget::PerPixel(1),
                ensemble: EnsembleSettings { seed: self.seed, threads: self.threads, ..ensemble },
                primary: primary.with_context(|| format!("--setting {name}"))?,
                dial: options.dial.settings(options.integrator)?,
            };
            settings.push(Setting { name: name.clone(), render });
        }
        Ok(settings)
    }

    fn floor(&self) -> Floor {
        self.floor.map_or(Floor::Relative, Floor::Absolute)
    }

    fn reference(&self, scene: &Scene) -> anyhow::Result<Reference> {
        if let Some(file) = &self.reference {
            let image = image_file::read_exr(file)?;
            check_reference(&image, scene)?;
            let missing = missing(&image);
            if missing > 0 {
                tracing::warn!(
                    "the reference has no value for {missing} pixels, which are ignored"
                );
            }
            return Ok(Reference { image, error: None });
        }
        let settings = RenderSettings {
            integrator: Integrator::Bdpt,
            budget: Budget::Time(self.reference_time / 2),
            ensemble: EnsembleSettings::default(),
            primary: PrimarySettings::default(),
            dial: Dial::default(),
        };
        let meter = Meter::new(format!("reference of {}", scene.name()), "made the reference");
        let reference =
            Reference::render(scene, &settings, self.floor(), |share| meter.show(share, ""));
        meter.finish();
        image_file::write(&self.out.join("reference.exr"), &reference.image, &[])?;
        Ok(reference)
    }
}

/// Measures, and writes and prints what was found.
pub fn run(args: &TradeArgs) -> anyhow::Result<ExitCode> {
    let (scene, wishes) = input::scene_with_depth(&args.scene, args.film, args.max_depth)?;
    let settings = args.settings(&scene, &wishes)?;
    let budgets = args.budgets();
    fs::create_dir_all(&args.out)
        .with_context(|| format!("cannot create the folder `{}`", args.out.display()))?;
    let file = |name: &str| Place::find(&args.out.join(name));
    let (json_file, chart_file) = (file("trade.json")?, file("trade.svg")?);
    let growing = Growing::begin(file("trade.csv")?)?;
    let reference = args.reference(&scene)?;
    let plan = Plan {
        settings: &settings,
        budgets: &budgets,
        runs: args.runs,
        reference: &reference.image,
        floor: args.floor(),
    };
    let points = measure(&plan, &scene, growing)?;
    let lines = summarize(&plan, &points);
    let outcome = Outcome {
        scene: scene.name(),
        reference_error: reference.error,
        slopes: (0..settings.len()).map(|s| (&*settings[s].name, slope(&points, s))).collect(),
        points: &lines,
    };
    let json = serde_json::to_string_pretty(&outcome)?;
    json_file.write_bytes(json.as_bytes())?;
    save_pictures(&plan, &points, &args.out)?;
    let chart = draw(&format!("{}: error against time", scene.name()), &lines)?;
    chart_file.write_bytes(chart.as_bytes())?;
    let mut out = io::stdout().lock();
    if args.json {
        writeln!(out, "{json}")?;
    } else {
        print(&mut out, &outcome, &budgets)?;
        writeln!(out, "written to {}", args.out.display())?;
    }
    Ok(ExitCode::SUCCESS)
}

/// Everything that was found.
#[derive(Debug, Serialize)]
struct Outcome<'a> {
    scene: &'a str,
    reference_error: Option<f64>,
    slopes: Vec<(&'a str, Option<f64>)>,
    points: &'a [Summary],
}

/// Runs the plan; each run is in the file as soon as it has ended.
fn measure(plan: &Plan<'_>, scene: &Scene, file: Growing) -> anyhow::Result<Vec<Point>> {
    let mut csv = csv::Writer::from_writer(file);
    let meter = Meter::new(format!("trade {}", scene.name()), "measured");
    let points = plan.measure(scene, |share, run: &Run| -> anyhow::Result<()> {
        csv.serialize(run)?;
        csv.flush()?;
        meter.show(share, &run.setting);
        Ok(())
    })?;
    meter.finish();
    csv.into_inner()?.finish()?;
    Ok(points)
}

fn save_pictures(plan: &Plan<'_>, points: &[Point], folder: &Path) -> anyhow::Result<()> {
    for point in points {
        let name = &plan.settings[point.setting].name;
        let budget = match plan.budgets[point.budget] {
            Budget::Time(time) => format!("{}s", time.as_secs_f64()),
            Budget::PerPixel(count) => count.to_string(),
        };
        let file = folder.join(format!("{name}-{budget}.exr"));
        image_file::write(&file, &point.picture, &[])?;
    }
    Ok(())
}

fn print(out: &mut impl Write, outcome: &Outcome<'_>, budgets: &[Budget]) -> io::Result<()> {
    writeln!(out, "{}", table(outcome.points, budgets).trim_fmt())?;
    if let Some(error) = outcome.reference_error {
        writeln!(out, "the reference's own relMSE is {error:.1e}")?;
        for line in outcome.points.iter().filter(|line| line.relative_mse < 4.0 * error) {
            let Summary { setting, cpu_seconds, .. } = line;
            writeln!(
                out,
                "  {setting} in {cpu_seconds:.1} CPU s is close to it: see --reference-time"
            )?;
        }
    }
    for (name, slope) in &outcome.slopes {
        if let Some(slope) = slope {
            writeln!(out, "{name}: error falls with the power {slope:.2} of CPU time")?;
        }
    }
    Ok(())
}

fn table(lines: &[Summary], budgets: &[Budget]) -> Table {
    let mut table = Table::new();
    let first = lines.first().map_or("", |line| &line.setting);
    table.load_style(UTF8_FULL_CONDENSED).set_header([
        "setting",
        "budget",
        "CPU s",
        "per pixel",
        "relMSE",
        "10 %",
        "50 %",
        "90 %",
        "trimmed",
        "relMSE x CPU s",
        "trimmed x CPU s",
        "bias",
        "mean ratio",
        &format!("efficiency over {first}"),
    ]);
    for line in lines {
        let budget = match budgets[line.budget] {
            Budget::Time(time) => format!("{} s", time.as_secs_f64()),
            Budget::PerPixel(count) => format!("{count} per pixel"),
        };
        let efficiency = line.efficiency.map(|e| {
            let (low, high) = (e.ratio / e.factor, e.ratio * e.factor);
            format!("{:.2} ({low:.2} to {high:.2})", e.ratio)
        });
        table.add_row([
            line.setting.clone(),
            budget,
            format!("{:.2}", line.cpu_seconds),
            format!("{:.1}", line.per_pixel),
            format!("{:.2e}", line.relative_mse),
            format!("{:.2e}", line.quantiles.low),
            format!("{:.2e}", line.quantiles.median),
            format!("{:.2e}", line.quantiles.high),
            format!("{:.2e}", line.trimmed),
            format!("{:.4}", line.cost),
            format!("{:.4}", line.trimmed_cost),
            format!("{:+.2}", line.bias_share),
            format!("{:.4}", line.mean_ratio),
            efficiency.unwrap_or_default(),
        ]);
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cli::{Cli, Command};

    fn parse(words: &[&str]) -> Result<TradeArgs, String> {
        let words = ["tracer-server", "trade", "cornell", "--out"].iter().chain(words);
        let cli = Cli::try_parse_from(words).map_err(|error| error.to_string())?;
        match cli.command {
            Command::Trade(args) => Ok(args),
            _ => Err("another subcommand".to_owned()),
        }
    }

    #[test]
    fn what_is_wrong_with_a_setting_is_named() {
        for (setting, words) in [
            ("plain", "NAME=OPTIONS"),
            ("a/b=", "not a valid name"),
            ("a=--seed 3", "applies to all settings"),
            ("a=--threads=3", "applies to all settings"),
            ("a=--integrator magic", "possible values"),
            ("a='", "not closed"),
        ] {
            let error = parse(&["x", "--setting", setting]).expect_err(setting);
            assert!(error.contains(words), "{setting}: {error}");
        }
        for bad in [&["x", "--floor", "0"], &["x", "--times", "-1"], &["x", "--runs", "0"]] {
            assert!(parse(bad).is_err(), "{bad:?} must be refused");
        }
    }

    #[test]
    fn a_trade_leaves_its_files() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let out = folder.path().join("new");
        let args = parse(&[
            &out.display().to_string(),
            "--per-pixel",
            "2,1,2",
            "--runs",
            "2",
            "--reference-time",
            "0.2",
            "--width",
            "8",
            "--height",
            "8",
            "--setting",
            "few=--integrator mlt --chains 8",
            "--setting",
            "tracer=--integrator path",
        ]);
        run(&args.expect("valid arguments")).expect("a trade");
        let csv = fs::read_to_string(out.join("trade.csv")).expect("the runs");
        assert_eq!(csv.lines().count(), 1 + 2 * 2 * 2, "a header, and a line a run:\n{csv}");
        assert!(!out.join("trade.csv.part").exists(), "nothing more is to come");
        let json = fs::read_to_string(out.join("trade.json")).expect("the points");
        let json: serde_json::Value = serde_json::from_str(&json).expect("JSON");
        assert_eq!(json["points"].as_array().map(Vec::len), Some(4));
        let svg = fs::read_to_string(out.join("trade.svg")).expect("the chart");
        assert!(svg.contains("few") && svg.contains("tracer"), "a legend");
        for file in ["reference.exr", "few-1.exr", "tracer-2.exr"] {
            image_file::read_exr(&out.join(file)).expect(file);
        }
    }
}
