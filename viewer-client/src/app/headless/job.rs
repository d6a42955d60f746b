//! The viewer without a window at work: it waits, follows its script, and writes the picture.

use std::io::{self, Write as _};
use std::path::Path;
use std::thread;
use std::time::{Duration, Instant};

use anyhow::{Context as _, ensure};
use host::file::Place;

use super::OffscreenWindow;
use crate::app::Viewer;
use crate::app::desktop::Connect;
use crate::app::failed::Failed;
use crate::app::preferences::Preferences;
use crate::command::Command;
use crate::source::connection::{Link, Peer};
use crate::source::status::LinkState;

/// What does not come for this long does not come.
const PATIENCE: Duration = Duration::from_mins(1);
/// A daemon that is not reached within this time is not there.
const REACH: Duration = Duration::from_secs(10);
/// How long to wait between looks into the inbox.
const LOOK: Duration = Duration::from_millis(20);

/// When to take the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wait {
    /// When this many paths have come.
    Paths(u64),
    /// After this long.
    Time(Duration),
}

/// What to do without a window.
#[derive(Clone, Debug)]
pub struct Job<'a> {
    /// Size of the picture in pixels.
    pub size: [u32; 2],
    /// When everything that gives something away begins: the picture, and commands such as `image
    /// save`.
    pub wait: Wait,
    /// Where the picture goes, as PNG.
    pub file: &'a Path,
    /// What else to do, in this order.
    pub commands: Vec<Command>,
}

/// Connects, waits, follows the commands, and writes the picture. Without a daemon, everything is
/// there already.
///
/// # Errors
///
/// [`Failed`] where a daemon is not reached, or a command could not be carried out; the picture is
/// written all the same, where there is one.
pub fn run(mut viewer: Viewer, peer: Option<Peer>, job: Job<'_>) -> anyhow::Result<()> {
    let Job { size, wait, file, commands } = job;
    let is_png = file.extension().is_some_and(|end| end.eq_ignore_ascii_case("png"));
    ensure!(
        is_png,
        "{}: the screenshot is written as PNG; use a name that ends in .png",
        file.display()
    );
    let place = Place::find(file)?;
    let mut offscreen = OffscreenWindow::new(size)?;
    let connect: Connect = Box::new(|peer| Link::start(peer, Box::new(|_| {})));
    let link = peer.map(&connect).transpose()?;
    viewer.adopt(Preferences::default(), connect);
    viewer.hold_back(true);
    let has_daemon = link.is_some();
    if let Some(link) = link {
        viewer.set_link(link);
    }
    viewer.run_script(commands);
    if has_daemon {
        wait_for(&mut viewer, wait)?;
    }
    viewer.hold_back(false);
    let followed = finish_script(&mut offscreen, &mut viewer);
    let image = offscreen.settled(&mut viewer)?;
    place.write(|output| {
        let written = image.write_to(output, image::ImageFormat::Png);
        written.with_context(|| format!("cannot write {}", file.display()))
    })?;
    followed?;
    let failures = viewer.take_failures();
    if failures.is_empty() { Ok(()) } else { Err(Failed(failures.join("\n")).into()) }
}

/// Waits until everything has come that the picture shows.
fn wait_for(viewer: &mut Viewer, wait: Wait) -> Result<(), Failed> {
    let started = Instant::now();
    let mut heard = (started, 0);
    let mut enough_since = None;
    loop {
        viewer.receive();
        let enough = match wait {
            Wait::Time(duration) => started.elapsed() >= duration,
            Wait::Paths(paths) => viewer.paths_received() >= paths,
        };
        if enough && viewer.has_everything() {
            return Ok(());
        }
        let over = enough.then(|| *enough_since.get_or_insert_with(Instant::now));
        if viewer.paths_received() != heard.1 {
            heard = (Instant::now(), viewer.paths_received());
        }
        let is_reached = viewer.status().welcome.is_some();
        let patience = if is_reached { PATIENCE } else { REACH };
        let since = over.unwrap_or(heard.0);
        if since.elapsed() > patience || enough && !is_reached {
            return Err(Failed(what_is_missing(viewer)));
        }
        thread::sleep(LOOK);
    }
}

/// Why the picture is not complete.
fn what_is_missing(viewer: &Viewer) -> String {
    let status = viewer.status();
    let address = &status.address;
    match &status.link {
        LinkState::Disconnected { reason, .. } => reason.clone(),
        LinkState::Idle | LinkState::Connecting => format!("no daemon answers at {address}"),
        LinkState::Connected => format!(
            "the daemon at {address} sends no more: {} paths have come, {} the scene, {} the image",
            viewer.paths_received(),
            if viewer.bounds().is_some() { "and" } else { "but not" },
            if status.statistics.is_some() { "and" } else { "but not" },
        ),
    }
}

/// Follows what is left of the script, as a window would that is drawn all the time.
fn finish_script(offscreen: &mut OffscreenWindow, viewer: &mut Viewer) -> anyhow::Result<()> {
    let mut progress = (Instant::now(), viewer.commands_left());
    while !viewer.is_idle() && !viewer.is_closing() {
        // What is given away is all of one moment, unless a command needs more than there is.
        if viewer.wants_more() {
            viewer.receive();
        } else {
            viewer.work_on();
        }
        offscreen.frame(viewer)?;
        offscreen.give_pictures(viewer)?;
        print(&offscreen.take_copied())?;
        let left = viewer.commands_left();
        if left != progress.1 {
            progress = (Instant::now(), left);
        }
        if progress.0.elapsed() > PATIENCE {
            let next = viewer.next_command().map_or_else(String::new, |next| format!("`{next}`"));
            let problem = format!("`{next}` waits for something that will not arrive");
            return Err(Failed(problem).into());
        }
        thread::sleep(LOOK);
    }
    Ok(())
}

/// What would go to the clipboard goes to standard output: nobody could paste it.
fn print(texts: &[String]) -> io::Result<()> {
    for text in texts {
        match writeln!(io::stdout(), "{}", text.trim_end()) {
            // Whoever reads it, such as `head`, has read enough.
            Err(error) if error.kind() == io::ErrorKind::BrokenPipe => {}
            written => written?,
        }
    }
    Ok(())
}
