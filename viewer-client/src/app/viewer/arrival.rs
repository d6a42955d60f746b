//! What comes from the daemon, taken in between frames.

use std::collections::VecDeque;
use std::time::{Duration, Instant};

use common::{Appearance, FilterReply, FocusPath, Notice, Welcome};

use super::{Stale, Viewer};
use crate::source::connection::{Delivery, FocusNews, Link};
use crate::source::model::Model;

/// Batches that one frame takes in at most; the rest waits for the next.
const BATCHES_PER_FRAME: usize = 128;

/// A filter that the user's hand is changing is sent when the hand has rested so long.
pub(super) const HAND: Duration = Duration::from_millis(120);

impl Viewer {
    /// Takes in what has come. True when there was anything.
    pub fn receive(&mut self) -> bool {
        let before = self.store.counts();
        let delivery = self.link.as_ref().map(Link::take).unwrap_or_default();
        let mut news = !delivery.is_empty();
        self.status.listen(news, Instant::now());
        self.take(delivery);
        news |= self.darkroom.collect(&mut self.settings.image, &mut self.status);
        let time = self.started.elapsed().as_secs_f64();
        for _ in 0..BATCHES_PER_FRAME {
            if !self.waiting.is_due(self.settings.cloud.threshold as usize) {
                break;
            }
            let Some(batch) = self.waiting.pop() else { break };
            if batch.origin().revision < self.filter_in_force {
                continue;
            }
            if self.settings.cloud.frozen {
                self.store.skip(&batch);
            } else {
                self.store.append(&batch);
            }
        }
        self.appear();
        if self.filter_changed.is_some_and(|at| at.elapsed() >= HAND) {
            self.filter_changed = None;
            if *self.settings.filter.whole() != self.asked_for {
                self.ask_for_paths();
            }
        }
        let counts = self.store.counts();
        self.status.path_rate.note(time, counts.paths);
        self.status.byte_rate.note(time, counts.bytes);
        news |= counts != before;
        if counts != before && !self.script.is_empty() {
            self.go_on();
        }
        news
    }

    /// Takes in a delivery; public for harnesses without a network.
    pub fn take(&mut self, delivery: Delivery) {
        if let Some(welcome) = delivery.welcome {
            self.take_welcome(welcome);
        }
        if let Some(scene) = delivery.scene {
            self.set_model(Model::new(scene.mesh));
        }
        if let Some(statistics) = delivery.statistics {
            self.settings.image.suit(statistics.normalization);
            self.status.statistics(statistics);
        }
        for news in delivery.focus {
            match news {
                FocusNews::Path(path) => self.take_focus(path),
                FocusNews::Step(step) => self.status.steering.focus.take_step(step),
                FocusNews::Gap(steps) => self.status.steering.focus.miss(steps),
            }
        }
        self.take_notices(delivery.notices);
        if let Some(reply) = delivery.filter {
            self.take_filter(reply);
        }
        for tile in delivery.explorer_film.values() {
            if !self.status.steering.film.accept(tile) {
                tracing::warn!("a tile of the explorer's film contradicts itself and was left out");
            }
        }
        for tile in delivery.film.values() {
            if !self.darkroom.film.accept(tile) {
                tracing::warn!("a tile of the image contradicts itself and was left out");
            }
        }
        if !delivery.film.is_empty() && !self.script.is_empty() {
            self.go_on();
        }
        if delivery.gaps > 0 {
            self.store.note_gap(delivery.gap.paths);
        }
        let gone = self.waiting.extend(delivery.batches, self.settings.cloud.limit as usize);
        if gone > 0 {
            self.store.note_gap(gone as u64);
        }
        self.status.latency = delivery.latency.or(self.status.latency);
        if let Some(state) = delivery.state {
            self.status.link = state;
        }
    }

    /// The explorer stands at a path: with another walk, the timeline is back at its end.
    fn take_focus(&mut self, path: FocusPath) {
        let focus = &mut self.status.steering.focus;
        focus.take_path(path);
        if focus.moments().is_empty() {
            self.scrub = None;
        }
    }

    /// A session begins, perhaps on another scene.
    fn take_welcome(&mut self, welcome: Welcome) {
        if welcome.scene_hash != self.scene_hash {
            self.forget_scene();
            self.scene_hash.clone_from(&welcome.scene_hash);
        }
        self.waiting.clear();
        if !self.status.embedded {
            self.desk.habits.note(&self.status.address);
        }
        self.appearance.0 = Appearance::default();
        self.status.welcome(welcome);
    }

    /// Takes in what the daemon tells of those who steer, and shows its last remark.
    fn take_notices(&mut self, notices: VecDeque<Notice>) {
        let remarks = self.status.steering.remark_count;
        for notice in notices {
            match notice {
                Notice::Detail(reply) => self.learn(*reply),
                notice => self.status.steering.take(notice),
            }
        }
        if self.status.steering.remark_count != remarks
            && let Some(remark) = self.status.steering.remark.clone()
        {
            self.status.say(remark);
        }
    }

    /// The daemon follows another filter from now on, or refuses it.
    fn take_filter(&mut self, reply: FilterReply) {
        if let Some(error) = &reply.error {
            self.status.say(Err(format!("The filter is refused: {error}")));
        } else {
            self.filter_in_force = reply.revision;
            // What came before was chosen by another filter, and comes again unless it is held.
            if !self.settings.cloud.frozen {
                self.store.clear();
            }
        }
        self.status.filter = Some(reply);
    }

    /// Leaves a scene, with everything that came of it.
    pub(super) fn forget_scene(&mut self) {
        self.scene_hash.clear();
        self.store.clear();
        self.darkroom.film.clear();
        self.model = None;
        self.selection = None;
        self.stale = Stale { surfaces: true, aids: true };
    }

    pub(super) fn set_model(&mut self, model: Option<Model>) {
        self.stale = Stale { surfaces: true, aids: true };
        let welcome = self.status.welcome.as_ref();
        let of_mesh = model.as_ref().and_then(|m| m.mesh.camera);
        let camera = welcome.map(|w| w.camera).or(of_mesh);
        if let Some(model) = &model {
            self.camera.set_scene(model.bounds, camera);
        }
        self.model = model;
        self.judge();
        self.go_on();
    }
}
