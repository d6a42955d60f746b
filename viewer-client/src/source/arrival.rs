//! What comes from a daemon, taken in between frames.

use std::collections::VecDeque;
use std::time::{Duration, Instant};

use common::{FilterReply, Notice, Welcome};

use super::connection::{Delivery, FocusNews};
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
    pub fn receive(&mut self, settings: &Settings) -> Arrived {
        let before = self.shown.store.counts();
        let delivery = match &self.origin {
            Origin::Daemon(daemon) => daemon.delivery(),
            Origin::Nothing | Origin::File(_) => Delivery::default(),
        };
        let mut news = !delivery.is_empty();
        self.status.listen(news, Instant::now());
        let session = delivery.welcome.is_some();
        self.accept(delivery, settings);
        if let Origin::Daemon(daemon) = &mut self.origin {
            let threshold = settings.cloud.threshold as usize;
            for _ in 0..BATCHES_PER_FRAME {
                let Some(batch) = daemon.next_batch(threshold) else { break };
                self.shown.take_in(&batch, settings.cloud.frozen);
            }
            if daemon.filter_is_due(HAND, &settings.filter.wanted()) {
                self.judge(settings);
                self.ask_for_paths(settings);
            }
        }
        self.shown.store.measure(self.since.elapsed().as_secs_f64());
        news |= self.shown.store.counts() != before;
        Arrived { news, session }
    }

    /// Takes in a delivery; public for harnesses without a network.
    pub fn accept(&mut self, delivery: Delivery, settings: &Settings) {
        if let Some(welcome) = delivery.welcome {
            self.begin_session(welcome, settings);
        }
        if let Some(scene) = delivery.scene {
            self.set_model(Model::new(scene.mesh), settings);
        }
        if let Some(statistics) = delivery.statistics {
            self.status.statistics(statistics);
        }
        for news in delivery.focus {
            let focus = &mut self.status.steering.focus;
            match news {
                FocusNews::Path(path) => focus.take_path(path),
                FocusNews::Step(step) => focus.take_step(step),
                FocusNews::Gap(steps) => focus.miss(steps),
            }
        }
        self.accept_notices(delivery.notices);
        if let Some(reply) = delivery.filter {
            self.accept_filter(reply, settings);
        }
        for tile in delivery.explorer_film.values() {
            if !self.status.steering.film.accept(tile) {
                tracing::warn!("a tile of the explorer's film contradicts itself and was left out");
            }
        }
        for tile in delivery.film.values() {
            if !self.shown.image.film.accept(tile) {
                tracing::warn!("a tile of the image contradicts itself and was left out");
            }
        }
        if delivery.gaps > 0 {
            self.shown.store.note_gap(delivery.gap.paths);
        }
        if let Origin::Daemon(daemon) = &mut self.origin {
            let gone = daemon.let_wait(delivery.batches, settings.cloud.limit as usize);
            if gone > 0 {
                self.shown.store.note_gap(gone as u64);
            }
        }
        self.status.latency = delivery.latency.or(self.status.latency);
        if let Some(state) = delivery.state {
            self.status.link = state;
        }
    }

    /// A session begins, perhaps on another scene.
    fn begin_session(&mut self, welcome: Welcome, settings: &Settings) {
        if welcome.scene_hash != self.shown.scene_hash {
            self.shown = Shown::new(welcome.scene_hash.clone(), &settings.cloud);
        }
        self.status.welcome(welcome);
        if let Origin::Daemon(daemon) = &mut self.origin {
            daemon.begin_session();
        }
        self.agree_on_paths(settings);
    }

    /// Takes in the scene's surfaces.
    pub fn set_model(&mut self, model: Option<Model>, settings: &Settings) {
        let welcome = self.status.welcome.as_ref();
        let of_mesh = model.as_ref().and_then(|m| m.mesh.camera);
        self.shown.set_model(model, welcome.map(|w| w.camera).or(of_mesh));
        self.judge(settings);
        self.agree_on_paths(settings);
    }

    /// Tells a daemon that has just become known which paths are wanted.
    fn agree_on_paths(&mut self, settings: &Settings) {
        let wanted = settings.filter.wanted();
        if matches!(&self.origin, Origin::Daemon(daemon) if daemon.must_hear(&wanted)) {
            self.ask_for_paths(settings);
        }
    }

    /// Takes in what the daemon tells of those who steer, and shows its last remark.
    fn accept_notices(&mut self, notices: VecDeque<Notice>) {
        let remarks = self.status.steering.remark_count;
        for notice in notices {
            match notice {
                Notice::Detail(reply) => self.accept_detail(*reply),
                notice => self.status.steering.accept(notice),
            }
        }
        if self.status.steering.remark_count != remarks
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
            self.status.say(Err(format!("The filter is refused: {error}")));
        } else {
            // What came before was chosen by another filter, and comes again unless it is held.
            if !settings.cloud.frozen {
                self.shown.store.clear();
            }
        }
        self.status.filter = Some(reply);
    }
}
