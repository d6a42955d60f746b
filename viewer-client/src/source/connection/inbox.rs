//! What has come from the daemon and has not been taken in yet: one queue, bounded, and never in the
//! way.
//!
//! The window may stand still for minutes while it is hidden. So the newest of everything is kept,
//! and of paths as many as fit; what is pushed out is counted.

use std::collections::VecDeque;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use common::{FilmTile, FocusPath, Gap, Notice, PathBatch, Statistics, TracerEvent};
use proto::ReceivedScene;

use super::backlog::Backlog;
use crate::source::status::LinkState;

/// Bytes of film tiles that may wait: a film of eight megapixels.
const FILM_BYTES: usize = 96 << 20;
/// Bytes of the explorer's steps that may wait.
const FOCUS_BYTES: usize = 8 << 20;
/// Notices that may wait.
const NOTICES: usize = 256;

/// Something that has come.
#[derive(Clone, Debug, PartialEq)]
pub enum Arrival {
    /// How the connection is now.
    Link(LinkState),
    /// What the tracer said, but for paths.
    Said(TracerEvent),
    /// The scene.
    Scene(Box<ReceivedScene>),
    /// How long the daemon took to answer a question, way and back.
    Latency(Duration),
}

impl Arrival {
    /// True for what is worth a picture of its own.
    fn is_news(&self) -> bool {
        !matches!(self, Self::Latency(_))
    }

    /// True where `old`, which nobody has looked at yet, is void now.
    fn makes_void(&self, old: &Self) -> bool {
        use TracerEvent as Event;
        match (self, old) {
            // How the connection is belongs to the connection, not to the session.
            (Self::Said(Event::Welcome(_)), old) => !matches!(old, Self::Link(_)),
            (Self::Link(_), Self::Link(_))
            | (Self::Scene(_), Self::Scene(_))
            | (Self::Latency(_), Self::Latency(_))
            | (Self::Said(Event::Statistics(_)), Self::Said(Event::Statistics(_)))
            | (Self::Said(Event::FilterReply(_)), Self::Said(Event::FilterReply(_))) => true,
            (Self::Said(Event::Film(new)), Self::Said(Event::Film(old)))
            | (Self::Said(Event::ExplorerFilm(new)), Self::Said(Event::ExplorerFilm(old))) => {
                let other_size = (new.width, new.height) != (old.width, old.height);
                other_size || new.first_row == old.first_row
            }
            (Self::Said(Event::Notice(new)), Self::Said(Event::Notice(old))) => new.makes_void(old),
            _ => false,
        }
    }

    fn notice(&self) -> Option<&Notice> {
        match self {
            Self::Said(TracerEvent::Notice(notice)) => Some(notice),
            _ => None,
        }
    }

    /// Bytes of a film's tile.
    fn film_bytes(&self) -> usize {
        let bytes = |tile: &FilmTile| size_of_val(tile.rgb.as_slice());
        match self {
            Self::Said(TracerEvent::Film(tile) | TracerEvent::ExplorerFilm(tile)) => bytes(tile),
            _ => 0,
        }
    }

    /// What the explorer did, if this reports it.
    fn focus(&self) -> Option<&TracerEvent> {
        match self {
            Self::Said(event) => match event {
                TracerEvent::FocusPath(_)
                | TracerEvent::FocusStep(_)
                | TracerEvent::FocusGap(_) => Some(event),
                _ => None,
            },
            Self::Link(_) | Self::Scene(_) | Self::Latency(_) => None,
        }
    }
}

/// Everything that waits.
#[derive(Debug, Default)]
struct Waiting {
    arrivals: VecDeque<Arrival>,
    /// Approximate size of the explorer's messages, in bytes.
    focus_bytes: usize,
    paths: Backlog,
    /// Paths have come since somebody looked last.
    has_new_paths: bool,
    /// The statistics of this session that came last.
    told: Option<Arc<Statistics>>,
}

impl Waiting {
    /// Puts in what is not paths. It makes room for itself among its like.
    fn push(&mut self, arrival: Arrival) {
        self.arrivals.retain(|old| !arrival.makes_void(old));
        if arrival.notice().is_some() {
            self.bound_notices();
        }
        if arrival.film_bytes() > 0 {
            let held: usize = self.arrivals.iter().map(Arrival::film_bytes).sum();
            if held + arrival.film_bytes() > FILM_BYTES {
                self.arrivals.retain(|old| old.film_bytes() == 0);
            }
        }
        if let Some(event) = arrival.focus() {
            if self.focus_bytes > FOCUS_BYTES {
                self.skip_focus();
            }
            self.focus_bytes += event.byte_len();
        }
        if matches!(arrival, Arrival::Said(TracerEvent::Welcome(_))) {
            (self.focus_bytes, self.told) = (0, None);
            self.paths.clear();
        }
        self.arrivals.push_back(arrival);
    }

    fn bound_notices(&mut self) {
        let notices = self.arrivals.iter().filter(|old| old.notice().is_some()).count();
        let oldest = self.arrivals.iter().position(|old| old.notice().is_some());
        if let Some(oldest) = oldest.filter(|_| notices >= NOTICES) {
            self.arrivals.remove(oldest);
        }
    }

    /// All that is told of the explorer makes room. The path after it is made of the last one that is
    /// known and what follows it; the steps to come need it.
    fn skip_focus(&mut self) {
        let focus = self.arrivals.iter().filter_map(Arrival::focus);
        let steps = focus.clone().map(TracerEvent::focus_steps).fold(0, u64::saturating_add);
        let path = focus.fold(None, |path: Option<FocusPath>, event| match event {
            TracerEvent::FocusPath(path) => Some(FocusPath::clone(path)),
            TracerEvent::FocusStep(step) => path?.after(step),
            _ => None,
        });
        self.arrivals.retain(|old| old.focus().is_none());
        let path = path.map(|path| TracerEvent::FocusPath(path.into()));
        self.focus_bytes = path.as_ref().map_or(0, TracerEvent::byte_len);
        let skipped = [Some(TracerEvent::FocusGap(steps)), path];
        self.arrivals.extend(skipped.into_iter().flatten().map(Arrival::Said));
    }

    /// Counts what never came, with what is counted already.
    fn lose(&mut self, gap: Gap) {
        let waiting = self.arrivals.iter_mut().find_map(|old| match old {
            Arrival::Said(TracerEvent::Gap(gap)) => Some(gap),
            _ => None,
        });
        match waiting {
            Some(waiting) => {
                waiting.batches = waiting.batches.saturating_add(gap.batches);
                waiting.paths = waiting.paths.saturating_add(gap.paths);
                waiting.bytes = waiting.bytes.saturating_add(gap.bytes);
            }
            None => self.arrivals.push_back(Arrival::Said(TracerEvent::Gap(gap))),
        }
    }

    /// True for statistics that say nothing new: a daemon whose chains rest says the same again and
    /// again.
    fn is_known(&self, new: &Statistics) -> bool {
        // Memory wavers by itself.
        self.told.as_ref().is_some_and(|old| {
            Statistics { memory_bytes: old.memory_bytes, ..new.clone() } == **old
        })
    }
}

/// The queue between the network's thread and the window's.
#[derive(Debug, Default)]
pub struct Inbox {
    waiting: Mutex<Waiting>,
}

impl Inbox {
    /// Puts in what the tracer said. False where that is nothing to show.
    pub fn put(&self, event: TracerEvent) -> bool {
        self.edit(|waiting| {
            match event {
                TracerEvent::SnapshotEnd | TracerEvent::Goodbye(_) | TracerEvent::Unknown => {
                    return false;
                }
                TracerEvent::Statistics(new) if waiting.is_known(&new) => return false,
                TracerEvent::Statistics(new) => {
                    waiting.told = Some(Arc::clone(&new));
                    waiting.push(Arrival::Said(TracerEvent::Statistics(new)));
                }
                TracerEvent::Paths(batch) => {
                    waiting.has_new_paths = true;
                    if let Some(lost) = waiting.paths.push(batch) {
                        waiting.lose(lost);
                    }
                }
                TracerEvent::Gap(gap) => waiting.lose(gap),
                event => waiting.push(Arrival::Said(event)),
            }
            true
        })
    }

    /// Puts in what did not come from the tracer's mouth.
    pub fn push(&self, arrival: Arrival) {
        self.edit(|waiting| match arrival {
            Arrival::Said(TracerEvent::Gap(gap)) => waiting.lose(gap),
            arrival => waiting.push(arrival),
        });
    }

    /// How many paths may wait; the oldest batches go, but never all.
    pub fn set_limit(&self, paths: usize) {
        self.edit(|waiting| {
            if let Some(lost) = waiting.paths.set_limit(paths) {
                waiting.lose(lost);
            }
        });
    }

    /// True when anything is in it that is worth a picture.
    pub fn has_news(&self) -> bool {
        self.edit(|waiting| waiting.has_new_paths || waiting.arrivals.iter().any(Arrival::is_news))
    }

    /// Takes out everything but the paths.
    pub fn take_arrivals(&self) -> VecDeque<Arrival> {
        self.edit(|waiting| {
            (waiting.focus_bytes, waiting.has_new_paths) = (0, false);
            std::mem::take(&mut waiting.arrivals)
        })
    }

    /// The oldest batch, once `threshold` paths have waited for it.
    pub fn next_batch(&self, threshold: usize) -> Option<Arc<PathBatch>> {
        self.edit(|waiting| waiting.paths.next(threshold))
    }

    /// True when paths wait that are to be taken in now.
    pub fn has_paths(&self, threshold: usize) -> bool {
        self.edit(|waiting| waiting.paths.is_due(threshold))
    }

    /// Paths that wait.
    pub fn paths(&self) -> usize {
        self.edit(|waiting| waiting.paths.len())
    }

    fn edit<T>(&self, edit: impl FnOnce(&mut Waiting) -> T) -> T {
        // A panic elsewhere leaves the box consistent: every edit is complete or has not begun.
        edit(&mut self.waiting.lock().unwrap_or_else(PoisonError::into_inner))
    }
}

#[cfg(test)]
mod tests {
    use common::{
        BatchBuilder, BatchLimits, Event, FocusStep, PathHeader, VertexKind, VertexRecord,
    };

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

    /// What is reported about losses.
    fn gap(arrivals: &VecDeque<Arrival>) -> Option<Gap> {
        arrivals.iter().find_map(|arrival| match arrival {
            Arrival::Said(TracerEvent::Gap(gap)) => Some(*gap),
            _ => None,
        })
    }

    #[test]
    fn the_oldest_batches_go_and_are_counted() {
        let inbox = Inbox::default();
        let large = batch(20_000);
        for sequence in 0..30 {
            inbox.put(TracerEvent::Paths(Arc::new(large.clone().with_sequence(sequence))));
        }
        let kept: Vec<_> = std::iter::from_fn(|| inbox.next_batch(0)).collect();
        let bytes: usize = kept.iter().map(|batch| batch.byte_len()).sum();
        assert!(bytes <= 16 << 20, "{bytes} bytes wait");
        assert_eq!(kept.last().map(|batch| batch.sequence()), Some(29), "the newest is kept");
        let lost = 30 - kept.len() as u64;
        let arrivals = inbox.take_arrivals();
        assert_eq!(gap(&arrivals).map(|gap| gap.batches), Some(lost), "losses");
        assert_eq!(gap(&arrivals).map(|gap| gap.paths), Some(lost * 20_000), "lost paths");
        assert!(inbox.take_arrivals().is_empty() && inbox.paths() == 0, "taken once");
    }

    #[test]
    fn only_the_newest_tile_of_a_row_waits() {
        let inbox = Inbox::default();
        for _ in 0..100 {
            inbox.put(TracerEvent::Film(tile(0, 32, 8)));
            inbox.put(TracerEvent::ExplorerFilm(tile(0, 32, 8)));
            inbox.put(TracerEvent::Film(tile(32, 32, 8)));
        }
        assert_eq!(inbox.take_arrivals().len(), 3, "two halves, and the explorer's");
        inbox.put(TracerEvent::Film(tile(0, 32, 8)));
        inbox.put(TracerEvent::Film(tile(32, 32, 16)));
        assert_eq!(inbox.take_arrivals().len(), 1, "a film of another size replaces the first");
    }

    #[test]
    fn what_was_said_before_is_no_news() {
        let inbox = Inbox::default();
        let said = |seconds: f64, memory_bytes| {
            let statistics =
                Statistics { elapsed_seconds: seconds, memory_bytes, ..Statistics::default() };
            inbox.put(TracerEvent::Statistics(Arc::new(statistics)))
        };
        assert_eq!([said(1.0, 5), said(1.0, 7), said(2.0, 7)], [true, false, true], "as they come");
        assert!(!inbox.put(TracerEvent::Unknown), "nothing that is known");
        let mut arrivals = inbox.take_arrivals();
        assert!(
            matches!(arrivals.make_contiguous(), [Arrival::Said(TracerEvent::Statistics(s))]
                if s.elapsed_seconds == 2.0),
            "the newest: {arrivals:?}"
        );
        assert!(!inbox.has_news(), "taken");
    }

    #[test]
    fn gaps_add_up() {
        let inbox = Inbox::default();
        let lost = Gap { batches: 1, paths: u64::MAX, bytes: 3 };
        inbox.put(TracerEvent::Gap(lost));
        inbox.put(TracerEvent::Gap(lost));
        let told = gap(&inbox.take_arrivals()).expect("a gap");
        assert_eq!(told.batches, 2, "two gaps");
        assert_eq!(told.paths, u64::MAX, "absurd counts do not overflow");
    }

    #[test]
    fn a_welcome_makes_everything_before_it_void() {
        let inbox = Inbox::default();
        inbox.push(Arrival::Link(LinkState::Connected));
        inbox.put(TracerEvent::Paths(Arc::new(batch(3))));
        inbox.put(TracerEvent::Film(tile(0, 32, 8)));
        inbox.put(TracerEvent::FocusGap(5));
        let welcome = Box::new(crate::synthetic::welcome());
        inbox.put(TracerEvent::Welcome(welcome.clone()));
        assert_eq!(inbox.paths(), 0, "paths are of another session");
        let expected =
            [Arrival::Link(LinkState::Connected), Arrival::Said(TracerEvent::Welcome(welcome))];
        assert_eq!(inbox.take_arrivals(), expected, "the connection is the same one");
    }

    #[test]
    fn steps_that_find_no_room_are_told_and_the_walk_goes_on() {
        let inbox = Inbox::default();
        let batch = batch(1);
        let vertices = batch.reader().next().expect("a path").vertices.to_vec();
        let path = FocusPath { vertices, next: 1, ..FocusPath::default() };
        inbox.put(TracerEvent::FocusPath(Arc::new(path.clone())));
        let mut expected = path;
        let mut pushed = 0;
        while pushed < 60_000 {
            pushed += 1;
            let step = FocusStep {
                number: expected.next,
                length: expected.vertices.len(),
                kept_light: 2,
                kept_eye: 2,
                ..FocusStep::default()
            };
            expected = expected.after(&step).expect("it follows");
            inbox.put(TracerEvent::FocusStep(Arc::new(step)));
        }
        let (mut told, mut bytes) = (0, 0);
        let mut path: Option<FocusPath> = None;
        for arrival in inbox.take_arrivals() {
            let Arrival::Said(event) = arrival else { continue };
            told += event.focus_steps();
            bytes += event.byte_len();
            path = match event {
                TracerEvent::FocusPath(path) => Some(FocusPath::clone(&path)),
                TracerEvent::FocusStep(step) => path.and_then(|path| path.after(&step)),
                _ => None,
            };
        }
        assert!(bytes <= FOCUS_BYTES + 4096, "{bytes} bytes wait");
        assert_eq!(told, pushed, "every step is told of, or told as missing");
        assert_eq!(path, Some(expected), "and the walk is where it is");
    }
}
