//! How chains are run: the options that every subcommand with chains has.

use std::str::FromStr;

use anyhow::{Context as _, ensure};
use clap::builder::RangedU64ValueParser;
use clap::{ArgAction, Args, ValueEnum};

use super::integrator::IntegratorName;
use crate::chain::EnsembleSettings;
use crate::mutation::{Form, KINDS, Kind, Mixture, Parameter, StrategyOptions};
use crate::render::Integrator;
use crate::scene::{Scene, StrategySetting, Wish};

/// Seed, chains, threads and strategies.
#[derive(Args, Clone, Debug)]
pub struct ChainArgs {
    /// Seed of the random numbers: the same seed gives the same result.
    #[arg(long, default_value_t = EnsembleSettings::default().seed)]
    pub seed: u64,
    /// Number of Markov chains [default: 512 for a picture, 128 to be watched].
    #[arg(long, value_name = "N")]
    #[arg(value_parser = clap::value_parser!(u32).range(1..=65_536))]
    pub chains: Option<u32>,
    /// Worker threads [default: the number of cores].
    #[arg(long, value_name = "N")]
    #[arg(value_parser = RangedU64ValueParser::<usize>::new().range(1..=1024))]
    pub threads: Option<usize>,
    /// The mutation strategies.
    #[command(flatten)]
    pub strategies: StrategyArgs,
}

/// Which strategies mutate, how often, and with what sizes.
///
/// What is said here goes before what the scene file says under `[strategies]`, and that before the
/// strategies' own figures.
#[derive(Args, Clone, Debug, Default)]
pub struct StrategyArgs {
    /// Use these mutation strategies only, with weights where given: `lens=0.3,bidirectional`.
    #[arg(long, value_name = "NAME[=WEIGHT],...", value_delimiter = ',', help_heading = HEADING)]
    #[arg(long_help = strategies_help())]
    pub strategies: Vec<Weighted>,
    /// Leave out these mutation strategies.
    #[arg(long, value_name = "NAME,...", value_delimiter = ',', help_heading = HEADING)]
    pub without: Vec<String>,
    /// Set a parameter of a strategy, such as `lens.radius=0.1..20`; may be repeated.
    #[arg(long, value_name = "NAME.PARAMETER=VALUE", action = ArgAction::Append)]
    #[arg(help_heading = HEADING, long_help = tune_help())]
    pub tune: Vec<Tuned>,
    /// Whether a pilot sets the weights before the chains start; on unless weights are given.
    #[arg(long, value_name = "on|off", help_heading = HEADING)]
    pub adapt: Option<Switch>,
}

const HEADING: &str = "Mutation strategies";

/// Chains of a picture that nobody watches. A chain that stays on one path leaves its whole share of
/// the steps in one pixel: the more chains, the smaller that share.
const CHAINS_OF_A_PICTURE: u32 = 512;

/// On or off.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Switch {
    /// On.
    On,
    /// Off.
    Off,
}

/// `NAME` or `NAME=WEIGHT`.
#[derive(Clone, Debug, PartialEq)]
pub struct Weighted {
    name: String,
    weight: Option<f64>,
}

impl FromStr for Weighted {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let Some((name, weight)) = text.split_once('=') else {
            return Ok(Self { name: text.trim().to_owned(), weight: None });
        };
        let weight = number(weight)?;
        Ok(Self { name: name.trim().to_owned(), weight: Some(weight) })
    }
}

/// `NAME.PARAMETER=VALUE`, where the value is a number or `MIN..MAX`.
#[derive(Clone, Debug, PartialEq)]
pub struct Tuned {
    name: String,
    parameter: String,
    values: Vec<f64>,
}

impl FromStr for Tuned {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let parts = text.split_once('=').and_then(|(key, value)| {
            let (name, parameter) = key.split_once('.')?;
            Some((name.trim(), parameter.trim(), value))
        });
        let (name, parameter, value) =
            parts.ok_or("give NAME.PARAMETER=VALUE, such as lens.radius=0.1..20")?;
        let values = value.split("..").map(number).collect::<Result<_, _>>()?;
        Ok(Self { name: name.to_owned(), parameter: parameter.to_owned(), values })
    }
}

fn number(text: &str) -> Result<f64, String> {
    text.trim().parse().map_err(|_error| format!("`{text}` is not a number"))
}

fn strategies_help() -> String {
    let lines = KINDS.map(|kind| format!("\n  {:14} {}", kind.key(), kind.weight));
    format!(
        "Use only these mutation strategies, with weights if given, such as \
         `lens=0.3,bidirectional`; weights are relative to each other.\n\nThe strategies with their default weights:{}",
        lines.concat()
    )
}

fn tune_help() -> String {
    let line = |kind: &Kind, parameter: &Parameter| {
        let form = match parameter.form {
            Form::Number => "a number",
            Form::Sizes => "MIN..MAX",
        };
        let key = format!("{}.{}", kind.key(), parameter.name);
        format!("\n  {key:20} {form}: {}", parameter.about)
    };
    let lines: Vec<String> = KINDS
        .iter()
        .flat_map(|kind| kind.parameters.iter().map(move |parameter| line(kind, parameter)))
        .collect();
    format!(
        "Set a parameter of a strategy, such as `lens.radius=0.1..20`; may be repeated.\n\nThe \
         parameters:{}",
        lines.concat()
    )
}

impl StrategyArgs {
    /// What the scene's file and the command line together say, the latter before the former.
    pub fn options(&self, settings: &[StrategySetting]) -> anyhow::Result<StrategyOptions> {
        let mut options = of_scene(settings)?;
        if !self.strategies.is_empty() {
            let list: Vec<_> = self.strategies.iter().map(|w| (w.name.clone(), w.weight)).collect();
            options.restrict(&list).context("--strategies")?;
        }
        for name in &self.without {
            options.set_weight(name.trim(), 0.0).context("--without")?;
        }
        for Tuned { name, parameter, values } in &self.tune {
            options.set_parameter(name, parameter, values).context("--tune")?;
        }
        options.adapt = self.adapt.map(|switch| switch == Switch::On);
        options.check()?;
        Ok(options)
    }
}

/// What a scene's file says of the strategies; an error names file and line.
pub fn of_scene(settings: &[StrategySetting]) -> anyhow::Result<StrategyOptions> {
    let mut options = StrategyOptions::default();
    for StrategySetting { place, strategy, wish } in settings {
        match wish {
            Wish::Weight(weight) => options.set_weight(strategy, *weight),
            Wish::Parameter(parameter, values) => {
                options.set_parameter(strategy, parameter, values)
            }
        }
        .with_context(|| format!("{place}: [strategies]"))?;
    }
    Ok(options)
}

impl ChainArgs {
    /// Rejects options that `integrator` would ignore.
    pub fn check(&self, integrator: IntegratorName) -> anyhow::Result<()> {
        let StrategyArgs { strategies, without, tune, adapt } = &self.strategies;
        let has_chains = matches!(integrator, IntegratorName::Mlt | IntegratorName::Pssmlt);
        let has_strategies = matches!(integrator, IntegratorName::Auto | IntegratorName::Mlt);
        let idle: Vec<&str> = [
            ("--chains", self.chains.is_some() && !has_chains),
            ("--strategies", !strategies.is_empty() && !has_strategies),
            ("--without", !without.is_empty() && !has_strategies),
            ("--tune", !tune.is_empty() && !has_strategies),
            ("--adapt", adapt.is_some() && !has_strategies),
        ]
        .into_iter()
        .filter_map(|(option, is_idle)| is_idle.then_some(option))
        .collect();
        ensure!(
            idle.is_empty(),
            "{} would have no effect: {} {}; leave it out, or use --integrator mlt",
            idle.join(", "),
            Integrator::from(integrator).name(),
            if has_strategies {
                "finds out by itself how many chains it needs"
            } else if has_chains {
                "has no mutation strategies"
            } else {
                "has no Markov chains"
            },
        );
        Ok(())
    }

    /// The settings of chains whose only end is a picture: they may be many, and each short.
    pub fn for_a_picture(
        &self,
        scene: &Scene,
        settings: &[StrategySetting],
    ) -> anyhow::Result<EnsembleSettings> {
        let ensemble = self.ensemble(scene, settings)?;
        Ok(EnsembleSettings { chains: self.chains.unwrap_or(CHAINS_OF_A_PICTURE), ..ensemble })
    }

    /// The settings of the chains on `scene`, whose file asks for `settings`.
    pub fn ensemble(
        &self,
        scene: &Scene,
        settings: &[StrategySetting],
    ) -> anyhow::Result<EnsembleSettings> {
        let strategies = self.strategies.options(settings)?;
        let names = Mixture::names_for(&strategies, scene.camera(), scene.features());
        ensure!(
            !names.is_empty(),
            "none of the enabled mutation strategies applies to this scene; enable others with \
            --strategies"
        );
        let defaults = EnsembleSettings::default();
        Ok(EnsembleSettings {
            seed: self.seed,
            chains: self.chains.unwrap_or(defaults.chains),
            threads: self.threads.unwrap_or(defaults.threads),
            strategies,
            ..defaults
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cli::{Cli, Command};
    use crate::scene::load::Place;
    use clap::Parser as _;
    use std::path::Path;

    fn options(line: &str, file: &[StrategySetting]) -> Result<StrategyOptions, String> {
        let line = format!("tracer-server serve cornell {line}");
        let cli = Cli::try_parse_from(line.split_whitespace()).map_err(|e| e.to_string())?;
        let Command::Serve(args) = cli.command else { return Err("no serve".to_owned()) };
        args.chains.strategies.options(file).map_err(|error| format!("{error:#}"))
    }

    fn setting(strategy: &str, wish: Wish) -> StrategySetting {
        let place = Place::line(Path::new("room.toml"), 7);
        StrategySetting { place, strategy: strategy.to_owned(), wish }
    }

    #[test]
    fn the_command_line_goes_before_the_scene_file() {
        let file = [
            setting("lens", Wish::Weight(0.9)),
            setting("lens", Wish::Parameter("radius".to_owned(), vec![1.0, 2.0])),
            setting("caustic", Wish::Weight(0.0)),
        ];
        let weights = |options: &StrategyOptions| -> Vec<f64> {
            (0..KINDS.len()).map(|index| options.weight(index)).collect()
        };
        let index = |name: &str| KINDS.iter().position(|k| k.key() == name).expect("a strategy");
        let plain = options("", &file).expect("options");
        assert_eq!(weights(&plain)[index("lens")], 0.9, "the file's");
        assert_eq!(weights(&plain)[index("caustic")], 0.0, "the file's");
        assert!(!plain.adapts(), "the file gives weights");
        let told = options("--strategies lens=0.1,caustic --tune lens.radius=3..4", &file);
        let told = told.expect("options");
        assert_eq!(weights(&told)[index("lens")], 0.1, "the command line's");
        assert_eq!(weights(&told)[index("caustic")], KINDS[index("caustic")].weight, "its own");
        assert_eq!(weights(&told)[index("bidirectional")], 0.0, "not listed");
        let radius = told.tuning(index("lens")).sizes("radius").expect("sizes");
        assert_eq!((radius.min, radius.max), (3.0, 4.0), "the command line's");
        assert!(options("--adapt on", &file).expect("options").adapts(), "said in so many words");
        assert!(options("--without lens", &[]).expect("options").adapts(), "no weight was given");
        assert!(!options("--adapt off", &[]).expect("options").adapts(), "switched off");
    }

    #[test]
    fn a_picture_has_more_chains_than_what_is_watched() {
        let scene = crate::scene::fixtures::diffuse_room().build();
        for (line, expected) in [("", [512, 128]), ("--chains 7", [7, 7])] {
            let line = format!("tracer-server serve cornell {line}");
            let cli = Cli::try_parse_from(line.split_whitespace()).expect("valid arguments");
            let Command::Serve(args) = cli.command else { panic!("no serve") };
            let picture = args.chains.for_a_picture(&scene, &[]).expect("settings").chains;
            let watched = args.chains.ensemble(&scene, &[]).expect("settings").chains;
            assert_eq!([picture, watched], expected, "{line}");
        }
    }

    #[test]
    fn what_is_wrong_is_named() {
        for (line, words) in [
            ("--strategies lenses", "`lenses`; the strategies are bidirectional"),
            ("--without lenses", "--without: there is no strategy"),
            ("--strategies lens=much", "`much` is not a number"),
            ("--tune lens=3", "NAME.PARAMETER=VALUE"),
            ("--tune lens.radius=3..2", "MIN below MAX"),
            ("--strategies lens=0", "no strategy is left"),
        ] {
            let error = options(line, &[]).expect_err(line);
            assert!(error.contains(words), "{line}: {error}");
        }
        let file = [setting("caustics", Wish::Weight(0.5))];
        let error = options("", &file).expect_err("no such strategy");
        assert!(error.contains("room.toml:7") && error.contains("multi-chain"), "{error}");
    }
}
