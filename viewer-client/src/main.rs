//! The viewer's program.

use std::process::ExitCode;

use anyhow::Context as _;
use clap::Parser as _;
use tracing_subscriber::EnvFilter;
use viewer_client::app::Failed;
use viewer_client::app::cli::Cli;
use viewer_client::app::run::run;
use viewer_client::source::connection::SessionError;

/// Exit code for what was asked for and could not be done.
const FAILED: u8 = 1;
/// Exit code for bad usage or input.
const BAD_INPUT: u8 = 2;

/// What is logged unless `RUST_LOG` says otherwise; graphics libraries warn of every driver they
/// pass over, and of desktops that do without something.
const DEFAULT_LOG: &str = "warn,viewer_client=info,wgpu_hal=off,egui_wgpu=error,winit=error";

fn main() -> ExitCode {
    let cli = Cli::parse();
    let wish = std::env::var("RUST_LOG").ok().filter(|wish| !wish.is_empty());
    let filter = EnvFilter::builder().parse(wish.as_deref().unwrap_or(DEFAULT_LOG));
    let filter = filter.context("RUST_LOG is no log filter");
    let (filter, ready) = match filter {
        Ok(filter) => (filter, Ok(())),
        Err(error) => (EnvFilter::default(), Err(error)),
    };
    let log = host::log::start(filter, true);
    let code = match ready.and_then(|()| run(cli)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            log.say(&format!("error: {error:#}"));
            let is_failure = error.is::<Failed>() || error.is::<SessionError>();
            ExitCode::from(if is_failure { FAILED } else { BAD_INPUT })
        }
    };
    log.finish();
    code
}
