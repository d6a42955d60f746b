//! The command line: one file a subcommand.
//!
//! A subcommand is a file with its `clap::Args` and a `run` that returns an exit code, a variant of
//! [`Command`], and an arm of `Command::run`. Results go to stdout, logs to stderr. Exit codes: 0
//! done, 1 a check failed, 2 bad usage or input.

pub mod access;
pub mod chains;
pub mod info;
pub mod input;
pub mod integrator;
mod inventory;
pub mod merge;
mod meter;
pub mod render;
pub mod scenes;
pub mod serve;
mod stopper;
pub mod trade;
pub mod verify;

use std::io;
use std::process::ExitCode;

use anyhow::Context as _;
use clap::{Parser, Subcommand};
use tracing_subscriber::EnvFilter;

/// Bad usage or bad input.
const BAD_INPUT: u8 = 2;

/// Renders with Metropolis light transport, and shows how light gets to the picture.
#[derive(Debug, Parser)]
#[command(
    name = "tracer-server",
    version,
    max_term_width = 100,
    after_help = "\
Examples:
  tracer-server scenes
  tracer-server info door
  tracer-server render door -o door.png
  tracer-server merge a.lvf b.lvf -o door.exr
  tracer-server serve cornell --seed 7
  tracer-server verify door
  tracer-server trade door --out trade

Exit codes: 0 done, 1 a check failed, 2 bad usage or input."
)]
pub struct Cli {
    /// What to log, as `LEVEL` or `MODULE=LEVEL,...`; levels are error, warn, info, debug, trace.
    #[arg(long, global = true, env = "RUST_LOG", default_value = "info", value_name = "FILTER")]
    pub log: String,
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

/// The subcommands.
#[derive(Clone, Debug, Subcommand)]
#[expect(missing_docs, reason = "the help of each stands on its arguments")]
pub enum Command {
    Serve(serve::ServeArgs),
    Render(render::RenderArgs),
    Merge(merge::MergeArgs),
    Scenes(scenes::ScenesArgs),
    Info(info::InfoArgs),
    Verify(verify::VerifyArgs),
    Trade(trade::TradeArgs),
}

impl Command {
    fn run(&self) -> anyhow::Result<ExitCode> {
        match self {
            Self::Serve(args) => serve::run(args),
            Self::Render(args) => render::run(args),
            Self::Merge(args) => merge::run(args),
            Self::Scenes(args) => scenes::run(args),
            Self::Info(args) => info::run(args),
            Self::Verify(args) => verify::run(args),
            Self::Trade(args) => trade::run(args),
        }
    }
}

/// Runs the program.
pub fn main() -> ExitCode {
    let cli = Cli::parse();
    let filter = EnvFilter::builder().parse(&cli.log);
    let filter =
        filter.with_context(|| format!("--log or RUST_LOG: `{}` is no log filter", cli.log));
    let (filter, ready) = match filter {
        Ok(filter) => (filter, Ok(())),
        Err(error) => (EnvFilter::default(), Err(error)),
    };
    let log = host::log::start(filter, false);
    let code = match ready.and_then(|()| cli.command.run()) {
        Ok(code) => code,
        // Whoever reads the results, such as `head`, has read enough.
        Err(error) if is_broken_pipe(&error) => ExitCode::SUCCESS,
        Err(error) => {
            log.say(&format!("error: {error:#}"));
            ExitCode::from(BAD_INPUT)
        }
    };
    log.finish();
    code
}

/// True where standard output is gone. Files that cannot be written have errors of their own.
fn is_broken_pipe(error: &anyhow::Error) -> bool {
    error.downcast_ref::<io::Error>().is_some_and(|e| e.kind() == io::ErrorKind::BrokenPipe)
}
