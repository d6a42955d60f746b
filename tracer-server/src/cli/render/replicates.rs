//! Options for the replicates of `--integrator auto`.

use std::path::PathBuf;

use anyhow::ensure;
use clap::{Args, ValueEnum};

use crate::cli::integrator::IntegratorName;
use crate::replicate::{Dial, Part, Selection};
use crate::target::Base;

/// Which replicates `--integrator auto` makes, what becomes of them, and how it divides the work.
#[derive(Args, Clone, Debug, Default)]
pub struct ReplicateArgs {
    /// Render only these replicates, such as `0..8`, `8..` (to the last that
    /// `--mutations-per-pixel` asks for), or what an earlier render has printed.
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
    /// Continue from the file of `--film-out`, if it exists.
    #[arg(long, requires = "film_out", help_heading = REPLICATES)]
    pub resume: bool,
    /// How it divides the work.
    #[command(flatten)]
    pub dial: DialArgs,
}

/// How `--integrator auto` divides the work between base samples and chains.
#[derive(Args, Clone, Debug, Default)]
pub struct DialArgs {
    /// Who draws the base samples [default: the pilot's choice].
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
    pub(crate) fn settings(&self, integrator: IntegratorName) -> anyhow::Result<Dial> {
        ensure!(
            (self.base.is_none() && self.tau.is_none()) || integrator == IntegratorName::Auto,
            "--base and --tau only apply to --integrator auto"
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
    pub(super) fn dial(&self, integrator: IntegratorName) -> anyhow::Result<Dial> {
        let silent = self.replicates.is_none() && self.until.is_none() && self.film_out.is_none();
        ensure!(
            silent || integrator == IntegratorName::Auto,
            "--replicates, --until and --film-out only apply to --integrator auto"
        );
        self.dial.settings(integrator)
    }

    /// What was kept of an earlier render.
    pub(super) fn begun(&self) -> anyhow::Result<Option<Part>> {
        let Some(file) = self.film_out.as_ref().filter(|file| file.exists()) else {
            return Ok(None);
        };
        ensure!(
            self.resume,
            "`{}` exists already: use --resume to continue it, or another name",
            file.display()
        );
        crate::cli::merge::read(file).map(Some)
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
