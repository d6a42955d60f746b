//! The task between producers and viewers.

use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::time::Duration;

use common::{FilmFrame, Gap, Notice, PathBatch};
use tokio::sync::mpsc;
use tokio::time::{MissedTickBehavior, interval};
use tokio_util::sync::CancellationToken;

use super::{FocusNews, News, NumberedFilm, Shared, film_bytes};

/// Statistics go to every viewer this often.
const STATISTICS_PERIOD: Duration = Duration::from_millis(500);

/// Empties the producers' queues into the viewers' lanes.
#[derive(Debug)]
pub struct Pump {
    shared: Arc<Shared>,
    paths: mpsc::Receiver<PathBatch>,
    news: mpsc::Receiver<News>,
    focus: mpsc::Receiver<FocusNews>,
    path_sequence: u64,
    film_sequence: u64,
}

impl Pump {
    pub(super) fn new(
        shared: Arc<Shared>,
        paths: mpsc::Receiver<PathBatch>,
        news: mpsc::Receiver<News>,
        focus: mpsc::Receiver<FocusNews>,
    ) -> Self {
        Self { shared, paths, news, focus, path_sequence: 0, film_sequence: 0 }
    }

    /// Runs until `shutdown`, or until every handle of the hub is gone.
    pub async fn run(mut self, shutdown: CancellationToken) {
        let mut tick = interval(STATISTICS_PERIOD);
        tick.set_missed_tick_behavior(MissedTickBehavior::Delay);
        loop {
            tokio::select! {
                biased;
                () = shutdown.cancelled() => break,
                _ = tick.tick() => self.tick(),
                Some(news) = self.news.recv() => self.accept(news),
                Some(news) = self.focus.recv() => self.forward_focus(&news),
                Some(batch) = self.paths.recv() => self.distribute(batch),
                else => break,
            }
        }
    }

    fn tick(&mut self) {
        self.report_lost();
        let registry = self.shared.registry();
        for lane in &registry.lanes {
            lane.tick(registry.statistics.as_ref());
        }
    }

    fn accept(&mut self, news: News) {
        if let News::Film(frame) | News::ExplorerFilm(frame) = &news {
            self.shared.waiting_film_bytes.fetch_sub(film_bytes(frame), Ordering::Relaxed);
        }
        match news {
            News::Statistics(statistics) => {
                self.shared.registry().statistics = Some(statistics);
            }
            News::Film(frame) | News::ExplorerFilm(frame) if frame.pixels.is_empty() => {}
            News::Film(frame) => {
                let film = self.number(frame);
                let mut registry = self.shared.registry();
                for lane in &registry.lanes {
                    lane.push_film(film.clone());
                }
                registry.film = Some(film);
            }
            News::ExplorerFilm(frame) => {
                let film = self.number(frame);
                let mut registry = self.shared.registry();
                for lane in &registry.lanes {
                    lane.push_explorer_film(film.clone());
                }
                registry.explorer_film = Some(film);
            }
            News::Chains(state) => {
                let mut registry = self.shared.registry();
                for lane in &registry.lanes {
                    lane.push_notice(Notice::Chains(state.clone()));
                }
                registry.chains = Some(state);
            }
            News::Reply(session, reply) => {
                if let Some(lane) = self.shared.registry().lane(session) {
                    lane.push_notice(Notice::Reply(reply));
                }
            }
        }
    }

    fn number(&mut self, frame: Arc<FilmFrame>) -> NumberedFilm {
        self.film_sequence += 1;
        NumberedFilm { sequence: self.film_sequence, frame }
    }

    fn forward_focus(&self, news: &FocusNews) {
        self.shared.waiting_focus_bytes.fetch_sub(news.byte_len(), Ordering::Relaxed);
        let mut registry = self.shared.registry();
        for lane in &registry.lanes {
            lane.push_focus(news);
        }
        registry.focus = Some(Arc::clone(&news.after));
    }

    fn distribute(&mut self, batch: PathBatch) {
        self.shared.waiting_bytes.fetch_sub(batch.byte_len(), Ordering::Relaxed);
        self.report_lost();
        let batch = Arc::new(batch.into_source().with_sequence(self.path_sequence));
        self.path_sequence += 1;
        for lane in &self.shared.registry().lanes {
            lane.push_paths(Arc::clone(&batch));
        }
    }

    /// Tells every viewer what never reached the pump. The sequence numbers skip it.
    fn report_lost(&mut self) {
        let lost = self.shared.lost.drain();
        if lost == Gap::default() {
            return;
        }
        self.path_sequence += lost.batches;
        for lane in &self.shared.registry().lanes {
            lane.push_lost(lost);
        }
    }
}
