//! From the command line to a window, a picture or a list.

use std::time::Duration;

use anyhow::Context as _;

use crate::app::Viewer;
use crate::cli::{Action, Cli, ViewArgs};
use crate::connection::Peer;
use crate::headless::Wait;
use crate::status::Status;
use crate::{bench, embedded, headless, script, share, watch, window};

/// A picture is taken after this long when nothing else is asked for.
const DEFAULT_WAIT: Duration = Duration::from_secs(5);

/// Does what the command line says.
pub fn run(cli: Cli) -> anyhow::Result<()> {
    match cli.action {
        Some(Action::Watch(args)) => watch::run(&args),
        Some(Action::Bench(args)) => bench::run(&args),
        None => view(&cli.view),
    }
}

fn view(args: &ViewArgs) -> anyhow::Result<()> {
    let link = args.address.as_deref().filter(|text| text.starts_with(share::SCHEME));
    let shared = link.map(share::read).transpose()?;
    let mut commands = Vec::new();
    let address = match shared {
        Some(shared) => {
            commands.extend(shared.commands);
            Some(shared.address)
        }
        None => args.address.clone(),
    };
    commands.extend(args.run.as_deref().map(script::read).transpose()?.unwrap_or_default());
    // The daemon must outlive the viewer, which says goodbye to it.
    let (peer, daemon) = if let Some(address) = address {
        (args.trust.peer(address)?, None)
    } else {
        let daemon = embedded::start(args.scene.as_deref().unwrap_or(embedded::DEFAULT_SCENE))?;
        (Peer::open(daemon.address().to_string()), Some(daemon))
    };
    let mut viewer = Viewer::new(Status::new(peer.address.clone(), daemon.is_some()));
    viewer.run_script(commands);
    if let Some(file) = &args.screenshot_to {
        let wait = match (args.wait_paths, args.wait) {
            (Some(paths), _) => Wait::Paths(paths),
            (None, time) => Wait::Time(time.unwrap_or(DEFAULT_WAIT)),
        };
        headless::run(viewer, peer, args.size, wait, file)
    } else {
        window::run(viewer, peer).context("the viewer ended")
    }
}
