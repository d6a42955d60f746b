//! Pages of paths, where whoever draws them reads them.

use std::collections::BTreeMap;

use shaders::LinePoint;

const STRIDE: u64 = size_of::<LinePoint>() as u64;

/// Which points of a page to draw: from `first` to the last one uploaded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PageRange {
    /// The page.
    pub serial: u64,
    /// Its first point to be drawn, which begins a path.
    pub first: usize,
}

/// How much of a page is there.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Uploaded {
    /// Revision of the page that the points are of.
    pub revision: u32,
    /// Paths of the page that were taken in, drawn or not.
    pub paths: usize,
}

/// Who draws paths.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Draws {
    /// The graphics card.
    Card,
    /// The processor.
    Processor,
}

/// Where the points of a page are.
#[derive(Debug)]
enum Storage {
    Card(wgpu::Buffer),
    Processor(Vec<LinePoint>),
}

#[derive(Debug)]
struct Page {
    storage: Storage,
    points: usize,
    uploaded: Uploaded,
}

/// All pages of paths.
#[derive(Debug)]
pub(super) struct Pages {
    draws: Draws,
    held: BTreeMap<u64, Page>,
    /// Storage of pages that are gone, for the next ones.
    spare: Vec<Storage>,
    page_points: usize,
}

impl Pages {
    /// Pages of `page_points` points each.
    pub(super) fn new(draws: Draws, page_points: usize) -> Self {
        Self { draws, held: BTreeMap::new(), spare: Vec::new(), page_points }
    }

    /// What of a page is here already.
    pub(super) fn uploaded(&self, serial: u64) -> Option<Uploaded> {
        self.held.get(&serial).map(|page| page.uploaded)
    }

    /// Appends points to a page, or replaces all of them when the page has another revision; what
    /// does not fit is left out.
    pub(super) fn append(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        serial: u64,
        uploaded: Uploaded,
        points: &[LinePoint],
    ) {
        let (draws, page_points) = (self.draws, self.page_points);
        let spare = &mut self.spare;
        let page = self.held.entry(serial).or_insert_with(|| {
            let storage = spare.pop().unwrap_or_else(|| Storage::new(device, draws, page_points));
            Page { storage, points: 0, uploaded }
        });
        if page.uploaded.revision != uploaded.revision {
            page.points = 0;
        }
        page.uploaded = uploaded;
        let left = page_points - page.points;
        let points = points.get(..left).unwrap_or(points);
        page.storage.write(queue, page.points, points);
        page.points += points.len();
    }

    /// Gives up every page older than `first`, and all of them when there is no page any more.
    pub(super) fn retain_from(&mut self, first: u64) {
        let kept = self.held.split_off(&first);
        let gone = std::mem::replace(&mut self.held, kept);
        self.spare.extend(gone.into_values().map(|page| page.storage));
        // A cleared store would otherwise keep its memory for ever.
        self.spare.truncate(self.held.len().max(1));
    }

    /// Bytes that all pages take.
    pub(super) fn byte_len(&self) -> u64 {
        let rooms = (self.held.len() + self.spare.len()) as u64;
        rooms * (self.page_points as u64 + 1) * STRIDE
    }

    /// Points that a range holds.
    pub(super) fn points_of(&self, range: PageRange) -> usize {
        self.held.get(&range.serial).map_or(0, |page| page.points.saturating_sub(range.first))
    }

    /// The buffer of a page that the graphics card draws, and its number of points.
    pub(super) fn on_card(&self, serial: u64) -> Option<(&wgpu::Buffer, usize)> {
        let page = self.held.get(&serial)?;
        match &page.storage {
            Storage::Card(buffer) => Some((buffer, page.points)),
            Storage::Processor(_) => None,
        }
    }

    /// The points of a range that the processor draws.
    pub(super) fn in_memory(&self, range: PageRange) -> Option<&[LinePoint]> {
        let page = self.held.get(&range.serial)?;
        match &page.storage {
            Storage::Card(_) => None,
            Storage::Processor(points) => points.get(range.first..page.points),
        }
    }
}

impl Storage {
    fn new(device: &wgpu::Device, draws: Draws, page_points: usize) -> Self {
        match draws {
            Draws::Card => Self::Card(device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("path page"),
                // One more, because the buffer is also read one point further on.
                size: (page_points as u64 + 1) * STRIDE,
                usage: wgpu::BufferUsages::VERTEX | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            })),
            Draws::Processor => Self::Processor(Vec::with_capacity(page_points)),
        }
    }

    /// Writes points from number `at` on, which is the end of those that are still meant.
    fn write(&mut self, queue: &wgpu::Queue, at: usize, points: &[LinePoint]) {
        match self {
            Self::Card(buffer) => {
                queue.write_buffer(buffer, at as u64 * STRIDE, bytemuck::cast_slice(points));
            }
            Self::Processor(storage) => {
                storage.truncate(at);
                storage.extend_from_slice(points);
            }
        }
    }
}
