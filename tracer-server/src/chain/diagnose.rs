//! What many monitored chains say together: chains that run apart agree where they explore well, and
//! differ where they do not [Gelman and Rubin 1992].

use common::{BatchBuilder, BatchLimits, Diagnostics, PathBatch, TileGrid, TileMaps, UNKNOWN};

use super::Chain;
use super::blocks::Blocks;
use super::monitor::{LongestStay, Monitor, TileCounts};
use crate::path::Vertex;

/// Arrivals that a tile must have seen before anything is said of it.
const ENOUGH: u64 = 32;
/// Longest stays that are reported.
const LONGEST: usize = 8;

/// What the monitored among `chains` say; `None` where there are none, or no steps yet.
pub(super) fn diagnose<'a, I: Iterator<Item = &'a Chain>>(chains: I) -> Option<Diagnostics> {
    let monitors: Vec<&Monitor> = chains.filter_map(Chain::monitor).collect();
    let grid = monitors.first()?.grid();
    let steps: u64 = monitors.iter().map(|monitor| monitor.settled()).sum();
    if steps == 0 {
        return None;
    }
    let heard: Vec<&Blocks> = monitors.iter().filter_map(|monitor| monitor.blocks()).collect();
    let mut blocks = Blocks::default();
    for chain in &heard {
        blocks.add(chain);
    }
    let moments: Vec<_> = heard.iter().map(|chain| chain.moments()).collect();
    let per_chain = blocks.steps() as f64 / heard.len() as f64;
    let correlation_steps = blocks.correlation_steps().unwrap_or(0.0);
    let known = correlation_steps > 0.0;
    Some(Diagnostics {
        grid,
        maps: maps(grid, &monitors),
        autocorrelation: blocks.correlations(),
        correlation_steps,
        effective_samples: if known { steps as f64 / correlation_steps } else { 0.0 },
        r_hat: scale_reduction(&moments, per_chain).unwrap_or(0.0),
        longest: batch(&longest(monitors.iter().copied())),
    })
}

/// Potential scale reduction of a quantity whose means and variances within chains of `steps` steps
/// are given; `None` where it does not vary within any chain, or there is one chain only.
fn scale_reduction(moments: &[(f64, f64)], steps: f64) -> Option<f64> {
    let chains = moments.len() as f64;
    let mean = moments.iter().map(|(mean, _)| mean).sum::<f64>() / chains;
    let within = moments.iter().map(|(_, variance)| variance).sum::<f64>() / chains;
    let between = moments.iter().map(|(m, _)| (m - mean).powi(2)).sum::<f64>() / (chains - 1.0);
    let reduction = ((steps - 1.0) / steps + between / within).sqrt();
    reduction.is_finite().then_some(reduction)
}

/// Sums over chains at one tile.
#[derive(Clone, Copy, Debug, Default)]
struct Tile {
    counts: TileCounts,
    /// Of the shares of their steps that the chains spent there.
    shares: f64,
    squares: f64,
}

fn maps(grid: TileGrid, monitors: &[&Monitor]) -> TileMaps {
    let mut tiles = vec![Tile::default(); grid.len()];
    for monitor in monitors {
        let steps = monitor.settled().max(1) as f64;
        for (tile, counts) in tiles.iter_mut().zip(monitor.tiles()) {
            let share = counts.steps as f64 / steps;
            tile.counts.steps += counts.steps;
            tile.counts.visits += counts.visits;
            tile.counts.acceptance += counts.acceptance;
            tile.shares += share;
            tile.squares += share * share;
        }
    }
    let chains = monitors.len() as f64;
    let [width, height] = monitors.first().map_or([1, 1], |monitor| monitor.size());
    let visits: u64 = tiles.iter().map(|tile| tile.counts.visits).sum();
    let mean_visits = visits as f64 / (f64::from(width) * f64::from(height));
    let density = |(index, tile): (usize, &Tile)| {
        let [x, y] = grid.origin(index);
        let pixels = (width - x).min(grid.side) * (height - y).min(grid.side);
        (tile.counts.visits as f64 / (f64::from(pixels) * mean_visits)) as f32
    };
    let map = |value: &dyn Fn(&Tile) -> f64| -> Vec<f32> {
        let known = |tile: &Tile| {
            let value = value(tile) as f32;
            if tile.counts.visits >= ENOUGH && value.is_finite() { value } else { UNKNOWN }
        };
        tiles.iter().map(known).collect()
    };
    TileMaps {
        acceptance: map(&|tile| tile.counts.acceptance / tile.counts.steps as f64),
        dwell: map(&|tile| tile.counts.steps as f64 / tile.counts.visits as f64),
        visits: tiles.iter().enumerate().map(density).collect(),
        spread: map(&|tile| (tile.between(chains) / chains).sqrt() * chains / tile.shares),
        r_hat: map(&|tile| tile.scale_reduction(chains)),
    }
}

impl Tile {
    /// Variance of the share between chains.
    fn between(&self, chains: f64) -> f64 {
        let mean = self.shares / chains;
        ((self.squares - chains * mean * mean) / (chains - 1.0)).max(0.0)
    }

    /// Potential scale reduction of being in the tile: within a chain, that varies by p (1 - p).
    fn scale_reduction(&self, chains: f64) -> f64 {
        let within = (self.shares - self.squares) / chains;
        (1.0 + self.between(chains) / within).sqrt()
    }
}

/// The longest stays of different chains, the longest first.
pub(super) fn longest<'a>(monitors: impl Iterator<Item = &'a Monitor>) -> Vec<&'a LongestStay> {
    let mut stays: Vec<_> = monitors.map(Monitor::longest).collect();
    stays.retain(|stay| !stay.vertices.is_empty());
    stays.sort_by_key(|stay| std::cmp::Reverse(stay.header.dwell));
    stays.truncate(LONGEST);
    stays
}

/// Stays as a batch of whole paths.
fn batch(stays: &[&LongestStay]) -> Option<PathBatch> {
    let mut builder = BatchBuilder::new(BatchLimits { bytes: usize::MAX });
    for stay in stays {
        let vertices: Vec<_> = stay.vertices.iter().map(Vertex::record).collect();
        // The batch has no limit, so none is complete before its time.
        drop(builder.push(&stay.header, &vertices, None));
    }
    builder.finish()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::chain::{Ensemble, EnsembleSettings};
    use crate::scene::Scene;
    use crate::scene::load::load;

    fn ensemble(threads: usize, monitored: bool) -> (Scene, Ensemble) {
        let mut description = load("cornell").expect("a built-in scene").description;
        (description.width, description.height) = (64, 48);
        let scene = Scene::new(&description).expect("a sound scene");
        let settings = EnsembleSettings {
            seed: 5,
            chains: 24,
            threads,
            bootstrap_samples: 1 << 13,
            ..EnsembleSettings::default()
        };
        let mut ensemble = Ensemble::new(&scene, &settings, |_| ());
        if monitored {
            ensemble.monitor();
        }
        for _ in 0..4 {
            ensemble.advance(&scene, 1000, Some(8));
        }
        (scene, ensemble)
    }

    #[test]
    fn watching_changes_no_bit_and_does_not_depend_on_threads() {
        let (scene, monitored) = ensemble(1, true);
        let (_, plain) = ensemble(1, false);
        assert!(monitored.image(&scene) == plain.image(&scene), "the image");
        assert_eq!(monitored.statistics(), plain.statistics(), "the counts");
        assert_eq!(plain.diagnostics(), None, "nobody looks");
        let (_, parallel) = ensemble(2, true);
        assert_eq!(monitored.diagnostics(), parallel.diagnostics(), "any number of threads");
    }

    #[test]
    fn the_tables_hold_every_step() {
        let (_, ensemble) = ensemble(1, true);
        let monitors: Vec<_> = ensemble.chains().filter_map(Chain::monitor).collect();
        let tiles = || monitors.iter().flat_map(|m| m.tiles());
        let steps: u64 = tiles().map(|tile| tile.steps).sum();
        assert_eq!(steps, ensemble.steps(), "steps");
        let statistics = ensemble.statistics();
        let accepted: u64 = statistics.strategies.iter().map(|s| s.accepted).sum();
        let visits: u64 = tiles().map(|tile| tile.visits).sum();
        assert_eq!(visits, accepted + monitors.len() as u64, "arrivals, the seeds included");
        let probability: f64 = statistics.strategies.iter().map(|s| s.acceptance_sum).sum();
        let summed: f64 = tiles().map(|tile| tile.acceptance).sum();
        assert!((summed / probability - 1.0).abs() < 1e-9, "{summed} of {probability}");
        // Every step puts luminance 1 on the film; part of it goes to proposals, so that the tables
        // and the film agree on average only.
        let splats = ensemble.splats();
        let grid = monitors[0].grid();
        let mut energy = vec![0.0; grid.len()];
        for (pixel, color) in splats.pixels().iter().enumerate() {
            let (x, y) = (pixel as u32 % splats.width(), pixel as u32 / splats.width());
            energy[grid.tile(x, y)] += color.luminance();
        }
        let mut stood = vec![0.0; grid.len()];
        for monitor in &monitors {
            for (sum, tile) in stood.iter_mut().zip(monitor.tiles()) {
                *sum += tile.steps as f64;
            }
        }
        let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let cosine =
            product(&energy, &stood) / (product(&energy, &energy) * product(&stood, &stood)).sqrt();
        assert!(cosine > 0.99, "the film and the tables show the same picture: {cosine}");
        let longest = ensemble.diagnostics().and_then(|d| d.longest).expect("stays");
        let dwells = &longest.paths().dwell;
        assert_eq!(dwells.len(), LONGEST, "the longest ones");
        assert!(dwells.is_sorted_by(|a, b| a >= b), "the longest first: {dwells:?}");
        assert!(u64::from(dwells[0]) >= statistics.longest_dwell, "none is longer: {dwells:?}");
    }

    #[test]
    fn chains_that_never_meet_are_found_out() {
        // Two places, and chains that stay where they began: only the variance between them is left.
        let apart: Vec<_> = (0..8).map(|i| (f64::from(i % 2), 0.01)).collect();
        let r_hat = scale_reduction(&apart, 1000.0).expect("it varies");
        assert!(r_hat > 5.0, "{r_hat}");
        let together = vec![(0.5, 0.25); 8];
        let r_hat = scale_reduction(&together, 1000.0).expect("it varies");
        assert!((r_hat - 1.0).abs() < 1e-3, "{r_hat}");
        assert_eq!(scale_reduction(&[(0.5, 0.25)], 1000.0), None, "one chain cannot disagree");
        let tile = |shares: &[f64]| Tile {
            counts: TileCounts::default(),
            shares: shares.iter().sum(),
            squares: shares.iter().map(|s| s * s).sum(),
        };
        let agree = tile(&[0.1, 0.11, 0.09, 0.1]).scale_reduction(4.0);
        let differ = tile(&[0.4, 0.0, 0.0, 0.0]).scale_reduction(4.0);
        assert!(agree < 1.01 && differ > 1.1, "{agree} and {differ}");
    }
}
