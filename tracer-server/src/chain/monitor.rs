//! What a chain's every step tells of how well it explores.
//!
//! A monitor draws no random numbers and changes nothing, so a monitored chain takes the same steps as
//! one that is not. Its tables are written when a state is left, not at every step, and it allocates
//! nothing after it was made.

use common::{ChainId, MAX_VERTICES, PathHeader, TileGrid};
use glam::DVec2;

use super::Chain;
use super::blocks::Blocks;
use crate::path::{Path, Vertex};

/// Chains whose memory is measured: the first ones, since so many know it as well as all.
const REMEMBERED: u32 = 16;
/// Most tiles that the film is divided into.
const TILES: u32 = 1024;

/// Sums over what happened at states that end in one tile of the film.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct TileCounts {
    /// Steps that the chain stood there.
    pub(super) steps: u64,
    /// Arrivals.
    pub(super) visits: u64,
    /// Sum of the acceptance probabilities of the proposals made from there.
    pub(super) acceptance: f64,
}

/// The state at which a chain stayed longest: all that is needed to make it again.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LongestStay {
    /// What is known of the path; its dwell is the length of the stay so far.
    pub header: PathHeader,
    /// The path's vertices.
    pub vertices: Vec<Vertex>,
    /// Its film point.
    pub film: DVec2,
}

/// Looks over one chain's shoulder.
#[derive(Clone, Debug)]
pub(super) struct Monitor {
    grid: TileGrid,
    /// Width and height of the film in pixels.
    size: [u32; 2],
    /// Width and height of the film in tiles.
    tiles_a_side: DVec2,
    tiles: Vec<TileCounts>,
    /// What the chain remembers, if that is measured.
    blocks: Option<Box<Blocks>>,
    /// Steps in the tables.
    settled: u64,
    longest: LongestStay,
    /// Tile and log luminance of the current state.
    tile: usize,
    log_luminance: f64,
    /// Steps at the current state, and the sum of their acceptance probabilities, that are not in the
    /// tables yet.
    steps: u64,
    acceptance: f64,
}

impl Monitor {
    /// Begins to look at the chain `id` in the state `current`, on a film of `size` pixels.
    pub(super) fn new(id: ChainId, size: [u32; 2], current: &Path) -> Self {
        let [width, height] = size;
        let grid = TileGrid::over(width, height, TILES);
        let vertices = Vec::with_capacity(MAX_VERTICES);
        let mut monitor = Self {
            grid,
            size,
            tiles_a_side: DVec2::new(f64::from(width), f64::from(height)) / f64::from(grid.side),
            tiles: vec![TileCounts::default(); grid.len()],
            blocks: (id.0 < REMEMBERED).then(Box::default),
            settled: 0,
            longest: LongestStay { vertices, ..LongestStay::default() },
            tile: 0,
            log_luminance: 0.0,
            steps: 0,
            acceptance: 0.0,
        };
        monitor.arrive(current);
        monitor
    }

    /// Forgets everything, and begins anew in the state `current`.
    pub(super) fn begin(&mut self, id: ChainId, current: &Path) {
        *self = Self::new(id, self.size, current);
    }

    /// The chain has come to `path`.
    #[inline]
    pub(super) fn arrive(&mut self, path: &Path) {
        let place = path.film() * self.tiles_a_side;
        let column = (place.x as usize).min(self.grid.columns as usize - 1);
        let row = (place.y as usize).min(self.grid.rows as usize - 1);
        self.tile = row * self.grid.columns as usize + column;
        if self.blocks.is_some() {
            self.log_luminance = -path.density_sum().ln();
        }
        self.tiles[self.tile].visits += 1;
    }

    /// A step has ended at the current state.
    #[inline]
    pub(super) fn step(&mut self) {
        self.steps += 1;
    }

    /// A proposal from the current state had this probability.
    #[inline]
    pub(super) fn propose(&mut self, acceptance: f64) {
        self.acceptance += acceptance;
    }

    /// Puts what happened at the chain's current state into the tables.
    pub(super) fn settle(&mut self, chain: &Chain) {
        let counts = &mut self.tiles[self.tile];
        counts.steps += self.steps;
        counts.acceptance += self.acceptance;
        self.settled += self.steps;
        if let Some(blocks) = &mut self.blocks {
            blocks.push(self.log_luminance, self.steps);
        }
        (self.steps, self.acceptance) = (0, 0.0);
        let dwell = u32::try_from(chain.stay()).unwrap_or(u32::MAX);
        if dwell > self.longest.header.dwell {
            self.longest.header = chain.header();
            self.longest.header.dwell = dwell;
            self.longest.vertices.clear();
            self.longest.vertices.extend_from_slice(chain.current().vertices());
            self.longest.film = chain.current().film();
        }
    }

    /// Width and height of the film in pixels.
    pub(super) fn size(&self) -> [u32; 2] {
        self.size
    }

    /// The tiles.
    pub(super) fn grid(&self) -> TileGrid {
        self.grid
    }

    /// The sums of every tile.
    pub(super) fn tiles(&self) -> &[TileCounts] {
        &self.tiles
    }

    /// Steps in the tables.
    pub(super) fn settled(&self) -> u64 {
        self.settled
    }

    /// What the chain remembers of its log luminance, if that is measured.
    pub(super) fn blocks(&self) -> Option<&Blocks> {
        self.blocks.as_deref()
    }

    /// Where the chain stayed longest.
    pub(super) fn longest(&self) -> &LongestStay {
        &self.longest
    }
}
