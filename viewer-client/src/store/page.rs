//! A page: as many whole paths as fit into a fixed number of vertices.

use common::{PathHeader, PathView, VertexRecord};
use shaders::{LinePoint, encode_radiance, role};

/// Vertices a page holds.
pub const PAGE_POINTS: usize = 16 * 1024;
/// No path is shorter, so that a page holds this many times fewer paths than vertices.
const FEWEST_VERTICES: usize = 2;

/// A path in a page.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StoredPath {
    /// All but the vertices.
    pub header: PathHeader,
    /// Index of its first vertex in the page.
    pub first: u32,
    /// Number of vertices.
    pub count: u8,
    /// Number of the path since the viewer started, wrapping.
    pub ordinal: u32,
}

/// Whole paths in two columns. It never reallocates, so that its size is known beforehand.
#[derive(Debug)]
pub struct Page {
    serial: u64,
    paths: Vec<StoredPath>,
    vertices: Vec<VertexRecord>,
}

impl Page {
    /// Bytes that a page uses at most, with its copy on the graphics card.
    pub const BYTES: usize = PAGE_POINTS * (size_of::<VertexRecord>() + size_of::<LinePoint>())
        + PAGE_POINTS / FEWEST_VERTICES * size_of::<StoredPath>();

    pub(super) fn new(serial: u64) -> Self {
        Self {
            serial,
            paths: Vec::with_capacity(PAGE_POINTS / FEWEST_VERTICES),
            vertices: Vec::with_capacity(PAGE_POINTS),
        }
    }

    /// Number of the page since the viewer started.
    pub fn serial(&self) -> u64 {
        self.serial
    }

    /// The paths, oldest first.
    pub fn paths(&self) -> &[StoredPath] {
        &self.paths
    }

    /// The vertices of one of its paths, from the light to the lens.
    pub fn vertices(&self, path: &StoredPath) -> &[VertexRecord] {
        let first = path.first as usize;
        self.vertices.get(first..first + usize::from(path.count)).unwrap_or_default()
    }

    /// Number of vertices.
    pub fn point_count(&self) -> usize {
        self.vertices.len()
    }

    pub(super) fn has_room(&self, vertices: usize) -> bool {
        self.vertices.len() + vertices <= PAGE_POINTS
    }

    pub(super) fn push(&mut self, path: &PathView<'_>, ordinal: u32) {
        self.paths.push(StoredPath {
            header: path.header,
            first: self.vertices.len() as u32,
            count: path.vertices.len() as u8,
            ordinal,
        });
        self.vertices.extend_from_slice(path.vertices);
    }

    /// The points to draw of every path from number `skip` on, in order.
    pub fn points(&self, skip: usize) -> impl Iterator<Item = LinePoint> {
        let paths = self.paths.get(skip..).unwrap_or_default();
        paths.iter().flat_map(|path| {
            let color = color_code(&path.header);
            let last = usize::from(path.count).saturating_sub(1);
            self.vertices(path).iter().enumerate().map(move |(i, vertex)| {
                let start = if i == 0 { role::START } else { 0 };
                let end = if i == last { role::LAST } else { 0 };
                let along = (255 * i).checked_div(last).unwrap_or(0) as u8;
                let info = [start | end, path.header.strategy.0, along, last as u8];
                LinePoint { position: vertex.position, color, ordinal: path.ordinal, info }
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
