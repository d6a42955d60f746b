//! What has come from the daemon and has not been looked at yet: bounded, and never in the way.
//!
//! The window may stand still for minutes while it is hidden. So the newest of everything is kept,
//! and of paths as many as fit; what is pushed out is counted.

use std::collections::{BTreeMap, VecDeque};
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

use common::{
    FilmTile, FilterReply, FocusPath, FocusStep, Gap, Notice, PathBatch, Statistics, Welcome,
};
use proto::{ReceivedScene, TracerEvent};

use crate::source::status::LinkState;

/// Bytes of batches that may wait.
const BATCH_BYTES: usize = 16 << 20;
/// Bytes of film tiles that may wait: a film of eight megapixels.
const FILM_BYTES: usize = 96 << 20;

/// Bytes of the explorer's steps that may wait.
const FOCUS_BYTES: usize = 8 << 20;
/// Notices that may wait.
const NOTICES: usize = 256;

/// What comes in the focus lane, in its order.
#[derive(Clone, Debug, PartialEq)]
pub enum FocusNews {
    /// The explorer's current path.
    Path(FocusPath),
    /// A step.
    Step(FocusStep),
    /// So many steps are missing here.
    Gap(u64),
}

/// Everything that waits.
#[derive(Debug, Default)]
pub struct Delivery {
    /// How the connection is now, if that changed.
    pub state: Option<LinkState>,
    /// The welcome of the newest session; it makes everything before it void.
    pub welcome: Option<Welcome>,
    /// The scene, if it came.
    pub scene: Option<ReceivedScene>,
    /// The newest statistics.
    pub statistics: Option<Statistics>,
    /// Paths in the order in which they came.
    pub batches: VecDeque<PathBatch>,
    /// The newest tile for each first row.
    pub film: BTreeMap<u32, FilmTile>,
    /// What was lost on the way, here or at the daemon.
    pub gap: Gap,
    /// How often something was lost.
    pub gaps: u64,
    /// The explorer's steps.
    pub focus: VecDeque<FocusNews>,
    /// Bytes that `focus` takes, about.
    pub focus_bytes: usize,
    /// The newest rows of the explorer's film for each first row.
    pub explorer_film: BTreeMap<u32, FilmTile>,
    /// Who steers, and what.
    pub notices: VecDeque<Notice>,
    /// The answer to the newest filter.
    pub filter: Option<FilterReply>,
    /// How long the daemon took to answer a question last, way and back.
    pub latency: Option<Duration>,
}

impl Delivery {
    /// True when nothing was delivered that is worth a picture of its own.
    pub fn is_empty(&self) -> bool {
        let quiet = self.state.is_none() && self.welcome.is_none() && self.scene.is_none();
        quiet
            && self.statistics.is_none()
            && self.batches.is_empty()
            && self.film.is_empty()
            && self.gaps == 0
            && self.focus.is_empty()
            && self.explorer_film.is_empty()
            && self.notices.is_empty()
            && self.filter.is_none()
    }

    fn push(&mut self, event: TracerEvent) {
        match event {
            TracerEvent::Welcome(welcome) => {
                // The state belongs to the connection, not to the session.
                let state = self.state.take();
                *self = Self { state, welcome: Some(welcome), ..Self::default() };
            }
            TracerEvent::Paths(batch) => self.push_batch(batch),
            TracerEvent::Film(tile) => push_tile(&mut self.film, tile),
            TracerEvent::ExplorerFilm(tile) => push_tile(&mut self.explorer_film, tile),
            TracerEvent::Statistics(statistics) => self.statistics = Some(statistics),
            TracerEvent::Gap(gap) => self.lose(gap),
            TracerEvent::FilterReply(reply) => self.filter = Some(reply),
            TracerEvent::FocusPath(path) => self.push_focus(FocusNews::Path(path)),
            TracerEvent::FocusStep(step) => self.push_focus(FocusNews::Step(step)),
            TracerEvent::FocusGap(steps) => self.push_focus(FocusNews::Gap(steps)),
            TracerEvent::Notice(notice) => self.push_notice(notice),
            TracerEvent::SnapshotEnd | TracerEvent::Goodbye(_) | TracerEvent::Unknown => {}
        }
    }

    fn push_batch(&mut self, batch: PathBatch) {
        self.batches.push_back(batch);
        let mut bytes: usize = self.batches.iter().map(PathBatch::byte_len).sum();
        while bytes > BATCH_BYTES && self.batches.len() > 1 {
            let Some(oldest) = self.batches.pop_front() else { return };
            bytes -= oldest.byte_len();
            self.lose(Gap {
                batches: 1,
                paths: oldest.len() as u64,
                bytes: oldest.byte_len() as u64,
            });
        }
    }

    /// Puts in a step. Where too many wait, all of them make room, and the next path begins anew.
    fn push_focus(&mut self, news: FocusNews) {
        if self.focus_bytes > FOCUS_BYTES {
            let lost = |news: &FocusNews| match news {
                FocusNews::Path(_) => 0,
                FocusNews::Step(_) => 1,
                FocusNews::Gap(steps) => *steps,
            };
            let steps = self.focus.iter().map(lost).fold(0, u64::saturating_add);
            // The path after the lost steps is made of the last one that is known and what follows
            // it; the steps after a gap need it.
            let path = replay(&self.focus);
            self.focus = VecDeque::from([FocusNews::Gap(steps)]);
            self.focus.extend(path.map(FocusNews::Path));
            self.focus_bytes = self.focus.iter().map(size).sum();
        }
        self.focus_bytes += size(&news);
        self.focus.push_back(news);
    }

    /// Puts in a notice. A state replaces the one before it that nobody has looked at.
    fn push_notice(&mut self, notice: Notice) {
        self.notices.retain(|old| !notice.makes_void(old));
        if self.notices.len() >= NOTICES {
            self.notices.pop_front();
        }
        self.notices.push_back(notice);
    }

    fn lose(&mut self, gap: Gap) {
        self.gaps += 1;
        self.gap.batches = self.gap.batches.saturating_add(gap.batches);
        self.gap.paths = self.gap.paths.saturating_add(gap.paths);
        self.gap.bytes = self.gap.bytes.saturating_add(gap.bytes);
    }
}

/// The newest tile for each first row.
fn push_tile(film: &mut BTreeMap<u32, FilmTile>, tile: FilmTile) {
    let bytes = |tile: &FilmTile| tile.rgb.len() * size_of::<f32>();
    let held: usize = film.values().map(bytes).sum();
    let other_size = |t: &FilmTile| (t.width, t.height) != (tile.width, tile.height);
    if held + bytes(&tile) > FILM_BYTES || film.values().any(other_size) {
        film.clear();
    }
    film.insert(tile.first_row, tile);
}

/// The explorer's current path at the end of its news; `None` where that is not known.
fn replay(news: &VecDeque<FocusNews>) -> Option<FocusPath> {
    news.iter().fold(None, |path: Option<FocusPath>, news| match news {
        FocusNews::Path(path) => Some(path.clone()),
        FocusNews::Step(step) => path?.after(step),
        FocusNews::Gap(_) => None,
    })
}

fn size(news: &FocusNews) -> usize {
    match news {
        FocusNews::Path(path) => path.byte_len(),
        FocusNews::Step(step) => step.byte_len(),
        FocusNews::Gap(_) => size_of::<FocusNews>(),
    }
}

/// The box between the network's thread and the window's.
#[derive(Debug, Default)]
pub struct Inbox {
    held: Mutex<Delivery>,
    /// The statistics of this session that came last.
    told: Mutex<Option<Statistics>>,
}

impl Inbox {
    /// Puts in what the tracer said. False where that is nothing to show: a daemon whose chains rest
    /// says the same again and again.
    pub fn push(&self, event: TracerEvent) -> bool {
        let mut told = self.told.lock().unwrap_or_else(PoisonError::into_inner);
        match &event {
            TracerEvent::SnapshotEnd | TracerEvent::Goodbye(_) | TracerEvent::Unknown => {
                return false;
            }
            TracerEvent::Welcome(_) => *told = None,
            TracerEvent::Statistics(new) => {
                // Memory wavers by itself.
                let same = |old: &Statistics| {
                    Statistics { memory_bytes: old.memory_bytes, ..new.clone() } == *old
                };
                if told.as_ref().is_some_and(same) {
                    return false;
                }
                *told = Some(new.clone());
            }
            _ => {}
        }
        drop(told);
        self.edit(|held| held.push(event));
        true
    }

    /// Puts in a scene.
    pub fn push_scene(&self, scene: ReceivedScene) {
        self.edit(|held| held.scene = Some(scene));
    }

    /// Puts in how long the daemon took to answer.
    pub fn push_latency(&self, latency: Duration) {
        self.edit(|held| held.latency = Some(latency));
    }

    /// Puts in how the connection is.
    pub fn push_state(&self, state: LinkState) {
        self.edit(|held| held.state = Some(state));
    }

    /// True when anything is in it.
    pub fn has_news(&self) -> bool {
        self.edit(|held| !held.is_empty())
    }

    /// Takes everything out.
    pub fn take(&self) -> Delivery {
        self.edit(std::mem::take)
    }

    fn edit<T>(&self, edit: impl FnOnce(&mut Delivery) -> T) -> T {
        // A panic elsewhere leaves the box consistent: every edit is complete or has not begun.
        edit(&mut self.held.lock().unwrap_or_else(PoisonError::into_inner))
    }
}

#[cfg(test)]
mod tests {
    use common::{BatchBuilder, BatchLimits, Event, PathHeader, VertexKind, VertexRecord};

    use super::*;

    fn batch(paths: usize) -> PathBatch {
        let vertex = VertexRecord {
            position: [0.0; 3],
            normal: [0; 2],
            kind: VertexKind::Diffuse,
            event: Event::Diffuse,
            material: 0,
            primitive: 0,
        };
        let mut builder = BatchBuilder::new(BatchLimits { bytes: usize::MAX });
        for _ in 0..paths {
            let full = builder.push(&PathHeader::default(), &[vertex; 4], None);
            assert!(full.is_none(), "the batch has no limit");
        }
        builder.finish().expect("a batch with paths")
    }

    fn tile(first_row: u32, rows: u32, width: u32) -> FilmTile {
        let rgb = vec![0.0; (3 * width * rows) as usize];
        FilmTile { sequence: 0, width, height: 64, first_row, steps: 0, rgb }
    }

    #[test]
    fn the_oldest_batches_go_and_are_counted() {
        let inbox = Inbox::default();
        let large = batch(20_000);
        for sequence in 0..30 {
            inbox.push(TracerEvent::Paths(large.clone().with_sequence(sequence)));
        }
        let delivery = inbox.take();
        let bytes: usize = delivery.batches.iter().map(PathBatch::byte_len).sum();
        assert!(bytes <= BATCH_BYTES, "{bytes} bytes wait");
        assert_eq!(
            delivery.batches.back().map(PathBatch::sequence),
            Some(29),
            "the newest is kept"
        );
        let kept = delivery.batches.len() as u64;
        assert_eq!((delivery.gap.batches, delivery.gaps), (30 - kept, 30 - kept), "losses");
        assert_eq!(delivery.gap.paths, (30 - kept) * 20_000, "lost paths");
        assert!(inbox.take().batches.is_empty(), "taken once");
    }

    #[test]
    fn only_the_newest_tile_of_a_row_waits() {
        let inbox = Inbox::default();
        for _ in 0..100 {
            inbox.push(TracerEvent::Film(tile(0, 32, 8)));
            inbox.push(TracerEvent::Film(tile(32, 32, 8)));
        }
        assert_eq!(inbox.take().film.len(), 2, "two halves");
        inbox.push(TracerEvent::Film(tile(0, 32, 8)));
        inbox.push(TracerEvent::Film(tile(32, 32, 16)));
        assert_eq!(inbox.take().film.len(), 1, "a film of another size replaces the first");
    }

    #[test]
    fn what_was_said_before_is_no_news() {
        let inbox = Inbox::default();
        let said = |seconds: f64, memory_bytes| {
            let statistics =
                Statistics { elapsed_seconds: seconds, memory_bytes, ..Statistics::default() };
            inbox.push(TracerEvent::Statistics(statistics))
        };
        assert_eq!([said(1.0, 5), said(1.0, 7), said(2.0, 7)], [true, false, true], "as they come");
        assert!(!inbox.push(TracerEvent::Unknown), "nothing that is known");
        assert_eq!(inbox.take().statistics.map(|s| s.elapsed_seconds), Some(2.0), "the newest");
        assert!(!inbox.has_news(), "taken");
    }

    #[test]
    fn gaps_add_up() {
        let inbox = Inbox::default();
        let gap = Gap { batches: 1, paths: u64::MAX, bytes: 3 };
        inbox.push(TracerEvent::Gap(gap));
        inbox.push(TracerEvent::Gap(gap));
        let delivery = inbox.take();
        assert_eq!((delivery.gaps, delivery.gap.batches), (2, 2), "two gaps");
        assert_eq!(delivery.gap.paths, u64::MAX, "absurd counts do not overflow");
    }
}
