//! The paths that the viewer holds: whole records, in pages, within a byte budget.
//!
//! Paths are only ever appended; when the budget is spent, the oldest page goes. Nothing here knows
//! of the window or the graphics card: [`Page::points`] yields plain vertices.

mod classes;
mod page;
#[cfg(test)]
mod tests;
mod tone;

pub use classes::{Classes, class_name};
pub use page::{Drawn, PAGE_POINTS, Page, StoredPath};
pub use tone::Tone;

use std::collections::VecDeque;

use common::{CompiledFilter, PathBatch};

use crate::value::rates::RateMeter;

/// What came, and what did not.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Batches received.
    pub batches: u64,
    /// Paths received.
    pub paths: u64,
    /// Bytes of the batches received.
    pub bytes: u64,
    /// Paths that came while the cloud was frozen, and were not kept.
    pub skipped: u64,
    /// Paths that were lost on the way, because somebody was too slow.
    pub dropped: u64,
    /// How often paths were lost.
    pub gaps: u64,
}

/// All paths held.
#[derive(Debug)]
pub struct Store {
    pages: VecDeque<Page>,
    next_serial: u64,
    next_ordinal: u32,
    held: usize,
    budget: usize,
    counts: Counts,
    path_rate: RateMeter,
    byte_rate: RateMeter,
    tone: Tone,
    classes: Classes,
    drawn: Drawn,
    filter: Option<CompiledFilter>,
}

impl Store {
    /// An empty store that will use `budget` bytes at most, a page at least.
    pub fn new(budget: usize) -> Self {
        Self {
            pages: VecDeque::new(),
            next_serial: 0,
            next_ordinal: 0,
            held: 0,
            budget,
            counts: Counts::default(),
            path_rate: RateMeter::default(),
            byte_rate: RateMeter::default(),
            tone: Tone::default(),
            classes: Classes::default(),
            drawn: Drawn::default(),
            filter: None,
        }
    }

    /// Takes every path of a batch.
    pub fn append(&mut self, batch: &PathBatch) {
        self.count(batch);
        let mut reader = batch.reader();
        while let Some(path) = reader.next() {
            let full = |page: &Page| !page.has_room(path.vertices.len());
            if self.pages.back().is_none_or(full) {
                self.open_page();
            }
            let filter = self.filter.as_ref();
            let wanted = filter.is_none_or(|f| f.matches(&path.header, path.vertices));
            let Some(page) = self.pages.back_mut() else { return };
            let class = self.classes.number(path.vertices);
            page.push(&path, self.next_ordinal, class, wanted);
            self.tone.include(path.header.luminance);
            self.next_ordinal = self.next_ordinal.wrapping_add(1);
            self.held += 1;
        }
    }

    /// Counts a batch that is not kept because the cloud is frozen.
    pub fn skip(&mut self, batch: &PathBatch) {
        self.count(batch);
        self.counts.skipped += batch.len() as u64;
    }

    fn count(&mut self, batch: &PathBatch) {
        self.counts.batches += 1;
        self.counts.paths += batch.len() as u64;
        self.counts.bytes += batch.byte_len() as u64;
    }

    /// Remembers that `paths` paths never came.
    pub fn count_gap(&mut self, paths: u64) {
        self.counts.gaps += 1;
        self.counts.dropped += paths;
    }

    /// Forgets every path; the counts stay.
    pub fn clear(&mut self) {
        self.pages.clear();
        self.held = 0;
        self.tone = Tone::default();
        self.classes = Classes::default();
    }

    /// Changes the budget, and drops what no longer fits.
    pub fn set_budget(&mut self, bytes: usize) {
        self.budget = bytes;
        self.make_room(0);
    }

    fn open_page(&mut self) {
        self.make_room(Page::BYTES);
        self.pages.push_back(Page::new(self.next_serial));
        self.next_serial += 1;
    }

    /// Drops the oldest pages until `more` bytes fit.
    fn make_room(&mut self, more: usize) {
        while self.byte_len() + more > self.budget {
            let Some(page) = self.pages.pop_front() else { return };
            self.held -= page.paths().len();
        }
    }

    /// The pages, oldest first.
    pub fn pages(&self) -> impl DoubleEndedIterator<Item = &Page> {
        self.pages.iter()
    }

    /// Serial number of the oldest page held, or of the next one when there is none.
    pub fn first_serial(&self) -> u64 {
        self.pages.front().map_or(self.next_serial, Page::serial)
    }

    /// The page called `serial`.
    pub fn page(&self, serial: u64) -> Option<&Page> {
        let index = serial.checked_sub(self.first_serial())?;
        self.pages.get(usize::try_from(index).ok()?)
    }

    /// Paths held.
    pub fn len(&self) -> usize {
        self.held
    }

    /// True without paths.
    pub fn is_empty(&self) -> bool {
        self.held == 0
    }

    /// Bytes in use, with the copy on the graphics card.
    pub fn byte_len(&self) -> usize {
        self.pages.len() * Page::BYTES
    }

    /// Bytes that may be used.
    pub fn budget(&self) -> usize {
        self.budget
    }

    /// What came so far.
    pub fn counts(&self) -> Counts {
        self.counts
    }

    /// Notes what had come by `time` (seconds), for the rates.
    pub fn measure(&mut self, time: f64) {
        self.path_rate.record(time, self.counts.paths);
        self.byte_rate.record(time, self.counts.bytes);
    }

    /// Paths received a second.
    pub fn path_rate(&self) -> f64 {
        self.path_rate.per_second()
    }

    /// Bytes of paths received a second.
    pub fn byte_rate(&self) -> f64 {
        self.byte_rate.per_second()
    }

    /// The range of radiances that paths carry.
    pub fn tone(&self) -> Tone {
        self.tone
    }

    /// Ordinal of the newest path.
    pub fn newest_ordinal(&self) -> u32 {
        self.next_ordinal.wrapping_sub(1)
    }

    /// The classes of the paths, in the order in which they came.
    pub fn classes(&self) -> &Classes {
        &self.classes
    }

    /// Which paths are drawn.
    pub fn drawn(&self) -> Drawn {
        self.drawn
    }

    /// Changes which paths are drawn.
    pub fn set_drawn(&mut self, drawn: Drawn) {
        if self.drawn != drawn {
            self.drawn = drawn;
            self.pages.iter_mut().for_each(Page::outdate);
        }
    }

    /// The filter that paths are judged by.
    pub fn filter(&self) -> Option<&CompiledFilter> {
        self.filter.as_ref()
    }

    /// Judges all paths, and those to come, by another filter; without one, all match.
    pub fn set_filter(&mut self, filter: Option<CompiledFilter>) {
        self.filter = filter;
        for page in &mut self.pages {
            page.judge(self.filter.as_ref());
        }
    }

    /// Paths held that match the filter.
    pub fn matched(&self) -> usize {
        self.pages.iter().map(Page::matched).sum()
    }

    /// The newest `paths` paths that are drawn as (page, first point), newest page first: from the
    /// first point to the end of the page. Only the points that are drawn count.
    pub fn newest(&self, paths: usize) -> Vec<(u64, usize)> {
        let mut wanted = paths;
        let mut ranges = Vec::new();
        for page in self.pages.iter().rev() {
            if wanted == 0 {
                break;
            }
            let drawn = page.drawn(self.drawn);
            let skipped = drawn.saturating_sub(wanted);
            wanted -= drawn - skipped;
            let before = page.paths().iter().filter(|path| self.drawn.includes(path));
            let first = before.take(skipped).map(|path| usize::from(path.count)).sum();
            ranges.push((page.serial(), first));
        }
        ranges
    }
}
