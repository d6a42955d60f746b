//! `tracer-server serve`: the daemon.

use std::fmt::Write as _;
use std::process::ExitCode;
use std::sync::Arc;

use anyhow::Context as _;
use clap::Args;
use host::Writer;
use host::signal::Endings;

use super::access::AccessArgs;
use super::chains::ChainArgs;
use super::input::{self, FilmSize};
use crate::daemon::{Daemon, DaemonOptions};

/// Traces a scene continuously, and streams paths and image to viewers.
///
/// Prints `listening on ADDR:PORT` when viewers may connect. Ctrl-C, SIGTERM and the end of its terminal
/// end it, and connected viewers are notified. Under `nohup` it outlives its terminal.
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
    pub door: AccessArgs,
    /// The chains.
    #[command(flatten)]
    pub chains: ChainArgs,
    /// The film.
    #[command(flatten)]
    pub film: FilmSize,
}

/// Serves until a signal stops it.
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
    let mut endings = Endings::listen().context("cannot wait for signals")?;
    let daemon = Daemon::start(scene, options)?;
    let mut hello = format!("listening on {}\n", daemon.address());
    if let Some(certificate) = &options.security.certificate {
        writeln!(hello, "certificate fingerprint {}", certificate.fingerprint())?;
    }
    // Viewers can come whether or not anybody reads this.
    Writer::stdout().say(hello);
    tokio::select! {
        ending = endings.next() => tracing::info!("stopping: {}", ending.name()),
        () = daemon.ended().cancelled() => anyhow::bail!("the network service has ended"),
    }
    daemon.stop();
    Ok(ExitCode::SUCCESS)
}
