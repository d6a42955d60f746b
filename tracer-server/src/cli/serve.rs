//! `tracer-server serve`: the daemon.

use std::io::{self, Write as _};
use std::process::ExitCode;
use std::sync::Arc;

use anyhow::Context as _;
use clap::Args;
use tokio::signal;

use super::chains::ChainArgs;
use super::door::DoorArgs;
use super::input::{self, FilmSize};
use crate::daemon::{Daemon, DaemonOptions};

/// Traces a scene for ever, and shows viewers how.
///
/// Prints `listening on ADDR:PORT` when viewers may connect. Ctrl-C and SIGTERM end it; viewers that
/// are connected are told.
#[derive(Args, Clone, Debug)]
#[command(after_help = "\
Examples:
  tracer-server serve
  tracer-server serve door --chains 256 --seed 7
  tracer-server serve door --strategies bidirectional=0.7,lens=0.3
  tracer-server serve scenes/room.toml --listen 127.0.0.1:0 --width 640 --height 480
  tracer-server serve --listen 0.0.0.0:50061 --token-file token --tls-self-signed")]
pub struct ServeArgs {
    /// A built-in scene, a .toml, .obj or Mitsuba .xml file, or a directory that holds one.
    #[arg(default_value = "cornell")]
    pub scene: String,
    /// Who may connect, and how.
    #[command(flatten)]
    pub door: DoorArgs,
    /// The chains.
    #[command(flatten)]
    pub chains: ChainArgs,
    /// The film.
    #[command(flatten)]
    pub film: FilmSize,
}

/// Serves until it is told to stop.
pub fn run(args: &ServeArgs) -> anyhow::Result<ExitCode> {
    let security = args.door.security()?;
    let (scene, wishes) = input::scene(&args.scene, args.film)?;
    let ensemble = args.chains.ensemble(&scene, &wishes)?;
    let scene = Arc::new(scene);
    let listen = args.door.listen;
    let options = DaemonOptions { listen, ensemble, security, ..DaemonOptions::default() };
    let runtime = tokio::runtime::Builder::new_current_thread()
        .enable_all()
        .build()
        .context("cannot wait for signals")?;
    runtime.block_on(serve(scene, &options))
}

async fn serve(
    scene: Arc<crate::scene::Scene>,
    options: &DaemonOptions,
) -> anyhow::Result<ExitCode> {
    // Before anyone can know that we are there, so that no signal kills us half-way.
    let told_to_stop = told_to_stop()?;
    let daemon = Daemon::start(scene, options)?;
    let mut out = io::stdout().lock();
    writeln!(out, "listening on {}", daemon.address())?;
    if let Some(certificate) = &options.security.certificate {
        writeln!(out, "certificate fingerprint {}", certificate.fingerprint())?;
    }
    out.flush()?;
    drop(out);
    tokio::select! {
        () = told_to_stop => {}
        () = daemon.ended().cancelled() => anyhow::bail!("the network service has ended"),
    }
    tracing::info!("stopping");
    daemon.stop();
    Ok(ExitCode::SUCCESS)
}

/// Resolves on Ctrl-C, or on SIGTERM where there is such a thing. Listens from the moment of the
/// call.
#[cfg(unix)]
fn told_to_stop() -> io::Result<impl Future<Output = ()>> {
    use signal::unix::{SignalKind, signal};

    let mut interrupt = signal(SignalKind::interrupt())?;
    let mut terminate = signal(SignalKind::terminate())?;
    Ok(async move {
        tokio::select! {
            _ = interrupt.recv() => {}
            _ = terminate.recv() => {}
        }
    })
}

/// Resolves on Ctrl-C.
#[cfg(not(unix))]
fn told_to_stop() -> io::Result<impl Future<Output = ()>> {
    Ok(async {
        if signal::ctrl_c().await.is_err() {
            // Without signals only the service itself can end.
            std::future::pending::<()>().await;
        }
    })
}
