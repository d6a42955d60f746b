//! All that panels may read.

use std::time::Instant;

use common::{Attendee, Diagnostics, FilterCounts, FilterScene};

use crate::camera::ViewCamera;
use crate::imaging::film::Film;
use crate::imaging::{FlipMap, Reference};
use crate::settings::Settings;
use crate::source::model::Model;
use crate::source::playback::Playback;
use crate::source::selection::{Names, Selection};
use crate::source::status::{LinkState, Status};
use crate::source::steering::Moment;
use crate::source::store::Store;

/// A view of the whole viewer, for the length of a frame.
#[derive(Clone, Copy, Debug)]
pub struct World<'a> {
    /// What the user has chosen.
    pub settings: &'a Settings,
    /// The user's eye.
    pub camera: &'a ViewCamera,
    /// The daemon and the way to it.
    pub status: &'a Status,
    /// The paths.
    pub store: &'a Store,
    /// The progressive image.
    pub film: &'a Film,
    /// What the image is compared with.
    pub reference: Option<&'a Reference>,
    /// How different it looks from that, where that was asked for.
    pub flip: Option<&'a FlipMap>,
    /// The path that is looked at.
    pub selection: Option<&'a Selection>,
    /// The step of the explorer that is shown, and its number where it is not the newest.
    pub moment: Option<&'a Moment>,
    /// See [`World::moment`].
    pub scrub: Option<u64>,
    /// Paths that have come and are not taken in yet.
    pub waiting: usize,
    /// HOST:PORT of daemons that were watched, the newest first.
    pub recent: &'a [String],
    /// There is a daemon inside this program.
    pub has_home: bool,
    /// The file of paths that is played, if one is.
    pub playback: Option<&'a Playback>,
    /// What the filter wants of it.
    pub counted: Option<&'a FilterCounts>,
    /// The scene, once it has come.
    pub model: Option<&'a Model>,
    /// What filters may ask for of it.
    pub filter_scene: &'a FilterScene,
    /// When the frame began.
    pub now: Instant,
}

impl World<'_> {
    /// How well the chains explore, as far as it is known.
    pub fn diagnostics(&self) -> Option<&Diagnostics> {
        self.status.statistics.as_ref()?.diagnostics.as_deref()
    }

    /// What the filter found: in the file that is played, or as the daemon counts.
    pub fn filter_counts(&self) -> Option<&FilterCounts> {
        self.counted.or_else(|| self.status.statistics.as_ref().map(|s| &s.filter))
    }

    /// True where there are chains that run, or will be once a daemon answers.
    pub fn has_chains(&self) -> bool {
        self.playback.is_none() && self.status.link != LinkState::Idle
    }

    /// The other viewers of the daemon.
    pub fn others(&self) -> impl Iterator<Item = &Attendee> {
        let own = self.status.welcome.as_ref().map(|welcome| welcome.session);
        let viewers = self.status.steering.presence.viewers.iter();
        viewers.filter(move |viewer| Some(viewer.author.session) != own)
    }

    /// What names and units the description of a path needs.
    pub fn names(&self) -> Names<'_> {
        let welcome = self.status.welcome.as_ref();
        Names {
            frame: welcome.map(|w| w.frame),
            strategies: welcome.map(|w| w.strategies.as_slice()).unwrap_or_default(),
            mesh: self.model.map(|model| &model.mesh),
        }
    }

    /// The name of a strategy; seeds have none.
    pub fn strategy_name(&self, index: usize) -> &str {
        let names = self.status.welcome.as_ref().map(|w| w.strategies.as_slice());
        names.and_then(|names| names.get(index)).map_or("unknown strategy", String::as_str)
    }

    /// The name of a reason why a proposal fails.
    pub fn failure_reason(&self, index: usize) -> &str {
        let names = self.status.welcome.as_ref().map(|w| w.failure_reasons.as_slice());
        names.and_then(|names| names.get(index)).map_or("unknown reason", String::as_str)
    }
}
