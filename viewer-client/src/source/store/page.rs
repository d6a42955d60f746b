//! A page: as many whole paths as fit into a fixed number of vertices.

use common::{CompiledFilter, PathHeader, PathView, THROUGHPUT_UNKNOWN, VertexRecord};
use shaders::{LinePoint, encode_radiance, path_word, role, strategy_and_edges};

/// Vertices a page holds.
pub const PAGE_POINTS: usize = 16 * 1024;
/// Paths a page holds: as many as have four vertices each. Shorter ones are rare.
const PAGE_PATHS: usize = PAGE_POINTS / 4;

/// A path in a page.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StoredPath {
    /// All but the vertices.
    pub header: PathHeader,
    /// Index of its first vertex in the page.
    pub first: u32,
    /// Number of vertices.
    pub count: u8,
    /// Number of its class; see [`super::Classes`].
    pub class: u8,
    /// The filter lets it through.
    pub matched: bool,
    /// Number of the path since the viewer started, wrapping.
    pub ordinal: u32,
}

impl StoredPath {
    /// The range of its vertices in the page.
    pub fn range(&self) -> std::ops::Range<usize> {
        let first = self.first as usize;
        first..first + usize::from(self.count)
    }
}

/// Which paths of a page are drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Drawn {
    /// All; those that the filter leaves out are dimmed.
    #[default]
    All,
    /// Those that match the filter.
    Matched,
}

impl Drawn {
    /// True when the path is drawn.
    pub fn includes(self, path: &StoredPath) -> bool {
        self == Self::All || path.matched
    }
}

/// Whole paths in columns. It never reallocates, so that its size is known beforehand.
#[derive(Debug)]
pub struct Page {
    serial: u64,
    revision: u32,
    matched: usize,
    paths: Vec<StoredPath>,
    vertices: Vec<VertexRecord>,
    /// Codes of the throughputs at them.
    throughput: Vec<u8>,
}

impl Page {
    /// Bytes that a page uses at most, with its copy on the graphics card.
    pub const BYTES: usize = PAGE_POINTS * (size_of::<VertexRecord>() + 1 + size_of::<LinePoint>())
        + PAGE_PATHS * size_of::<StoredPath>();

    pub(super) fn new(serial: u64) -> Self {
        Self {
            serial,
            revision: 0,
            matched: 0,
            paths: Vec::with_capacity(PAGE_PATHS),
            vertices: Vec::with_capacity(PAGE_POINTS),
            throughput: Vec::with_capacity(PAGE_POINTS),
        }
    }

    /// Number of the page since the viewer started.
    pub fn serial(&self) -> u64 {
        self.serial
    }

    /// Grows when points that were handed out before are no longer right.
    pub fn revision(&self) -> u32 {
        self.revision
    }

    /// The paths, oldest first.
    pub fn paths(&self) -> &[StoredPath] {
        &self.paths
    }

    /// The vertices of all its paths, one path after the other.
    pub fn all_vertices(&self) -> &[VertexRecord] {
        &self.vertices
    }

    /// The vertices of one of its paths, from the light to the lens.
    pub fn vertices(&self, path: &StoredPath) -> &[VertexRecord] {
        self.vertices.get(path.range()).unwrap_or_default()
    }

    /// Paths that match the filter.
    pub fn matched(&self) -> usize {
        self.matched
    }

    /// Paths that are drawn.
    pub fn drawn(&self, drawn: Drawn) -> usize {
        if drawn == Drawn::All { self.paths.len() } else { self.matched }
    }

    pub(super) fn has_room(&self, vertices: usize) -> bool {
        self.vertices.len() + vertices <= PAGE_POINTS && self.paths.len() < PAGE_PATHS
    }

    pub(super) fn push(&mut self, path: &PathView<'_>, ordinal: u32, class: u8, matched: bool) {
        self.paths.push(StoredPath {
            header: path.header,
            first: self.vertices.len() as u32,
            count: path.vertices.len() as u8,
            class,
            matched,
            ordinal,
        });
        self.vertices.extend_from_slice(path.vertices);
        self.throughput.extend_from_slice(path.throughput);
        self.throughput.resize(self.vertices.len(), THROUGHPUT_UNKNOWN);
        self.matched += usize::from(matched);
    }

    /// Judges all paths by a filter; without one, all match.
    pub(super) fn judge(&mut self, filter: Option<&CompiledFilter>) {
        let mut changed = false;
        for path in &mut self.paths {
            let vertices = self.vertices.get(path.range()).unwrap_or_default();
            let wanted = filter.is_none_or(|filter| filter.matches(&path.header, vertices));
            changed |= wanted != path.matched;
            path.matched = wanted;
        }
        if changed {
            self.matched = self.paths.iter().filter(|path| path.matched).count();
            self.outdate();
        }
    }

    /// Points handed out before are no longer right.
    pub(super) fn outdate(&mut self) {
        self.revision = self.revision.wrapping_add(1);
    }

    /// The points to draw of every path from number `skip` on, in order.
    pub fn points(&self, skip: usize, drawn: Drawn) -> impl Iterator<Item = LinePoint> {
        let paths = self.paths.get(skip..).unwrap_or_default();
        paths.iter().filter(move |path| drawn.includes(path)).flat_map(|path| {
            let color = color_code(&path.header);
            let last = usize::from(path.count).saturating_sub(1);
            let dimmed = if path.matched { 0 } else { role::DIMMED };
            let group = (path.header.id.chain.0 % 16) as u8 | path.class << 4;
            let ordinal = path_word(path.ordinal, path.header.acceptance, path.header.dwell);
            let making = strategy_and_edges(path.header.strategy.0, last);
            let throughput = self.throughput.get(path.range()).unwrap_or_default();
            let vertices = self.vertices(path).iter().zip(throughput);
            vertices.enumerate().map(move |(i, (vertex, throughput))| {
                let start = if i == 0 { role::START } else { 0 };
                let end = if i == last { role::LAST } else { 0 };
                let kind = (vertex.kind as u8) << role::KIND_SHIFT;
                let roles = start | end | dimmed | kind;
                let info = [roles, making, group, *throughput];
                LinePoint { position: vertex.position, color, ordinal, info }
            })
        })
    }
}

/// The hue as square roots of the colour over its largest channel, and the radiance.
fn color_code(header: &PathHeader) -> [u8; 4] {
    let largest = header.rgb.iter().fold(0.0_f32, |m, c| m.max(*c));
    let scale = if largest > 0.0 { 1.0 / largest } else { 0.0 };
    let [r, g, b] = header.rgb.map(|c| ((c * scale).max(0.0).sqrt() * 255.0).round() as u8);
    [r, g, b, encode_radiance(header.luminance)]
}
