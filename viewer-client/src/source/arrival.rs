//! What comes from a daemon, taken in between frames.

use std::collections::VecDeque;
use std::time::{Duration, Instant};

use common::{FilterReply, Notice, TracerEvent, Welcome};

use super::connection::Arrival;
use super::model::Model;
use super::shown::Shown;
use super::{Origin, Source};
use crate::settings::Settings;

/// Batches that one frame takes in at most; the rest waits for the next.
const BATCHES_PER_FRAME: usize = 128;

/// A filter that the user's hand is changing is sent when the hand has rested so long.
pub const HAND: Duration = Duration::from_millis(120);

/// What a look into the inbox has found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Arrived {
    /// Something that changes the picture.
    pub news: bool,
    /// A session has begun.
    pub session: bool,
}

impl Source {
    /// Takes in what has come.
    pub fn receive(&mut self, settings: &mut Settings) -> Arrived {
        let before = self.shown.store.counts();
        let (mut news, mut arrivals) = (false, VecDeque::new());
        if let Origin::Daemon(daemon) = &self.origin {
            daemon.inbox().set_limit(settings.cloud.limit as usize);
            news = daemon.inbox().has_news();
            arrivals = daemon.inbox().take_arrivals();
        }
        self.status.listen(news, Instant::now());
        let remarks = self.status.steering.remark_count;
        let mut session = false;
        for arrival in arrivals {
            session |= matches!(arrival, Arrival::Said(TracerEvent::Welcome(_)));
            self.apply_arrival(arrival, settings);
        }
        self.show_remark(remarks);
        self.take_in_paths(settings);
        self.shown.store.measure(self.since.elapsed().as_secs_f64());
        news |= self.shown.store.counts() != before;
        Arrived { news, session }
    }

    fn take_in_paths(&mut self, settings: &Settings) {
        let Origin::Daemon(daemon) = &mut self.origin else { return };
        for _ in 0..BATCHES_PER_FRAME {
            let Some(batch) = daemon.next_batch(settings.cloud.threshold as usize) else { break };
            self.shown.take_in(&batch, settings.cloud.frozen);
        }
        if daemon.filter_is_due(HAND, settings.filter.whole()) {
            self.judge(settings);
            self.ask_for_paths(settings);
        }
    }

    fn apply_arrival(&mut self, arrival: Arrival, settings: &mut Settings) {
        match arrival {
            Arrival::Link(state) => self.status.link = state,
            Arrival::Scene(scene) => self.set_model(Model::new(scene.mesh), settings),
            Arrival::Latency(latency) => self.status.latency = Some(latency),
            Arrival::Said(event) => self.apply_event(event, settings),
        }
    }

    fn apply_event(&mut self, event: TracerEvent, settings: &mut Settings) {
        let steering = &mut self.status.steering;
        match event {
            TracerEvent::Welcome(welcome) => self.begin_session(*welcome, settings),
            TracerEvent::Statistics(statistics) => self.status.statistics(statistics),
            TracerEvent::FilterReply(reply) => self.accept_filter(reply, settings),
            TracerEvent::Notice(Notice::Detail(reply)) => self.accept_detail(*reply),
            TracerEvent::Notice(notice) => steering.accept(notice),
            TracerEvent::FocusPath(path) => steering.focus.set_path(path),
            TracerEvent::FocusStep(step) => steering.focus.add_step(step),
            TracerEvent::FocusGap(steps) => steering.focus.miss(steps),
            TracerEvent::Film(tile) => {
                if !self.shown.image.film.accept(&tile) {
                    tracing::warn!("an inconsistent tile of the image was dropped");
                }
            }
            TracerEvent::ExplorerFilm(tile) => {
                if !steering.film.accept(&tile) {
                    tracing::warn!("an inconsistent tile of the explorer's film was dropped");
                }
            }
            TracerEvent::Gap(gap) => self.shown.store.count_gap(gap.paths),
            TracerEvent::Paths(batch) => self.shown.take_in(&batch, settings.cloud.frozen),
            TracerEvent::SnapshotEnd | TracerEvent::Goodbye(_) | TracerEvent::Unknown => {}
        }
    }

    /// A session begins, perhaps on another scene.
    fn begin_session(&mut self, welcome: Welcome, settings: &mut Settings) {
        if welcome.scene_hash != self.shown.scene_hash {
            self.shown = Shown::new(welcome.scene_hash.clone(), &settings.cloud);
        }
        self.shown.rename_for_filters(Some(&welcome));
        self.status.welcome(welcome);
        if let Origin::Daemon(daemon) = &mut self.origin {
            daemon.begin_session();
        }
        self.agree_on_paths(settings);
    }

    /// Takes in the scene's surfaces.
    pub fn set_model(&mut self, model: Option<Model>, settings: &mut Settings) {
        self.shown.set_model(model, self.status.welcome.as_ref());
        self.agree_on_paths(settings);
    }

    /// Leaves out of the filter what cannot be asked of this scene, and tells a daemon that has just
    /// become known which paths are wanted.
    fn agree_on_paths(&mut self, settings: &mut Settings) {
        self.fit(settings);
        self.judge(settings);
        if matches!(&self.origin, Origin::Daemon(daemon) if daemon.must_hear(settings.filter.whole()))
        {
            self.ask_for_paths(settings);
        }
    }

    /// Shows the last remark of those who steer, where there was one since there were `before`.
    fn show_remark(&mut self, before: u64) {
        if self.status.steering.remark_count != before
            && let Some(remark) = self.status.steering.remark.clone()
        {
            self.status.say(remark);
        }
    }

    /// The daemon follows another filter from now on, or refuses it.
    fn accept_filter(&mut self, reply: FilterReply, settings: &Settings) {
        if let Origin::Daemon(daemon) = &mut self.origin {
            daemon.accept_filter(&reply);
        }
        if let Some(error) = &reply.error {
            self.status.say(Err(format!("The filter was rejected: {error}")));
        } else {
            // What came before was chosen by another filter, and comes again unless it is held.
            if !settings.cloud.frozen {
                self.shown.store.clear();
            }
        }
        self.status.filter = Some(reply);
    }
}
