//! `tracer-server verify`: whether the mutation strategies obey their laws on a scene.

use std::io::{self, Write};
use std::process::ExitCode;

use clap::Args;
use clap::builder::RangedU64ValueParser;
use comfy_table::Table;
use comfy_table::presets::UTF8_FULL_CONDENSED;

use super::chains::StrategyArgs;
use super::input::{self, FilmSize};
use super::meter::Meter;
use crate::chain::EnsembleSettings;
use crate::scene::MAX_EDGES;
use crate::verify::{Finding, Report, Settings, Verdict, verify};

/// Bidirectional samples of each test unless the user says otherwise.
const DEFAULT_SAMPLES: u64 = 100_000;

/// Checks the mutation strategies on a scene: invariance, flow, reversal and ergodicity.
///
/// Every test starts from bidirectional samples, which represent the light in the scene without
/// bias: a right strategy must leave every mean over them as it was. The same scene, seed and
/// options give the same report, whatever the number of threads. Exit code 1 when a law is broken.
#[derive(Args, Clone, Debug)]
#[command(after_help = "\
Examples:
  tracer-server verify cornell
  tracer-server verify scenes/room.toml --strategy lens --strategy caustic
  tracer-server verify door --quick --json
  tracer-server verify caustic --strategy caustic --tune caustic.radius=1..60 --samples 1000000

The laws:
  invariance    moving light by a strategy, rejections included, must not change how it is distributed
                over paths: by film point, length, class, position and direction. Tested once over
                three steps with random acceptance, and once with ten proposals per path, weighted
                by their acceptance.
  flow          between any two classes of paths, as much light must flow one way as the other.
  reversal      the ratios of a move and its reverse must multiply to one, what is declared to be
                kept must be kept, and the proposal must be consistent.
  visits        chains with all strategies must visit each class in proportion to its light.

A deviation fails if |z| exceeds a limit that all comparisons together would exceed once in a million
runs. Suspicious results are repeated once with four times the samples before they count.")]
pub struct VerifyArgs {
    /// A built-in scene, a scene file, or a directory that holds one.
    pub scene: String,
    /// Check only this strategy; may be repeated.
    #[arg(long, value_name = "NAME")]
    pub strategy: Vec<String>,
    /// How thoroughly.
    #[command(flatten)]
    pub effort: Effort,
    /// Seed of the random numbers: the same seed gives the same report.
    #[arg(long, default_value_t = 0)]
    pub seed: u64,
    /// Worker threads [default: the number of cores].
    #[arg(long, value_name = "N")]
    #[arg(value_parser = RangedU64ValueParser::<usize>::new().range(1..=1024))]
    pub threads: Option<usize>,
    /// The film.
    #[command(flatten)]
    pub film: FilmSize,
    /// Longest path in edges from light to camera [default: the scene's own].
    #[arg(long, value_name = "EDGES")]
    #[arg(value_parser = RangedU64ValueParser::<usize>::new().range(1..=MAX_EDGES as u64))]
    pub max_depth: Option<usize>,
    /// The strategies of the mixture.
    #[command(flatten)]
    pub strategies: StrategyArgs,
    /// Print JSON instead of tables.
    #[arg(long)]
    pub json: bool,
}

/// How thoroughly strategies are checked.
#[derive(Args, Clone, Copy, Debug)]
pub struct Effort {
    /// Bidirectional samples of each test [default: 100000].
    #[arg(long, value_name = "N", conflicts_with_all = ["quick", "full"])]
    #[arg(value_parser = RangedU64ValueParser::<u64>::new().range(1000..=1 << 32))]
    pub samples: Option<u64>,
    /// A quarter of the usual samples.
    #[arg(long, conflicts_with = "full")]
    pub quick: bool,
    /// Ten times the usual samples.
    #[arg(long)]
    pub full: bool,
}

impl Effort {
    fn samples(self) -> u64 {
        match self {
            Self { samples: Some(samples), .. } => samples,
            Self { quick: true, .. } => DEFAULT_SAMPLES / 4,
            Self { full: true, .. } => DEFAULT_SAMPLES * 10,
            Self { .. } => DEFAULT_SAMPLES,
        }
    }
}

/// Checks, and prints what was found.
pub fn run(args: &VerifyArgs) -> anyhow::Result<ExitCode> {
    let (scene, wishes) = input::scene_with_depth(&args.scene, args.film, args.max_depth)?;
    let settings = Settings {
        strategies: args.strategy.clone(),
        options: args.strategies.options(&wishes)?,
        samples: args.effort.samples(),
        seed: args.seed,
        threads: args.threads.unwrap_or_else(|| EnsembleSettings::default().threads),
    };
    let meter = Meter::new(format!("verify {}", scene.name()), "verified");
    let report = verify(&scene, &settings, &|share, what| meter.show(share, what));
    meter.finish();
    let report = report?;
    let mut out = io::stdout().lock();
    if args.json {
        writeln!(out, "{}", serde_json::to_string_pretty(&report)?)?;
    } else {
        print(&mut out, &report)?;
    }
    Ok(if report.has_failed() { ExitCode::FAILURE } else { ExitCode::SUCCESS })
}

fn print(out: &mut impl Write, report: &Report) -> io::Result<()> {
    let Report { scene, seed, samples, .. } = report;
    writeln!(out, "{scene}: {samples} bidirectional samples a test, seed {seed}")?;
    let mut table =
        head(&["strategy", "law", "compared", "samples", "max |z|", "limit", "verdict", ""]);
    for finding in &report.findings {
        table.add_row(row(finding));
    }
    writeln!(out, "{}", table.trim_fmt())?;
    if !report.flows.is_empty() {
        let mut table = head(&["strategy", "classes", "forth", "back", "light moved a step", "z"]);
        for flow in &report.flows {
            table.add_row([
                flow.strategy.clone(),
                flow.classes.join(" <-> "),
                flow.forth.to_string(),
                flow.back.to_string(),
                format!("{:.3} %", 100.0 * flow.share),
                format!("{:+.2}", flow.z),
            ]);
        }
        writeln!(out, "The largest flows of light between classes\n{}", table.trim_fmt())?;
    }
    if !report.visits.is_empty() {
        let mut table = head(&["class", "light", "visits", "z"]);
        for visit in report.visits.iter().take(16) {
            table.add_row([
                visit.class.clone(),
                format!("{:.4} %", 100.0 * visit.energy),
                format!("{:.4} %", 100.0 * visit.visits),
                visit.z.map_or_else(|| "too few chains".to_owned(), |z| format!("{z:+.2}")),
            ]);
        }
        writeln!(out, "Visits of the chains\n{}", table.trim_fmt())?;
    }
    if !report.switched_off.is_empty() {
        writeln!(
            out,
            "Off, because they do not apply to the scene or were switched off: {}",
            report.switched_off.join(", ")
        )?;
    }
    conclude(out, report)
}

fn head(titles: &[&str]) -> Table {
    let mut table = Table::new();
    table.load_style(UTF8_FULL_CONDENSED).set_header(titles.iter().copied());
    table
}

fn row(finding: &Finding) -> [String; 8] {
    let is_measured = finding.limit > 0.0 && finding.judged > 0;
    let number = |value: f64| if is_measured { format!("{value:.2}") } else { String::new() };
    [
        finding.subject.clone(),
        finding.law.to_owned(),
        finding.judged.to_string(),
        finding.samples.to_string(),
        number(finding.worst),
        number(finding.limit),
        finding.verdict.name().to_owned(),
        finding.remark.clone(),
    ]
}

/// What the verdicts mean, in plain words.
fn conclude(out: &mut impl Write, report: &Report) -> io::Result<()> {
    let with =
        |verdict: Verdict| report.findings.iter().filter(move |finding| finding.verdict == verdict);
    for finding in with(Verdict::Fail) {
        writeln!(out, "FAIL {}, {}: {}", finding.subject, finding.law, meaning(finding.law))?;
    }
    for finding in with(Verdict::Note) {
        writeln!(out, "note {}, {}: {}", finding.subject, finding.law, advice(finding.law))?;
    }
    let unjudged = with(Verdict::Unjudged).count();
    if unjudged > 0 {
        writeln!(
            out,
            "{unjudged} checks saw too few moves to judge: raise --samples, or choose a scene \
            whose light takes such paths"
        )?;
    }
    if report.has_failed() {
        writeln!(out, "A law is broken: images made with these strategies would be wrong.")
    } else {
        writeln!(out, "No law is broken, as far as could be judged.")
    }
}

fn meaning(law: &str) -> &'static str {
    match law {
        "invariance, 3 steps" | "invariance, proposals" => {
            "the strategy moves light to where it does not belong. The quantities above show where: \
             film rows and columns near the border point to proposals off the film that are drawn \
             again or clamped; lengths and classes to a selection probability that is missing in one \
             direction; cosines and distances to a density in the wrong measure."
        }
        "flow between classes" => {
            "more light goes from one class to the other than comes back: the strategy's \
            `transition` gives moves between these classes the wrong weight in one direction."
        }
        "reversal" => {
            "`reverse` does not name the move that leads back, `kept` names vertices that change, or \
             a number of `transition` is NaN or negative."
        }
        "visits of classes" => {
            "chains are in these classes more or less often than light is: a strategy is wrong."
        }
        _ => "see `tracer-server verify --help`.",
    }
}

/// What is worth knowing though no law is broken, in plain words.
fn advice(law: &str) -> &'static str {
    match law {
        "visits of classes" => {
            "each of these carries more than 0.01 % of the light, but no chain got there: more \
            steps, or a strategy that reaches them, would help."
        }
        "longest rejection run" => {
            "one path carries so much of the image that it may show as a bright dot; more chains, \
            or a strategy that can leave it, would help."
        }
        "from the rarest classes" => {
            "chains that started in rare classes still show it after half of their steps: the \
            image is right on average, but converges slowly."
        }
        "ways between classes" => {
            "no chain got from one of these islands to the other without starting afresh, so they \
            depend on the independent mutation."
        }
        _ => "see `tracer-server verify --help`.",
    }
}

#[cfg(test)]
mod tests {
    use clap::Parser as _;

    use super::*;
    use crate::cli::{Cli, Command};

    fn parse(line: &str) -> VerifyArgs {
        let cli = Cli::try_parse_from(line.split_whitespace()).expect("valid arguments");
        match cli.command {
            Command::Verify(args) => args,
            _ => panic!("another subcommand"),
        }
    }

    #[test]
    fn a_report_tells_every_strategy_and_class() {
        let line = "tracer-server verify caustic --width 32 --height 32 --samples 3000";
        let args = parse(line);
        let (scene, _) = input::scene(&args.scene, args.film).expect("a scene");
        let settings = Settings {
            strategies: Vec::new(),
            options: args.strategies.options(&[]).expect("options"),
            samples: 3000,
            seed: 1,
            threads: 1,
        };
        let report = verify(&scene, &settings, &|_, _| ()).expect("a report");
        let text = |report: &Report| {
            let mut out = Vec::new();
            print(&mut out, report).expect("written to memory");
            String::from_utf8(out).expect("UTF-8")
        };
        let alone = text(&report);
        for words in ["bidirectional", "multi-chain", "flow between classes", "LSSDE", "No law"] {
            assert!(alone.contains(words), "`{words}` is missing from\n{alone}");
        }
        let settings = Settings { threads: 3, ..settings };
        let report = verify(&scene, &settings, &|_, _| ()).expect("a report");
        assert_eq!(text(&report), alone, "the number of threads changes nothing");
    }

    #[test]
    fn a_strategy_that_is_off_is_told() {
        let args = parse("tracer-server verify cornell --strategy multi-chain");
        let error = run(&args).expect_err("cornell has no mirror").to_string();
        assert!(error.contains("`multi-chain`") && error.contains("bidirectional"), "{error}");
    }
}
