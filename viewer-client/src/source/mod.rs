//! What is looked at: a daemon's session, a file of paths or nothing, and all that came of it.
//!
//! Everything that belongs to it lies in one [`Source`], which is replaced whole when the user goes
//! elsewhere. Within it, what came of a scene lies in one [`Shown`], which is replaced when a daemon
//! comes back with another scene, and what came of a session in one [`status::Status`], which every
//! session begins anew.

mod arrival;
pub mod connection;
mod daemon;
mod detail;
pub mod dump;
pub mod embedded;
pub mod file;
mod filtering;
pub mod model;
pub mod playback;
mod script;
pub mod selection;
mod shown;
pub mod status;
pub mod steering;
pub mod store;
pub mod units;

pub use arrival::{Arrived, HAND};
pub use daemon::Daemon;
pub use shown::{Shown, filter_scene};

use std::time::Instant;

use crate::command::Command;
use crate::settings::{CloudSettings, Settings};
use crate::source::connection::Link;
use crate::source::playback::Playback;
use crate::source::selection::Names;
use crate::source::status::{LinkState, Status};
use crate::value::{ColorMode, Exposure};

/// Where what is looked at comes from.
#[derive(Debug)]
pub enum Origin {
    /// From nowhere.
    Nothing,
    /// From a daemon.
    Daemon(Box<Daemon>),
    /// From a file of paths.
    File(Box<Playback>),
}

/// What is looked at, and all that came of it.
#[derive(Debug)]
pub struct Source {
    /// Where it comes from.
    pub origin: Origin,
    /// What is known of the daemon, and of the way to it.
    pub status: Status,
    /// What came of the scene.
    pub shown: Shown,
    /// Commands that wait for something to come.
    pub script: Vec<Command>,
    /// When the user came here.
    since: Instant,
}

impl Source {
    /// Nothing to look at.
    pub fn nothing() -> Self {
        let mut status = Status::new(String::new(), false);
        status.link = LinkState::Idle;
        Self::of(Origin::Nothing, status)
    }

    /// The daemon at `address`, HOST:PORT, which may be embedded in this program; nothing has come.
    pub fn daemon(address: String, embedded: bool) -> Self {
        Self::of(Origin::Daemon(Box::default()), Status::new(address, embedded))
    }

    fn of(origin: Origin, status: Status) -> Self {
        let shown = Shown::new(String::new(), &CloudSettings::default());
        Self { origin, status, shown, script: Vec::new(), since: Instant::now() }
    }

    /// With the connection through which it comes.
    #[must_use]
    pub fn through(mut self, link: Link) -> Self {
        self.attach(link);
        self
    }

    /// Takes over the connection through which it comes.
    pub fn attach(&mut self, link: Link) {
        if let Origin::Daemon(daemon) = &mut self.origin {
            daemon.attach(link);
        }
    }

    /// Follows what the user has chosen already.
    pub fn adopt(&mut self, settings: &mut Settings) {
        self.shown.configure(&settings.cloud);
        self.fit(settings);
        self.judge(settings);
    }

    /// The daemon that is watched.
    pub fn as_daemon(&self) -> Option<&Daemon> {
        match &self.origin {
            Origin::Daemon(daemon) => Some(daemon),
            Origin::Nothing | Origin::File(_) => None,
        }
    }

    /// The file of paths that is played.
    pub fn playback(&self) -> Option<&Playback> {
        match &self.origin {
            Origin::File(playback) => Some(playback),
            Origin::Nothing | Origin::Daemon(_) => None,
        }
    }

    /// The settings as they are seen here: what comes decides what the user leaves open, and what does
    /// not come cannot be shown.
    pub fn suited(&self, settings: &Settings) -> Settings {
        let mut seen = settings.clone();
        if !seen.image.exposure.is_chosen() {
            seen.image.exposure = Exposure::Auto(0.0);
        }
        if let Some(statistics) = &self.status.statistics {
            seen.image.suit(statistics.normalization);
        }
        let needs_light = matches!(
            seen.cloud.color,
            ColorMode::Radiance | ColorMode::Luminance | ColorMode::Throughput
        );
        if needs_light && self.playback().is_some() {
            // A file tells no radiance.
            seen.cloud.color = ColorMode::Class;
        }
        seen
    }

    /// What names and units the description of a path needs.
    pub fn names(&self) -> Names<'_> {
        let welcome = self.status.welcome.as_ref();
        Names {
            frame: welcome.map(|w| w.frame),
            strategies: welcome.map(|w| w.strategies.as_slice()).unwrap_or_default(),
            mesh: self.shown.model.as_ref().map(|model| &model.mesh),
        }
    }

    /// True when the picture moves by itself, and the next frame should not wait.
    pub fn is_moving(&self, settings: &Settings) -> bool {
        match &self.origin {
            Origin::Nothing => false,
            Origin::Daemon(daemon) => daemon.inbox().has_paths(settings.cloud.threshold as usize),
            Origin::File(playback) => playback.is_playing(),
        }
    }
}
