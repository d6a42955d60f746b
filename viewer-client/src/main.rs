//! The viewer's program.

use std::io::{IsTerminal as _, Write as _};
use std::process::ExitCode;

use clap::Parser as _;
use tracing_subscriber::EnvFilter;
use viewer_client::app::cli::Cli;

/// Exit code for bad usage or input.
const BAD_INPUT: u8 = 2;

/// What is logged unless `RUST_LOG` says otherwise; graphics libraries warn of every driver they
/// pass over.
const DEFAULT_LOG: &str = "warn,viewer_client=info,wgpu_hal=off,egui_wgpu=error";

fn main() -> ExitCode {
    let filter = EnvFilter::try_from_default_env().unwrap_or_else(|_| EnvFilter::new(DEFAULT_LOG));
    tracing_subscriber::fmt()
        .with_env_filter(filter)
        .with_ansi(std::io::stderr().is_terminal())
        .with_writer(std::io::stderr)
        .init();
    match viewer_client::app::run::run(Cli::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            // Nothing is left to tell the user with when stderr is closed.
            drop(writeln!(std::io::stderr(), "error: {error:#}"));
            ExitCode::from(BAD_INPUT)
        }
    }
}
