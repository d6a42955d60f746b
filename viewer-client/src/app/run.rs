//! From the command line to a window, a picture or a list.

use std::path::Path;
use std::time::Duration;

use anyhow::Context as _;

use crate::app::Viewer;
use crate::app::cli::{Action, Cli, Target, ViewArgs};
use crate::app::headless::{Job, Wait};
use crate::app::{bench, headless, script, share, watch, window};
use crate::source::connection::Peer;
use crate::source::{Source, dump, embedded, file};

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
    let text = match &args.source {
        Some(Target::Daemon(text)) => Some(text.as_str()),
        Some(Target::File(_)) | None => None,
    };
    let link = text.filter(|text| text.starts_with(share::SCHEME));
    let shared = link.map(share::read).transpose()?;
    let mut commands = Vec::new();
    let address = match shared {
        Some(shared) => {
            commands.extend(shared.commands);
            Some(shared.address)
        }
        None => text.map(str::to_owned),
    };
    commands.extend(args.run.as_deref().map(script::read).transpose()?.unwrap_or_default());
    // The daemon must outlive the viewer, which says goodbye to it.
    let (peer, daemon) = match (address, &args.source) {
        (Some(address), _) => (Some(args.trust.peer(address)?), None),
        (None, Some(_)) => (None, None),
        (None, None) => {
            let daemon = embedded::start(args.scene.as_deref().unwrap_or(embedded::DEFAULT_SCENE))?;
            (Some(Peer::open(daemon.address().to_string())), Some(daemon))
        }
    };
    let viewer = if let Some(Target::File(file)) = &args.source {
        open(file, args.surfaces.as_deref())?
    } else {
        let address = peer.as_ref().map(|peer| peer.address.clone()).unwrap_or_default();
        Viewer::new(Source::daemon(address, daemon.is_some()))
    };
    if let Some(file) = &args.screenshot_to {
        let wait = match (args.wait_paths, args.wait) {
            (Some(paths), _) => Wait::Paths(paths),
            (None, time) => Wait::Time(time.unwrap_or(DEFAULT_WAIT)),
        };
        headless::run(viewer, peer, Job { size: args.size, wait, file, commands })
    } else {
        window::run(viewer, peer, commands).context("the viewer has ended")
    }
}

/// A viewer of a file of paths, with the surfaces of a scene where one is named.
fn open(path: &Path, surfaces: Option<&str>) -> anyhow::Result<Viewer> {
    let read = dump::read(path)?;
    let scene = surfaces.map(embedded::surfaces).transpose()?;
    let playable = dump::PlayableDump::new(read, scene);
    // The window shows them, too, but nobody may look at it.
    for warning in &playable.warnings {
        tracing::warn!("{}: {warning}", path.display());
    }
    Ok(Viewer::new(Source::file(&file::name_of(path), playable)))
}
